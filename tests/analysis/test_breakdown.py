"""Breakdown of a pin force into the contributions of its sources, and the speed limit."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from drawn import closed_figures, line, plt, texts  # noqa: F401
from scipy.optimize import brentq

import linksweep as ls
from linksweep.analysis.pins import speed_limit

CRANK = ls.Link(0.08, 0.5, 1e-3, 0.03, 20.0)
ROD = ls.Link(0.22, 0.7, 3e-3, 0.1, -10.0)
ROCKER = ls.Link(0.18, 0.6, 2e-3, 0.08, 5.0)
FOUR_BAR = ls.FourBar(CRANK, ROD, ROCKER, ground=0.2)
SLIDER = {"slider_mass": 0.4, "slider_cg_distance": 0.05, "slider_cg_angle": 65.0}
BLOCK = {"block_mass": 0.3, "block_inertia": 1e-4, "block_cg_distance": 0.04, "block_cg_angle": -35.0}
SLIDER_CRANK = ls.SliderCrank(CRANK, ROD, **SLIDER, offset=0.02, friction=0.2)
INVERTED = ls.InvertedSliderCrank(CRANK, ROCKER, 0.2, **BLOCK, offset=0.02)
SPRING = ls.Spring(("ground", 0.3, 0.1), ("crank", 0.04, 30.0), rate=2000.0, free_length=0.1)
UPRIGHT = (0.5, -9.81)


def push(link):
    return ls.Load(link, force=(3.0, lambda theta2: -80.0 * np.cos(np.radians(theta2))), at=(0.1, 15.0), torque=-2.0)


SCENES = [
    ls.Scene(FOUR_BAR, 30.0, 70.0, UPRIGHT, [push("coupler"), SPRING]),
    ls.Scene(FOUR_BAR, -30.0, 70.0, UPRIGHT, [push("rocker")], drive="rocker"),
    ls.Scene(SLIDER_CRANK, 30.0, 70.0, UPRIGHT, [push("rod"), SPRING]),
    ls.Scene(INVERTED, 30.0, 70.0, UPRIGHT, [push("rocker"), ls.TorsionDamper("ground", "crank", 0.3)]),
    ls.Scene(INVERTED, 30.0, 70.0, UPRIGHT, [push("rocker")], drive="cylinder"),
    ls.example("engine"),
]


def test_a_crank_alone_has_a_force_that_no_angle_changes():
    """F12 = m r ω² at every angle, all of it the crank's inertia; its bar is drawn along and not bent."""
    thin = {"width": 0.02, "thickness": 0.02}
    links = ls.Bar(0.08, **thin, density=7850.0), *(ls.Bar(length, **thin, density=0.0) for length in (0.22, 0.18))
    scene = ls.Scene(ls.FourBar(*links, ground=0.2), omega2=30.0)
    shares = ls.breakdown(scene, "F12")
    force = links[0].mass * 0.04 * 30.0**2
    assert f"{force:.5g}" in str(shares.linksweep) and "100.0 %" in str(shares.linksweep)
    assert ls.plot.moment_diagram(scene, "crank").get_title(loc="right") == "crank: 0 N m"


@pytest.mark.parametrize("scene", SCENES)
def test_contributions_add_up_to_the_whole(scene):
    drive = scene.mechanism.drives[scene.drive]
    names = ["F12", "F32", "F43x", "F14", "F14y", drive, *(["T14"] if scene.mechanism == SLIDER_CRANK else [])]
    shares, whole = ls.breakdown(scene, names, theta2=72), ls.sweep(scene, 72, of=names)
    np.testing.assert_array_equal(shares.status, whole.status)
    for name in names:
        largest = abs(shares[name]).max("source")
        assert float((abs(shares[name].sum("source", skipna=False) - whole[name]) / largest).max()) < 1e-13
        np.testing.assert_array_equal(shares[name].isnull().any("source"), whole[name].isnull())
        assert shares[name].attrs["units"] == whole[name].attrs["units"]


def alone(scene, **changes):
    return ls.sweep(replace(scene, **changes), 72, of=["F32x", "F14y", "T12"])


