"""Derivatives of single results: lives of bearings and time ratios against closed forms, the others by differences."""

import math
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from long import long_but
from refusals import refusal

import linksweep as ls
from linksweep.scene.parameters import free, replaced

A, B, OMEGA, MASS, CAPACITY = 0.08, 0.22, 30.0, 1.5, 5000.0
NOTHING = {"mass": 0.0, "inertia": 0.0}
BALL, ROLLER = ls.Bearing(capacity=CAPACITY), ls.Bearing(capacity=CAPACITY, kind="roller")


def slider_crank(offset: float, crank: ls.Link | None = None, **numbers) -> ls.Scene:
    machine = ls.SliderCrank(crank or ls.Link(A, **NOTHING), ls.Link(B, **NOTHING), slider_mass=0.0, offset=offset)
    return ls.Scene(machine, **({"omega2": OMEGA} | numbers))


@pytest.mark.parametrize("bearing", [BALL, ROLLER])
def test_the_life_under_a_force_that_turns_with_the_crank(bearing):
    """A crank with its centre of gravity at r from A bears F = m r ω²: L10 = (C/F)^p, L10h = L10·10⁶·2π/(3600 ω)."""
    r, p = 0.05, bearing.exponent
    scene = slider_crank(0.0, ls.Link(A, MASS, 0.01, cg_distance=r))
    paths = ["crank.mass", "crank.cg_distance", "omega2"]
    ds = ls.sensitivities(scene, of=["equivalent_load_A", "L10_A", "L10h_A"], to=paths, pins={"A": bearing})
    force = MASS * r * OMEGA**2
    life = (CAPACITY / force) ** p
    hours = life * 1e6 * 2.0 * math.pi / (3600.0 * OMEGA)
    assert [float(ds[name]) for name in ("equivalent_load_A", "L10_A", "L10h_A")] == pytest.approx([force, life, hours])
    values = np.array([MASS, r, OMEGA])
    for name, value, powers in (
        ("equivalent_load_A", force, (1.0, 1.0, 2.0)),
        ("L10_A", life, (-p, -p, -2.0 * p)),
        ("L10h_A", hours, (-p, -p, -2.0 * p - 1.0)),
    ):
        assert ds[f"{name}_derivative"].values == pytest.approx(value * np.array(powers) / values, rel=1e-9)
        assert int(ds[f"{name}_status"]) == 0
    assert (ds.L10_A.units, ds.L10h_A.units, ds.L10_A_derivative.units) == ("megarevolution", "h", "megarevolution")


def test_the_life_under_a_force_that_changes_over_the_turn():
    """A yoke of mass M on a massless crank a: F12 = M a ω² |cos θ|, of which the mean of F³ is (M a ω²)³·4/(3π)."""
    machine = ls.Linkage(
        "crank A-B, yoke on slide past B",
        ground={"A": (0, 0)},
        guides={"slide": ls.Guide()},
        crank=ls.Link(A, **NOTHING),
        yoke=ls.Slider(mass=MASS),
    )
    scene = ls.Scene(machine, omega2=OMEGA)
    ds = ls.sensitivities(scene, of=["L10_A"], to=["yoke.mass", "crank.length", "omega2"], pins={"A": BALL})
    life = (CAPACITY / (MASS * A * OMEGA**2)) ** 3 * 0.75 * math.pi
    assert float(ds.L10_A) == pytest.approx(life, rel=1e-10)
    assert ds.L10_A_derivative.values == pytest.approx([-3 * life / MASS, -3 * life / A, -6 * life / OMEGA], rel=1e-8)


@pytest.mark.parametrize("pin", "ABCD")
def test_lives_under_inertia_alone_are_powers_of_the_speed(pin):
    """Forces are as ω², and a pin turns by as much in each cycle: P ~ ω², L10 ~ ω⁻⁶, L10h ~ ω⁻⁷."""
    scene = replace(ls.example("press"), gravity=(0.0, 0.0), loads=())
    powers = {"equivalent_load": 2.0, "L10": -6.0, "L10h": -7.0}
    ds = ls.sensitivities(scene, of=[f"{name}_{pin}" for name in powers], to=["omega2"], pins={pin: BALL})
    for name, power in powers.items():
        expected = power * float(ds[f"{name}_{pin}"]) / scene.omega2
        assert float(ds[f"{name}_{pin}_derivative"].squeeze()) == pytest.approx(expected, rel=1e-9)


