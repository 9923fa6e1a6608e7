"""Drawings as files, read back: DXF by ezdxf, sizes of SVG and PDF; expected places by circle and circle, in complex
numbers."""

import cmath
import math
import re
import sys
from dataclasses import replace

import ezdxf
import numpy as np
import pytest
from drawn import closed_figures  # noqa: F401

import linksweep as ls
from linksweep.cli.main import main
from linksweep.plot.sheets.save_drawing import scale_of

INCH, MM, POINT = 0.0254, 1e-3, 0.0254 / 72.0  # m
GROUND = 0.20


def places(theta2) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return pins B and C of the press, and the direction of its coupler."""
    b = 0.08 * np.exp(1j * np.radians(theta2))
    span = GROUND - b
    away = np.arccos((0.22**2 + np.abs(span) ** 2 - 0.18**2) / (2.0 * 0.22 * np.abs(span)))
    c = b + 0.22 * span / np.abs(span) * np.exp(1j * away)
    return b, c, (c - b) / 0.22


def on_layer(document, layer: str, kind: str) -> list:
    return [*document.modelspace().query(f'{kind}[layer=="{layer}"]')]


def points(line) -> np.ndarray:
    return np.array(line.get_points("xy")) @ [1.0, 1.0j]


def centres(document, layer: str) -> np.ndarray:
    return np.array([complex(*circle.dxf.center.vec2) for circle in on_layer(document, layer, "CIRCLE")])


@pytest.mark.parametrize(("units", "code", "metre"), [("", 4, MM), ("in, lbf, rpm", 1, INCH), ("m, N", 6, 1.0)])
def test_a_press_as_dxf_has_its_pins_links_and_curves_in_the_chosen_unit(tmp_path, units, code, metre):
    scene = replace(ls.example("press"), units=units)
    curves = [("coupler", 0.1, 15.0), ("crank", "80 mm", 0.0)]
    ls.save_drawing(scene, tmp_path / "press.dxf", theta2="30 deg", curves=curves)
    document = ezdxf.readfile(tmp_path / "press.dxf")
    assert document.header["$INSUNITS"] == code and not document.audit().errors
    b, c, _ = places(30.0)
    near = {"rtol": 0.0, "atol": 1e-9 / metre}
    np.testing.assert_allclose(centres(document, "pins"), np.array([0.0, b, c, GROUND]) / metre, **near)
    links = {"2 crank": [0.0, b], "3 coupler": [b, c], "4 rocker": [GROUND, c], "1 ground": [0.0, GROUND]}
    for layer, ends in links.items():
        (line,) = on_layer(document, layer, "LWPOLYLINE")
        np.testing.assert_allclose(points(line), np.array(ends) / metre, **near)
    masses = [complex(*at.dxf.location.vec2) for at in on_layer(document, "centres of gravity", "POINT")]
    np.testing.assert_allclose(masses, np.array([b, b + c, GROUND + c]) / 2.0 / metre, **near)
    (curve,), (circle,) = (on_layer(document, f"curve {name}", "LWPOLYLINE") for name in ("1 of coupler", "2 of crank"))
    all_b, _, along = places(np.arange(720) * 0.5)
    expected = all_b + 0.1 * along * cmath.exp(1j * math.radians(15.0))
    np.testing.assert_allclose(points(curve), expected / metre, **near)
    np.testing.assert_allclose(np.abs(points(circle)), 0.08 / metre, rtol=1e-12)
    assert curve.closed and circle.closed
    assert {text.dxf.text for text in on_layer(document, "names", "TEXT")} == {*"ABCD"}
    (turning,) = on_layer(document, "centre lines", "CIRCLE")
    assert (turning.dxf.radius * metre, turning.dxf.linetype) == (pytest.approx(0.08), "CENTER")


def test_an_engine_as_dxf_has_its_block_on_its_guide(tmp_path):
    ls.save_drawing(ls.example("engine"), tmp_path / "engine.dxf", theta2=30.0)
    document = ezdxf.readfile(tmp_path / "engine.dxf")
    (block,), (guide,) = (on_layer(document, layer, "LWPOLYLINE") for layer in ("4 slider", "guides"))
    b = 43.0 * cmath.exp(1j * math.radians(30.0))  # mm
    height = b.imag + math.sqrt(145.0**2 - b.real**2)
    assert block.closed and points(block).mean() == pytest.approx(1j * height, abs=1e-9)
    assert points(guide).real == pytest.approx([0.0, 0.0], abs=1e-9) and guide.dxf.linetype == "CENTER"


def test_a_curve_with_gaps_is_drawn_in_pieces(tmp_path):
    long = replace(ls.example("press").mechanism, ground=0.45)
    scene = ls.Scene(long, omega2=10.0)
    ls.save_drawing(scene, tmp_path / "curve.dxf", theta2=20.0, curves=[("coupler", 0.11, 0.0)], machine=False)
    document = ezdxf.readfile(tmp_path / "curve.dxf")
    lines = on_layer(document, "curve 1 of coupler", "LWPOLYLINE")
    assert len(lines) == 2 and not any(line.closed for line in lines)
    assert {part.dxf.layer for part in document.modelspace()} == {"curve 1 of coupler"}


@pytest.mark.parametrize("scale", ["1:2", "0.5", 0.5, " 1 : 2 "])
def test_a_scale_is_a_ratio_or_a_number(scale):
    assert scale_of(scale) == 0.5


def test_svg_and_pdf_are_to_scale(tmp_path):
    for ending in ("svg", "pdf"):
        ls.save_drawing(ls.example("press"), tmp_path / f"press.{ending}", theta2=30.0, scale="1:2")
    svg = (tmp_path / "press.svg").read_text("utf-8")
    b, c, _ = places(30.0)
    signs = re.findall(r'<use xlink:href="#\w+" x="([\d.]+)" y="([\d.]+)" style="fill: #ffffff; stroke: #3f4b55"', svg)
    drawn = [float(x) - 1j * float(y) for x, y in signs[-4:]]  # of the pins, after the supports
    np.testing.assert_allclose(np.array(drawn) - drawn[0], 0.5 * np.array([0.0, b, c, GROUND]) / POINT, atol=1e-4)
    size = [float(side) for side in re.search(r'width="([\d.]+)pt" height="([\d.]+)pt"', svg).groups()]
    page = re.search(rb"/MediaBox \[ 0 0 ([\d.]+) ([\d.]+) \]", (tmp_path / "press.pdf").read_bytes())
    assert [float(side) for side in page.groups()] == pytest.approx(size, abs=0.01)
    assert "1:2" in svg or "1:2" in re.sub(r"<[^>]*>", "", svg)


def test_drawings_of_equal_scenes_are_equal(tmp_path):
    curves = [("coupler", 0.2, 10.0), ("rocker", 0.1, 0)]
    for name in ("one", "two"):
        ls.save_drawing(ls.example("press"), tmp_path / f"{name}.svg", curves=curves, machine=False)
    assert (tmp_path / "one.svg").read_bytes() == (tmp_path / "two.svg").read_bytes()


@pytest.mark.parametrize(
    ("name", "words", "message"),
    [
        ("press.dwg", {}, r"press\.dwg: its ending must be \.dxf or \.pdf or \.svg"),
        ("press.dxf", {"scale": 0.5}, r"scale = 0\.5: a DXF file is in full size"),
        ("press.svg", {"scale": "1:zero"}, r'scale = "1:zero": must be a scale such as 1:2, or a number such as 0\.5'),
        ("press.svg", {"scale": "1/2"}, r'scale = "1/2": must be a scale such as 1:2, or a number such as 0\.5'),
        ("press.svg", {"scale": "-0.5"}, r"scale = -0\.5: must be greater than 0"),
        ("press.svg", {"scale": "200:1"}, r"scale = 200: makes a page of .* m; must be small enough"),
        ("press.svg", {"machine": False}, r"machine = False: curves must name at least one point"),
        ("press.svg", {"curves": [("rod", 0.1, 0.0)]}, r"curves\[1\]\[1\] = 'rod': must be one of"),
        ("press.svg", {"curves": [("coupler", 0.1)]}, r"curves\[1\] = .*must be \(link, distance \[m\], angle"),
        ("press.svg", {"curves": [("coupler", "1 kg", 0.0)]}, r"curves\[1\]"),
        ("press.svg", {"theta2": "noon"}, r"theta2 = 'noon': must be one crank angle"),
    ],
)
def test_bad_requests_are_refused_and_leave_no_file(tmp_path, name, words, message):
    with pytest.raises(ValueError, match=message):
        ls.save_drawing(ls.example("press"), tmp_path / name, **words)
    assert not [*tmp_path.iterdir()]


def test_without_ezdxf_the_sentence_names_the_extra(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "ezdxf", None)
    with pytest.raises(ImportError, match=r'pip install "linksweep\[cad\]"'):
        ls.save_drawing(ls.example("press"), tmp_path / "press.dxf")
    assert not [*tmp_path.iterdir()]


def test_the_command_draws(tmp_path, capsys):
    file = tmp_path / "press.dxf"
    curve = ["--curve", "coupler", "10 cm", "15"]
    assert main(["draw", "press", "-o", str(file), "--theta2", "30 deg", "--units", "US", *curve, "--curves-only"]) == 0
    assert f"written: {file}" in capsys.readouterr().out
    document = ezdxf.readfile(file)
    assert document.header["$INSUNITS"] == 1
    (curve,) = on_layer(document, "curve 1 of coupler", "LWPOLYLINE")
    b, _, along = places(0.0)
    assert points(curve)[0] == pytest.approx((b + 0.1 * along * cmath.exp(1j * math.radians(15.0))) / INCH)
    assert main(["draw", "press", "-o", str(file), "--scale", "1:2"]) == 2
    assert "DXF file is in full size" in capsys.readouterr().err
