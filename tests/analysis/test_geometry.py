"""geometry and coupler_curve: against the sweep's own extremes, textbook values, and finite differences."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from refusals import LOOP, refusal

import linksweep as ls
from linksweep.scene.file.writing import write_scene

PRESS, ENGINE, SHAPER = (ls.example(name) for name in ("press", "engine", "quick-return"))
LIGHT = {"mass": 0.0, "inertia": 0.0}


def four_bar(a, b, c, d, **more):
    return ls.Scene(ls.FourBar(*(ls.Link(length, **LIGHT) for length in (a, b, c)), ground=d, **more), omega2=1.0)


def slider(a, b, **more):
    return ls.Scene(ls.SliderCrank(ls.Link(a, **LIGHT), ls.Link(b, **LIGHT), slider_mass=1.0, **more), omega2=1.0)


@pytest.mark.parametrize("branch", ["open", "crossed"])
@pytest.mark.parametrize("lengths", [(0.08, 0.22, 0.18, 0.2), (0.02, 0.07, 0.05, 0.06), (0.05, 0.3, 0.31, 0.12)])
def test_the_rocker_swings_between_its_extremes(lengths, branch):
    scene = four_bar(*lengths, branch=branch, ground_angle=20.0)
    geometry, theta4 = ls.geometry(scene), ls.sweep(scene, theta2=36000, of=["theta4"]).theta4
    turned = np.unwrap(theta4, period=360.0)
    assert float(geometry.swing) == pytest.approx(np.ptp(turned), abs=1e-5)
    at = np.sort(geometry.reversal_angle.values)
    seen = np.sort([float(theta4.theta2[k]) for k in (turned.argmax(), turned.argmin())])
    np.testing.assert_allclose(at, seen, atol=0.02)
    way = at[1] - at[0]
    assert float(geometry.time_ratio) == pytest.approx(max(way, 360.0 - way) / min(way, 360.0 - way), rel=1e-12)
    standing = ls.sweep(scene, theta2=geometry.reversal_angle.values, of=["omega4"]).omega4
    np.testing.assert_allclose(standing, 0.0, atol=1e-12)


@pytest.mark.parametrize("ground_angle", [0.0, 115.0])
def test_travel_by_the_zeros_of_the_rate_equals_the_closed_form(ground_angle):
    """The rocker's angle passes 180 degrees in one of them."""
    lengths = xr.DataArray([0.16, 0.18, 0.2], dims="c")
    scene = four_bar(0.08, 0.22, lengths, 0.2, ground_angle=ground_angle)
    closed, motion = ls.geometry(scene), ls.geometry(scene, "theta4")
    np.testing.assert_allclose(motion.theta4_travel, closed.swing, rtol=1e-13)
    np.testing.assert_allclose(motion.theta4_time_ratio, closed.time_ratio, rtol=1e-10)
    ends = np.sort([motion.theta4_max_at, motion.theta4_min_at], axis=0).T
    np.testing.assert_allclose(ends, np.sort(closed.reversal_angle.transpose("c", "limit") % 360.0), rtol=1e-10)
    rod = slider(0.05, 0.15, offset=0.02, slide_angle=30.0)
    assert float(ls.geometry(rod, "x_slider").x_slider_travel) == pytest.approx(
        float(ls.geometry(rod).stroke), rel=1e-14
    )


def test_a_dwell_is_the_angle_for_which_a_position_is_near_its_end():
    """x = a cos θ2 at the pin B of a crank: within 2 % of 2a of its end for 2·acos(0.96)."""
    motion = ls.geometry(slider(0.05, 0.15), ["Bx", "theta3"], dwell=0.02)
    for end in ("max", "min"):
        assert float(motion[f"Bx_dwell_{end}"]) == pytest.approx(2.0 * np.degrees(np.arccos(0.96)), rel=1e-12)
    assert float(motion.Bx_travel) == pytest.approx(0.1, rel=1e-15)
    assert (float(motion.Bx_max_at) % 360.0, float(motion.Bx_min_at)) == pytest.approx((0.0, 180.0), abs=1e-12)


def test_a_link_that_turns_fully_has_no_travel_and_a_name_must_be_a_position():
    drag = four_bar(0.2, 0.22, 0.25, 0.08)
    assert np.isnan(ls.geometry(drag, "theta4").theta4_travel)
    assert "T12" in refusal(lambda: ls.geometry(drag, "T12"))[0]
    assert refusal(lambda: ls.geometry(drag, dwell=0.0))[0].startswith("dwell = 0")
    for whole in (1.0, 2.0):  # no position is beyond: it would rest all the time
        assert refusal(lambda dwell=whole: ls.geometry(drag, dwell=dwell))[0].startswith(f"dwell = {whole:g}: must be")


