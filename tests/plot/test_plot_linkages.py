"""Drawings of linkages: pins at the links' lengths, plates, blocks on their guides, the curve of a free pin."""

from dataclasses import replace
from itertools import combinations, pairwise

import numpy as np
import pytest
from drawn import boxes, closed_figures, line, page_hides_nothing, texts  # noqa: F401

import linksweep as ls
from linksweep import plot
from linksweep.reports.scene_tables import settings

NAMES = ("watt-2", "knuckle-press", "crank-shaper", "whitworth", "jansen-leg", "scissor-lift")


def pins_of(ax, scene):
    """Return the drawn places of the pins by name."""
    names = sorted(scene.mechanism.topology.members)
    return dict(zip(names, np.transpose(line(ax, "_pins").get_data()), strict=True))


@pytest.mark.parametrize("name", NAMES)
def test_links_are_drawn_to_scale_with_their_pins_named(name):
    scene = ls.example(name)
    ax = plot.mechanism(scene, 40.0)
    pins, mechanism = pins_of(ax, scene), scene.mechanism
    assert {*pins} <= {*texts(ax)}
    for role, (first, second, *_) in mechanism.topology.links.items():
        drawn = np.linalg.norm(pins[second] - pins[first])
        np.testing.assert_allclose(drawn, mechanism.parts[role].length, rtol=1e-12)
    pivot = np.array(next(iter(mechanism.ground.values())))
    for pin, place in mechanism.ground.items():
        np.testing.assert_allclose(pins[pin], np.array(place) - pivot, atol=1e-15)


def test_the_foot_of_a_leg_draws_the_curve_and_a_link_of_choice_another():
    scene = ls.example("jansen-leg")
    ax = plot.mechanism(scene, 40.0)
    foot, curve = pins_of(ax, scene)["H"], np.transpose(line(ax, "_coupler curve").get_data())
    step = np.linalg.norm(np.diff(curve, axis=0), axis=1).max()
    assert np.linalg.norm(curve - foot, axis=1).min() < step
    assert not any("G" in text and "_" in text for text in texts(ax))
    crank = plot.mechanism(scene, 40.0, link=scene.mechanism.roles[0], point=(0.05, 0.0))
    radii = np.linalg.norm(np.transpose(line(crank, "_coupler curve").get_data()), axis=1)
    np.testing.assert_allclose(radii, 0.05)
    with pytest.raises(ValueError, match=r"^link = 'wing': must be one of "):
        plot.mechanism(scene, 40.0, link="wing")


def test_a_press_has_its_ram_on_the_guide_and_an_arrow_at_every_joint():
    scene = ls.example("knuckle-press")
    ax = plot.mechanism(scene, 40.0, forces=True)
    ram = pins_of(ax, scene)["E"]
    corners = np.transpose(line(ax, "_block").get_data())
    np.testing.assert_allclose(corners[:4].mean(axis=0), ram)
    sizes = [text.get_text() for text in ax.texts] + texts(ax)
    assert {"F_{53}", "F_{65}", "F_{16}"} <= {part for text in sizes for part in text.replace("$", " ").split()}


def test_a_cycle_of_a_press_has_all_forces_in_its_legend():
    ax = plot.forces(ls.sweep(ls.example("knuckle-press"), 360))
    legend = [text.get_text() for text in ax.get_legend().get_texts()]
    assert [text.split("(")[1] for text in legend if ":" in text] == ["C:upper)", "C:lower)"]
    assert ax.get_ylabel() == "pin and slide force [N]"


def test_of_many_forces_those_of_half_of_the_largest_have_their_values():
    """Twelve values covered each other; all twelve have a dot and a place in the legend."""
    ds = ls.sweep(ls.example("scissor-lift"))
    figure = ds.linksweep.cycle()
    machine, curves, _locus, _torque = figure.axes
    peaks = ls.peaks(ls.example("scissor-lift"))
    dots = [line.get_label().removeprefix("_peak ") for line in curves.lines if line.get_label().startswith("_peak")]
    sizes = {name: float(peaks[f"{name}_peak"]) for name in dots}
    large = {f"$F_{{{name[1:]}}}$" for name, size in sizes.items() if size >= 0.5 * max(sizes.values())}
    assert len(dots) == len(curves.get_legend().get_texts()) == 12
    assert {word for text in texts(curves) for word in text.split() if word.startswith("$F")} == large
    assert {text.split()[0] for text in texts(machine) if text.startswith("$F")} == large
    values = [*boxes(curves), curves.get_legend().get_window_extent()]
    assert not any(one.overlaps(other) for one, other in combinations(values, 2))


