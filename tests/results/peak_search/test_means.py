"""Means over the revolution against quadrature in 30 digits of formulas that are not the package's.

Links without mass leave a slider-crank's forces to one line: the rod pushes the slider with R along itself, the guide
answers with N = R·sin φ across and μ|N| against its motion. A four-bar without mass passes a torque on as the rocker
turns with the crank, and its coupler presses with T/(c·sin μ).
"""

import math
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
import xarray as xr
from references import mp

import linksweep as ls

A, B, MASS, SPEED = 0.04, 0.14, 0.5, 100.0
BORE, RATIO, P1, P3, GAMMA = 0.05, 9.0, 1.0e5, 4.0e6, 1.4


@dataclass(frozen=True)
class Engine:
    """A slider and its friction, with an Otto cycle or without; angles in radians, in mpmath's numbers."""

    offset: float
    friction: float
    gas: bool

    @property
    def turns(self) -> int:
        return 2 if self.gas else 1

    def dead_centres(self) -> list:
        """Return angles of the whole cycle, counted from the one at which it fires."""
        top, bottom = mp.asin(mp.mpf(self.offset) / (A + B)), mp.pi + mp.asin(mp.mpf(self.offset) / (B - A))
        return [angle + 2 * mp.pi * k for k in range(self.turns) for angle in (top, bottom)]

    def slider(self, angle):
        """Position, and its first two derivatives by the angle; the rod's height over its length."""
        up, cos, sin = self.offset - A * mp.sin(angle), mp.cos(angle), mp.sin(angle)
        along = mp.sqrt(B * B - up * up)
        first = -A * sin + up * A * cos / along
        second = -A * cos - (A * A * cos * cos + up * A * sin) / along + up * up * A * A * cos * cos / -(along**3)
        return A * cos + along, first, second, up / B

    def pressure(self, x, stroke: int):
        """Expansion, exhaust, intake, compression; over that of the crankcase."""
        near, far = mp.sqrt((B - A) ** 2 - self.offset**2), mp.sqrt((A + B) ** 2 - self.offset**2)
        volume = 1 + (RATIO - 1) * (far - x) / (far - near)
        return (P3 * volume**-GAMMA, P1, P1, P1 * (RATIO / volume) ** GAMMA)[stroke] - P1 if self.gas else 0

    @cache  # noqa: B019
    def loads(self, angle, stroke: int) -> tuple:
        """R [N], and the torque of the drive [N m], from the power of all forces."""
        x, first, second, sin = self.slider(angle)
        push = MASS * SPEED**2 * second + mp.pi * BORE**2 / 4 * self.pressure(x, stroke)
        cos = mp.sqrt(1 - sin * sin)
        against = self.friction * abs(sin) * mp.sign(first) * mp.sign(push)
        R = push / (cos - against)
        return R, first * push + self.friction * abs(R * sin * first)

    def mean(self, what) -> float:
        """Return the mean of a function of R and torque, stroke by stroke; cut where R changes its sign."""
        starts = self.dead_centres()
        total = mp.mpf(0)
        for stroke, (start, end) in enumerate(pairwise([*starts, starts[0] + 2 * mp.pi * self.turns])):
            level = [angle for angle in self.level() if start < angle < end]
            cuts = sorted([start, *self.turning_points(start, end, stroke), *level, end])
            total += mp.quad(lambda angle, stroke=stroke: what(*self.loads(angle, stroke)), cuts)
        return float(total / (2 * mp.pi * self.turns))

    def level(self) -> list:
        """Return the angles at which the rod lies along the guide, and the guide's force changes its side."""
        angle = mp.asin(mp.mpf(self.offset) / A)
        return [first + 2 * mp.pi * k for k in range(-1, self.turns + 1) for first in (angle, mp.pi - angle)]

    def turning_points(self, start, end, stroke: int) -> list:
        angles = mp.linspace(start + mp.mpf("1e-9"), end - mp.mpf("1e-9"), 24)
        R = [self.loads(angle, stroke)[0] for angle in angles]
        push = lambda angle: self.loads(angle, stroke)[0]  # noqa: E731
        crossed = [(a, b) for (a, r), (b, s) in pairwise(zip(angles, R, strict=True)) if r * s < 0]
        return [mp.findroot(push, pair, solver="anderson") for pair in crossed]

    def scene(self) -> ls.Scene:
        links = ls.Link(A, 0.0, 0.0), ls.Link(B, 0.0, 0.0)
        engine = ls.SliderCrank(*links, slider_mass=MASS, offset=self.offset, friction=self.friction)
        gas = ls.GasPressure(BORE, ls.OttoCycle(RATIO, P3, P1, GAMMA), crankcase=P1)
        return ls.Scene(engine, SPEED, loads=[gas] if self.gas else [])