def _still_slider() -> ls.Scene:
    """Return a slider whose rod begins at the crank's own pivot."""
    parts = {"crank": ls.Link(0.08, **LIGHT), "rod": ls.Link(0.2, **LIGHT), "ram": ls.Slider(1.0)}
    place = {"ground": {"A": (0.3, 0.1)}, "guides": {"slide": ls.Guide(through=(0.3, 0.1), angle=37.0)}}
    text = "crank A-B-P, rod P-C, ram C on slide"
    return ls.Scene(ls.Linkage(text, points={"P": (0.0, 0.0)}, **place, **parts), omega2=1.0)


@pytest.mark.parametrize(
    ("scene", "name", "value"),
    [
        (_still_slider(), "x_ram", 0.2),
        (_still_slider(), "theta3", 37.0),
        (_still_slider(), "Cx", 0.2 * np.cos(np.radians(37.0))),
        (four_bar(0.08, 0.2, 0.08, 0.2, ground_angle=31.0), "theta3", 31.0),
    ],
)
def test_a_position_that_stands_still_has_no_travel_and_no_angles(scene, name, value):
    motion = ls.geometry(scene, name)
    ends = [float(motion[f"{name}_{end}"]) for end in ("max", "min")]
    assert float(motion[f"{name}_travel"]) == 0.0 and ends[0] == ends[1] == pytest.approx(value, abs=1e-13)
    words = ("max_at", "min_at", "time_ratio", "dwell_max", "dwell_min")
    assert all(np.isnan(float(motion[f"{name}_{word}"])) for word in words)


def test_a_small_travel_is_none_of_rounding():
    motion = ls.geometry(slider(1e-7, 0.15), ["x_slider"])
    assert float(motion.x_slider_travel) == pytest.approx(2e-7, rel=1e-8)
    assert float(motion.x_slider_max_at) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("name", ["x_fixed", "x_turning", "Dx"])
def test_a_position_that_grows_without_bound_has_infinite_travel(name):
    """A guide of the crank turns with it, and becomes parallel to one on the ground twice: pin D runs to infinity."""
    angles = xr.DataArray([30.0, 47.0, 61.3], dims="angle")
    guides = {"rail": ls.Guide((0.0, 0.3), 10.0), "slot": ls.Guide((0.05, 0.02), angles, of="crank")}
    parts = {"crank": ls.Link(0.1, **LIGHT), "fixed": ls.Slider(1.0), "turning": ls.Slider(1.0)}
    text = "crank A-B, fixed D on rail, turning D on slot"
    motion = ls.geometry(ls.Scene(ls.Linkage(text, ground={"A": (0.0, 0.0)}, guides=guides, **parts), 1.0), name)
    for end, value in (("travel", np.inf), ("max", np.inf), ("min", -np.inf)):
        np.testing.assert_array_equal(motion[f"{name}_{end}"], value)
    for end in ("max_at", "min_at"):
        np.testing.assert_allclose(motion[f"{name}_{end}"] % 180.0, (10.0 - angles) % 180.0, atol=1e-9)
    assert all(np.isnan(motion[f"{name}_{word}"]).all() for word in ("time_ratio", "dwell_max", "dwell_min"))


def test_a_link_that_turns_fully_has_nothing_of_its_travel():
    motion = ls.geometry(ls.example("drag-link-press"), "theta4")
    assert all(np.isnan(float(motion[name])) for name in motion if str(name).startswith("theta4"))


@pytest.mark.parametrize("lengths", [(0.1, 0.3, 0.1, 0.3), (0.1, 0.1, 0.3, 0.3), (0.3, 0.1, 0.1, 0.3)])
@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_a_rocker_that_passes_change_points_does_not_turn_round_where_closed_forms_say(lengths, branch):
    """A parallelogram's rocker never does; a kite's swings to both sides of the frame, or stands still."""
    geometry = ls.geometry(four_bar(*lengths, branch=branch))
    assert np.isnan([geometry.swing, geometry.time_ratio, *geometry.reversal_angle]).all()


def test_a_transmission_angle_that_does_not_change_has_no_place():
    motion, limits = ls.geometry(ls.example("whitworth")), ls.check(ls.example("whitworth"))
    for end in ("max", "min"):
        assert float(motion[f"transmission_angle_arm_{end}"]) == 90.0
        assert np.isnan(float(motion[f"transmission_angle_arm_{end}_at"]))
        places = limits[f"transmission_angle_{end}_at"]
        assert np.isnan(float(places.sel(pin="arm"))) and np.isfinite(float(places.sel(pin="E")))


