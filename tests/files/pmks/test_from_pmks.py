"""Every public drawing of the sample becomes a scene assembled as it is drawn, or is refused with what to change."""

import math
import re
import warnings
from urllib.parse import quote

import numpy as np
import pytest
from test_reading import DOCUMENTS, body_of, stamped

import linksweep as ls
from linksweep.files.pmks.linkage import words_of
from linksweep.files.pmks.machines import machines
from linksweep.files.pmks.reading import read_drawing

REFUSED = {
    "Elliptical crank": "bc, cde, df, block_E close only together",
    "Double butterfly linkage": "ce, efg, bfj, dhi, gh, ij close only together",
    "Elliptical trammel, driven": "no link turns about a pin on the ground",
    "Braced four-bar": "no degree of freedom",
    "Slider-crank with a Prismatic slider": "no degree of freedom",
    "Link hanging from a pivot": "de hangs loose",
    "Four-bar with its rocker deleted": "bc hangs loose",
}
"""Drawings that PMKS+ itself says do not run, and those that close by no dyads."""

MOVING = sorted(DOCUMENTS.keys() - REFUSED.keys())

LEFT_OUT = {
    "Cylinder-driven boom": [
        "the steady speed of the input at P: oc turns steadily instead",
        "the mass of GN, 0.001 kg: a cylinder has none",
        "the mass of PC, 0.001 kg: a cylinder has none",
    ],
    "Offset-mount hatch": [
        "the steady speed of the input at S: offset_barrel turns steadily instead and is the drive",
        "B on rod_bracket: a slider has no further points",
    ],
    "Four-bar driven at its coupler-rocker pin": [
        "the steady speed of the input at C: oa turns steadily instead and is the drive"
    ],
    "Walking-beam pumping unit": ["the steady speed of the input at P: am turns steadily instead and is the drive"],
    "Two four-bars": ["machine 2, of the links EF, FG, GH: machine=2 takes it"],
    "Four-bar with two inputs": ["the input at D: ab turns by that at A"],
    "Four-bar with a stray link": ["machine 2, of the links EF: machine=2 takes it"],
    "Crank grounded at both ends": ["no joint has an input: bc turns"],
    "Watt I": [],
    "Scotch yoke": ["D on cd: a slider has no further points"],
    "Guided rod pushed by a link": [],
}

TEXTS = {
    "Punch press": "crank A-B, connecting_rod B-C, block_C C on guide_C",
    "Reciprocating saw": "flywheel_crank A-B, saw_carriage on guide_C past B",
    "Cylinder-driven boom": "oc O-C, gn G~C",
    "Parallel gripper": "hanger_bd B-D, hanger_ce C-E, jaw_def D-E-F, ad A-D, hanger_gi G-I, hanger_hj H-J, "
    "jaw_ijk I-J-K, ai A-I, block_A A on guide_A",
    "Shaper's quick-return drive": "ab A-B, cd C-D, dr D-R, block_B B on guide_B, block_R R on guide_R",
    "Jansen leg": "oa O-A, ab A-B, gbc G-B-C, ad A-D, gd G-D, ce C-E, link_def D-E-F",
    "Guided rod pushed by a link": "ab A-B, bf B-F, ft F on guide_T",
    "Watt I": "ab A-B, bcd B-C-D, de D-E, ef E-F, cfg C-F-G",
    "Four-bar with its frame drawn as a bar": "ab A-B, bc B-C, cd D-C",
    "Stephenson I, 2024": "abc A-B-C, bd B-D, de D-E, efg G-E-F, fc F-C",
}


def read(source, **which) -> ls.Scene:
    """Return the scene of a document, whatever is left out."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ls.NotCarriedOverWarning)
        return ls.from_pmks(source, **which)


def left_out(source) -> list[str]:
    """Return the lines on what is left out of a document."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        ls.from_pmks(source)
    return [line for warning in caught for line in str(warning.message).splitlines()[1:]]


