"""Arcs, toggles and near-toggles that a search finds are those of the closed forms, which share no code with it."""

import math
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from scipy.optimize import brentq

import linksweep as ls
from benchmarks.accuracy import missed
from linksweep.engine.peaks import laid_out
from linksweep.engine.quantity import Limit, Row
from linksweep.physics.algebra import planar
from linksweep.results.peak_search.groups import groups
from linksweep.results.peak_search.limits import find_limits, limits_of
from linksweep.results.peak_search.side_by_side import Events, search_side_by_side
from linksweep.scene.pairs import by_row, quantities_at, some_of

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


def linkages(name, longest):
    """An example with cranks of many lengths: from short ones to some that come near to toggles, or turn not fully."""
    machine, random = ls.example(name).mechanism, np.random.default_rng(6)
    crank = machine.parts[machine.topology.crank]
    crank = replace(crank, length=over_designs(crank.length * random.uniform(0.3, longest, 150)))
    return ls.Scene(replace(machine, parts={**machine.parts, machine.topology.crank: crank}), 1.0).unloaded


def six_bars_near_toggles():
    return missed.FAMILIES["Watt six-bar"].scene(np.random.default_rng(9), 150).unloaded


def presses_near_toggles():
    return missed.FAMILIES["knuckle-joint press with friction"].scene(np.random.default_rng(9), 150).unloaded


SIDE_BY_SIDE = {
    "presses": lambda: linkages("knuckle-press", 4.0),
    "six-bars": lambda: linkages("watt-2", 3.0),
    "legs of two dyads": lambda: linkages("klann-leg", 3.0),
    "legs of three dyads": lambda: linkages("jansen-leg", 2.5),
    "wipers": lambda: linkages("wipers", 3.0),
    "presses near toggles": presses_near_toggles,
    "six-bars near toggles": six_bars_near_toggles,
}


@pytest.fixture
def along_arcs_alone(monkeypatch):
    """Let limits be sought along arcs, as those are that the search side by side leaves."""
    nothing = Events(*(np.empty(0, dtype=kind) for kind in (int, float, int, float)))
    left = np.empty(0, dtype=int), nothing, nothing.place
    return lambda: monkeypatch.setattr("linksweep.results.peak_search.limits.search_side_by_side", lambda *_: left)


def test_limits_along_arcs_have_the_same_bits_among_any_others(along_arcs_alone):
    along_arcs_alone()
    scene = linkages("klann-leg", 3.0)
    every = find_limits(scene, scene.table.limits, np.arange(30))
    for design in (3, 17, 29):
        alone = find_limits(scene, scene.table.limits, np.array([design]))
        for one, all_of in zip(alone, every, strict=True):
            own, other = (np.sort(np.atleast_1d(x).ravel()) for x in (one[0], all_of[design]))
            np.testing.assert_array_equal(own[np.isfinite(own)], other[np.isfinite(other)])


@pytest.mark.parametrize("name", SIDE_BY_SIDE)
def test_limits_found_side_by_side_are_those_of_the_search_of_arcs(name, along_arcs_alone):
    scene, designs = SIDE_BY_SIDE[name](), np.arange(150)
    by_both, rows = (
        find_limits(scene, scene.table.limits, designs),
        search_side_by_side(scene, scene.table.limits, designs)[0],
    )
    along_arcs_alone()
    searched = find_limits(scene, scene.table.limits, designs)
    np.testing.assert_array_equal(by_both.assembly, searched.assembly)
    assert len(rows) > 147
    turning = np.flatnonzero(searched.assembly == 0.0)
    for both, alone in zip(by_both[1:3], searched[1:3], strict=True):
        np.testing.assert_allclose(both, alone, rtol=0.0, atol=1e-8)
    np.testing.assert_allclose(by_both.zeros, searched.zeros, rtol=0.0, atol=1e-3)
    for part, limit in enumerate(scene.table.limits):
        row, nth = np.nonzero(np.isfinite(by_both.zeros[:, part]))
        if limit.zeros == "jump" and len(row):
            zero = by_both.zeros[row, part, nth]
            names = (*limit.signals, *limit.noise)
            before, after = (quantities_at(scene, names, row, zero + away) for away in (-2e-13, 2e-13))
            assert ((before[0] * after[0] <= 0.0) | (np.abs(before[0]) <= 10.0 * before[1])).all()
    for row in turning:
        compare_narrow_near_toggles(by_both, searched, row)


