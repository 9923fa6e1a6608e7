"""Arcs, toggles and near-toggles that a search finds are those of the closed forms, which share no code with it."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from benchmarks.accuracy import missed
from linksweep.engine.quantity import Limit, Row
from linksweep.physics.algebra import planar
from linksweep.results.peak_search.clear import clear_designs
from linksweep.results.peak_search.limits import find_limits
from linksweep.scene.pairs import quantities_at

RRR = (Limit("C", ("low", "high"), ("low_noise", "high_noise")),)
CLOSURES = {
    "FourBar": RRR,
    "SliderCrank": RRR,
    "InvertedSliderCrank": (Limit("rocker", ("slide_squared",), ("noise",)),),
}


def limits_by_search(scene):
    count = next(iter(scene.inputs.sizes.values()), 1)
    return find_limits(scene.unloaded, CLOSURES[type(scene.mechanism).__name__], np.arange(count))


def over_designs(values):
    return xr.DataArray(values, dims="design")


def link(length):
    return ls.Link(over_designs(length), 1.0, 0.1, 0.0, 0.0)


def four_bars(random, n, margin):
    """Four-bars that miss their full turn by a margin, at one near-toggle or at both."""
    a, d = np.exp(random.uniform(-1.5, 1.5, (2, n)))
    difference = np.abs(d - a) * (1.0 - margin) * random.choice([-1.0, 1.0], n)
    total = (d + a) * (1.0 + np.where(random.random(n) < 0.5, margin, 0.3 * random.random(n)))
    b, c = 0.5 * (total + difference), 0.5 * (total - difference)
    turned = over_designs(random.uniform(-180.0, 180.0, n))
    return ls.Scene(ls.FourBar(link(a), link(b), link(c), over_designs(d), ground_angle=turned), 1.0)


def slider_cranks(random, n, margin):
    a = np.exp(random.uniform(-1.5, 1.5, n))
    offset = a * random.uniform(-0.8, 0.8, n) * random.choice([0.0, 1.0], n)
    b = (a + np.abs(offset)) * (1.0 + margin)
    turned = over_designs(random.uniform(-180.0, 180.0, n))
    return ls.Scene(ls.SliderCrank(link(a), link(b), 1.0, over_designs(offset), slide_angle=turned), 1.0)


def inverted_slider_cranks(random, n, margin):
    a, d = np.exp(random.uniform(-1.5, 1.5, (2, n)))
    offset = over_designs(np.abs(d - a) * (1.0 - margin) * random.choice([-1.0, 1.0], n))
    turned = over_designs(random.uniform(-180.0, 180.0, n))
    machine = ls.InvertedSliderCrank(link(a), link(d), over_designs(d), 1.0, 0.1, offset, ground_angle=turned)
    return ls.Scene(machine, 1.0)


MACHINES = [four_bars, slider_cranks, inverted_slider_cranks]


def any_four_bars(random, n):
    return missed.FAMILIES["four-bar of any lengths"].scene(random, n)


def compare_arcs(scene, atol):
    limits, checks = limits_by_search(scene), ls.check(scene)
    np.testing.assert_array_equal(limits.assembly, checks.assembly)
    order = np.argsort(checks.arc_start.values, axis=-1)
    start, end = (np.take_along_axis(checks[name].values, order, axis=-1) for name in ("arc_start", "arc_end"))
    arcs = limits.arc_start.shape[1]
    assert np.isnan(start[:, arcs:]).all()
    np.testing.assert_allclose(limits.arc_start, start[:, :arcs], rtol=0, atol=atol)
    np.testing.assert_allclose(limits.arc_end, end[:, :arcs], rtol=0, atol=atol)


def test_arcs_of_any_four_bars():
    compare_arcs(any_four_bars(np.random.default_rng(1), 600), 1e-11)


@pytest.mark.parametrize("machines", MACHINES)
@pytest.mark.parametrize(("margin", "atol"), [(-1e-2, 1e-11), (-1e-5, 1e-10), (-1e-8, 5e-9)])
def test_arcs_of_machines_that_nearly_turn_fully(machines, margin, atol):
    """A gap is as wide as the root of its margin, so its ends have the error of the lengths over twice that root."""
    random = np.random.default_rng(2)
    compare_arcs(machines(random, 200, margin * random.uniform(0.1, 1.0, 200)), atol)


def test_short_arcs_and_a_narrow_gap_where_the_turn_begins():
    """It lay between samples that were counted from the end of the turn, the arc's start from its beginning."""
    n = 24
    ground_angle, a, d = np.linspace(0.0, 23.0, n), np.full(n, 0.3), np.full(n, 1.0)
    reach = np.sqrt(a**2 + d**2 - 2.0 * a * d * np.cos(np.radians(10.0)))
    difference = (d - a) * (1.0 + 1e-7)
    b, c = 0.5 * (reach + difference), 0.5 * (reach - difference)
    machine = ls.FourBar(link(a), link(b), link(c), over_designs(d), ground_angle=over_designs(ground_angle))
    compare_arcs(ls.Scene(machine, 1.0), 1e-9)


