"""Drawings of machines show loads and centres of gravity: where they are, in which sense, to one scale, with values.

Expected places are those of a four-bar by circle and circle, in complex numbers.
"""

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest
from drawn import closed_figures, line, texts  # noqa: F401
from long import long_but

import linksweep as ls
from linksweep import plot
from linksweep.scene.examples import names

STEEL = {"width": 0.02, "thickness": 0.02, "density": 7750.0}
A, D, THETA2 = 0.0, 0.20, 60.0


def press(*loads, **options) -> ls.Scene:
    crank, coupler, rocker = (ls.Bar(length, **STEEL) for length in (0.08, 0.22, 0.18))
    machine = ls.FourBar(crank, coupler, rocker, ground=D)
    return ls.Scene(machine, omega2=30.0, gravity=(0.0, -9.81), loads=loads, **options)


def places() -> tuple[complex, complex, complex, complex]:
    """Return pins B and C, and the directions of coupler and rocker."""
    b = cmath.rect(0.08, math.radians(THETA2))
    span = D - b
    away = math.acos((0.22**2 + abs(span) ** 2 - 0.18**2) / (2.0 * 0.22 * abs(span)))
    c = b + 0.22 * span / abs(span) * cmath.exp(1j * away)
    return b, c, (c - b) / 0.22, (c - D) / 0.18


def drawn(ax, label: str) -> np.ndarray:
    """Return the points of all lines of a name, in complex numbers."""
    rows = [np.transpose(one.get_data()) for one in ax.lines if one.get_label() == label]
    return np.concatenate(rows) @ [1.0, 1.0j]


def turned(degrees: float) -> complex:
    return cmath.exp(1j * math.radians(degrees))


def shafts(ax, color: str) -> np.ndarray:
    """Return start and end of each arrow of a colour, in complex numbers."""
    rows = [one.get_xydata() for one in ax.lines if one.get_color() == color and len(one.get_xdata()) == 2]
    return np.array(rows) @ [1.0, 1.0j]


def test_centres_of_gravity_are_where_the_masses_are():
    b, _, along, rocker = places()
    expected = [0.5 * b, b + 0.11 * along, D + 0.09 * rocker]
    ax = plot.mechanism(press(), THETA2)
    np.testing.assert_allclose(drawn(ax, "_centres"), expected, rtol=1e-12)
    np.testing.assert_allclose(drawn(ax, "_quarters"), expected, rtol=1e-12)
    light = replace(press().mechanism, coupler=ls.Link(0.22, 0.0, 0.0))
    ax = plot.mechanism(ls.Scene(light, omega2=30.0), THETA2)
    np.testing.assert_allclose(drawn(ax, "_centres"), [expected[0], expected[2]], rtol=1e-12)


def test_arrows_of_loads_end_where_they_act_to_the_scale_of_the_joints():
    b, _, along, rocker = places()
    push = ls.Load("coupler", force=(60.0, -80.0), at=(0.10, 15.0))
    turning = ls.Load("rocker", force=(0.0, 40.0), at=(0.05, 0.0), frame="link")
    scene = press(push, turning)
    ax = plot.mechanism(scene, THETA2, forces=True)
    tips = [b + 0.10 * along * turned(15.0), D + 0.05 * rocker]
    forces = [60.0 - 80.0j, 40.0j * rocker]
    np.testing.assert_allclose(drawn(ax, "_acts"), tips, rtol=1e-12)
    arrows = shafts(ax, "#5A5148")
    np.testing.assert_allclose(arrows[:, 1], tips, rtol=1e-12)
    joint = ls.sweep(scene, [THETA2], of=["F32x", "F32y"])
    scale = abs(np.diff(shafts(ax, "#D55E00")[0])[0]) / math.hypot(joint.F32x.item(), joint.F32y.item())
    np.testing.assert_allclose(arrows[:, 1] - arrows[:, 0], scale * np.array(forces), rtol=1e-9)
    assert {"load 1: 100.0 N", "load 2: 40.00 N"} <= {*texts(ax)}
    ax = plot.mechanism(replace(scene, units="in, lbf, rpm"), THETA2)
    assert f"load 1: {100.0 / 4.4482216152605:.2f} lbf" in texts(ax)


