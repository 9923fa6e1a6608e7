"""Sliders with a slot, and two sliders that share a pin, beside the multibody reference and closed forms."""

import numpy as np
import pytest
from linkage_reference import largest_error

import linksweep as ls

STEEL = {"width": 0.02, "thickness": 0.02, "density": 7750.0}
CRANK = ls.Link(0.08, 0.4, 3e-4, 0.03, 20.0)
MOTION = {"omega2": 20.0, "alpha2": 30.0, "gravity": (0.0, -9.81)}


def yoke(friction=0.0, slot_friction=0.0, slot_angle=70.0):
    """Return a yoke on the ground, or rather its scene."""
    guide = ls.Guide((0.01, 0.03), 30.0, friction)
    slider = ls.Slider(5.0, cg_distance=0.1, cg_angle=40.0, slot_angle=slot_angle, slot_friction=slot_friction)
    machine = ls.Linkage(
        "crank A-B, yoke on slide past B", ground={"A": (0.1, 0.0)}, guides={"slide": guide}, crank=CRANK, yoke=slider
    )
    return ls.Scene(machine, loads=[ls.Load("yoke", force=(-100.0, 40.0), at=(0.1, 20.0))], **MOTION)


def on_links(friction=0.0):
    """Return a yoke on a guide of the rocker, its slot past a coupler's pin; and two sliders on moving guides."""
    machine = ls.Linkage(
        "crank A-B, rod B-C-E, rocker D-C, one F on left, two F on right, yoke on rail past E, tail F-G, end H-G",
        ground={"A": (0.0, 0.0), "D": (0.2, 0.0), "H": (0.1, -0.4)},
        points={"E": (0.1, 30.0)},
        crank=CRANK,
        **{role: ls.Bar(length, **STEEL) for role, length in {"rod": 0.22, "rocker": 0.18, "end": 0.5}.items()},
        tail=ls.Link(0.5, 0.3, 2e-4, 0.1, 30.0),
        guides={
            "left": ls.Guide((0.02, 0.05), 20.0, friction, of="rod"),
            "right": ls.Guide((0.05, 0.01), 20.0, 2.0 * friction, of="rocker"),
            "rail": ls.Guide((0.0, 0.1), 10.0, friction, of="rocker"),
        },
        one=ls.Slider(1.0, 0.1, 0.02, 30.0),
        two=ls.Slider(2.0, 0.02, 0.01, 80.0),
        yoke=ls.Slider(2.0, 0.1, 0.02, 10.0, slot_angle=80.0, slot_friction=friction),
    )
    return ls.Scene(machine, loads=[ls.Load("two", force=(-30.0, 40.0)), ls.Load("tail", torque=3.0)], **MOTION)


@pytest.mark.parametrize("theta2", [12.0, 77.0, 163.0, 224.0, 303.0])
@pytest.mark.parametrize("scene", [yoke(), yoke(0.2, 0.3), yoke(0.9, 1.5), on_links(), on_links(0.1)])
def test_beside_the_reference(scene, theta2):
    assert largest_error(scene, theta2) < 1e-13


def test_jammed_slides_have_the_status_of_the_reference():
    """Friction of guide and slot wedge each other: no solution, or several."""
    scenes = [yoke(0.9, slot_friction, slot_angle) for slot_friction in (0.8, 2.5) for slot_angle in (30.0, 140.0)]
    statuses = np.concatenate([ls.sweep(scene, 24, of=["F12", "status"]).status for scene in scenes])
    assert {0, 4, 6} <= {*statuses.tolist()}
    assert max(largest_error(scene, theta2) for scene in scenes for theta2 in np.arange(7.0, 360.0, 30.0)) < 1e-12


def test_a_scotch_yoke_moves_as_the_cosine():
    machine = ls.Linkage(
        "crank A-B, yoke on slide past B",
        ground={"A": (0.0, 0.0)},
        guides={"slide": ls.Guide()},
        crank=ls.Link(0.1, 0.0, 0.0),
        yoke=ls.Slider(5.0),
    )
    cycle = ls.sweep(ls.Scene(machine, omega2=20.0), 36, of=["x_yoke", "F32n", "F32x", "F13n", "T12", "power_residual"])
    cos, sin = np.cos(np.radians(cycle.theta2)), np.sin(np.radians(cycle.theta2))
    np.testing.assert_allclose(cycle.x_yoke, 0.1 * cos, rtol=0, atol=1e-16)
    np.testing.assert_allclose(cycle.F32x, 5.0 * 400.0 * 0.1 * cos, rtol=0, atol=1e-12)
    np.testing.assert_allclose(cycle.F32n, -cycle.F32x, rtol=0, atol=1e-12)  # the slot points up: its left is -x
    np.testing.assert_allclose(cycle.T12, 5.0 * 400.0 * 0.01 * sin * cos, rtol=0, atol=1e-13)
    assert abs(cycle.F13n).max() < 1e-12 and abs(cycle.power_residual).max() < 1e-15


def test_parallel_slot_and_guide_are_a_toggle():
    assert np.all(ls.sweep(yoke(slot_angle=180.0), 4, of=["F12", "status"]).status == 2)


@pytest.mark.parametrize("scene", [yoke(0.2, 0.3), on_links(0.1)])
def test_dense_and_fast_agree(scene):
    names = [name for name in scene.mechanism.unknowns(scene.drive) if name != "T12"]
    fast, dense = (ls.sweep(scene, 13, of=names, solver=solver) for solver in ("fast", "dense"))
    largest = max(abs(fast[name]).max() for name in names)
    assert max(abs(fast[name] - dense[name]).max() for name in names) < 1e-12 * largest