@pytest.mark.parametrize("name", MOVING)
def test_every_pin_is_where_it_is_drawn(name):
    """Lengths, points and guides come from the drawn places, and the branches from the drawn assembly."""
    scene, drawing = read(DOCUMENTS[name]), read_drawing(DOCUMENTS[name])
    words = words_of(machines(drawing)[0])
    pins = {pin for pins in words.pins.values() for pin in pins} - words.ground.keys()
    cycle = ls.sweep(
        scene, theta2=[words.axes[words.crank].angle], of=[f"{pin}{axis}" for pin in pins for axis in "xy"]
    )
    pivot = next(iter(words.ground.values()))
    for pin in pins:
        there = drawing.joints[pin].at
        place = (float(cycle[f"{pin}x"].item()) + pivot[0], float(cycle[f"{pin}y"].item()) + pivot[1])
        assert place == pytest.approx(there, abs=1e-15), pin


@pytest.mark.parametrize("name", MOVING)
def test_energy_is_balanced(name):
    scene = read(DOCUMENTS[name])
    start = words_of(machines(read_drawing(DOCUMENTS[name]))[0])
    cycle = ls.sweep(scene, theta2=[start.axes[start.crank].angle], of=["power_residual"])
    assert abs(float(cycle.power_residual.item())) < 1e-12 and (cycle.status == 0).all()


@pytest.mark.parametrize("name", REFUSED)
def test_machines_that_cannot_be_are_refused(name):
    with pytest.raises(ValueError, match=re.escape(REFUSED[name])):
        ls.from_pmks(DOCUMENTS[name])


@pytest.mark.parametrize("name", sorted(LEFT_OUT.keys()))
def test_what_is_left_out_is_listed(name):
    assert left_out(DOCUMENTS[name]) == LEFT_OUT[name]


@pytest.mark.parametrize("name", TEXTS)
def test_links_pins_and_order_follow_the_document(name):
    assert words_of(machines(read_drawing(DOCUMENTS[name]))[0]).text == TEXTS[name]


def test_links_files_and_texts_are_one_document(tmp_path):
    text = DOCUMENTS["Punch press"]
    (tmp_path / "press.pmks").write_text(text + "\n")
    scene = read(text)
    assert read(f"https://app.pmksplus.com/?{quote(text, safe=',.*')}") == scene
    assert read(tmp_path / "press.pmks") == scene and read(str(tmp_path / "press.pmks")) == scene


def test_a_missing_file_and_another_program_are_named(tmp_path):
    with pytest.raises(ValueError, match=r"press\.pmks: there is no such file"):
        ls.from_pmks(tmp_path / "press.pmks")
    with pytest.raises(
        ValueError, match=r"press\.txt' is no document of PMKS\+, .*; the name of a file ends in \.pmks$"
    ):
        ls.from_pmks("press.txt")
    with pytest.raises(
        ValueError, match=r"^source is a Scene: must be the link that PMKS\+ shares, or the name of a file"
    ):
        ls.from_pmks(ls.example("press"))
    with pytest.raises(ValueError, match=r"a link with data=… is of another program"):
        ls.from_pmks("https://example.org/?data=N4IgViBcDa0g")


def test_each_machine_of_a_drawing_can_be_taken():
    text = DOCUMENTS["Three machines, three drives"]
    crank, slider, rocker = (read(text, machine=number).mechanism.links for number in (1, 2, 3))
    assert (
        crank.startswith("drag_crank A-B") and slider.startswith("crank E-F") and rocker.startswith("rocker_crank H-I")
    )
    assert read(text, machine=2).omega2 == pytest.approx(-8 * math.pi / 30)
    for machine in (0, 4, "2"):
        with pytest.raises(ValueError, match=r"machine = .*: must be a number from 1 to 3"):
            ls.from_pmks(text, machine=machine)


def test_links_of_one_title_have_their_letters_too():
    assert {"hanger_bd", "hanger_ce", "jaw_ijk"} <= read(DOCUMENTS["Parallel gripper"]).mechanism.parts.keys()