def test_each_contribution_is_the_machine_with_that_source_alone():
    scene = SCENES[0]
    shares = ls.breakdown(scene, ["F32x", "F14y", "T12"], theta2=72)
    none = replace(CRANK, mass=0.0, inertia=0.0), replace(ROD, mass=0.0, inertia=0.0)
    rocker = ls.FourBar(*none, ROCKER, ground=0.2)
    massless = ls.FourBar(*none, replace(ROCKER, mass=0.0, inertia=0.0), ground=0.2)
    nothing = (0.0, 0.0)
    expected = {
        "rocker inertia": alone(scene, mechanism=rocker, gravity=nothing, loads=()),
        "gravity": alone(scene, omega2=0.0, alpha2=0.0, loads=()),
        "load1 (coupler)": alone(scene, mechanism=massless, gravity=nothing, loads=scene.loads[:1]),
        "load2 (ground–crank)": alone(scene, mechanism=massless, gravity=nothing, loads=scene.loads[1:]),
    }
    assert shares.source.values.tolist() == ["crank inertia", "coupler inertia", *expected]
    for source, ds in expected.items():
        for name in ("F32x", "F14y", "T12"):
            share = shares[name].sel(source=source)
            np.testing.assert_allclose(share, ds[name], rtol=1e-12, atol=1e-12 * float(abs(shares[name]).max()))


def test_the_contribution_of_friction_is_its_force_on_a_frictionless_slider():
    scene = SCENES[2]
    force = ls.sweep(scene, 72, of=["friction_force"]).friction_force
    smooth = replace(SLIDER_CRANK, friction=0.0, crank=replace(CRANK, mass=0.0, inertia=0.0), slider_mass=0.0)
    smooth = replace(smooth, rod=replace(ROD, mass=0.0, inertia=0.0))
    rubbing = ls.Scene(smooth, 30.0, loads=[ls.Load("slider", force=(force.reset_coords(drop=True), 0.0))])
    expected = ls.sweep(rubbing, 72, of=["F32x", "F32y", "T12", "F14y"])
    shares = ls.breakdown(scene, ["F32x", "F32y", "T12", "F14y"], theta2=72).sel(source="friction")
    for name in ("F32x", "F32y", "T12", "F14y"):
        np.testing.assert_allclose(shares[name], expected[name], atol=1e-11 * float(abs(expected.F32x).max()))
    assert float(abs(shares.T12).max()) > 0.1


def test_the_contribution_to_a_magnitude_is_the_component_along_the_force():
    scene = SCENES[0]
    shares = ls.breakdown(scene, ["F32", "F32x", "F32y"], theta2=36)
    whole = ls.sweep(scene, 36, of=["F32x", "F32y"])
    angle = np.arctan2(whole.F32y, whole.F32x)
    np.testing.assert_allclose(shares.F32, shares.F32x * np.cos(angle) + shares.F32y * np.sin(angle), atol=1e-11)


def test_designs_keep_their_dims_and_absent_sources_are_left_out():
    heavy = replace(FOUR_BAR, rocker=replace(ROCKER, mass=xr.DataArray([0.5, 0.6], {"m": [1, 2]}, "m")))
    scene = ls.Scene(heavy, xr.DataArray([10.0, 20.0, 30.0], dims="speed"))
    shares = ls.breakdown(scene, "T12", theta2=12)
    assert shares.T12.sizes == {"source": 3, "m": 2, "speed": 3, "theta2": 12}
    one = ls.breakdown(
        replace(scene, mechanism=replace(FOUR_BAR, rocker=replace(ROCKER, mass=0.6)), omega2=20.0), "T12", theta2=12
    )
    np.testing.assert_array_equal(shares.T12.sel(m=2).isel(speed=1).transpose("source", "theta2"), one.T12)


def test_refusals_of_breakdown():
    with pytest.raises(ValueError, match="of: nothing is named 'theta3'"):
        ls.breakdown(SCENES[0], ["theta3"])
    with pytest.raises(ValueError, match="LoopTrack, which has no pins"):
        ls.breakdown(ls.example("loop"))
    with pytest.raises(ValueError, match="scene is a FourBar: must be a Scene"):
        ls.breakdown(FOUR_BAR)


# ------------------------------------------------------------------------------------------------ speed limit

SMOOTH = [
    ls.Scene(FOUR_BAR, 30.0, 70.0, UPRIGHT, [push("coupler"), SPRING]),
    ls.Scene(replace(SLIDER_CRANK, friction=0.0), -30.0, 70.0, UPRIGHT, [push("rod")]),
    ls.Scene(INVERTED, 30.0, 70.0, UPRIGHT, [push("rocker")]),
]


@pytest.mark.parametrize("scene", SMOOTH)
def test_three_terms_give_the_force_at_every_speed(scene):
    parts = ls.speed_separation(scene, theta2=72)
    names = [name for name in scene.mechanism.unknowns("crank") if name != "T14"]
    for omega2, alpha2 in ((30.0, 70.0), (-112.0, 0.0), (0.0, -900.0)):
        ds = ls.sweep(replace(scene, omega2=omega2, alpha2=alpha2), 72, of=names)
        for name in names:
            A, B, C = (parts[f"{name}_{term}"] for term in ("per_omega2_squared", "per_alpha2", "static"))
            whole = A * omega2**2 + B * alpha2 + C
            np.testing.assert_allclose(whole, ds[name], rtol=0, atol=1e-12 * float(abs(ds[name]).max()))
    assert parts.F32x_per_omega2_squared.attrs["units"] == "N s^2/rad^2"
    assert parts.T12_per_alpha2.attrs["units"] == "N m s^2/rad"