def test_the_life_of_a_bearing_takes_its_capacity():
    with pytest.raises(ValueError, match=r"of: L10_B takes a bearing with a capacity; give pins="):
        ls.sensitivities(ls.example("press"), of=["L10_B"])
    with pytest.raises(ValueError, match=r"pins: nothing is named 'Z'"):
        ls.sensitivities(ls.example("press"), of=["L10_B"], pins={"Z": BALL})
    with pytest.raises(ValueError, match=r"did you mean"):
        ls.sensitivities(ls.example("press"), of=["L10_Q"], pins={"B": BALL})


# ------------------------------------------------------------------------------------------------- time ratios


def ram(offset: float) -> ls.Scene:
    """Return that slider-crank as a linkage."""
    guides = {"slide": ls.Guide(through=(0.0, offset))}
    parts = {"crank": ls.Link(A, **NOTHING), "rod": ls.Link(B, **NOTHING), "ram": ls.Slider(0.0)}
    machine = ls.Linkage("crank A-B, rod B-C, ram C on slide", ground={"A": (0, 0)}, guides=guides, **parts)
    return ls.Scene(machine, omega2=OMEGA)


@pytest.mark.parametrize("offset", [0.03, -0.03])
def test_the_time_ratio_of_a_slider_crank(offset):
    """φ = π + |asin(e/(b − a)) − asin(e/(b + a))|, ρ = φ/(2π − φ)."""
    e = abs(offset)
    folded, stretched = math.asin(e / (B - A)), math.asin(e / (B + A))
    way = math.pi + folded - stretched
    steep = 2.0 * math.pi / (2.0 * math.pi - way) ** 2
    near, far = math.sqrt((B - A) ** 2 - e * e), math.sqrt((B + A) ** 2 - e * e)
    of_folded, of_stretched = e / ((B - A) * near), e / ((B + A) * far)
    to_offset = steep * (1.0 / near - 1.0 / far) * math.copysign(1.0, offset)
    expected = [steep * (of_folded + of_stretched), steep * (of_stretched - of_folded), to_offset]
    ds = ls.sensitivities(
        slider_crank(offset), of=["time_ratio"], to=["crank.length", "rod.length", "offset", "omega2"]
    )
    assert float(ds.time_ratio) == pytest.approx(way / (2.0 * math.pi - way), rel=1e-12)
    assert ds.time_ratio_derivative.values == pytest.approx([*expected, 0.0], rel=1e-9)
    paths = ["crank.length", "rod.length", "guides.slide.through[2]"]
    linkage = ls.sensitivities(ram(offset), of=["x_ram_time_ratio"], to=paths)
    assert linkage.x_ram_time_ratio_derivative.values == pytest.approx(expected, rel=1e-9)


def test_the_time_ratio_of_a_quick_return():
    """With sin α = a/d the arm's slow way takes 180 + 2α degrees of the crank."""
    d = 0.2
    crank, rocker = ls.Link(A, **NOTHING), ls.Link(0.3, **NOTHING)
    scene = ls.Scene(ls.InvertedSliderCrank(crank, rocker, ground=d, block_mass=0.0), omega2=OMEGA)
    alpha = math.asin(A / d)
    steep = 4.0 * math.pi / (math.pi - 2.0 * alpha) ** 2
    across = math.sqrt(d * d - A * A)
    ds = ls.sensitivities(scene, of=["time_ratio", "swing"], to=["crank.length", "ground"])
    assert float(ds.time_ratio) == pytest.approx((math.pi + 2.0 * alpha) / (math.pi - 2.0 * alpha), rel=1e-12)
    assert ds.time_ratio_derivative.values == pytest.approx([steep / across, -steep * A / (d * across)], rel=1e-9)
    of_swing = [math.degrees(2.0 / across), math.degrees(-2.0 * A / (d * across))]
    assert ds.swing_derivative.values == pytest.approx(of_swing, rel=1e-9)