def compare_narrow_near_toggles(limits, others, row):
    """Each narrow one of the others is known, to a part of its width. It is less narrow where it is no parabola."""
    angle, width = limits.near_toggle[row], limits.near_toggle_width[row]
    for at, expected in zip(others.near_toggle[row], others.near_toggle_width[row], strict=True):
        if expected < 0.03:
            away = np.radians(np.abs(np.mod(angle - at + 180.0, 360.0) - 180.0))
            same = (away < 0.2 * expected) & (np.abs(np.log(width / expected)) < 0.7)
            assert same.any(), (row, at, expected, angle, width)


def test_limits_found_side_by_side_have_the_same_bits_among_any_others_and_interpreted(monkeypatch):
    scene = presses_near_toggles()
    every = search_side_by_side(scene, scene.table.limits, np.arange(150))[1]
    some = np.array([77, 3, 149])
    for most in (math.inf, -1):
        monkeypatch.setattr(laid_out, "INTERPRETED_DESIGNS", most)
        alone = search_side_by_side(scene, scene.table.limits, some)[1]
        for k, design in enumerate(some):
            same = some_of(alone, alone.row == k), some_of(every, every.row == design)
            for one, other in zip(same[0][1:], same[1][1:], strict=True):
                np.testing.assert_array_equal(one, other)


def test_limits_of_all_groups_are_looked_up_once():
    """To look them up, all numbers of all designs are read: in each group of a study, time would grow as its square."""
    scene = presses_near_toggles()
    every = limits_of(scene.unloaded)[1]
    before = limits_of.cache_info().hits
    designs = np.arange(0, 150, 2)[::-1]
    parts = list(groups(scene, designs, at_once=20))
    assert [len(group.designs) for group in parts] == [20, 20, 20, 15]
    assert limits_of.cache_info().hits == before + 1
    for group in parts:
        for own, others in zip(group.limits, some_of(every, group.designs), strict=True):
            np.testing.assert_array_equal(own, others)


def test_a_ram_that_turns_round_three_times_within_a_degree():
    """Just before the rocker turns round, it is in line with the guide; the ram turns round there on both ways, and in
    between. Samples some degrees apart show one of these changes of direction."""
    a, b, c, d = 0.05, 0.2, 0.15, 0.22

    def rocker(theta2):
        x, y = a * np.cos(theta2) - d, a * np.sin(theta2)
        return np.arctan2(y, x) - np.arccos((x * x + y * y + c * c - b * b) / (2.0 * c * np.hypot(x, y)))

    outermost = np.arccos((d * d + (a + b) ** 2 - c * c) / (2.0 * d * (a + b)))
    away = np.radians(np.geomspace(0.3, 8.0, 40))
    lines = rocker(outermost + away)
    before = [brentq(lambda x, line=line: rocker(x) - line, outermost - 0.3, outermost - 1e-3) for line in lines]
    links = {"crank": a, "rod": b, "upper": c, "lower": 0.4}
    mechanism = ls.Linkage(
        "crank A-B, rod B-C, upper D-C, lower C-E, ram E on slide",
        ground={"A": (0.0, 0.0), "D": (d, 0.0)},
        guides={"slide": ls.Guide((d, 0.0), over_designs(np.degrees(lines)), 0.1)},
        ram=ls.Slider(1.0),
        **{role: ls.Link(length, 1.0, 0.1) for role, length in links.items()},
    )
    scene = ls.Scene(mechanism, 1.0).unloaded
    rows, events, angle = search_side_by_side(scene, scene.table.limits, np.arange(len(away)))
    np.testing.assert_array_equal(np.sort(rows), np.arange(len(away)))
    turns = np.radians(by_row(events.row, angle, len(away))) - outermost
    turns = np.sort(np.mod(turns + np.pi, 2.0 * np.pi) - np.pi, axis=1)
    near = np.where(np.abs(turns) < 0.3, turns, np.nan)
    assert (np.isfinite(near).sum(axis=1) == 3).all()
    expected = np.stack([np.array(before) - outermost, 0.0 * away, away], axis=1)
    np.testing.assert_allclose(near[np.isfinite(near)].reshape(-1, 3), expected, rtol=0.0, atol=1e-8)