def test_a_centric_crank_rocker_has_time_ratio_one():
    """a² + d² = b² + c² (Norton, chapter 3: a four-bar without quick return)."""
    a, b, d = 0.05, 0.12, 0.2
    geometry = ls.geometry(four_bar(a, b, np.sqrt(a**2 + d**2 - b**2), d))
    assert float(geometry.time_ratio) == pytest.approx(1.0, abs=1e-12)


def test_a_double_crank_has_no_swing():
    assert np.isnan(ls.geometry(four_bar(0.2, 0.22, 0.25, 0.08)).swing)


@pytest.mark.parametrize("branch", ["open", "crossed"])
@pytest.mark.parametrize("offset", [0.0, 0.02, -0.03])
def test_the_slider_travels_between_its_extremes(offset, branch):
    scene = slider(0.05, 0.15, offset=offset, slide_angle=30.0, branch=branch)
    geometry, x = ls.geometry(scene), ls.sweep(scene, theta2=36000, of=["x_slider"]).x_slider
    assert float(geometry.stroke) == pytest.approx(np.ptp(x.values), abs=1e-9)
    standing = ls.sweep(scene, theta2=geometry.reversal_angle.values, of=["v_slider"]).v_slider
    np.testing.assert_allclose(standing, 0.0, atol=1e-14)
    way = float(abs(geometry.reversal_angle.diff("limit")).item())
    assert float(geometry.time_ratio) == pytest.approx(max(way, 360.0 - way) / min(way, 360.0 - way), rel=1e-12)
    assert (float(geometry.time_ratio) == pytest.approx(1.0, abs=1e-12)) == (offset == 0.0)


def test_a_quick_return_has_the_time_ratio_of_check():
    geometry = ls.geometry(SHAPER)
    half = np.degrees(np.arccos(0.12 / 0.36))
    assert float(geometry.time_ratio) == pytest.approx((360.0 - 2.0 * half) / (2.0 * half), rel=1e-12)
    assert float(geometry.swing) == pytest.approx(2.0 * np.degrees(np.arcsin(0.12 / 0.36)), rel=1e-12)


def test_transmission_angles_of_the_press():
    """The transmission angle is extreme with the crank on the line of the ground pins (Norton, chapter 4)."""
    geometry = ls.geometry(PRESS)
    a, b, c, d = PRESS.mechanism.lengths().values()
    at_0, at_180 = (np.degrees(np.arccos((b * b + c * c - f * f) / (2.0 * b * c))) for f in (d - a, d + a))
    acute = [min(angle, 180.0 - angle) for angle in (at_0, at_180)]
    assert float(geometry.transmission_angle_min) == pytest.approx(min(acute), rel=1e-9)
    assert float(geometry.transmission_angle_min_at) % 180.0 == pytest.approx(0.0, abs=1e-5)
    assert float(geometry.transmission_angle_max) <= 90.0


def test_designs_and_branches_are_batched():
    several = xr.DataArray([0.15, 0.18, 0.4], {"rocker": [1, 2, 3]}, "rocker")
    scene = four_bar(0.08, 0.22, several, 0.2, branch="both")
    geometry = ls.geometry(scene)
    assert geometry.swing.dims == ("rocker",)
    assert {*geometry.reversal_angle.dims} == {"rocker", "branch", "limit"}
    assert np.isnan(geometry.swing[2])
    one = ls.geometry(four_bar(0.08, 0.22, 0.18, 0.2, branch="crossed"))
    assert float(geometry.swing[1]) == float(one.swing)
    np.testing.assert_array_equal(geometry.reversal_angle.sel(rocker=2, branch="crossed"), one.reversal_angle)


# ------------------------------------------------------------------------------------------------- curves

POINTS = [
    (PRESS, None, (0.1, 15.0)),
    (replace(PRESS, alpha2=-40.0), "rocker", (0.25, -30.0)),
    (PRESS, "crank", (0.03, 100.0)),
    (ENGINE, None, (0.06, 20.0)),
    (ENGINE, "slider", (0.02, 90.0)),
    (SHAPER, None, (0.7, 0.0)),
    (SHAPER, "block", (0.05, 45.0)),
]


