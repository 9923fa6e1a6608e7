"""Machines with a name of their own, and those that a linkage's text can state in two ways, have equal numbers."""

import numpy as np
import pytest
import xarray as xr
from random_linkages import swept

import linksweep as ls
from linksweep.mechanisms import Mechanism

THETA2 = np.array([33.1, 153.7, 261.4])
CRANK, ROD = (ls.Link(length, 1.3, 0.017, 0.3 * length, angle) for length, angle in ((0.1, 20.0), (0.3, -13.0)))
LEVER = ls.Link(0.25, 0.8, 0.02, 0.1, 40.0)
ARM = ls.Link(0.5, 0.8, 0.02, 0.1, 40.0)
PIVOTS = {"A": (0.0, 0.0), "D": (0.32, 0.0)}


def scene(machine: Mechanism, drive: str = "crank") -> ls.Scene:
    return ls.Scene(machine, 3.0, 2.0, (0.0, -9.81), [ls.Load("crank", torque=0.7)], drive)


def differences(named: ls.Scene, linkage: ls.Scene, but=()) -> dict[str, float]:
    """Return the quantities of both that differ by a bit, and by how much of their largest."""
    x, y = (swept(one, THETA2) for one in (named, linkage))
    names = [name for name in x if name in y.data_vars and name not in ("error_bound", "power_residual", *but)]
    assert len(names) > 60
    return {
        str(name): float(abs(x[name] - y[name]).max() / abs(x[name]).max())
        for name in names
        if not np.array_equal(*xr.broadcast(x[name], y[name]))
    }


def four_bars(branch: str, drive: str) -> tuple[ls.Scene, ls.Scene]:
    named = ls.FourBar(CRANK, ROD, LEVER, ground=0.32, branch=branch)
    parts = {"crank": CRANK, "coupler": ROD, "rocker": LEVER}
    linkage = ls.Linkage("crank A-B, coupler B-C, rocker D-C", ground=PIVOTS, branch={"C": branch}, **parts)
    return scene(named, drive), scene(linkage, drive)


@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_four_bar(branch):
    """Not a bit differs but of the bound on the error, which follows every operation of the placed pins, too."""
    assert differences(*four_bars(branch, "crank")) == {}


def test_four_bar_by_its_rocker():
    """The general drive's torque is all work over the ratio; the four-bar's comes from moments where the rocker is
    slow."""
    errors = differences(*four_bars("open", "rocker"))
    assert "T14" in errors and max(errors.values()) < 1e-14


def slider_cranks() -> tuple[ls.Scene, ls.Scene]:
    named = ls.SliderCrank(CRANK, ROD, 2.0, offset=0.02, friction=0.1)
    guides = {"slide": ls.Guide(through=(0.0, 0.02), friction=0.1)}
    parts = {"crank": CRANK, "rod": ROD, "slider": ls.Slider(2.0)}
    text = "crank A-B, rod B-C, slider C on slide"
    return scene(named), scene(ls.Linkage(text, ground={"A": (0.0, 0.0)}, guides=guides, **parts))


def test_slider_crank():
    """The torque adds up friction's work with the loads' in another order."""
    errors = differences(*slider_cranks())
    of_the_torque = {"T12", "reduced_torque", "power", "power_fed", "power_regenerated"}
    assert errors.keys() <= of_the_torque and max(errors.values(), default=0.0) < 1e-15


def inverted(drive: str, friction: float) -> tuple[ls.Scene, ls.Scene]:
    block = {"block_mass": 0.9, "block_inertia": 0.003}
    named = ls.InvertedSliderCrank(CRANK, ARM, ground=0.32, friction=friction, **block)
    parts = {"crank": CRANK, "block": ls.Slider(0.9, 0.003), "rocker": ARM}
    guides = {"rocker": ls.Guide(of="rocker", friction=friction)}
    text = "crank A-B, block B on rocker, rocker D-E"
    return scene(named, drive), scene(ls.Linkage(text, ground=PIVOTS, guides=guides, **parts), drive)


def test_inverted_slider_crank():
    assert differences(*inverted("crank", 0.0)) == {}


@pytest.mark.parametrize(
    "scenes",
    [four_bars("open", "rocker"), slider_cranks(), inverted("crank", 0.2)],
    ids=lambda it: type(it[0].mechanism).__name__,
)
def test_peaks_are_of_the_same_quantities_by_default(scenes):
    """The whole force of each pin and slide, with friction, the moment of a slide between links, and the drive."""
    named, linkage = (ls.peaks(one, theta2=8) for one in scenes)
    assert {*named.data_vars} == {*linkage.data_vars}


def test_a_drive_that_loads_a_slide_without_friction():
    """Friction that the drive itself decides is refused; without friction nothing of the drive comes back to it. The
    named machine's formula has no friction in it, so last digits may differ."""
    assert max(differences(*inverted("rocker", 0.0)).values()) < 1e-15


@pytest.mark.parametrize("friction", [0.0, 0.2])
def test_a_line_past_a_pin_is_one_through_a_block_without_mass(friction):
    parts = {"guides": {"rocker": ls.Guide(of="rocker", friction=friction)}, "crank": CRANK, "rocker": ARM}
    past = ls.Linkage("crank A-B, rocker D-E past B", ground=PIVOTS, **parts)
    block = ls.Linkage("crank A-B, rocker D-E, block B on rocker", ground=PIVOTS, block=ls.Slider(0.0), **parts)
    one, other = (swept(scene(machine), THETA2) for machine in (past, block))
    assert not one.status.any()
    for name, same in {"T12": "T12", "F12x": "F12x", "F13y": "F13y", "F32x": "F42x", "x_rocker": "x_block"}.items():
        np.testing.assert_allclose(one[name], other[same], rtol=1e-13, atol=1e-13, err_msg=name)


def test_two_equal_chains_between_the_same_pivots():
    """The vector between the pivots is made once, for both."""
    links = {"crank": CRANK, "coupler": ROD, "rocker": LEVER, **dict.fromkeys(("rod", "rod2"), LEVER)}
    twice = ls.Linkage(
        "crank A-B, coupler B-C, rocker D-C-E, rod E-F, output G-F, rod2 E-H, output2 G-H",
        ground={**PIVOTS, "G": (0.5, 0.1)},
        points={"E": (0.2, -30.0)},
        **links,
        **dict.fromkeys(("output", "output2"), ARM),
    )
    made = [name for row in scene(twice).table.rows for name in row.outputs]
    assert made.count("ground_D_Gx") == 1
    cycle = swept(scene(twice), THETA2)
    assert (cycle.status == 0).any()
    for one, other in (("omega6", "omega8"), ("Fx", "Hx"), ("F65", "F87"), ("F16", "F18")):
        np.testing.assert_array_equal(cycle[one], cycle[other])
