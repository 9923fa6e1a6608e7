"""Linkages in scene files: tables of named things, parts by their names, and texts that read back as equal scenes."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.scene.file import reading
from linksweep.scene.file.reading import parse_scene
from linksweep.scene.file.writing import write_scene

KNUCKLE = """
omega2 = 30.0

[mechanism]
type = "Linkage"
links = "crank A-B, rod B-C, upper D-C, lower C-E, ram E on slide"        # knuckle-joint press
ground = { A = [0, 0], D = ["26 cm", "16 cm"] }
guides.slide = { through = ["26 cm", 0], angle = "-90 deg", friction = 0.1 }
ram = { type = "Slider", mass = "3 kg" }
crank = { length = "4 cm", mass = 0.5, inertia = 1e-3 }
rod = { length = "24 cm", mass = 0.5, inertia = 1e-3 }
upper = { length = "16 cm", mass = 0.5, inertia = 1e-3 }

[mechanism.lower]
type = "Bar"
length = {dim = "lower", values = ["16 cm", "18 cm"]}
width = 0.02
thickness = 0.02
density = 7750
"""
STEEL = {"width": 0.02, "thickness": 0.02, "density": 7750}
PARTS = {role: ls.Bar(length, **STEEL) for role, length in (("crank", 0.08), ("coupler", 0.22), ("rocker", 0.18))}
SIX_BAR = ls.Linkage(
    "crank A-B, coupler B-C, rocker D-C-E, rod E-F, output G-F",
    ground={"A": (0, 0), "D": (0.20, 0), "G": (0.42, 0.05)},
    points={"E": (0.12, -35.0)},
    branch={"F": "crossed"},
    rod=ls.Bar(0.20, **STEEL),
    output=ls.Disk(0.15, 0.02, 0.02, 7750),
    **PARTS,
)


def knuckle() -> ls.Linkage:
    link, length = {"mass": 0.5, "inertia": 1e-3}, xr.DataArray([0.16, 0.18], {"lower": [0.16, 0.18]}, "lower")
    return ls.Linkage(
        "crank A-B, rod B-C, upper D-C, lower C-E, ram E on slide",
        ground={"A": (0, 0), "D": (0.26, 0.16)},
        guides={"slide": ls.Guide(through=(0.26, 0), angle=-90.0, friction=0.1)},
        crank=ls.Link(0.04, **link),
        rod=ls.Link(0.24, **link),
        upper=ls.Link(0.16, **link),
        lower=ls.Bar(length, **STEEL),
        ram=ls.Slider(mass=3.0),
    )


def test_a_file_has_the_words_of_the_constructor():
    assert parse_scene(KNUCKLE).mechanism == knuckle()


@pytest.mark.parametrize("linkage", [knuckle(), SIX_BAR, replace(SIX_BAR, branch={"C": "both", "F": "crossed"})])
def test_a_text_reads_back_as_an_equal_scene(linkage):
    scene = ls.Scene(linkage, omega2=30.0, gravity=(0, -9.81), loads=[ls.Load(linkage.roles[-1], force=(1.0, 2.0))])
    text = write_scene(scene)
    assert parse_scene(text) == scene
    assert write_scene(parse_scene(text)) == text


def test_the_text_is_laid_out_as_people_write_it():
    lines = ls.Scene(SIX_BAR, omega2=30.0).to_toml().split("[mechanism]\n")[1].split("\n")
    assert lines[:5] == [
        'type = "Linkage"',
        'links = "crank A-B, coupler B-C, rocker D-C-E, rod E-F, output G-F"',
        "ground = {A = [0.0, 0.0], D = [0.2, 0.0], G = [0.42, 0.05]}",
        "points = {E = [0.12, -35.0]}",
        'branch = {F = "crossed"}',
    ]
    assert "[mechanism.output]" in lines
    guides = next(line for line in ls.Scene(knuckle(), omega2=30.0).to_toml().split("\n") if line.startswith("guides"))
    assert guides == 'guides = {slide = {through = [0.26, 0.0], angle = -90.0, friction = 0.1, of = "ground"}}'


def test_numbers_over_designs_stand_elsewhere_in_a_file_by_their_paths():
    text = write_scene(ls.Scene(knuckle(), omega2=30.0), elsewhere=["lower.length"])
    assert 'length = {variable = "lower.length"}' in text


def problems(old: str, new: str) -> list[str]:
    assert old in KNUCKLE
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        parse_scene(KNUCKLE.replace(old, new))
    return str(refused.value).split("\n")


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        ("guides.slide", "guide.slide", 'scene:8: guide: unknown key; did you mean "guides"?'),
        ("upper = {", "uper = {", 'scene:12: uper: unknown key; did you mean "upper"?'),
        ("upper = {", "[other]\nupper = {", "scene:4: upper: missing; give upper = a Link, Bar or Disk"),
        ("A = [0, 0]", "A = 0", "scene:7: ground.A = 0: must be a pair (x, y) in m"),
        (
            '{ A = [0, 0], D = ["26 cm", "16 cm"] }',
            "3",
            "scene:7: ground = 3: must be a table; write, for example, ground = {A = [0, 0], D = [0.2, 0]}",
        ),
        (
            'ground = { A = [0, 0], D = ["26 cm", "16 cm"] }',
            "",
            "scene:4: ground: missing; write, for example, ground =",
        ),
        ("friction = 0.1", "friction = -0.1", "scene:8: guides.slide.friction = -0.1: must be at least 0"),
        ("angle =", "angel =", 'scene:8: guides.slide.angel: unknown key; did you mean "angle"?'),
        ('"3 kg"', '"3 m"', 'scene:9: ram.mass = "3 m": m is a unit of length, not of mass; accepted:'),
        ('"Slider"', '"Slidr"', "scene:9: ram.type = 'Slidr': must be one of Link, Bar, Disk, Slider, Cylinder"),
        ("E on slide", "E on slid", 'scene:6: links: "slid", on which ram slides, is neither a guide nor a link'),
    ],
)
def test_problems_have_line_and_path(old, new, problem):
    lines = problems(old, new)
    assert any(line.startswith(problem) for line in lines), lines


SLIPS = {"guides.slide": "guide.slide", "E on slide": "E on slid", '"-90 deg"': '"-90deg"', "A = [0, 0]": "A = [0]"}


@pytest.mark.parametrize(("old", "new"), SLIPS.items())
def test_only_the_cause_is_reported(old, new):
    assert len(problems(old, new)) == 1


def test_points_under_an_unknown_name_are_missing():
    text = Path(reading.__file__).parents[1].joinpath("examples/klann-leg.toml").read_text()
    with pytest.raises(ValueError, match=r"points.E: missing;.*\n.*points.H: missing;.*\n.* ts: unknown key"):
        parse_scene(text.replace("points = ", "ts = "))


def test_all_problems_stand_in_one_message():
    text = KNUCKLE.replace("30.0", '"3 m"').replace("friction = 0.1", "friction = -1").replace('"3 kg"', "-3")
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        parse_scene(text.replace('"24 cm"', "-1"))
    assert [line.split(":")[1] for line in str(refused.value).split("\n")] == ["2", "8", "9", "11"]


def test_one_branch_of_both_is_chosen_by_its_label():
    both = ls.Scene(replace(SIX_BAR, branch={"C": "both", "F": "both"}), omega2=30.0)
    chosen = ls.scene_at(both, branch_F="crossed", branch_C="open").mechanism.branch
    assert chosen == {"C": "open", "F": "crossed"}
    assert ls.scene_at(both, branch_F="crossed").mechanism.branch == {"C": "both", "F": "crossed"}


def test_the_name_of_a_branch_dim_is_taken():
    length = xr.DataArray(np.array([0.2, 0.21]), dims="branch_F")
    linkage = replace(SIX_BAR, branch={"F": "both"}, rod=ls.Bar(length, **STEEL))
    with pytest.raises(ValueError, match=r'rod\.length has a dimension "branch_F": that is the name of a result'):
        ls.Scene(linkage, omega2=30.0)