@pytest.mark.parametrize(("scene", "link", "at"), POINTS)
def test_velocity_and_acceleration_by_finite_differences(scene, link, at):
    """Time derivatives from positions beside each angle: dθ2/dt = ω2 and d²θ2/dt² = α2."""
    angles, step = np.arange(5.0, 360.0, 30.0), 1e-2
    here, left, right = (ls.coupler_curve(scene, at, theta2=angles + s, link=link) for s in (0.0, -step, step))
    turn = np.radians(step)
    for axis in "xy":
        p, v, a = (here[f"{name}{axis}"].values for name in ("P", "vP", "aP"))
        before, after = left[f"P{axis}"].values, right[f"P{axis}"].values
        slope, bend = (after - before) / (2.0 * turn), (after - 2.0 * p + before) / turn**2
        np.testing.assert_allclose(v, slope * scene.omega2, atol=1e-6 * max(abs(v).max(), 1e-3))
        expected = bend * scene.omega2**2 + slope * (scene.alpha2 or 0.0)
        np.testing.assert_allclose(a, expected, atol=1e-5 * max(abs(a).max(), 1e-3))


def test_points_of_known_position():
    cycle = ls.sweep(PRESS, theta2=36, of=["Bx", "By", "Cx", "Cy", "aG3x", "aG3y"])
    pin_b, pin_c = (ls.coupler_curve(PRESS, (r, 0.0), theta2=36) for r in (0.0, 0.22))
    np.testing.assert_allclose(pin_b.Px, cycle.Bx, atol=1e-15)
    np.testing.assert_allclose(pin_c.Py, cycle.Cy, atol=1e-14)
    tip = ls.coupler_curve(PRESS, (0.18, 0.0), theta2=36, link="rocker")
    np.testing.assert_allclose(tip.Px, cycle.Cx, atol=1e-14)
    centre = ls.coupler_curve(PRESS, (0.11, 0.0), theta2=36)
    np.testing.assert_allclose(centre.aPx, cycle.aG3x, rtol=1e-10)


def test_hoekens_straight_line():
    """Hoeken's linkage (Norton, chapter 3): crank 1, ground 2, coupler and rocker 2.5; the tip, as far again beyond C,
    runs along a line to within a hundredth of the crank for nearly half a turn."""
    hoeken = four_bar(1.0, 2.5, 2.5, 2.0)
    curve = ls.coupler_curve(hoeken, (5.0, 0.0), theta2=np.arange(100.0, 261.0, 5.0))
    assert float(np.ptp(curve.Py.values)) < 0.01
    assert float(np.ptp(curve.Px.values)) > 3.0


def test_points_over_designs_and_gaps():
    distances = xr.DataArray([0.0, 0.1], dims="point")
    several = ls.coupler_curve(PRESS, (distances, 30.0), theta2=12)
    np.testing.assert_array_equal(several.Px.isel(point=1), ls.coupler_curve(PRESS, (0.1, 30.0), theta2=12).Px)
    stuck = ls.coupler_curve(four_bar(0.2, 0.12, 0.12, 0.2), (0.1, 0.0), theta2=12)
    assert (np.isnan(stuck.Px) == (stuck.status != 0)).all()
    assert np.isnan(stuck.Px).any()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ls.geometry(LOOP), "which has no links"),
        (lambda: ls.coupler_curve(LOOP, (0.1, 0.0)), "which has no links"),
        (
            lambda: ls.coupler_curve(PRESS, (0.1, 0.0), link="rod"),
            "link = 'rod': must be one of crank, coupler, rocker",
        ),
        (lambda: ls.coupler_curve(PRESS, 0.1), "at = 0.1: must be a pair"),
        (lambda: ls.coupler_curve(PRESS, (-0.1, 0.0)), "at[1] = -0.1 m: must be at least 0"),
    ],
)
def test_refusals(call, message):
    (line,) = refusal(call)
    assert message in line


def test_loads_and_speeds_are_not_evaluated(monkeypatch):
    """Geometry depends on the mechanism alone, and its Dataset keeps the whole scene."""

    def looked(*_):
        raise AssertionError("a load over the angle was looked at")

    def push(theta2):
        return np.cos(np.radians(theta2))

    length = xr.DataArray([0.20, 0.22, 0.24], {"design": [5, 6, 7]}, "design")
    press = ls.example("press")
    bare = replace(press, mechanism=replace(press.mechanism, coupler=replace(press.mechanism.coupler, length=length)))
    torque = xr.DataArray([1.0, 2.0, 3.0], {"design": [5, 6, 7]}, "design")
    loads = [ls.Load("rocker", torque=torque), ls.Load("coupler", force=(push, 0.0))]
    scene = replace(bare, omega2=lambda theta2: 20.0 + push(theta2), loads=loads)
    monkeypatch.setattr("linksweep.scene.curves.over_angle.called", looked)
    geometry = ls.geometry(scene)
    xr.testing.assert_equal(geometry.drop_vars("loads[1].torque"), ls.geometry(bare))
    assert geometry.attrs["scene"] == write_scene(scene, elsewhere=["coupler.length", "loads[1].torque"])
    assert ls.scene_at(geometry, design=6).loads[0].torque == 2.0