def test_loads_turn_with_the_ground_or_with_their_link():
    """The hook of the crane hangs straight down, its rope pulls along the jib."""
    scene, drawing = read(DOCUMENTS["Crane carrying two loads"]), read_drawing(DOCUMENTS["Crane carrying two loads"])
    hook, rope = scene.loads
    assert (hook.frame, rope.frame) == ("ground", "link") and hook.force == pytest.approx((0.0, -260.0), abs=2.0)
    start, end = drawing.joints["O"].at, drawing.joints["C"].at
    jib = math.atan2(end[1] - start[1], end[0] - start[0])
    turned = complex(*rope.force) * np.exp(1j * jib)
    assert (turned.real, turned.imag) == pytest.approx(drawing.forces[1].force, rel=1e-14)
    assert math.hypot(*rope.force) == pytest.approx(180.0, abs=2.0)


def test_an_inverted_slider_crank_is_that_of_its_own_class():
    """A document's results are those of a machine of another class, with other closures, from the same numbers."""
    scene = read(DOCUMENTS["Inverted slider-crank with a load"])
    parts = scene.mechanism.parts
    named = ls.InvertedSliderCrank(
        crank=parts["ab"], rocker=parts["cd"], ground=0.03, ground_angle=0.0, branch="open", block_mass=0.0
    )
    loads = [ls.Load("rocker", force=load.force, at=load.at) for load in scene.loads]
    other = ls.Scene(named, omega2=scene.omega2, gravity=scene.gravity, loads=loads)
    here, there = ls.sweep(scene, theta2=12, of=["T12"]), ls.sweep(other, theta2=12, of=["T12"])
    assert here.T12.values == pytest.approx(there.T12.values, rel=1e-13)


def test_a_document_without_gravity():
    scene = read(stamped("63" + body_of("Watt I")[2:]))
    assert scene.gravity == (0.0, 0.0)


def test_a_cylinder_that_drives_has_its_speed_where_it_is_drawn():
    """The boom stands upright, 4 cm from O to C; the cylinder pushes from G, 3 cm beside O, at 1 cm/s."""
    scene = read(DOCUMENTS["Cylinder-driven boom"])
    assert scene.drive == "gn" and scene.omega2 == pytest.approx(0.01 / (0.04 * 3 / 5), rel=1e-12)
    cycle = ls.sweep(scene, theta2=[60.0, 90.0], of=["rate_gn", "force_gn"])
    assert float(cycle.rate_gn[1]) == pytest.approx(0.01, rel=1e-12)
    c = 0.04 * np.exp(1j * math.radians(60.0))
    towards = (c - 0.03) / abs(c - 0.03)
    weight = 0.001 * 9.80665 * 0.01  # 1 g, 2 cm from O at 60 degrees
    assert float(cycle.force_gn[0]) == pytest.approx(weight / (c.conjugate() * towards).imag, rel=1e-12)


def test_joints_of_two_letters_have_names_that_change_no_number():
    """They become P1, P2, …: names of the loads on links, and of all that acts on them, in tables of old."""
    drawn, body = read(DOCUMENTS["Rocker with an offset load"]), body_of("Rocker with an offset load")
    renamed = body.replace("0C,C,", "0AA,AA,").replace("0L,L,", "0AB,AB,")
    renamed = renamed.replace("B,C,,", "B,AA,,").replace("C,D,L,,", "AA,D,AB,,")
    scene, names = read(stamped(renamed)), ["T12", "F12", "F32", "F43", "F14", "Fs"]
    assert scene.mechanism.links == drawn.mechanism.links.replace("B-C", "B-P1").replace("D-C-L", "D-P1-P2")
    two, one = (ls.sweep(machine, [40.0, 80.0], of=names) for machine in (scene, drawn))
    assert two.equals(one) and np.isfinite(one.T12).all()