@pytest.mark.parametrize("scene", SMOOTH)
@pytest.mark.parametrize("of", ["F32", "T12"])
def test_at_the_limit_the_exact_peak_is_the_limit_and_beyond_it_is_larger(scene, of):
    below = 2.0 * float(ls.peaks(replace(scene, omega2=0.0), of=[of])[f"{of}_peak"])
    limit = ls.speed_limit(scene, of, below=below)
    speed = float(limit.omega2_limit)
    speeds = xr.DataArray(speed * np.array([1.0, 1.0 + 1e-6, 1.1, 2.0]), dims="speed")
    peaks = ls.peaks(replace(scene, omega2=np.sign(scene.omega2) * speeds), of=[of])[f"{of}_peak"]
    np.testing.assert_allclose(peaks[0], below, rtol=1e-10)
    assert bool((peaks[1:] > below).all())
    brute = np.array(
        [*ls.peaks(replace(scene, omega2=xr.DataArray(np.linspace(0, speed, 9), dims="n")), of=[of])[f"{of}_peak"]]
    )
    assert brute.max() <= below * (1.0 + 1e-10)


def test_the_limit_is_independent_of_the_initial_grid(monkeypatch):
    fine = ls.speed_limit(SMOOTH[0], "F43", below=300.0)
    monkeypatch.setattr(speed_limit, "SAMPLES", 5)
    coarse = ls.speed_limit(SMOOTH[0], "F43", below=300.0)
    np.testing.assert_allclose(coarse.omega2_limit, fine.omega2_limit, rtol=1e-10)
    np.testing.assert_allclose(coarse.omega2_limit_at, fine.omega2_limit_at, atol=1e-4)


ENDS = 30.1, 30.4
"""Angles [degree] at which a push begins and ends, between two samples of a grid."""
PUSHED = replace(
    ls.example("press"),
    loads=[
        ls.Load(
            "coupler",
            force=(0.0, xr.DataArray([0.0, -2000.0, 0.0], {"theta2": [0.0, *ENDS]}, "theta2")),
            at=(0.1, 0.0),
            interpolation="step",
        )
    ],
)


@pytest.mark.parametrize("of", ["F32", "F43"])
def test_the_limit_holds_on_either_side_of_a_jump(of):
    """The largest force while the push acts is that of samples from its begin to just before its end."""
    angles = np.linspace(ENDS[0] + 1e-9, ENDS[1] - 1e-9, 31)

    def largest(speed):
        return float(ls.sweep(replace(PUSHED, omega2=speed), angles, of=[of])[of].max())

    below = 1.2 * largest(0.0)
    expected = brentq(lambda speed: largest(speed) - below, 1.0, 200.0)
    assert float(ls.speed_limit(PUSHED, of, below=below).omega2_limit) == pytest.approx(expected, rel=1e-8)


def test_contributions_to_a_peak_before_a_jump_add_up_to_it():
    peaks = ls.peaks(PUSHED, of=["F12", "F32", "F43"])
    for name in ("F12", "F32", "F43"):
        shares = ls.breakdown(PUSHED, name, theta2=[float(peaks[f"{name}_peak_at"])])[name]
        assert float(shares.sum()) == pytest.approx(float(peaks[f"{name}_peak"]), rel=1e-8)


def test_a_study_has_a_limit_for_each_design():
    length = xr.DataArray([0.2, 0.22, 0.25], dims="rod")
    scene = ls.Scene(replace(FOUR_BAR, coupler=replace(ROD, length=length)), 30.0, loads=[push("rocker")])
    limit = ls.speed_limit(scene, "F43", below=150.0)
    assert limit.omega2_limit.dims == ("rod",)
    for k in range(3):
        single = replace(scene, mechanism=replace(FOUR_BAR, coupler=replace(ROD, length=float(length[k]))))
        np.testing.assert_allclose(
            limit.omega2_limit[k], ls.speed_limit(single, "F43", below=150.0).omega2_limit, rtol=1e-10
        )


