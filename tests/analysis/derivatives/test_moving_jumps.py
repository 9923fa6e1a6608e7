"""Derivatives of results where forces jump at angles that parameters move, by differences of computed results."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.results.derivatives.of_peaks import MEANINGS
from linksweep.scene.parameters import free, replaced

BARS = ls.Bar(0.05, 0.03, 0.02, 7850.0), ls.Bar(0.20, 0.03, 0.02, 7850.0)
PISTON = ls.SliderCrank(*BARS, slider_mass=4.0, offset=0.01)
PUSH = xr.DataArray([-200.0, -150.0, 0.0], {"position": [0.0, 0.16, 0.2]}, "position")
FOLLOWING = ls.Load("slider", force=PUSH, over="slider.position", while_="closing", interpolation="linear")
OUT_OF_REACH = ls.Scene(PISTON, omega2=10.0, loads=[FOLLOWING])
"""The slider goes from 0.15 to 0.25 m, and does not reach the first position of the table."""


ANGLES = np.arange(0.0, 360.0, 60.0)
TABLE = xr.DataArray([0.0, -50.0, -90.0, -120.0, -90.0, -50.0], {"theta2": ANGLES}, "theta2")
RUBBING = ls.Scene(replace(PISTON, offset=0.0, friction=0.15), 10.0, gravity=(0, -9.81))
PRESS = ls.example("press")


def spring(free_angle=0.0, rate=5.0):
    """Return a spring whose torque jumps where the crank is at 180 degrees more."""
    return ls.TorsionSpring("ground", "crank", rate=rate, free_angle=free_angle)


def result(scene, name):
    if name == "flywheel_inertia":
        return ls.flywheel(scene, fluctuation=0.02)[name]
    return ls.peaks(scene, of=[name.removesuffix("_peak").removesuffix("_min")])[name]


def differences(scene, name, path, step):
    """Return differences forward and backward, each of two steps: without their error of first order."""
    value = free(scene)[path][0] or 0.0
    away = xr.DataArray([0.0, 1.0, 2.0, -1.0, -2.0], dims="away")
    own, one, two, back, far = result(replaced(scene, {path: value + step * away}), name).transpose("away", ...).values
    return (4.0 * one - two - 3.0 * own) / (2.0 * step), (3.0 * own - 4.0 * back + far) / (2.0 * step)


def has_those_of_differences(scene, names, steps, rel=1e-5):
    ds = ls.sensitivities(scene, of=names, to=list(steps))
    for name in names:
        assert MEANINGS[int(ds[f"{name}_status"])] == "ok", name
        for path, step in steps.items():
            ours = float(ds[f"{name}_derivative"].sel(parameter=path))
            two_sided = float(np.mean(differences(scene, name, path, step)))
            assert ours == pytest.approx(two_sided, rel=rel), (name, path)


def test_a_position_that_is_not_reached_moves_nothing():
    has_those_of_differences(OUT_OF_REACH, ["T12_rms", "F32_mean", "flywheel_inertia"], {"crank.length": 1e-4})


def test_a_search_goes_on_where_a_position_is_not_reached():
    """A shorter crank works less against the load: the least torque has the shortest."""
    least = ls.objective(OUT_OF_REACH, {"crank.length": (0.03, 0.07)}, minimize="T12_rms").optimum()
    assert least.success and least.x == pytest.approx([0.03], rel=1e-6)


def test_what_is_zero_has_no_derivative_and_a_search_there_no_success():
    light = ls.FourBar(*(ls.Link(length, 0.0, 0.0) for length in (0.08, 0.22, 0.18)), ground=0.2)
    scene = ls.Scene(light, omega2=3.0)
    ds = ls.sensitivities(scene, of=["T12_rms", "F32_rms"], to=["ground"])
    for name in ("T12_rms", "F32_rms"):
        assert ds[name] == 0.0 and np.isnan(ds[f"{name}_derivative"]).all()
        assert MEANINGS[int(ds[f"{name}_status"])] == "zero_magnitude"
    most = ls.objective(scene, {"ground": (0.19, 0.21)}, maximize="T12_rms").optimum()
    assert not most.success and "not known" in most.message


# ------------------------------------------------------------------------------------------- several at one angle


def test_a_table_that_bends_at_a_dead_centre_does_not_hold_it():
    """Friction jumps at 0 and 180 degrees, where the table has nodes; the offset moves both dead centres."""
    scene = replace(RUBBING, loads=[ls.Load("slider", force=TABLE, interpolation="linear")])
    has_those_of_differences(scene, ["F12_rms", "F32x_rms"], {"offset": 1e-5}, rel=1e-4)


@pytest.mark.parametrize("jumps", [(), (180.0,), (0.0, 180.0)])
def test_a_break_at_which_nothing_breaks_does_not_hold_a_spring(jumps):
    scene = replace(PRESS, loads=[spring(), ls.Load("coupler", force=(0.0, -80.0), breaks=jumps)])
    has_those_of_differences(scene, ["T12_rms", "T12_min", "flywheel_inertia"], {"loads[1].free_angle": 0.05}, rel=1e-4)


def test_loads_that_jump_and_move_alike_are_one_jump():
    """A load that acts on one way alone jumps at dead centres, with friction."""
    one_way = ls.Load("slider", force=-100.0, over="slider.position", while_="closing")
    for offset in (0.01, 0.0):
        scene = replace(RUBBING, mechanism=replace(RUBBING.mechanism, offset=offset), loads=[one_way])
        has_those_of_differences(scene, ["F12_rms"], {"offset": 1e-5}, rel=1e-4)


PARTED = {
    "two springs": (replace(PRESS, loads=[spring(20.0), spring(20.0, 3.0)]), "loads[1].free_angle", 0.2),
    "a spring and a table of steps": (
        replace(PRESS, loads=[spring(), ls.Load("crank", torque=0.1 * TABLE, interpolation="step")]),
        "loads[1].free_angle",
        0.2,
    ),
    "a spring and a function": (
        replace(PRESS, loads=[spring(), ls.Load("crank", torque=lambda angle: np.where(angle % 360 < 180, 4.0, -3.0))]),
        "loads[1].free_angle",
        0.2,
    ),
    "a spring a turn later than a table of steps": (
        replace(PRESS, loads=[spring(180.0), ls.Load("crank", torque=0.1 * TABLE, interpolation="step")]),
        "loads[1].free_angle",
        0.2,
    ),
}


@pytest.mark.parametrize("case", PARTED)
def test_jumps_that_a_parameter_parts_have_a_corner(case):
    """Whichever comes first decides what acts between them: the square of the torque changes by another amount."""
    scene, path, step = PARTED[case]
    forward, backward = differences(scene, "T12_rms", path, step)
    assert abs(forward - backward) > 1e-3 * abs(forward)
    ds = ls.sensitivities(scene, of=["T12_rms", "flywheel_inertia"], to=[path, "omega2"])
    for name in ("T12_rms", "flywheel_inertia"):
        assert MEANINGS[int(ds[f"{name}_status"])] == "tie"
        assert np.isnan(ds[f"{name}_derivative"].values).tolist() == [True, False]


def hat(angle):
    """Return a force that has its largest size, 1000 N, at 180 degrees, where it bends."""
    return -1000.0 + 5.0 * abs(angle % 360.0 - 180.0)


PEAKS = {
    "slider-crank": RUBBING,
    "linkage": replace(
        RUBBING,
        mechanism=ls.Linkage(
            "crank A-B, rod B-C, ram C on slide", ground={"A": (0, 0)}, guides={"slide": ls.Guide(friction=0.15)},
            crank=BARS[0], rod=BARS[1], ram=ls.Slider(mass=4.0),
        ),
    ),
}  # fmt: skip


@pytest.mark.parametrize(
    ("machine", "jumps"), [("slider-crank", ()), ("slider-crank", (180.0,)), ("linkage", (180.0,))]
)
def test_a_peak_at_a_dead_centre_where_a_load_bends_has_a_corner(machine, jumps):
    """The offset takes the dead centre away from where the load is largest."""
    link, path = ("slider", "offset") if machine == "slider-crank" else ("ram", "guides.slide.through[2]")
    scene = replace(PEAKS[machine], loads=[ls.Load(link, force=(hat, 0.0), breaks=jumps)])
    forward, backward = differences(scene, "F12_peak", path, 1e-6)
    assert abs(forward - backward) > 0.5 * abs(forward)
    ds = ls.sensitivities(scene, of=["F12_peak"], to=[path])
    assert np.isnan(float(ds.F12_peak_derivative[0]))
    assert MEANINGS[int(ds.F12_peak_status)] == ("tie" if machine == "slider-crank" else "moving_jump")


def test_two_sides_of_a_jump_that_are_as_high_tie():
    """The force on the coupler turns round at 180 degrees, where it is largest: another adds to one side alone."""

    def push(angle):
        return np.where(angle % 360 < 180, 1.0, -1.0) * (1000.0 - 50.0 * abs(angle % 360 - 180))

    loads = [ls.Load("coupler", force=(push, 0.0), breaks=[180.0, 0.0]), ls.Load("coupler", force=(0.0, 0.0))]
    scene = replace(PRESS, gravity=(0.0, 0.0), omega2=1e-6, loads=loads)
    forward, backward = differences(scene, "F32_peak", "loads[2].force[1]", 1e-3)
    assert forward == pytest.approx(-backward, rel=1e-6) and abs(forward) > 0.1
    ds = ls.sensitivities(scene, of=["F32_peak"], to=["loads[2].force[1]", "coupler.length"])
    assert MEANINGS[int(ds.F32_peak_status)] == "tie" and np.isnan(ds.F32_peak_derivative[0])
    assert float(ds.F32_peak_derivative[1]) == pytest.approx(0.0, abs=1e-6)  # it acts at that pin