def test_of_two_curves_on_top_of_each_other_both_are_seen():
    """Crank pin and yoke of a pump without masses in between bear the same force; the pins of a press differ."""
    crank, _slide, yoke = plot.forces(ls.sweep(ls.example("scotch-yoke"))).lines[:3]
    np.testing.assert_allclose(crank.get_ydata(), yoke.get_ydata(), rtol=1e-2)
    assert crank.get_linestyle() == "-" and yoke.get_linestyle() == "--"
    F12, _F32, F43, _F14 = plot.forces(ls.sweep(ls.example("press"))).lines[:4]
    assert F12.get_linestyle() == F43.get_linestyle() == "-"


def test_a_direction_of_zero_has_no_sign():
    ax = ls.sweep(ls.example("scotch-yoke")).linksweep.bearing("F12")
    assert any("direction 0.0°" in text for text in texts(ax))


def test_over_a_part_of_the_turn_the_point_has_that_part_of_its_curve():
    """The tip of an excavator's bucket over 0 to 40 degrees, in its drawing, its cycle and its film."""
    scene = ls.example("excavator")
    ds = ls.sweep(scene, range(41))
    tip = ls.sweep(scene, np.linspace(0.0, 40.0, 721), of=["Tx", "Ty"])
    expected = [tip.Tx.values, tip.Ty.values]
    figures = ds.linksweep.mechanism(20.0).figure, ds.linksweep.cycle(), plot.animate(ds, frames=2).figure
    for figure in figures:
        np.testing.assert_allclose(line(figure.axes[0], "_coupler curve").get_data(), expected, atol=1e-9)
    for whole in (scene, ls.sweep(scene, 360)):
        x, y = line(plot.mechanism(whole, 20.0), "_coupler curve").get_data()
        assert (x[0], y[0]) == (x[-1], y[-1]) and len(x) == 721


def test_a_report_lists_ground_pins_guides_and_branches():
    page = str(settings(ls.example("knuckle-press")))
    for row in ("ground pin D", "guide slide", "branch of C"):
        assert row in page


@pytest.mark.parametrize(("ratio", "turns", "step"), [("-3/2", 2, 90.0), ("-3/7", 7, 360.0), ("40/99", 99, 7200.0)])
def test_angles_of_many_turns_are_round_and_have_room(ratio, turns, step):
    """On the axis, where no two overlap, and along a locus, with the dots between them."""
    link = ls.Link(0.05, 0.5, 1e-3, 0.02, 30.0)
    machine = ls.Linkage(
        f"crank A-B, wheel D-E : {ratio} crank, left B-C, right E-C",
        ground={"A": (0.0, 0.0), "D": (0.2, 0.05)},
        crank=link,
        wheel=link,
        left=replace(link, length=0.22),
        right=replace(link, length=0.25),
    )
    cycle = ls.sweep(ls.Scene(machine, omega2=20.0), theta2=turns * 36)
    ax = cycle.linksweep.torque()
    ax.figure.canvas.draw()
    labels = [label.get_window_extent() for label in ax.get_xticklabels()]
    assert set(np.diff(ax.get_xticks())) == {step} and all(one.x1 < other.x0 for one, other in pairwise(labels))
    figure = cycle.linksweep.cycle()
    figure.canvas.draw()
    for ax in (ax for ax in figure.axes if "crank angle" in ax.get_xlabel()):
        labels = [label.get_window_extent() for label in ax.get_xticklabels()]
        assert len(labels) > 2 and all(one.x1 < other.x0 for one, other in pairwise(labels))
    ax = cycle.linksweep.bearing("F42")
    named = [text for text in texts(ax) if text.endswith("°") and "F_" not in text]
    assert len(named) <= 8 and len(line(ax, "_ticks").get_xdata()) <= 24