def test_where_both_ways_take_as_long_the_ratio_has_a_corner():
    ds = ls.sensitivities(slider_crank(0.0), of=["time_ratio"], to=["offset"])
    assert float(ds.time_ratio) == 1.0 and int(ds.time_ratio_status) == 1
    assert int(ls.sensitivities(slider_crank(0.0), of=["time_ratio"], to=["rod.length"]).time_ratio_status) == 0


# ------------------------------------------------------------------------- every single result of every machine

ENGINE = replaced(ls.example("engine"), {"offset": 0.006, "friction": 0.0})
RESULTS = {
    "press": (ls.example("press"), ["swing", "time_ratio", "transmission_angle_min", "L10_B", "L10h_C"], "ground"),
    "engine": (ENGINE, ["stroke", "time_ratio", "transmission_angle_min", "L10_B", "flywheel_inertia"], "rod.length"),
    "quick return": (ls.example("quick-return"), ["swing", "time_ratio", "L10_B", "flywheel_inertia"], "crank.length"),
    "press of two dyads": (
        replaced(ls.example("knuckle-press"), {"guides.slide.friction": 0.0}),
        ["x_ram_travel", "x_ram_time_ratio", "transmission_angle_C_min", "L10_C:lower", "flywheel_inertia"],
        "upper.length",
    ),
}


@pytest.mark.parametrize("machine", long_but(RESULTS, "press"))
def test_single_results_have_the_derivatives_of_differences(machine):
    scene, names, path = RESULTS[machine]
    request = {"of": names, "to": [path], "pins": dict.fromkeys(scene.mechanism.pins, BALL)}
    ds, value = ls.sensitivities(scene, **request), free(scene)[path][0]
    step = 1e-3 * value
    moved = {k: ls.sensitivities(replaced(scene, {path: value + k * step}), **request) for k in (-2, -1, 1, 2)}
    for name in names:
        two, one = (float(moved[k][name] - moved[-k][name]) for k in (2, 1))
        assert int(ds[f"{name}_status"]) == 0, name
        assert float(ds[f"{name}_derivative"][0]) == pytest.approx((8.0 * one - two) / (12.0 * step), rel=1e-5), name


def test_tolerances_and_constraints_take_lives_and_time_ratios():
    """The time ratio is held, and the life of the bearing in B; both constraints have the gradients of differences."""
    press, pins = ls.example("press"), {"B": BALL}
    ds = ls.tolerance(press, {"ground": "js9"}, of=["L10_B", "time_ratio"], n=16, pins=pins)
    own = ls.sensitivities(press, of=["L10_B", "time_ratio"], to=["ground"], pins=pins)
    for name in ("L10_B", "time_ratio"):
        spread = (ds[f"{name}_upper"] - ds[f"{name}_lower"]) / (2.0 * math.sqrt(3.0))
        assert float(ds[f"{name}_sigma"]) == pytest.approx(abs(float(spread[0])), rel=1e-12)
        assert float(ds[f"{name}_drawn_sigma"]) == pytest.approx(float(ds[f"{name}_sigma"]), rel=0.5)
    bounds = {"L10_B": (1000.0, None), "time_ratio": (None, 1.4)}
    lightest = ls.objective(press, {"ground": (0.18, 0.22)}, minimize="F32_peak", subject_to=bounds, pins=pins)
    for name, constraint in zip(bounds, lightest.constraints, strict=True):
        assert constraint.fun(lightest.x0) == pytest.approx(float(own[name]), rel=1e-12)
        assert constraint.jac(lightest.x0) == pytest.approx(own[f"{name}_derivative"].values, rel=1e-9)


@pytest.mark.parametrize("turns", [2, 3])
def test_rises_that_come_again_in_each_turn_of_the_cycle_do_not_tie(turns):
    """A load of several turns leaves the motion as it is: turned in its plane, a machine has the same extremes."""
    push = ls.Load("coupler", force=(0.0, lambda theta2: -30.0 * np.cos(np.radians(theta2 / turns))), at=(0.1, 15.0))
    scene = replace(ls.example("press"), loads=[push])
    assert scene.mechanism.ground_angle == 0.0
    names = ["transmission_angle_min", "omega4_max", "alpha4_max"]
    ds = ls.sensitivities(scene, of=names, to=["ground_angle"])
    for name in names:
        assert int(ds[f"{name}_status"]) == 0
        assert np.abs(ds[f"{name}_derivative"].values) < 1e-13 * float(ds[name])


