"""Peaks of linkages that move over part of a turn: on pieces of their arcs, and limits at the toggles between these."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np
import pytest
import xarray as xr
from long import long_but
from scipy.optimize import brentq, minimize_scalar

import linksweep as ls
from benchmarks.accuracy import missed
from linksweep.results.peak_search import exact
from linksweep.results.peak_search.limits import limits_of
from linksweep.scene.parameters import replaced

LINKAGES = {
    "watt-2": (("omega4", "Ex", "F12x", "T12"), (1.2, 2.5)),
    "jansen-leg": (("Hx", "omega4", "F12x", "T12"), (1.5, 2.2)),
    "knuckle-press": (("omega4", "F12x", "F14"), (3.0, 5.0)),
    "stephenson-3": (("omega4", "omega6", "F12x"), (2.8, 4.0)),
    "klann-leg": (("omega4", "omega6", "F12x"), (1.2, 2.5)),
}
"""Quantities that are searched, some of them bounded at toggles; and how many times as long the crank is."""


def longer(name: str, designs: int) -> ls.Scene:
    """Return an example with longer cranks, and other links of any length near their own."""
    random, machine = np.random.default_rng(1), ls.example(name).mechanism
    links = {role: getattr(machine, role) for role in machine.topology.links if role != "ground"}
    ends = {role: LINKAGES[name][1] if role == "crank" else (0.95, 1.05) for role in links}
    spread = {
        role: replace(link, length=xr.DataArray(link.length * random.uniform(*ends[role], designs), dims="design"))
        for role, link in links.items()
        if hasattr(link, "length")
    }
    return replace(ls.example(name), mechanism=replace(machine, **spread))


def counted(monkeypatch, search) -> list[int]:
    """Return a list that gets the number of designs of each search of arcs, and that of those that it leaves."""
    counts = []

    def follow(scene, designs, *arguments):
        left = search(scene, designs, *arguments)
        counts.extend([len(designs), len(left)])
        return left

    monkeypatch.setattr(exact, "follow_arcs", follow)
    return counts


@pytest.mark.parametrize("name", long_but(LINKAGES, "watt-2", "jansen-leg"))
def test_no_sample_exceeds_a_peak_and_paths_lead_to_the_same(name, monkeypatch):
    scene, of = longer(name, 12), list(LINKAGES[name][0])
    counts = counted(monkeypatch, exact.follow_arcs)
    peaks = ls.peaks(scene, of=of)
    assert counts[0] > 5 and counts[1] <= 0.3 * counts[0] * scene.mechanism.rubs
    assert missed.shortfall(peaks, ls.peaks(scene, of=of, theta2=1800)).max() <= 1e-10
    counted(monkeypatch, lambda scene, designs, *_: designs)
    along_paths = ls.peaks(scene, of=of)
    for value in (quantity for quantity in map(str, peaks.data_vars) if f"{quantity}_at" in peaks):
        np.testing.assert_allclose(peaks[value], along_paths[value], rtol=1e-9, err_msg=value)


def away(angle: xr.DataArray, other: float) -> float:
    """Return the distance between two crank angles [degree]."""
    return abs((float(angle) - other + 180.0) % 360.0 - 180.0)


LINK = partial(ls.Link, mass=1.0, inertia=0.01)


@pytest.mark.parametrize("turned", [0.0, 25.0, -70.0])
def test_angles_of_peaks_on_arcs_are_those_of_the_crank(turned):
    """The pin B of a crank a is rightmost at 0 and highest at 90 degrees; a crank and a rod that is shorter, past which
    the guide lies by e, are stretched at asin(e/(a + b)) from it."""
    slider = ls.SliderCrank(LINK(0.1), LINK(0.08), slider_mass=1.0, offset=0.03, slide_angle=turned)
    four_bar = ls.FourBar(LINK(0.2), LINK(0.25), LINK(0.1), ground=0.3, ground_angle=turned + 15.0)
    inverted = ls.InvertedSliderCrank(LINK(0.2), LINK(0.1), 0.15, 1.0, offset=0.08, ground_angle=turned)
    for machine, radius in ((slider, 0.1), (four_bar, 0.2), (inverted, 0.2)):
        scene = ls.Scene(machine, omega2=10.0)
        peaks, checks = ls.peaks(scene, of=["Bx", "By", "F12"]), ls.check(scene)
        first, last = float(checks.arc_start[0]), float(checks.arc_end[0])
        for name, angle in {"Bx_max": 0.0, "By_max": 90.0, "Bx_min": 180.0, "By_min": 270.0}.items():
            if (angle - first) % 360.0 < last - first:
                assert abs(float(peaks[name])) == pytest.approx(radius, rel=1e-12)
                assert away(peaks[f"{name}_at"], angle) < 1e-5
        assert np.isinf(peaks.F12_peak)
        assert min(away(peaks.F12_peak_at, toggle) for toggle in (first, last)) < 1e-9
    peaks = ls.peaks(ls.Scene(slider, omega2=10.0), of=["x_slider"])
    assert float(peaks.x_slider_max) == pytest.approx(math.sqrt(0.18**2 - 0.03**2), rel=1e-12)
    assert away(peaks.x_slider_max_at, turned + math.degrees(math.asin(0.03 / 0.18))) < 1e-5


def rocker_speed(theta2: np.ndarray, a: np.ndarray, b: float, c: float, d: float) -> np.ndarray:
    """Return ω4/ω2 of an open four-bar on the x axis at crank angles [degree], by its loop equation."""
    theta2 = np.radians(theta2)
    x, y = a * np.cos(theta2) - d, a * np.sin(theta2)
    distance = np.hypot(x, y)
    theta4 = np.arctan2(y, x) - np.arccos((distance**2 + c * c - b * b) / (2.0 * distance * c))
    theta3 = np.arctan2(c * np.sin(theta4) - y, c * np.cos(theta4) - x)
    return a * np.sin(theta3 - theta2) / (c * np.sin(theta3 - theta4))


@pytest.mark.parametrize("designs", [30, 80], ids=["interpreted", "compiled"])
def test_limits_where_a_later_dyad_toggles_are_values_of_the_four_bar_before_it(designs):
    """The rocker is stopped far from a toggle of its own; it turns the more quickly the nearer to that."""
    scene = ls.example("watt-2")
    machine, lengths = scene.mechanism, np.linspace(0.055, 0.065, designs)
    crank = replace(machine.crank, length=xr.DataArray(lengths, dims="design"))
    scene = replace(scene, mechanism=replace(machine, crank=crank))
    peaks, limits = ls.peaks(scene, of=["omega4"]), limits_of(scene.unloaded)[1]
    for value, sign in (("omega4_max", 1.0), ("omega4_min", -1.0)):
        at = peaks[f"{value}_at"].values
        ends = np.concatenate([limits.arc_start, limits.arc_end], axis=1)
        away = np.mod(at[:, None] - ends + 180.0, 360.0) - 180.0
        stopped = (np.abs(away) < 1e-9).any(axis=1)
        assert stopped.sum() > 0.3 * designs or sign < 0.0
        speed = float(scene.omega2) * rocker_speed(at, lengths, 0.113, 0.05, 0.126)
        np.testing.assert_allclose(peaks[value].values[stopped], speed[stopped], rtol=3e-11)


@pytest.mark.parametrize("couplers", [[0.22, 0.09], [0.09, 0.22], [0.22, 0.3], [0.3, 0.22]])
def test_a_signal_that_designs_share_has_the_highest_peak_on_the_arcs_of_all(couplers):
    press = replace(ls.example("press"), loads=[])
    scene = replaced(press, {"coupler.length": xr.DataArray(couplers, dims="design"), "crank.length": 0.3})
    checks, peaks = ls.check(scene), ls.peaks(scene, ["Bx"])
    arcs = np.stack([checks.arc_start, checks.arc_end], axis=-1).reshape(-1, 2)
    angles = np.radians(np.concatenate([np.linspace(*arc, 10_001) for arc in arcs if np.isfinite(arc).all()]))
    assert peaks.Bx_max == pytest.approx(0.3 * np.cos(angles).max(), rel=1e-7)
    assert peaks.Bx_min == pytest.approx(0.3 * np.cos(angles).min(), rel=1e-7)


def test_a_design_on_arcs_has_the_same_bits_whichever_others_stand_beside_it():
    """Others need limits of more signals, and closer to their toggles."""
    scene, of = longer("watt-2", 12), [*LINKAGES["watt-2"][0], "alpha4", "omega6"]
    together = ls.peaks(scene, of=[*of, *(f"{quantity}_samples" for quantity in of)])
    for design in (0, 5, 11):
        alone = ls.peaks(ls.scene_at(scene, design=design), of=[*of, *(f"{quantity}_samples" for quantity in of)])
        for name, peak in alone.data_vars.items():
            np.testing.assert_array_equal(peak, together[name].isel(design=design, missing_dims="ignore"), name)


ROD, FRICTION, OFFSET = np.random.default_rng(3).uniform([0.4, 0.2, -0.3], [0.65, 1.5, 0.3], (24, 3)).T
OMEGA2, ALPHA2 = 10.0, 3.0


def slope_of_slide(angle: np.ndarray, rod: float, offset: float) -> np.ndarray:
    """Return dx/dθ2 of a slide on a rod that is pinned to a crank of 1 m at angles [rad]."""
    across = np.sin(angle) - offset
    return -np.sin(angle) - across * np.cos(angle) / np.sqrt(rod * rod - across * across)


def force_and_torque(angle: np.ndarray, toward: float, rod: float, friction: float, offset: float) -> list[np.ndarray]:
    """Return the force P along the guide of a rod without mass on a slide of 1 kg, and the torque on the crank.

    The slide moves `toward` greater x, or less. P accelerates it against friction: P − μ·sign(v)·|P·tan φ| = a, where φ
    is the angle between rod and guide; where μ·|tan φ| = 1, P is a/2 or infinite.
    """
    across = np.sin(angle) - offset
    along, slope = np.sqrt(rod * rod - across * across), slope_of_slide(angle, rod, offset)
    bend = -np.cos(angle) - (np.cos(angle) ** 2 * rod * rod / along**2 - across * np.sin(angle)) / along
    acceleration = bend * OMEGA2**2 + slope * ALPHA2
    share = 1.0 - toward * np.sign(acceleration) * friction * np.abs(across) / along
    with np.errstate(divide="ignore"):
        force = acceleration / np.where(share < 1e-12, 0.0, share)
    return [force, force * slope]


def largest(function: Callable[[np.ndarray], np.ndarray], start: float, end: float) -> float:
    angles = np.linspace(start, end, 3001)
    values = function(angles)
    top = int(values.argmax())
    about = angles[max(top - 1, 0)], angles[min(top + 1, 3000)]
    return max(values[top], -minimize_scalar(lambda angle: -function(angle), bounds=about, method="bounded").fun)


def bounds_where_friction_does_not_wedge(rod: float, friction: float, offset: float) -> np.ndarray:
    """Return the least and the largest force, and torque, between the angles at which friction wedges, ends included.

    There the slide lies sin φ = 1/√(1 + μ²) of the rod beside the crank pin; where it stands still, friction jumps.
    """
    wedged = np.arcsin(offset + rod / np.hypot(1.0, friction) * np.array([-1.0, 1.0]))
    of_pieces = []
    for first, last in (wedged, np.pi - wedged[::-1]):
        cuts, slope = np.linspace(first, last, 3001), partial(slope_of_slide, rod=rod, offset=offset)
        turned = np.flatnonzero(slope(cuts[:-1]) * slope(cuts[1:]) < 0.0)
        ends = [first, *(brentq(slope, cuts[k], cuts[k + 1], xtol=1e-15) for k in turned), last]
        for piece in pairwise(ends):
            toward = np.sign(slope(0.5 * sum(piece)))
            at = partial(force_and_torque, toward=toward, rod=rod, friction=friction, offset=offset)
            force, torque = (lambda angle, at=at, k=k: at(angle)[k] for k in range(2))
            of_pieces.append([bounds(force, *piece), bounds(torque, *piece)])
    low, high = np.moveaxis(of_pieces, -1, 0)
    return np.stack([low.min(axis=0), high.max(axis=0)], axis=1)


def bounds(function: Callable[[np.ndarray], np.ndarray], start: float, end: float) -> tuple[float, float]:
    return -largest(lambda angle: -function(angle), start, end), largest(function, start, end)


def test_arcs_end_where_friction_wedges(monkeypatch):
    rod, friction, offset = (xr.DataArray(numbers, dims="design") for numbers in (ROD, FRICTION, OFFSET))
    machine = ls.Linkage(
        "crank A-B, rod B-C, ram C on slide",
        ground={"A": (0.0, 0.0)},
        guides={"slide": ls.Guide((0.0, offset), 0.0, friction)},
        crank=ls.Link(1.0, 0.0, 0.0),
        rod=ls.Link(rod, 0.0, 0.0),
        ram=ls.Slider(1.0),
    )
    designs = zip(ROD, FRICTION, OFFSET, strict=True)
    exact_bounds = np.array([bounds_where_friction_does_not_wedge(*numbers) for numbers in designs])
    force, torque = exact_bounds[:, 0], exact_bounds[:, 1]
    assert np.isfinite(exact_bounds[:, [0, 1], [1, 0]]).all() and np.isinf(exact_bounds[:, [0, 1], [0, 1]]).all()
    counts = counted(monkeypatch, exact.follow_arcs)
    peaks = ls.peaks(ls.Scene(machine, OMEGA2, ALPHA2), of=["F43x", "T12"])  # F43 acts on the rod
    np.testing.assert_allclose([peaks.F43x_min, peaks.F43x_max], -force.T[::-1], rtol=1e-9)
    np.testing.assert_allclose([peaks.T12_min, peaks.T12_max], torque.T, rtol=1e-9)
    assert counts == [len(ROD), 0]