def test_a_linkage_of_eleven_dyads_has_peaks():
    """Its limits have 66 signals with their opposites and bounds: np.choose takes 64."""
    pins, ground, lengths = iter("CDEFGHIJKLMNOPQRSTUVWX"), {"A": (0.0, 0.0)}, {"crank": 0.05}
    text, before = ["crank A-B"], "B"
    for k, (pin, fixed) in enumerate(zip(pins, pins, strict=True)):
        text += [f"coupler{k} {before}-{pin}", f"rocker{k} {pin}-{fixed}"]
        ground[fixed], before = (0.3 * (k + 1), -0.2), pin
        lengths |= {f"coupler{k}": 0.3, f"rocker{k}": 0.2}
    links = {name: ls.Link(length, 0.3, 1e-3) for name, length in lengths.items()}
    scene = ls.Scene(ls.Linkage(", ".join(text), ground=ground, **links), omega2=10.0)
    assert ls.peaks(scene, of=["T12"]).T12_max > 0.0


def test_a_short_arc_beside_a_toggle_of_the_links_before_is_found():
    """The distance from E to G is at most that of rod and output together over 0.03 degrees, 0.2 degrees from a toggle
    of the first four links; the other arc is a third of a degree long."""
    a, b, c, d, e, turned, rod, output, g = 1.345, 1.334, 0.677, 1.683, 0.452, -139.959, 0.722, 1.907, (-1.226, 1.015)
    lengths = {"crank": a, "coupler": b, "rocker": c, "rod": rod, "output": output}
    six_bar = ls.Linkage(
        "crank A-B, coupler B-C, rocker D-C-E, rod E-F, output G-F",
        ground={"A": (0.0, 0.0), "D": (d, 0.0), "G": g},
        points={"E": (e, turned)},
        branch={"C": "crossed", "F": "open"},
        **{role: ls.Link(length, 1.0, 0.1, 0.0, 0.0) for role, length in lengths.items()},
    )

    def slack(theta2):
        """Return by how much rod and output are longer than the distance from E to G."""
        at_b = a * np.exp(1j * np.radians(theta2))
        diagonal = d - at_b
        corner = (b**2 + abs(diagonal) ** 2 - c**2) / (2.0 * b * abs(diagonal))
        at_c = at_b + b * diagonal / abs(diagonal) * np.exp(-1j * np.arccos(corner))
        at_e = d + e * (at_c - d) / abs(at_c - d) * np.exp(1j * np.radians(turned))
        return rod + output - abs(at_e - complex(*g))

    between = [(21.8, 21.825), (21.825, 21.85), (305.9, 306.2), (306.2, 306.5)]
    toggles = [brentq(slack, *ends, xtol=1e-13) for ends in between]
    limits = limits_of(ls.Scene(six_bar, omega2=1.0).unloaded)[1]
    np.testing.assert_allclose(limits.arc_start, [toggles[::2]], rtol=0.0, atol=1e-8)
    np.testing.assert_allclose(limits.arc_end, [toggles[1::2]], rtol=0.0, atol=1e-8)