@pytest.mark.parametrize("machines", MACHINES)
@pytest.mark.parametrize("decades", [(-4.0, -1.5), (-9.0, -4.0)])
def test_near_toggles_of_machines_that_barely_turn_fully(machines, decades):
    """The closed form is x cos²(ψ/2) + y sin²(ψ/2), which is 2x at tan(ψ/2) = √(x/(y − 2x))."""
    random = np.random.default_rng(3)
    scene = machines(random, 300, 10.0 ** random.uniform(*decades, 300))
    limits, middle = limits_by_search(scene), np.asarray(scene.mechanism.near_toggle_angle)
    assert (limits.assembly == 0.0).all()
    widths = quantities_at(scene, ("near_toggle_near", "near_toggle_far"), np.arange(300), np.zeros(300))
    compared = 0
    for opposite, width in zip((0.0, 180.0), widths, strict=True):
        away = np.abs(np.mod(limits.near_toggle - (middle + opposite)[:, None] + 180.0, 360.0) - 180.0)
        near = away < 1.0
        narrow = width < 0.2
        assert (near.sum(axis=1)[narrow] == 1).all()
        own = near & narrow[:, None]
        width = width[np.nonzero(own)[0]]
        expected = width / np.sqrt(1.0 - 2.0 * width**2)
        np.testing.assert_allclose(limits.near_toggle_width[own], expected, rtol=1e-5)
        assert (np.radians(away[own]) < 1e-5 * expected).all()
        compared += own.sum()
    assert compared >= 250


def test_machines_that_touch_a_toggle_turn_fully():
    parallelograms = [(0.3, 0.7, 0.3, 0.7), (1.0, 0.2, 1.0, 0.2)]
    kites = [(0.4, 0.4, 0.9, 0.9)]
    lengths = np.array(parallelograms + kites).T
    scene = ls.Scene(ls.FourBar(*map(link, lengths[:3]), over_designs(lengths[3])), 1.0)
    limits = limits_by_search(scene)
    np.testing.assert_array_equal(limits.assembly, 0.0)
    expected = np.broadcast_to([0.0, 180.0], (3, 2))
    away = np.mod(limits.zeros[:, 0, :] + 90.0, 360.0) - 90.0
    np.testing.assert_allclose(np.sort(away, axis=1), expected, atol=1e-5)


@pytest.fixture
def without_closed_forms(monkeypatch):
    """Let machines state the signals of their closure, as those do that have no closed forms."""

    def replaced(kind, rows=(), limits=()):
        own, tables = kind.table, {}

        def table(self, drive, loads):
            plain = own(self, drive, loads)
            both = (*plain.rows, *rows), (*CLOSURES[kind.__name__], *limits)
            return tables.setdefault(plain, replace(plain, rows=both[0], limits=both[1]))

        monkeypatch.setattr(kind, "table", table)

    return replaced


