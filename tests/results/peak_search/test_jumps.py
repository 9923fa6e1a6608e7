"""Peaks see both one-sided limits where friction jumps."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import linksweep as ls

CRANK = ls.Link(0.045, 1.2, 1e-3, cg_distance=0.01, cg_angle=30.0)
ROD = ls.Link(0.15, 0.6, 2.2e-3, cg_distance=0.05, cg_angle=-5.0)
ENGINE = ls.SliderCrank(CRANK, ROD, slider_mass=0.5, offset=0.01, friction=0.3, slide_angle=20.0)
PUSH = ls.Load("slider", force=(-900.0, 0.0), frame="link")
SCENE = ls.Scene(ENGINE, omega2=10.0, gravity=(0.0, -9.81), loads=[PUSH])


def branch(name):
    return replace(SCENE, mechanism=replace(ENGINE, branch=name))


@pytest.mark.parametrize("name", ["open", "crossed"])
def test_the_slider_turns_round_at_every_jump(name):
    scene = branch(name)
    assert len(scene.mechanism.jumps()) == 2
    for angle in scene.mechanism.jumps():
        beside = ls.sweep(scene, [angle - 1e-6, angle + 1e-6], of=["v_slider", "friction_force"])
        assert np.prod(np.sign(beside.v_slider.values)) == -1.0
        assert np.prod(np.sign(beside.friction_force.values)) == -1.0


@pytest.mark.parametrize("name", ["open", "crossed"])
def test_a_one_sided_limit_is_the_peak(name):
    """The normal force hardly changes beside the dead centre: the limits are those of samples very near to it."""
    scene = branch(name)
    beside = [angle + aside for angle in scene.mechanism.jumps() for aside in (-1e-5, 1e-5)]
    near = ls.sweep(scene, beside, of=["friction_force"]).friction_force
    peaks = ls.peaks(scene, of=["friction_force"])
    everywhere = ls.sweep(scene, 3600, of=["friction_force"]).friction_force
    assert float(peaks.friction_force_max) == pytest.approx(max(float(near.max()), float(everywhere.max())), rel=1e-3)
    assert float(peaks.friction_force_min) == pytest.approx(min(float(near.min()), float(everywhere.min())), rel=1e-3)


MU, A, B = 0.3, 0.043, 0.145


def greatest_normal_force(offset, omega2, way):
    """Largest |N| on a guide at y = e of a slider without mass, by statics, while 2000 N push it across, along y.

    Where the slider moves by the sign s, the rod's force S at the angle β and the friction −μ·|N|·s give
    S·cos β = μ·|N|·s and S·sin β + N + 2000 = 0, so that |N| = 2000/(1 − μ·s·tan β); at a dead centre alone it is 2000.
    """
    stretched, folded = np.arcsin(offset / (B + A)), np.pi + np.arcsin(offset / (B - A))
    outwards = (folded, stretched + 2.0 * np.pi) if omega2 > 0.0 else (stretched, folded)
    inwards = (stretched, folded) if omega2 > 0.0 else (folded, stretched + 2.0 * np.pi)
    theta = np.linspace(*(inwards if way == "opening" else outwards), 20_001)  # the limits at both ends included
    tangent = np.tan(np.arcsin((offset - A * np.sin(theta)) / B))
    return np.max(2000.0 / (1.0 - MU * (-1.0 if way == "opening" else 1.0) * tangent))


@pytest.mark.parametrize("offset", [0.02, 0.021, -0.013])
@pytest.mark.parametrize("omega2", [30.0, -30.0])
@pytest.mark.parametrize("way", ["opening", "closing"])
def test_what_stands_between_the_limits_of_friction_and_a_load_is_no_peak(offset, omega2, way):
    """At a dead centre the load is on, and friction, which eases it on one side, is not."""
    expected = greatest_normal_force(offset, omega2, way)
    crank, rod = ls.Link(A, 0.0, 0.0), ls.Link(B, 0.0, 0.0)
    engine = ls.SliderCrank(crank, rod, 0.0, offset=offset, friction=MU)
    guide = ls.Guide(through=(0.0, offset), friction=MU)
    text, parts = "crank A-B, rod B-C, ram C on slide", {"crank": crank, "rod": rod, "ram": ls.Slider(0.0)}
    linkage = ls.Linkage(text, ground={"A": (0.0, 0.0)}, guides={"slide": guide}, **parts)
    for machine, slider, name in ((engine, "slider", "normal_force"), (linkage, "ram", "F14n")):
        push = ls.Load(slider, force=(0.0, 2000.0), over=f"{slider}.position", while_=way)
        peaks = ls.peaks(ls.Scene(machine, omega2=omega2, loads=[push]), of=[name])
        assert float(peaks[f"{name}_peak"]) == pytest.approx(expected, rel=1e-8)


def test_nothing_is_read_into_a_jump():
    """A peak is never more than the densest sampling shows."""
    for name in ("open", "crossed"):
        dense = ls.sweep(branch(name), 20_000, of=["friction_force", "T12"])
        peaks = ls.peaks(branch(name), of=["friction_force", "T12"])
        assert float(peaks.friction_force_max) <= float(dense.friction_force.max()) * (1.0 + 1e-3)
        assert float(peaks.T12_max) <= float(dense.T12.max()) * (1.0 + 1e-3)


def test_each_design_has_its_own_jumps():
    friction = xr.DataArray([0.0, 0.1, 0.3], dims="mu")
    length = xr.DataArray([0.12, 0.15], dims="rod")
    speed = xr.DataArray([10.0, 300.0], dims="speed")
    push = ls.Load("slider", force=(lambda theta2: -900.0 * (1.0 + np.cos(np.radians(theta2))), 0.0))

    def scene(friction, length, speed):
        engine = replace(ENGINE, friction=friction, rod=replace(ROD, length=length))
        return ls.Scene(engine, omega2=speed, loads=[push])

    batch = ls.peaks(scene(friction, length, speed), of=["friction_force", "F12"])
    for i, j, k in np.ndindex(3, 2, 2):
        alone = ls.peaks(scene(*(float(x[n]) for x, n in ((friction, i), (length, j), (speed, k)))), of=["F12"])
        one = batch.isel(mu=i, rod=j, speed=k)
        if float(friction[i]):
            assert float(one.F12_peak) == float(alone.F12_peak)
            assert float(one.F12_peak_at) == float(alone.F12_peak_at)


def test_a_design_that_jams_says_so():
    """Towards where friction wedges the slider, forces grow without bound: in between no sample has them all."""
    short = replace(ENGINE, rod=replace(ROD, length=0.06), friction=xr.DataArray([0.0, 0.9], dims="mu"))
    peaks = ls.peaks(replace(SCENE, mechanism=short))
    assert peaks.status.values.tolist() == [0, 3]
    assert np.isinf(peaks.F14_peak.values).tolist() == [False, True]
    assert ls.peaks(replace(SCENE, mechanism=short), theta2=720).status.values.tolist() == [0, 1]


def test_check_knows_which_link_wedges():
    scene = replace(SCENE, drive="coupler")
    status = ls.sweep(scene, 36_000, of=["status"]).status
    jammed = np.flatnonzero(np.diff((status.values >= 3).astype(int)))
    np.testing.assert_allclose(np.sort(ls.check(scene).jam_angle.values), status.theta2.values[jammed], atol=0.011)


# --------------------------------------------------------------------------------------------- linkages


def test_the_ram_of_a_moved_cylinder_may_turn_round_with_it():
    angle = np.arange(0.0, 360.0, 5.0)
    length = xr.DataArray(0.3 + 0.02 * np.cos(np.radians(angle)), {"theta2": angle}, "theta2")
    machine = ls.Linkage(
        "crank A-B, coupler B-C, rocker D-C-E, cylinder E~F, ram F on guide",
        ground={"A": (0.0, 0.0), "D": (0.2, 0.0)},
        points={"E": (0.2, 10.0)},
        guides={"guide": ls.Guide(through=(0.3, 0.0), friction=0.1)},
        **{role: ls.Link(x, 1.0, 1e-3) for role, x in (("crank", 0.05), ("coupler", 0.2), ("rocker", 0.15))},
        cylinder=ls.Cylinder(length=length),
        ram=ls.Slider(1.0),
    )
    scene = ls.Scene(machine, 5.0, gravity=(0.0, -9.81))
    largest = ls.sweep(scene, 7200, of=["F12"]).F12.max()
    assert 0.0 <= ls.peaks(scene, of=["F12"]).F12_peak / largest - 1.0 < 1e-6


def test_a_yoke_with_much_friction_has_its_peaks_beside_one_in_a_toggle():
    slot, slope = xr.DataArray([0.0, 90.0], dims="design"), ls.Guide(angle=10.0, friction=1.0)
    machine = ls.Linkage(
        "crank A-B, yoke on guide past B",
        ground={"A": (0.0, 0.0)},
        guides={"guide": slope},
        crank=ls.Bar(0.08, width=0.02, thickness=0.02, density=7750.0),
        yoke=ls.Slider(2.0, slot_angle=slot, slot_friction=1.0),
    )
    scene = ls.Scene(machine, 5.0, gravity=(0.0, -9.81))
    off_reversals = np.arange(0.0, 360.0, 0.05) + 1e-6
    peaks, largest = ls.peaks(scene, of=["F12"]), ls.sweep(scene, off_reversals, of=["F12"]).F12.max("theta2")
    assert peaks.status.values.tolist() == [2, 0]
    assert 0.0 <= (peaks.F12_peak / largest - 1.0)[1] < 1e-6


# ---------------------------------------------------------------------------------------------- the angle's side


def step(first, last):
    """Return a push that begins at one angle and ends at another [N]."""
    return xr.DataArray([-2000.0, 0.0], {"theta2": [first, last]}, "theta2").sortby("theta2")


def pushed(push, *others, **words):
    load = ls.Load("coupler", force=(0.0, push), at=(0.1, 0.0), **words)
    return replace(ls.example("press"), omega2=30.0, loads=[load, *others])


SPRING = ls.Spring(("ground", 0.0, 0.3), ("coupler", 0.1, 0.0), 10.0, 0.1)
JUMPING = {
    "a table": (pushed(step(30.1, 60.3), interpolation="step"), None),
    "a table, round angles": (pushed(step(30.0, 60.0), interpolation="step"), None),
    "a table and a spring": (pushed(step(30.1, 60.3), SPRING, interpolation="step"), None),
    "a table that ends at 0": (pushed(step(300.0, 0.0), SPRING, interpolation="step"), None),
    "a function": (pushed(lambda a: -2000.0 * ((a >= 53.7) & (a < 251.3)), breaks=(53.7, 251.3)), None),
    "the end of a part": (pushed(step(30.0, 60.0), interpolation="step"), (30.0, 60.0)),
    "a part of negative angles": (pushed(step(30.0, 60.0), interpolation="step"), (-345.0, -300.0)),
    "friction": (replace(ls.example("engine"), loads=()), None),
    "gas": (ls.example("engine"), None),
    "a torsion spring": (replace(pushed(0.0), loads=[ls.TorsionSpring("crank", "ground", 5.0, 256.5)]), None),
}


@pytest.mark.parametrize("name", JUMPING)
def test_a_sweep_at_the_angle_of_a_peak_has_its_value(name):
    scene, part = JUMPING[name]
    peaks = ls.peaks(scene, between=part)
    for at in (str(each) for each in peaks if str(each).endswith("_at")):
        quantity, _, end = at.removesuffix("_at").rpartition("_")
        angle = float(peaks[at])
        assert part is None or part[0] <= angle <= part[1]
        there = ls.sweep(scene, [angle], of=[quantity])[quantity].item()
        assert there == pytest.approx(float(peaks[f"{quantity}_{end}"]), rel=1e-8)


def test_a_limit_at_the_end_of_a_part_stands_there():
    scene, part = JUMPING["the end of a part"]
    peaks = ls.peaks(scene, of=["F32"], between=part)
    assert 0.0 < 60.0 - float(peaks.F32_peak_at) < 1e-8 and int(peaks.F32_peak_at_end) == 2
