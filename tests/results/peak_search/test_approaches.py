"""No peak of a spring or damper is missed whose ends pass close by and turn it over within a fraction of a degree."""

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.results.peak_search.approaches import approaches
from linksweep.results.peak_search.groups import different, groups

MACHINE = ls.FourBar(
    ls.Link(0.11, 0.13, 0.02, 0.01, -120.0),
    ls.Link(0.53, 1.7, 0.014, 0.02, 110.0),
    ls.Link(0.49, 2.0, 0.003, 0.04, 105.0),
    ground=0.46,
    branch="crossed",
)


def braked(distance=4e-4, radius=0.3637, scene=MACHINE, **words) -> ls.Scene:
    """A damper between a point of the ground and one of the crank, which pass at this distance at 64 degrees."""
    fixed = radius * np.exp(1j * np.radians(64.0))
    ends = ("crank", radius + distance, 0.0), ("ground", fixed.real, fixed.imag)
    return ls.Scene(scene, omega2=22.0, gravity=(6.5, 8.6), loads=[ls.Damper(*ends, coefficient=20.0)], **words)


def brute(scene: ls.Scene, of: str) -> float:
    """The largest of samples every 1e-5 degree where the ends pass."""
    return ls.sweep(scene, np.arange(62.0, 66.0, 1e-5), of=[of])[of].max(...).item()


def test_a_damper_whose_ends_pass_close_by():
    scene = braked()
    peaks = ls.peaks(scene, of=["F12", "F12_bound"])
    assert peaks.F12_peak >= brute(scene, "F12")
    assert peaks.F12_peak == pytest.approx(222.181832, rel=1e-8)
    assert peaks.F12_peak_at == pytest.approx(63.867317, abs=1e-5)


@pytest.mark.parametrize("distance", [1e-2, 1e-3, 1e-5, 1e-8, 0.0])
@pytest.mark.parametrize("omega2", [22.0, lambda theta2: 22.0 + 0.0 * theta2])
def test_however_close_they_pass(distance, omega2):
    scene = braked(distance)
    peaks = ls.peaks(ls.Scene(MACHINE, omega2, gravity=(6.5, 8.6), loads=scene.loads), of=["F12"])
    assert peaks.F12_peak >= brute(scene, "F12") * (1.0 - 1e-10)


def test_a_spring_at_rest_turns_over_too():
    """Its direction turns with the position alone, also of a crank that stands."""
    ends = braked().loads[0].from_, braked().loads[0].to
    scene = ls.Scene(MACHINE, omega2=0.0, loads=[ls.Spring(*ends, rate=300.0, free_length=0.2)])
    peaks = ls.peaks(scene, of=["T12"])
    assert peaks.T12_max >= brute(scene, "T12") * (1.0 - 1e-10)


@pytest.mark.parametrize("ground", [0.55, 0.25])
def test_the_pin_of_a_crank_at_rest_bears_the_whole_spring_in_every_direction_that_it_turns_through(ground):
    """Also where the crank moves over part of a turn: F12 is opposite to the spring, whose direction turns by half a
    turn about where its ends pass; there its tension is rate·(distance - free length)."""
    machine = ls.FourBar(*(ls.Link(x, 1.0, 0.01, 0.1) for x in (0.3, 0.3, 0.35)), ground=ground)
    ends = braked(1e-5, radius=0.2).loads[0]
    scene = ls.Scene(machine, omega2=0.0, loads=[ls.Spring(ends.from_, ends.to, rate=300.0, free_length=2.0)])
    peaks = ls.peaks(scene, of=["F12x", "F12y"])
    assert peaks.status == 1
    along_x, along_y = 300.0 * (2.0 - 1e-5 / np.cos(np.radians([64.0, 26.0])))
    sagitta = 300.0 * 1e-9  # of the circle that the end moves on, over as much as it takes to turn
    np.testing.assert_allclose([peaks.F12x_min, peaks.F12y_min], [-along_x, -along_y], rtol=0.0, atol=4.0 * sagitta)


def test_the_drive_works_against_a_spring_on_both_arcs_of_a_crank_that_turns_partly():
    """Without masses ∫ T12 dθ2 is the spring's gain of ½·rate·stretch² from toggle to toggle. The spring's ends would
    come close between the arcs, where nothing can be assembled."""
    lengths, fixed, rate, free_length = (0.2, 0.15, 0.12), 0.05 + 0.1j, 2000.0, 0.01
    machine = ls.FourBar(*(ls.Link(x, mass=0.0, inertia=0.0) for x in lengths), ground=0.2)
    spring = ls.Spring(("ground", fixed.real, fixed.imag), ("coupler", 0.1, 15.0), rate, free_length)
    scene = ls.Scene(machine, omega2=30.0, loads=[spring])
    peaks = ls.peaks(scene, of=["F32", "T12_mean"])
    assert peaks.status.attrs["flag_meanings"].split()[peaks.status.item()] == "unbounded"

    def energy(theta2):
        """Return the spring's energy where coupler and rocker lie in one line, at |BD| = |BC| ± |CD|."""
        b = lengths[0] * np.exp(1j * np.radians(theta2))
        toward_d = (0.2 - b) / np.abs(0.2 - b)
        point = b + 0.1 * toward_d * np.exp(1j * np.radians(15.0))
        return 0.5 * rate * (np.abs(point - fixed) - free_length) ** 2

    arcs = ls.check(scene)
    gain = (energy(arcs.arc_end.values) - energy(arcs.arc_start.values)).sum()
    turned = np.radians(arcs.arc_end - arcs.arc_start).sum()
    assert peaks.T12_mean.item() == pytest.approx(gain / turned.item(), rel=1e-7)


def test_approaches_on_the_crank_are_those_of_a_point_on_a_circle():
    """Distance √((ρ − R)² + 4ρR·sin²(Δ/2)): least, |ρ − R|, in line, and the width there |ρ − R|/ρ."""
    distance = xr.DataArray([1e-3, 1e-4, 1e-6], dims="design")
    scene = braked(distance)
    (group,) = groups(scene, different(scene, ("F12",)))
    angles = np.tile(np.arange(0.0, 360.0, 5.0), (3, 1))
    close = approaches(group, angles)
    np.testing.assert_array_equal(close.row, [0, 1, 2])
    np.testing.assert_allclose(close.angle, 64.0, atol=1e-9)
    np.testing.assert_allclose(close.width, np.degrees(distance / (0.3637 + distance)), rtol=1e-6)


def test_a_damper_that_never_comes_close_is_not_looked_at_twice():
    scene = ls.Scene(MACHINE, 22.0, loads=[ls.Damper(("ground", -0.5, 0.3), ("rocker", 0.2, 0.0), coefficient=20.0)])
    samples = ls.peaks(scene, of=["F12_samples"]).F12_samples
    without = ls.peaks(ls.Scene(MACHINE, 22.0), of=["F12_samples"]).F12_samples
    assert samples < 2 * without
