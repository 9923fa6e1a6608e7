"""Scenes, machines and loads show in a notebook as a small drawing with their numbers."""

import re
from xml.etree import ElementTree

import numpy as np
import pytest

import linksweep as ls
from linksweep.scene.examples import names

MANY = ("press", "engine", "quick-return", "loop", "knuckle-press", "scotch-yoke", "excavator", "whitworth")
LONG = [pytest.param(name, marks=pytest.mark.long) for name in names() if name not in MANY]


def svg(page: str) -> ElementTree.Element:
    """Return the drawing of a page."""
    return ElementTree.fromstring(re.search("<svg.*?</svg>", page, re.DOTALL)[0])


@pytest.mark.parametrize("name", [*MANY, *LONG])
def test_every_example_shows_its_drawing_and_numbers(name):
    scene = ls.example(name)
    page = scene._repr_html_()
    assert ("<svg" in page) == (scene.mechanism.drawing is not None)
    assert all(f" {body.role}</th>" in page for body in scene.mechanism.bodies)
    assert page.count("load ") >= len(scene.loads) and "nan" not in page
    assert ("<svg" in scene.mechanism._repr_html_()) == ("<svg" in page)


def test_pins_of_the_drawing_are_those_of_the_sweep():
    scene = ls.example("press")
    drawn = svg(scene._repr_html_())
    letters = [text.text for text in drawn.iter("text")]
    places = np.array([[float(pin.get(f"c{axis}")) for axis in "xy"] for pin in drawn.iter("circle")])
    at_45 = ls.sweep(scene, [45.0], of=["Bx", "By", "Cx", "Cy"]).isel(theta2=0)
    expected = np.array([[0.0, 0.0], [at_45.Bx, at_45.By], [at_45.Cx, at_45.Cy], [0.20, 0.0]], dtype=float)
    assert letters == ["A", "B", "C", "D"]
    scale = np.linalg.norm(places[3] - places[0]) / 0.20
    np.testing.assert_allclose((places - places[0]) * [1.0, -1.0] / scale, expected, atol=0.1 / scale)
    signs = [sign.get("transform") for sign in drawn.iter("g") if sign.get("class") == "centre"]
    middles = np.array([re.findall(r"[\d.]+", sign) for sign in signs], dtype=float)
    centres = [expected[:2].mean(axis=0), expected[1:3].mean(axis=0), expected[2:].mean(axis=0)]
    np.testing.assert_allclose((middles - places[0]) * [1.0, -1.0] / scale, centres, atol=0.15 / scale)


def test_several_designs_show_the_first():
    scene = ls.sample(ls.example("press"), {"crank.length": (0.07, 0.08)}, n=4)
    page = scene._repr_html_()
    assert "FourBar, 4 design: the first of them" in page and "<svg" in page


def test_parts_and_loads_show_their_fields():
    assert '<th scope="row">length</th>' in ls.Bar(0.08, 0.02, 0.02, 7750.0)._repr_html_()
    page = ls.Load("<coupler>", force=(0.0, -80.0))._repr_html_()
    assert "&lt;coupler&gt;" in page and "(0.0, -80.0)" in page