@pytest.mark.parametrize(
    "engine",
    [Engine(0.0, 0.3, False), Engine(0.02, 0.3, False), Engine(0.02, 0.0, True), Engine(0.0, 0.2, True)],
)
def test_means_with_friction_and_gas(engine):
    peaks = ls.peaks(engine.scene(), of=["F32_mean", "F32_rms", "T12_mean", "T12_rms"])
    with mp.workdps(20):
        assert float(peaks.F32_mean) == pytest.approx(engine.mean(lambda R, T: abs(R)), rel=1e-10)
        assert float(peaks.F32_rms) == pytest.approx(math.sqrt(engine.mean(lambda R, T: R * R)), rel=1e-10)
        torque = math.sqrt(engine.mean(lambda R, T: T * T))
        assert float(peaks.T12_rms) == pytest.approx(torque, rel=1e-10)
        assert float(peaks.T12_mean) == pytest.approx(engine.mean(lambda R, T: T), rel=1e-10, abs=1e-10 * torque)
    assert int(peaks.status) == 0


# -------------------------------------------------------------------------------------------- part of a turn

TORQUE = -12.0
SWINGING = {
    "folded": (0.3, 0.7, 0.3, 0.4),
    "stretched": (0.3, 0.25, 0.2, 0.4),
    "both": (0.3, 0.4, 0.2, 0.4),
}
"""Crank, coupler, rocker, ground, by the toggles that end its arcs."""


def swinging(kind: str) -> ls.Scene:
    *links, ground = SWINGING[kind]
    mechanism = ls.FourBar(*(ls.Link(length, 0.0, 0.0) for length in links), ground=ground)
    return ls.Scene(mechanism, 10.0, loads=[ls.Load("rocker", torque=TORQUE)])


def arcs(kind: str) -> list[tuple]:
    """Starts and ends [rad] of where the diagonal from B to D lies between b − c and b + c, by the cosine rule."""
    a, b, c, d = map(mp.mpf, SWINGING[kind])
    folded, stretched = (mp.acos((a * a + d * d - f * f) / (2 * a * d)) for f in (abs(b - c), b + c))
    ends = {"folded": (folded, 2 * mp.pi - folded), "stretched": (-stretched, stretched), "both": (folded, stretched)}
    first = tuple(mp.re(end) for end in ends[kind])
    return [first, (-first[1], -first[0])] if kind == "both" else [first]


def triangle(kind: str, angle) -> tuple:
    """Return the sine of the angle at C of the triangle B, C, D, and the rocker's angle from x."""
    a, b, c, d = map(mp.mpf, SWINGING[kind])
    across, up = a * mp.cos(angle) - d, a * mp.sin(angle)  # from D to B
    f = mp.sqrt(across**2 + up**2)
    at_c, at_d = (b * b + c * c - f * f) / (2 * b * c), (c * c + f * f - b * b) / (2 * c * f)
    # C lies to the left of the line from B to D: seen from D, clockwise of B
    return mp.sqrt(abs(1 - at_c**2)), mp.atan2(up, across) - mp.acos(max(-1, min(1, at_d)))


def swing(kind: str, start, end):
    """Return the angle that the rocker turns along an arc, step by step."""
    angles = [triangle(kind, angle)[1] for angle in mp.linspace(start, end, 50)]
    steps = [after - before for before, after in pairwise(angles)]
    return sum(step - 2 * mp.pi * mp.nint(step / (2 * mp.pi)) for step in steps)


@pytest.mark.parametrize("kind", SWINGING)
def test_means_over_part_of_a_turn(kind):
    peaks = ls.peaks(swinging(kind), of=["F43_mean", "T12_mean", "omega4_mean"])
    with mp.workdps(30):
        length = sum(end - start for start, end in arcs(kind))
        parts = [mp.quad(lambda angle: 1 / triangle(kind, angle)[0], [s, (s + e) / 2, e]) for s, e in arcs(kind)]
        force = float(abs(TORQUE) / SWINGING[kind][2] * sum(parts) / length)
        ratio = float(sum(swing(kind, s, e) for s, e in arcs(kind)) / length)
    assert float(peaks.F43_mean) == pytest.approx(force, rel=1e-10)
    assert float(peaks.omega4_mean) == pytest.approx(10.0 * ratio, rel=1e-10, abs=1e-10)
    assert float(peaks.T12_mean) == pytest.approx(-TORQUE * ratio, rel=1e-10, abs=1e-10)