# ------------------------------------------------------------------------- the fluctuation of a flywheel


@pytest.mark.parametrize(
    ("fluctuation", "message"),
    [
        ("abc", 'fluctuation = "abc": must be'),
        (None, "fluctuation = None: must be a number"),
        (math.nan, "fluctuation = nan: must be finite and greater than 0"),
        (0.0, "fluctuation = 0: must be greater than 0"),
        (2.0, "fluctuation = 2.0: must be less than 2"),
        (xr.DataArray([0.01, 0.02], dims="k"), "fluctuation: has 1 dims: give one number for all designs"),
    ],
)
def test_a_fluctuation_that_is_none_is_refused_whatever_is_asked_for(fluctuation, message):
    press, may_be = ls.example("press"), {"ground": (0.19, 0.21)}
    for call in (
        lambda: ls.sensitivities(press, ["F32_peak"], to=["ground"], fluctuation=fluctuation),
        lambda: ls.tolerance(press, {"ground": "h9"}, of="F32_peak", fluctuation=fluctuation),
        lambda: ls.objective(press, may_be, minimize="F32_peak", fluctuation=fluctuation),
    ):
        (line,) = refusal(call)
        assert line.startswith(message)


def test_a_fluctuation_is_a_text_too():
    press, of = ls.example("press"), ["flywheel_inertia"]
    text, number = (ls.sensitivities(press, of, to=["ground"], fluctuation=each) for each in ("5 %", 0.05))
    assert text.identical(number)


@pytest.mark.parametrize(("thrust", "slope", "status"), [(-1.0, 0.0, 0), (0.0, np.nan, 1), (1.0, 4.0 * np.pi, 0)])
def test_a_car_without_thrust_is_as_heavy_at_both_ends_of_its_lap(thrust, slope, status):
    """At the bottom N = m v²/r + m g, of the first speed where a lap begins and 2·2π·thrust more where it ends."""
    car = ls.Scene(ls.LoopTrack(12.0, 300.0), speed=26.0, thrust=thrust, gravity=(0.0, -9.81), profile="energy")
    ds = ls.sensitivities(car, of="normal_force_peak", to=["thrust", "speed"])
    expected = [slope, 2.0 * 300.0 * 26.0 / 12.0]
    assert ds.normal_force_peak_derivative.values == pytest.approx(expected, rel=1e-9, abs=1e-9, nan_ok=True)
    assert ds.normal_force_peak_status == status


def test_the_flywheel_does_not_depend_on_alpha2():
    """It is that of the mean speed, whether another parameter is asked for or none."""
    press = ls.example("press")
    alone, beside = (ls.sensitivities(press, of="flywheel_inertia", to=to) for to in (["alpha2"], ["ground", "alpha2"]))
    assert alone.flywheel_inertia_derivative.values.tolist() == [0.0] and alone.flywheel_inertia_status == 0
    assert beside.flywheel_inertia_derivative.sel(parameter="alpha2") == 0.0


def test_the_mean_speed_of_a_car_has_the_derivative_of_its_time():
    """The mean of the speed is the lap over its time, whatever the speed in it."""
    car = replace(ls.example("loop"), profile="energy", thrust=3000.0)
    ds = ls.sensitivities(car, of=["speed_mean", "speed_rms"], to=["speed", "thrust"])
    angles = np.radians((np.arange(4096) + 0.5) * 360.0 / 4096)
    radius, mass = car.mechanism.radius, car.mechanism.mass

    def speed_mean(speed, thrust):
        work = thrust * radius * angles / mass - 9.81 * radius * (1.0 - np.cos(angles))
        return 1.0 / np.mean(1.0 / np.sqrt(speed**2 + 2.0 * work))

    assert float(ds.speed_mean) == pytest.approx(speed_mean(car.speed, 3000.0), rel=1e-6)
    of_speed = (speed_mean(car.speed + 0.01, 3000.0) - speed_mean(car.speed - 0.01, 3000.0)) / 0.02
    of_thrust = (speed_mean(car.speed, 3001.0) - speed_mean(car.speed, 2999.0)) / 2.0
    assert ds.speed_mean_derivative.values == pytest.approx([of_speed, of_thrust], rel=1e-5)
    assert int(ds.speed_mean_status) == 0