@pytest.mark.parametrize("torque", [12.0, -12.0])
def test_an_arc_about_a_ground_pin_turns_as_its_torque(torque):
    ax = plot.mechanism(press(ls.Load("rocker", torque=torque)), THETA2)
    arc = line(ax, "_torque")
    np.testing.assert_allclose(drawn(ax, "_torque"), [D])
    *_, outer, tip, inner, _ = arc.get_marker().vertices @ [1.0, 1.0j]
    middle = 0.5 * (outer + inner)
    assert math.copysign(1.0, ((tip - middle) / middle).imag) == math.copysign(1.0, torque)
    assert f"load 1: {torque:.2f} N m".replace("-", "−") in texts(ax)


def test_an_arc_stands_about_the_point_where_its_torque_acts():
    b, _, along, _ = places()
    ax = plot.mechanism(press(ls.Load("coupler", torque=5.0, at=(0.10, 15.0))), THETA2)
    np.testing.assert_allclose(drawn(ax, "_torque"), [b + 0.10 * along * turned(15.0)], rtol=1e-12)


def test_springs_and_dampers_run_from_end_to_end():
    b, _, along, rocker = places()
    loads = [
        ls.Spring(("ground", 0.1, -0.05), ("coupler", 0.1, 20.0), rate=2000.0, free_length=0.05),
        ls.Damper(("crank", 0.04, 0.0), ("rocker", 0.15, 0.0), coefficient=100.0),
        ls.TorsionSpring("ground", "rocker", rate=5.0),
        ls.TorsionDamper("crank", "coupler", coefficient=0.2),
    ]
    ax = plot.mechanism(press(*loads), THETA2)
    spring = drawn(ax, "_spring")
    np.testing.assert_allclose(spring[[0, -1]], [0.1 - 0.05j, b + 0.1 * along * turned(20.0)], rtol=1e-12)
    damper = drawn(ax, "_damper")
    np.testing.assert_allclose(damper[[0, -1]], [0.5 * b, D + 0.15 * rocker], rtol=1e-12)
    np.testing.assert_allclose(drawn(ax, "_torsion spring"), [D])
    np.testing.assert_allclose(drawn(ax, "_torsion damper"), [b], rtol=1e-12)
    words = {"load 1: spring", "load 2: damper", "load 3: torsion spring", "load 4: torsion damper"}
    assert words <= {*texts(ax)}


def test_gas_presses_onto_the_head_of_its_piston():
    machine = ls.SliderCrank(ls.Bar(0.05, **STEEL), ls.Bar(0.15, **STEEL), slider_mass=0.5, slide_angle=90.0)
    gas = ls.GasPressure(bore=0.08, pressure=3e6)
    ax = plot.mechanism(ls.Scene(machine, omega2=30.0, loads=[gas]), THETA2)
    arrows = shafts(ax, "#5A5148")[1:]  # without the line of their starts
    piston = drawn(ax, "_block")[:4]
    np.testing.assert_allclose(arrows[:, 1].imag, piston.imag.max(), rtol=0.05)
    assert len(arrows) == 3 and np.all(arrows[:, 0].imag > arrows[:, 1].imag)
    force = (3e6 - 101325.0) * 0.25 * math.pi * 0.08**2
    assert f"load 1: gas {force:.0f} N"[:-3] in next(text for text in texts(ax) if text.startswith("load 1"))


def test_a_load_that_does_nothing_is_not_drawn():
    push = ls.Load("rocker", torque=lambda theta2: np.where(np.mod(theta2, 360.0) < 90.0, 0.0, 5.0))
    assert not [text for text in texts(plot.mechanism(press(push), THETA2)) if text.startswith("load")]
    assert [text for text in texts(plot.mechanism(press(push), 120.0)) if text == "load 1: 5.000 N m"]


def test_a_film_shows_loads_and_centres_of_gravity():
    film = plot.animate(press(ls.Load("coupler", force=(0.0, -80.0)), ls.Load("rocker", torque=-12.0)), frames=2)
    labels = [str(artist.get_label()) for artist in film.show(1)]
    words = [artist.get_text() for artist in film.show(1) if hasattr(artist, "get_text")]
    assert {"_centres", "_acts", "_torque"} <= {*labels} and {"load 1", "load 2"} <= {*words}


@pytest.mark.parametrize("name", long_but(sorted({*names()} - {"loop"}), "engine", "excavator"))
def test_every_example_is_drawn_with_its_centres_of_gravity(name):
    scene = ls.example(name)
    sound = ls.sweep(scene, 72, of=["status"]).query(theta2="status == 0").theta2
    ax = plot.mechanism(scene, float(sound[7]))
    masses = scene.mechanism.masses().values()
    assert len(drawn(ax, "_centres")) == sum(float(link.mass) > 0.0 for link in masses)
    assert np.isfinite(drawn(ax, "_centres")).all()