@pytest.mark.parametrize("turn", [0, 1])
@pytest.mark.parametrize("kind", SWINGING)
def test_a_load_of_one_turn_in_two_has_half_the_mean(kind, turn):
    angles = np.arange(0.0, 720.0, 90.0)
    torque = xr.DataArray(np.where(angles // 360.0 == turn, TORQUE, 0.0), {"theta2": angles}, "theta2")
    load = ls.Load("rocker", torque=torque, interpolation="step")
    steady = float(ls.peaks(swinging(kind), of=["T12_mean"]).T12_mean)
    mean = float(ls.peaks(replace(swinging(kind), loads=[load]), of=["T12_mean"]).T12_mean)
    assert mean == pytest.approx(0.5 * steady, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("kind", SWINGING)
def test_a_mean_that_diverges_is_infinite_and_has_that_status(kind):
    peaks = ls.peaks(swinging(kind), of=["T12_rms"])  # its square goes with one over the distance from a toggle
    assert (float(peaks.T12_rms), int(peaks.status)) == (math.inf, 3)
    assert np.isfinite(ls.peaks(swinging(kind), of=["theta4_rms"]).theta4_rms)


def test_beside_the_dead_centres_of_a_driven_rod():
    rod = ls.Link(B, 1.0, 2e-3, cg_distance=0.05)
    engine = ls.SliderCrank(ls.Link(A, 1.0, 1e-4), rod, slider_mass=0.5, friction=0.1)
    peaks = ls.peaks(ls.Scene(engine, SPEED, drive="coupler"), of=["F32_rms", "F32_mean", "omega3_rms"])
    assert (float(peaks.F32_rms), float(peaks.F32_mean), int(peaks.status)) == (math.inf, math.inf, 3)
    with mp.workdps(20):  # sin φ = a/b·sin θ; it moves where the crank's slope is below 1/μ
        rate = lambda angle: (A * mp.cos(angle)) ** 2 / (B**2 - (A * mp.sin(angle)) ** 2)  # noqa: E731
        jam = mp.atan(1 / mp.mpf(engine.friction))
        expected = SPEED * math.sqrt(mp.quad(rate, [0, jam / 2, jam]) / jam)
    assert float(peaks.omega3_rms) == pytest.approx(expected, rel=1e-10)


def test_a_quantity_of_nothing_but_rounding_has_a_mean():
    """The inertia of a crank alone acts through A, where it has no moment."""
    crank = ls.Link(0.08, 1.0, 0.001, cg_distance=0.04)
    machine = ls.FourBar(crank, ls.Link(0.22, 0.0, 0.0), ls.Link(0.18, 0.0, 0.0), ground=0.20)
    means = ls.peaks(ls.Scene(machine, omega2=30.0), of=["Ms_rms", "Fs_rms"])
    assert float(means.Ms_rms) < 1e-15
    assert float(means.Fs_rms) == pytest.approx(1.0 * 0.04 * 30.0**2, rel=1e-13)


def test_a_kink_just_inside_the_end_of_a_piece_of_quadrature():
    """Lifting a crank's centre of gravity from below A to above it takes 2·m·g·d, in whichever direction gravity acts:
    where the work begins moves past the ends of pieces, beyond the outermost points of their rules, too."""
    mass, distance, aside = 1.5, 0.1, np.radians(np.linspace(0.0, 15.0, 301))
    gravity = (xr.DataArray(9.81 * numbers, dims="aside") for numbers in (np.sin(aside), -np.cos(aside)))
    massless = ls.Link(0.22, 0.0, 0.0), ls.Link(0.18, 0.0, 0.0)
    lifted = ls.FourBar(ls.Link(0.08, mass, 1e-3, cg_distance=distance), *massless, ground=0.2)
    work = ls.duty(ls.Scene(lifted, omega2=10.0, gravity=tuple(gravity))).work_fed
    np.testing.assert_allclose(work, 2.0 * mass * 9.81 * distance, rtol=1e-10)
