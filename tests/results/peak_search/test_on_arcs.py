"""Peaks of linkages that move over part of a turn: on pieces of their arcs, and limits at the toggles between these."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from long import long_but

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
