"""Inputs and joints of linkages in a report, in words that state what they are."""

import re
from unittest import mock

import pytest
from html_page import Page

import linksweep as ls
from linksweep.reports import figures, scene_tables, tables
from linksweep.reports.markup import tag
from linksweep.reports.page import page


def rows(table) -> dict[str, str]:
    """Return the second cell of each row of a table by the first."""
    cells = re.findall("<tr><t[dh][^>]*>(.*?)</t[dh]><td[^>]*>(.*?)</td>", str(table).replace("\u202f", " "))
    return dict(cells)


def test_places_guides_branches_and_cylinders_are_described():
    arm = rows(scene_tables.settings(ls.example("excavator")))
    assert arm["ground pin P"] == "(450 mm, −500 mm)" and arm["pin B"] == "2600 mm at 10°"
    assert arm["branch of E"] == "crossed" and arm["speed of the boom"].startswith("1.9099 rpm")
    assert arm["cylinder c1"] == "follows" and arm["cylinder c2"] == "2545.8 to 3570.9 mm long"
    press = rows(scene_tables.settings(ls.example("knuckle-press")))
    assert press["guide slide"] == "on the ground, through (552 mm, 0 mm) at −90°, friction 0.08"
    gears = rows(scene_tables.settings(ls.example("geared-five-bar")))
    assert gears["gears of wheel"] == "phase 180°, pressure angle 20°"


def test_a_guide_on_a_link_lies_in_its_axes():
    parts = {"crank": ls.Link(0.1, 1, 0.1), "arm": ls.Link(0.5, 1, 0.1), "block": ls.Slider(1.0)}
    guides = {"arm": ls.Guide(of="arm", through=(0.0, 0.01), friction=0.0)}
    shaper = ls.Linkage(
        "crank A-B, arm D-E, block B on arm", ground={"A": (0, 0.3), "D": (0, 0)}, guides=guides, **parts
    )
    scene = ls.Scene(shaper, 3.0, loads=[ls.Load("block", force=(1.0, 0.0)), ls.Load("arm", (1.0, 0.0), at=(0.5, 0.0))])
    assert rows(scene_tables.settings(scene))["guide arm"] == "on the arm, in its axes, through (0 mm, 10 mm) at 0°"
    loads = rows(scene_tables.loads(scene))
    assert loads["load 1"] == "(1, 0) N on the block, at its pin"
    assert loads["load 2"] == "(1, 0) N on the arm, 500 mm at 0° from its first pin"


@pytest.mark.parametrize(
    ("name", "force", "words"),
    [
        ("knuckle-press", "F16", "slide: ground on ram"),
        ("knuckle-press", "F53", "pin C: lower on rod"),
        ("crank-shaper", "F32", "arm past B: arm on crank"),
        ("excavator", "force_c1", "drive, positive where it pushes"),
        ("engine", "F14", "guide: ground on slider"),
        ("watt-2", "T12", "drive of the crank"),
    ],
)
def test_joints_are_named_in_words(name, force, words):
    assert tables._where(ls.example(name), force) == words


def test_a_transmission_angle_that_does_not_change_has_no_place():
    with mock.patch.object(figures, "_image", lambda figure, title: tag("img", src="data:,", alt=title)):
        checks = Page(page(ls.example("scotch-yoke"))).rows("Checks")
    assert {"assembly", "toggles"} <= {*checks}
    assert checks["least transmission angle of yoke"][0][0] == "90.0° at every crank angle"