def test_a_design_that_closes_at_no_angle_has_no_limit_of_speed():
    scene = ls.Scene(replace(FOUR_BAR, ground=xr.DataArray([0.2, 2.0], dims="span")), 30.0, loads=[push("rocker")])
    closes = (ls.sweep(scene, of=[]).status == 0).any("theta2")
    limit = ls.speed_limit(scene, "F43", below=150.0).omega2_limit
    assert closes.values.tolist() == [True, False]
    assert np.isfinite(limit[0]) and np.isnan(limit[1])


def test_a_massless_machine_has_no_limit_and_an_overloaded_one_no_speed():
    light = [replace(link, mass=0.0, inertia=0.0) for link in (CRANK, ROD, ROCKER)]
    scene = ls.Scene(ls.FourBar(*light, ground=0.2), 30.0, loads=[push("rocker")])
    peak = float(ls.peaks(scene, of=["F43"]).F43_peak)
    assert float(ls.speed_limit(scene, "F43", below=1.001 * peak).omega2_limit) == np.inf
    assert np.isnan(float(ls.speed_limit(scene, "F43", below=0.9 * peak).omega2_limit))
    assert np.isnan(float(ls.speed_limit(SMOOTH[0], "F32", below=1.0).omega2_limit))


def test_a_mass_on_the_crank_by_hand():
    """With one mass m at r on the crank, |F12| = m r ω² and T12 = 0 at constant speed."""
    light = [replace(link, mass=0.0, inertia=0.0) for link in (ROD, ROCKER)]
    scene = ls.Scene(ls.FourBar(ls.Link(0.08, 2.0, 0.0, 0.05), *light, ground=0.2), 30.0)
    np.testing.assert_allclose(ls.speed_limit(scene, "F12", below=250.0).omega2_limit, 50.0, rtol=1e-12)


@pytest.mark.parametrize(
    ("scene", "of", "below", "message"),
    [
        (SCENES[2], "F32", 10.0, "mechanism.friction: its force does not grow"),
        (SCENES[3], "F32", 10.0, r"loads\[2\] is a damper"),
        (SMOOTH[0], "F23z", 10.0, 'did you mean "F23'),
        (SMOOTH[0], "F32", xr.DataArray([9.0, 10.0], dims="w"), "below: has 1 dims: give one number for all designs"),
        (SMOOTH[0], "F32", -1.0, "below = -1 N: must be greater than 0"),
        (replace(SMOOTH[0], mechanism=replace(FOUR_BAR, branch="both")), "F32", 1.0, 'branch = "both"'),
        (ls.example("loop"), "F32", 1.0, "has no crank"),
    ],
)
def test_refusals_of_the_limit(scene, of, below, message):
    with pytest.raises(ValueError, match=message):
        ls.speed_limit(scene, of, below=below)


def test_the_stack_of_contributions_ends_at_the_sum():
    ax = ls.plot.breakdown(ls.breakdown(SCENES[0], "T12"))
    angles, drawn = line(ax, "sum").get_data()
    shares = ls.breakdown(SCENES[0], "T12", theta2=angles[:-1])
    np.testing.assert_allclose(drawn[:-1], shares.T12.sum("source"), atol=1e-12)
    tops = dict.fromkeys((1.0, -1.0), 0.0)
    for k, area in enumerate(ax.collections):
        sign = 1.0 if k % 2 == 0 else -1.0
        edge = area.get_paths()[0].vertices[:, 1]
        tops[sign] = max(tops[sign], float(np.max(sign * edge)))
    assert tops[1.0] == pytest.approx(float(shares.T12.clip(min=0.0).sum("source").max()))
    assert tops[-1.0] == pytest.approx(float((-shares.T12).clip(min=0.0).sum("source").max()))
    assert ax.get_ylabel() == "share in $T_{12}$ [N m]"
    with pytest.raises(ValueError, match="ds has no sources"):
        ls.plot.breakdown(ls.sweep(SCENES[0], 12))


def test_the_peak_over_speed_marks_its_limit():
    speeds = np.linspace(0.0, 60.0, 13)
    ax = ls.plot.over_speed(SMOOTH[0], "F32", speeds=speeds, below=600.0)
    curve = ax.lines[0]
    np.testing.assert_array_equal(curve.get_xdata(), speeds)
    at_30 = ls.peaks(replace(SMOOTH[0], omega2=30.0), of=["F32"]).F32_peak
    np.testing.assert_allclose(curve.get_ydata()[6], at_30, rtol=1e-12)
    (limit,), (below,) = line(ax, "_limit").get_data()
    assert below == 600.0
    np.testing.assert_allclose(limit, ls.speed_limit(SMOOTH[0], "F32", below=600.0).omega2_limit)
    assert f"{limit * 30.0 / np.pi:.5g} rpm" in texts(ax)[0]
