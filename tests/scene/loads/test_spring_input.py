"""Springs and dampers in scene files, and refused input."""

import re
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from refusals import refusal
from test_springs import FOUR_BAR, all_kinds, scene

import linksweep as ls
from linksweep.scene.file.reading import parse_scene
from linksweep.scene.file.writing import write_scene


def test_scene_file_round_trip():
    places = xr.DataArray([0.1, 0.3], dims="place")
    loads = [*all_kinds(FOUR_BAR), ls.Spring(("ground", places, -0.1), ("crank", 0.0, 0.0), 1.0, places)]
    loads.append(ls.Load("rocker", torque=-1.0))
    loaded = scene(loads=loads)
    assert parse_scene(write_scene(loaded)) == loaded
    assert ls.sweep(loaded, 4, of=["T12"]).sizes == {"place": 2, "theta2": 4}


FILE = """omega2 = 3
[mechanism]
type = "FourBar"
crank = {length = 0.04, mass = 1, inertia = 1}
coupler = {length = 0.12, mass = 1, inertia = 1}
rocker = {length = 0.09, mass = 1, inertia = 1}
ground = 0.13
[[loads]]
"""


@pytest.mark.parametrize(
    ("table", "expected"),
    [
        (
            'type = "Spring"\nfrom_ = ["ground", "30 cm", 0]\nto = ["rocker", "9 cm", "1 rad"]\n'
            'rate = "2 N/mm"\nfree_length = "50 mm"',
            ls.Spring(("ground", 0.3, 0.0), ("rocker", 0.09, np.degrees(1.0)), 2000.0, 0.05),
        ),
        (
            'type = "Damper"\nfrom_ = ["ground", 1, 0]\nto = ["crank", 0, 0]\ncoefficient = "3 kN s/m"',
            ls.Damper(("ground", 1.0, 0.0), ("crank", 0.0, 0.0), 3000.0),
        ),
        (
            'type = "TorsionSpring"\nfrom_ = "ground"\nto = "rocker"\nrate = "5 N m/rad"\nfree_angle = "0.25 rev"',
            ls.TorsionSpring("ground", "rocker", 5.0, 90.0),
        ),
        (
            'type = "TorsionDamper"\nfrom_ = "crank"\nto = "rocker"\ncoefficient = "200 N mm s/rad"',
            ls.TorsionDamper("crank", "rocker", 0.2),
        ),
        ('link = "rocker"\ntorque = 2', ls.Load("rocker", torque=2.0)),
    ],
)
def test_reads_from_a_file(table, expected):
    assert parse_scene(FILE + table).loads == (expected,)


@pytest.mark.parametrize(
    ("table", "line", "expected"),
    [
        (
            'from_ = ["ground", 0, 0]\nto = ["crank", 0, 0]\nrate = 1\nfree_length = 0',
            8,
            'loads[1].type: missing; by its keys a Spring, so write type = "Spring"',
        ),
        (
            'type = "Spring"\nfrom_ = ["ground", 0, 0]\nto = ["crank", "3 N", 0]\nrate = 1\nfree_length = 0',
            11,
            'loads[1].to[2] = "3 N": N is a unit of force',
        ),
        ('type = "Sprig"\nrate = 1', 9, "loads[1].type = 'Sprig': must be one of Load"),
        ('type = "TorsionDamper"\nfrom_ = "ground"\nto = "rocker"', 8, "loads[1].coefficient: missing"),
    ],
)
def test_a_slip_in_a_file_is_refused_with_its_line(table, line, expected):
    with pytest.raises(ValueError, match=re.escape(f"scene:{line}: {expected}")):
        parse_scene(FILE + table)


SPRING = ls.Spring(("ground", 0.3, 0.1), ("coupler", 0.1, 15.0), rate=2000.0, free_length=0.05)
WOUND = ls.TorsionSpring("ground", "rocker", rate=5.0)
REFUSED = [
    (replace(SPRING, rate=-1.0), "loads[1].rate = -1 N/m: must be at least 0"),
    (replace(SPRING, free_length=-0.1), "loads[1].free_length = -0.1 m: must be at least 0"),
    (replace(SPRING, rate=np.sin), "loads[1].rate = <ufunc 'sin'>: must be a number in N/m, not a function"),
    (replace(SPRING, to=("coupler", -0.1, 0.0)), "loads[1].to[2] = -0.1 m: must be at least 0; for a point on the"),
    (replace(SPRING, to=("coupler", 0.1)), "loads[1].to = ('coupler', 0.1): must be (\"ground\", x, y) in m, or"),
    (replace(SPRING, from_="ground"), "loads[1].from_ = 'ground': must be (\"ground\", x, y) in m, or"),
    (replace(SPRING, from_=("ground", np.nan, 0.0)), "loads[1].from_[2] = nan m: must be finite"),
    (
        replace(SPRING, to=("ruler", 0.1, 0.0)),
        "loads[1].to[1] = 'ruler': must be one of ground, crank, coupler, rocker",
    ),
    (replace(SPRING, to=("ground", 0.1, 0.0)), "loads[1].to[1] = 'ground': must be another link than that of from_"),
    (ls.Damper(("crank", 0.0, 0.0), ("crank", 0.1, 0.0), 1.0), "loads[1].to[1] = 'crank': must be another link"),
    (ls.Damper(*(SPRING.from_, SPRING.to), np.inf), "loads[1].coefficient = inf N s/m: must be finite and at least 0"),
    (replace(WOUND, to="ground"), "loads[1].to = 'ground': must be another link than that of from_"),
    (replace(WOUND, from_="frame"), "loads[1].from_ = 'frame': must be one of ground, crank, coupler, rocker"),
    (replace(WOUND, from_=xr.DataArray([0.1, 0.2], dims="n")), "loads[1].from_ = "),
    (replace(WOUND, rate=-5.0), "loads[1].rate = -5 N m/rad: must be at least 0"),
    (
        replace(WOUND, free_angle="90"),
        'loads[1].free_angle = "90": has no unit; write "90 degree", or 90 without',
    ),
]


@pytest.mark.parametrize(("action", "expected"), REFUSED)
def test_refusals_of_springs_and_dampers(action, expected):
    (line,) = refusal(scene, loads=action)
    assert line.startswith(expected)


def test_a_free_length_is_not_rotated_as_a_point():
    (line,) = refusal(scene, loads=replace(SPRING, free_length=-0.1))
    assert "angle" not in line