def grip(low, high, rod_across, friction):
    """Positive where friction does not wedge the slider, |μ·across| < |along|."""
    return low * high - (friction * rod_across) * (friction * rod_across)


GRIP = Row(grip, ("grip",)), Row(planar.product, ("grip_noise",), ("noise", "rod_length"))
SLIDES = Limit("C", ("grip",), ("grip_noise",), "wedge"), Limit("C", ("ratio_slider",), ("noise",), "jump")


@pytest.mark.parametrize("jams", [0.0, 0.3])
def test_peaks_with_friction_are_those_by_closed_forms(without_closed_forms, monkeypatch, jams):
    """The angles at which the slider turns round, and friction wedges it, are then known by search alone."""

    def scene():
        plain = missed.FAMILIES["slider-crank with friction"].scene(np.random.default_rng(5), 60)
        rough = plain.mechanism.friction + xr.DataArray(np.where(np.arange(60) < 20, jams, 0.0), dims="design")
        return replace(plain, mechanism=replace(plain.mechanism, friction=rough))

    expected = ls.peaks(scene())
    assert (expected.status == 3).any() == (jams > 0.0)
    without_closed_forms(ls.SliderCrank, GRIP, SLIDES)
    monkeypatch.setattr(ls.SliderCrank, "jumps", lambda self: ())
    monkeypatch.setattr(ls.SliderCrank, "driven_findings", lambda self, motion: ())
    peaks = ls.peaks(scene())
    for variable in ("F12_peak", "F32_peak", "F43_peak", "T12_max", "T12_min", "status"):
        np.testing.assert_allclose(peaks[variable], expected[variable], rtol=2e-11, err_msg=variable)


@pytest.mark.parametrize("name", ["four-bar", "four-bar of any lengths", "slider-crank", "inverted slider-crank"])
def test_peaks_are_those_by_closed_forms(name, without_closed_forms):
    family = missed.FAMILIES[name]
    scene = family.scene(np.random.default_rng(4), 40)
    expected = ls.peaks(scene)
    without_closed_forms(type(scene.mechanism))
    peaks = ls.peaks(family.scene(np.random.default_rng(4), 40))
    for variable in ("F12_peak", "F32_peak", "F43_peak", "T12_max", "T12_min", "status"):
        np.testing.assert_allclose(peaks[variable], expected[variable], rtol=2e-11, err_msg=variable)


@pytest.mark.parametrize(("name", "longest"), [("knuckle-press", 4.0), ("watt-2", 1.3)])
def test_designs_clear_of_all_limits_are_those_in_which_a_search_finds_none(name, longest, monkeypatch):
    press, random = ls.example(name).mechanism, np.random.default_rng(6)
    crank = press.parts[press.topology.crank]
    crank = replace(crank, length=over_designs(crank.length * random.uniform(0.3, longest, 150)))
    press = replace(press, parts={**press.parts, press.topology.crank: crank})
    scene, designs = ls.Scene(press, 1.0).unloaded, np.arange(150)
    clear, (row, angle, part) = clear_designs(scene, scene.table.limits, designs)
    by_both = find_limits(scene, scene.table.limits, designs)
    nothing = row[:0], angle[:0], part[:0]
    monkeypatch.setattr("linksweep.results.peak_search.limits.clear_designs", lambda *_: (designs[:0], nothing))
    searched = find_limits(scene, scene.table.limits, designs)
    for both, alone in zip(by_both, searched, strict=True):
        np.testing.assert_allclose(both, alone, rtol=0.0, atol=1e-10)
    assert 20 < len(clear) < 140 and np.isnan(searched.near_toggle[clear]).all()
    other = np.setdiff1d(np.flatnonzero(searched.assembly == 0.0), clear)
    assert np.isfinite(searched.near_toggle[other]).any(axis=1).mean() > 0.2
    assert set(np.bincount(row, minlength=150)[clear]) == ({2, 4} if press.rubs else {0})  # 4 at a stretched joint
