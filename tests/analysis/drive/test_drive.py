"""Drive: work, power, reduced inertia, mechanical advantage, flywheel, motor."""

from dataclasses import replace

import numpy as np
import oracle
import pytest
import references
import xarray as xr
from drawn import closed_figures, line, plt, texts  # noqa: F401
from references import mp
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

import linksweep as ls

CRANK = ls.Link(0.08, 0.5, 1e-3, 0.03, 20.0)
ROD = ls.Link(0.22, 0.7, 3e-3, 0.1, -10.0)
ROCKER = ls.Link(0.18, 0.6, 2e-3, 0.08, 5.0)
LIGHT = tuple(replace(link, mass=0.0, inertia=0.0) for link in (CRANK, ROD, ROCKER))
FOUR_BAR = ls.FourBar(CRANK, ROD, ROCKER, ground=0.2)
SLIDER_CRANK = ls.SliderCrank(CRANK, ROD, slider_mass=0.4, offset=0.02, slide_angle=15.0)
INVERTED = ls.InvertedSliderCrank(CRANK, ROCKER, 0.2, block_mass=0.3, block_inertia=1e-4, offset=0.02)
MACHINES = pytest.mark.parametrize("mechanism", [FOUR_BAR, SLIDER_CRANK, INVERTED])
SPRING = ls.Spring(("ground", 0.3, 0.1), ("crank", 0.04, 30.0), rate=2000.0, free_length=0.1)

# ------------------------------------------------------------------------------------------------ duty


@MACHINES
def test_inertia_does_no_work_in_a_cycle(mechanism):
    duty = ls.duty(ls.Scene(mechanism, 30.0))
    assert abs(float(duty.effort_mean)) < 1e-10 * float(duty.effort_peak)
    assert abs(float(duty.work)) < 1e-10 * float(duty.work_fed)


@MACHINES
def test_weights_and_springs_do_no_work_in_a_cycle(mechanism):
    duty = ls.duty(ls.Scene(mechanism, -30.0, gravity=(1.0, -9.81), loads=[SPRING]))
    assert abs(float(duty.work)) < 1e-10 * float(duty.work_fed)
    np.testing.assert_allclose(duty.work_fed, duty.work_regenerated, rtol=1e-9)


def test_energy_balance_with_friction():
    duty = ls.duty(ls.example("engine"))
    terms = [float(duty[name]) for name in ("work", "work_of_loads", "work_of_friction")]
    assert abs(sum(terms)) < 1e-10 * max(map(abs, terms))
    assert terms[2] < 0.0 < terms[1]
    assert float(duty.work_fed - duty.work_regenerated) == pytest.approx(terms[0], rel=1e-10)


def test_a_constant_torque_on_the_crank_by_hand():
    scene = ls.Scene(FOUR_BAR, -20.0, loads=[ls.Load("crank", torque=3.0)])
    duty = ls.duty(scene)
    np.testing.assert_allclose(duty.effort_mean, -3.0, rtol=1e-10)
    np.testing.assert_allclose(duty.work, 3.0 * 2.0 * np.pi, rtol=1e-10)  # the crank turns against it
    np.testing.assert_allclose(duty.power_mean, 60.0, rtol=1e-10)
    np.testing.assert_allclose(duty.work_of_loads, -3.0 * 2.0 * np.pi, rtol=1e-10)


def test_duty_against_a_fine_grid():
    scene = ls.Scene(FOUR_BAR, 30.0, gravity=(0.0, -9.81), loads=[ls.Load("rocker", torque=-5.0)])
    duty, cycle = ls.duty(scene), ls.sweep(scene, 7200, of=["T12", "power"])
    np.testing.assert_allclose(duty.effort_rms, np.sqrt((cycle.T12**2).mean()), rtol=1e-9)
    np.testing.assert_allclose(duty.work_fed, cycle.power.clip(min=0.0).mean() * 2.0 * np.pi / 30.0, rtol=1e-6)
    np.testing.assert_allclose(duty.power_min, cycle.power.min(), rtol=1e-6)


def test_designs_and_broken_cycles():
    rocker = replace(ROCKER, length=xr.DataArray([0.18, 0.10], dims="rocker"))
    scene = ls.Scene(replace(FOUR_BAR, rocker=rocker), 30.0, loads=[ls.Load("crank", torque=-3.0)])
    duty = ls.duty(scene)
    assert duty.status.values.tolist()[0] == 0
    assert duty.status.values.tolist()[1] != 0
    assert np.isfinite(duty.work).values.tolist() == [True, False]


@pytest.mark.parametrize(
    ("scene", "message"),
    [
        (ls.Scene(FOUR_BAR, 0.0), "omega2 = 0 rad/s: must turn"),
        (ls.Scene(FOUR_BAR, lambda theta2: 30.0 * np.cos(np.radians(theta2))), "omega2: changes its sign over theta2"),
        (ls.Scene(FOUR_BAR, 30.0, -40.0), "alpha2: a constant omega2 has none over a cycle; leave it out"),
        (ls.example("loop"), "which has no crank"),
    ],
)
def test_a_cycle_needs_a_crank_that_turns_fully(scene, message):
    with pytest.raises(ValueError, match=message):
        ls.duty(scene)


# ------------------------------------------------------------------------------------------ reduced inertia


@MACHINES
def test_the_power_of_inertia_is_the_rate_of_the_reduced_kinetic_energy(mechanism):
    names = ["reduced_inertia", "reduced_inertia_slope", "kinetic_energy", "inertia_power"]
    ds = ls.sweep(ls.Scene(mechanism, 30.0, 70.0), of=names)
    J, slope = ds.reduced_inertia, ds.reduced_inertia_slope
    np.testing.assert_allclose(ds.kinetic_energy, 0.5 * J * 900.0, rtol=1e-14)
    power = 0.5 * slope * 30.0**3 + J * 30.0 * 70.0
    np.testing.assert_allclose(-ds.inertia_power, power, rtol=0, atol=1e-13 * float(abs(power).max()))
    angles = np.radians(np.append(ds.theta2.values, 360.0))
    spline = CubicSpline(angles, np.append(J.values, J.values[0]), bc_type="periodic")
    np.testing.assert_allclose(slope, spline(angles[:-1], 1), atol=1e-6 * float(abs(slope).max()))


@pytest.mark.parametrize("theta2", [20.0, 145.0, 290.0])
def test_the_reduced_inertia_of_a_four_bar_in_60_digits(theta2):
    links = [references.LinkData(x.length, x.mass, x.inertia, x.cg_distance, x.cg_angle) for x in (CRANK, ROD, ROCKER)]
    data = oracle.FourBarData(*links, ground=0.2)

    def centre(k, link, angle):
        corners = oracle.close_loop(data, angle)
        first, second = corners["ABD"[k]], corners["BCC"[k]]
        return first + link.cg_distance * (second - first) / link.length * references.turn(link.cg_angle)

    def line_of_pins(k, angle):
        corners = oracle.close_loop(data, angle)
        return corners["BCC"[k]] - corners["ABD"[k]]

    def J(angle):
        total = mp.mpf(0)
        for k, link in enumerate(links):
            velocity = mp.diff(lambda at, k=k, link=link: centre(k, link, at), angle) * 180 / mp.pi
            turning = mp.diff(lambda at, k=k: mp.log(line_of_pins(k, at)), angle).imag * 180 / mp.pi
            total += mp.mpf(link.mass) * abs(velocity) ** 2 + mp.mpf(link.inertia) * turning**2
        return total

    names = ["reduced_inertia", "reduced_inertia_slope"]
    ds = ls.sweep(ls.Scene(FOUR_BAR, 0.0), [theta2], of=names).isel(theta2=0)
    step = mp.mpf("1e-6")
    slope = (J(theta2 + step) - J(theta2 - step)) / (2 * step) * 180 / mp.pi
    np.testing.assert_allclose(ds.reduced_inertia, float(J(mp.mpf(theta2))), rtol=1e-13)
    np.testing.assert_allclose(ds.reduced_inertia_slope, float(slope), rtol=1e-9)


# -------------------------------------------------------------------------------------- mechanical advantage


@pytest.mark.parametrize(
    "mechanism", [ls.FourBar(*LIGHT, ground=0.2), ls.InvertedSliderCrank(LIGHT[0], LIGHT[2], 0.2, 0.0)]
)
def test_mechanical_advantage_of_a_torque_on_the_rocker(mechanism):
    scene = ls.Scene(mechanism, 5.0, loads=[ls.Load("rocker", torque=-2.0)])
    ds = ls.sweep(scene, 90, of=["T12", "torque_ratio", "velocity_ratio", "omega4"])
    np.testing.assert_allclose(ds.T12 * ds.torque_ratio, 2.0, rtol=1e-12)
    np.testing.assert_allclose(ds.velocity_ratio, ds.omega4 / 5.0, rtol=1e-14)


def test_mechanical_advantage_of_a_force_on_the_rocker():
    push = ls.Load("rocker", force=(0.0, -10.0), at=(0.18, 0.0), frame="link")
    ds = ls.sweep(ls.Scene(ls.FourBar(*LIGHT, ground=0.2), 5.0, loads=[push]), 90, of=["T12", "mechanical_advantage"])
    np.testing.assert_allclose(ds.T12 / 0.08 * ds.mechanical_advantage, 10.0, rtol=1e-12)


def test_mechanical_advantage_of_a_force_on_a_slider():
    scene = ls.Scene(ls.SliderCrank(*LIGHT[:2], 0.0, offset=0.02), 5.0, loads=[ls.Load("slider", force=-10.0)])
    ds = ls.sweep(scene, np.arange(5.0, 360.0, 10.0), of=["T12", "mechanical_advantage", "velocity_ratio", "v_slider"])
    np.testing.assert_allclose(ds.T12 / 0.08 * ds.mechanical_advantage, 10.0, rtol=1e-12)
    np.testing.assert_allclose(ds.velocity_ratio, ds.v_slider / 5.0, rtol=1e-14)


def test_the_reduced_torque_is_the_drives_power_per_crank_speed():
    for drive in ("crank", "coupler", "rocker"):
        scene = ls.Scene(FOUR_BAR, -30.0, 70.0, (1.0, -9.81), [ls.Load("coupler", torque=3.0)], drive)
        ds = ls.sweep(scene, 91, of=["reduced_torque", "power", "power_fed", "power_regenerated"])
        np.testing.assert_allclose(ds.reduced_torque * -30.0, ds.power, rtol=1e-9)
        np.testing.assert_array_equal(ds.power_fed - ds.power_regenerated, ds.power)
        assert float(ds.power_fed.min()) == float(ds.power_regenerated.min()) == 0.0


# ------------------------------------------------------------------------------------------------ flywheel


def test_a_torque_of_second_order_on_a_crank_without_mass_by_hand():
    """For T = 4 + 6 sin 2θ the energy varies by 6 J, J = 6/(δ ω²) (R. L. Norton, Dynamic Force Analysis)."""
    load = ls.Load("crank", torque=lambda theta2: -4.0 - 6.0 * np.sin(np.radians(2.0 * theta2)))
    wheel = ls.flywheel(ls.Scene(ls.FourBar(*LIGHT, ground=0.2), 20.0, loads=[load]), fluctuation=0.03)
    np.testing.assert_allclose(wheel.flywheel_inertia, 6.0 / (0.03 * 400.0), rtol=1e-7)
    np.testing.assert_allclose(wheel.drive_torque, 4.0, rtol=1e-9)
    np.testing.assert_allclose(wheel.energy_fluctuation, 6.0, rtol=1e-7)
    assert wheel.flywheel_inertia.attrs["units"] == "kg m^2"


@MACHINES
@pytest.mark.parametrize("omega2", [30.0, -30.0])
def test_the_speed_solves_the_equation_of_motion(mechanism, omega2):
    scene = ls.Scene(mechanism, omega2, gravity=(1.0, -9.81), loads=[ls.Load("crank", torque=-2.0), SPRING])
    wheel = ls.flywheel(scene, inertia=0.05)
    speed = np.append(wheel.speed.values, wheel.speed.values[0])
    np.testing.assert_allclose(0.5 * (wheel.speed_max + wheel.speed_min), omega2, rtol=1e-12)
    np.testing.assert_allclose([speed.max(), speed.min()], [wheel.speed_max, wheel.speed_min], rtol=1e-5)

    angles = np.append(wheel.theta2.values, 360.0)
    static = ls.sweep(replace(scene, omega2=0.0, alpha2=0.0), of=["T12", "reduced_inertia", "reduced_inertia_slope"])
    T, J, slope = (CubicSpline(angles, np.append(row, row[0]), bc_type="periodic") for row in
                   (static.T12.values, static.reduced_inertia.values, static.reduced_inertia_slope.values))  # fmt: skip
    drive = float(wheel.drive_torque)

    def motion(angle, square):  # (J_f + J) dω²/dθ/2 + J' ω²/2 = T_d − T
        degrees = np.degrees(angle)
        return 2.0 * (drive - T(degrees) - 0.5 * slope(degrees) * square) / (0.05 + J(degrees))

    solved = solve_ivp(motion, (0.0, 2.0 * np.pi), speed[:1] ** 2, t_eval=np.radians(angles), rtol=1e-10, atol=1e-8)
    np.testing.assert_allclose(solved.y[0], speed**2, rtol=1e-7)


@pytest.mark.parametrize("scene", [ls.example("press"), ls.example("quick-return"), ls.Scene(SLIDER_CRANK, -30.0)])
def test_the_flywheel_gives_the_requested_fluctuation(scene):
    wheel = ls.flywheel(scene, fluctuation=0.02)
    again = ls.flywheel(scene, inertia=float(wheel.flywheel_inertia))
    if float(wheel.flywheel_inertia) > 0.0:
        np.testing.assert_allclose(wheel.fluctuation, 0.02, rtol=1e-10)
    np.testing.assert_allclose(again.speed, wheel.speed, rtol=1e-12)
    assert float(again.fluctuation) <= 0.02 * (1.0 + 1e-10)


def test_a_constant_torque_needs_no_flywheel():
    wheel = ls.flywheel(
        ls.Scene(ls.FourBar(*LIGHT, ground=0.2), 20.0, loads=[ls.Load("crank", torque=-4.0)]), fluctuation=0.01
    )
    np.testing.assert_allclose([wheel.drive_torque, wheel.flywheel_inertia], [4.0, 0.0], atol=1e-12)


def test_a_large_flywheel_follows_from_the_energy_at_constant_speed():
    wheel = ls.flywheel(ls.example("press"), fluctuation=1e-6)
    estimate = wheel.energy_fluctuation / (1e-6 * ls.example("press").omega2 ** 2)
    np.testing.assert_allclose(wheel.flywheel_inertia, estimate, rtol=1e-3)


def test_a_machine_without_need_has_no_flywheel_and_a_stalling_one_no_speed():
    heavy = ls.FourBar(ls.Disk(0.08, 0.5, 0.1, 7800), ROD, ROCKER, ground=0.2)
    assert float(ls.flywheel(ls.Scene(heavy, 30.0), fluctuation=0.1).flywheel_inertia) == 0.0
    pull = ls.Load("rocker", torque=lambda theta2: -200.0 * np.cos(np.radians(theta2)))
    stalls = ls.flywheel(ls.Scene(FOUR_BAR, 5.0, loads=[pull]), inertia=0.0)
    assert np.isnan(stalls.speed).all()
    assert np.isnan(stalls.fluctuation)


def test_designs_fluctuations_and_broken_cycles():
    rocker = replace(ROCKER, length=xr.DataArray([0.18, 0.10], dims="rocker"))
    expected = xr.DataArray([0.01, 0.05], dims="aim")
    wheel = ls.flywheel(ls.Scene(replace(FOUR_BAR, rocker=rocker), 10.0, loads=[SPRING]), fluctuation=expected)
    assert wheel.flywheel_inertia.sizes == {"rocker": 2, "aim": 2}
    assert np.isfinite(wheel.flywheel_inertia.isel(rocker=0)).all()
    assert np.isnan(wheel.flywheel_inertia.isel(rocker=1)).all()
    single = ls.flywheel(ls.Scene(FOUR_BAR, 10.0, loads=[SPRING]), fluctuation=0.05)
    np.testing.assert_allclose(wheel.flywheel_inertia.isel(rocker=0, aim=1), single.flywheel_inertia, rtol=1e-12)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({}, "give either fluctuation"),
        ({"fluctuation": 0.1, "inertia": 1.0}, "give either fluctuation"),
        ({"fluctuation": 0.0}, "fluctuation = 0: must be greater than 0"),
        ({"fluctuation": 2.0}, "fluctuation = 2.0: must be less than 2"),
        ({"inertia": -1.0}, r"inertia = -1 kg m\^2: must be at least 0"),
    ],
)
def test_refusals_of_flywheel(words, message):
    with pytest.raises(ValueError, match=message):
        ls.flywheel(ls.Scene(FOUR_BAR, 30.0), **words)


@pytest.mark.parametrize(
    "alpha2", [-40.0, xr.DataArray([0.0, 5.0], dims="case"), lambda theta2: np.sin(np.radians(theta2))]
)
def test_a_crank_with_alpha2_beside_a_constant_speed_runs_through_no_cycle(alpha2):
    with pytest.raises(ValueError, match="alpha2: a constant omega2 has none over a cycle"):
        ls.flywheel(ls.Scene(FOUR_BAR, 30.0, alpha2), fluctuation=0.02)


# --------------------------------------------------------------------------------------------------- motor

DC = ls.Motor(speeds=(0.0, 400.0), torques=(2.0, 0.0), inertia=1e-4)


def test_a_motors_curve():
    assert DC.torque_at(100.0) == DC.torque_at(-100.0) == 1.5
    assert DC.torque_at(500.0) == 0.0
    np.testing.assert_array_equal(DC.torque_at(np.array([0.0, 200.0])), [2.0, 1.0])


@pytest.mark.parametrize(("torque", "needed"), [(-4.0, 4.0 / (10.0 * 0.8)), (4.0, -4.0 * 0.8 / 10.0)])
def test_a_gear_with_losses_by_hand(torque, needed):
    """4 N m at 10:1 and 80 % need 0.5 N m to drive and 0.32 N m to brake, plus the rotor's J·i·α = 0.05 N m."""
    scene = ls.Scene(ls.FourBar(*LIGHT, ground=0.2), 20.0, 50.0, loads=[ls.Load("crank", torque=torque)])
    motor = ls.motor_load(scene, DC, ratio=10.0, efficiency=0.8, theta2=8)
    np.testing.assert_allclose(motor.motor_torque, needed + 1e-4 * 10.0 * 50.0, rtol=1e-12)
    np.testing.assert_allclose(motor.motor_speed, 200.0)
    np.testing.assert_allclose(motor.available_torque, 1.0)
    np.testing.assert_allclose(motor.torque_margin, 1.0 - np.abs(motor.motor_torque))
    np.testing.assert_allclose(motor.motor_torque_rms, np.abs(needed + 0.05), rtol=1e-12)
    np.testing.assert_allclose(motor.reflected_inertia, 1e-4 * 100.0)


@pytest.mark.parametrize(
    ("theta2", "margin", "at"),
    [
        (7, -0.25, (45.0, 225.0)),
        (np.linspace(-60.0, 30.0, 5), 1.0 - (4.0 + 3.0 * np.sqrt(3.0)) / 8.0, (30.0,)),
        ([100.0], 1.0 - (4.0 - 6.0 * np.sin(np.radians(20.0))) / 8.0, (100.0,)),
    ],
)
def test_the_least_margin_is_that_between_the_samples(theta2, margin, at):
    """4 + 6 sin 2θ through 10:1 and 80 % is an eighth of it; the motor gives 1 N m at 200 rad/s."""
    load = ls.Load("crank", torque=lambda angle: -4.0 - 6.0 * np.sin(np.radians(2.0 * angle)))
    scene = ls.Scene(ls.FourBar(*LIGHT, ground=0.2), 20.0, loads=[load])
    motor = ls.motor_load(scene, DC, ratio=10.0, efficiency=0.8, theta2=theta2)
    np.testing.assert_allclose(motor.torque_margin_min, margin, rtol=1e-10)
    assert np.min(np.abs(motor.torque_margin_min_at.item() - np.array(at))) < 1e-4


def test_least_margins_of_several_designs_motors_and_gears_by_dense_samples():
    """The third frame lets the crank turn to toggles alone, at which the torque grows without bound."""
    weak = ls.DCMotor(stall_torque=xr.DataArray([3.0, 2.0], dims="motor"), no_load_speed=400.0, inertia=1e-3)
    ground = xr.DataArray([0.2, 0.205, 0.05], dims="base")
    scene = ls.Scene(replace(FOUR_BAR, ground=ground), 20.0, 300.0, gravity=(0.0, -9.81), loads=[SPRING])
    request = {"ratio": xr.DataArray([5.0, 10.0, 15.0], dims="ratio"), "efficiency": 0.9}
    result = ls.motor_load(scene, weak, theta2=36, **request)
    dense = ls.motor_load(scene, weak, theta2=14400, **request).torque_margin.min("theta2")
    least, whole = result.torque_margin_min.transpose(*dense.dims), {"base": slice(2)}
    assert np.isneginf(least.isel(base=2)).all()
    np.testing.assert_allclose(least.isel(whole), dense.isel(whole), rtol=1e-5)
    assert (least <= dense + 1e-9).all()


def test_least_margins_of_designs_whose_loads_change_over_the_angle():
    torque = xr.DataArray([[-4.0, 2.0], [-8.0, 2.0]], {"theta2": [0, 180]}, ("size", "theta2"))
    scene = ls.Scene(ls.FourBar(*LIGHT, 0.2), 20.0, loads=[ls.Load("crank", torque=torque, interpolation="step")])
    np.testing.assert_allclose(ls.motor_load(scene, DC, ratio=10.0, theta2=8).torque_margin_min, [0.6, 0.2])


def test_a_motor_on_the_rocker_has_no_least_margin_over_its_dead_centres():
    scene = ls.Scene(FOUR_BAR, 20.0, gravity=(0.0, -9.81), drive="rocker")
    assert np.isneginf(ls.motor_load(scene, DC, theta2=36).torque_margin_min)
    part = ls.motor_load(scene, DC, ratio=5.0, theta2=np.linspace(70.0, 110.0, 9))
    dense = ls.motor_load(scene, DC, ratio=5.0, theta2=np.linspace(70.0, 110.0, 40001)).torque_margin
    np.testing.assert_allclose(part.torque_margin_min, dense.min(), rtol=1e-7)
    np.testing.assert_allclose(part.torque_margin_min_at, dense.idxmin("theta2"), atol=1e-3)


def test_a_motor_on_the_rocker_with_several_ratios():
    ratio = xr.DataArray([5.0, 10.0], dims="ratio")
    scene = ls.Scene(FOUR_BAR, 20.0, drive="rocker")
    motor = ls.motor_load(scene, DC, ratio=ratio, theta2=[100.0, 200.0])
    ds = ls.sweep(scene, [100.0, 200.0], of=["T14", "omega4", "alpha4"])
    np.testing.assert_allclose(motor.motor_torque, ds.T14 / ratio + 1e-4 * ratio * ds.alpha4)
    np.testing.assert_allclose(motor.motor_speed, ratio * ds.omega4)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"speeds": (0.0, 1.0), "torques": (1.0,)}, "torques has 1 values for 2 speeds"),
        ({"speeds": (1.0, 2.0), "torques": (1.0, 1.0)}, "must grow from 0"),
        ({"speeds": (0.0, 1.0), "torques": (1.0, -1.0)}, r"torques\[2\] = -1 N m: must be at least 0"),
        ({"speeds": (0.0, 1.0), "torques": (1.0, 1.0), "inertia": -1.0}, "inertia = -1"),
    ],
)
def test_refused_curves(words, message):
    with pytest.raises(ValueError, match=message):
        ls.Motor(**words)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"ratio": 0.0}, "ratio = 0: must be greater than 0"),
        ({"efficiency": 1.5}, "efficiency = 1.5: must be greater than 0 and at most 1"),
        ({"motor": 3.0}, "motor = 3.0: must be a Motor"),
        ({"scene": ls.Scene(INVERTED, 1.0, drive="cylinder")}, 'drive = "cylinder": must be the torque on a link'),
    ],
)
def test_refusals_of_motor_load(words, message):
    with pytest.raises(ValueError, match=message):
        ls.motor_load(**{"scene": ls.Scene(FOUR_BAR, 30.0), "motor": DC} | words)


def test_the_plots_show_the_results():
    wheel = ls.flywheel(ls.example("press"), fluctuation=0.05)
    ax = ls.plot.flywheel(wheel)
    np.testing.assert_array_equal(line(ax, "_speed").get_ydata()[:-1], wheel.speed)
    for end in ("max", "min"):
        assert line(ax, f"_{end}").get_xydata().tolist() == [[wheel[f"speed_{end}_at"], wheel[f"speed_{end}"]]]
    assert f"max {float(wheel.speed_max):.5g} rad/s" in texts(ax)[0]
    part = ls.plot.flywheel(wheel.sel(theta2=slice(200, 300)))  # which has the largest speed alone
    assert [each.get_label() for each in part.lines if each.get_label() in ("_max", "_min")] == ["_max"]
    assert "fluctuation 5 %" in ax.get_title(loc="left")
    weak = ls.Motor((0.0, 600.0), (1.0, 0.2))
    load = ls.motor_load(ls.example("press"), weak, ratio=10.0)
    ax = ls.plot.motor_load(load, weak)
    assert "too much" in [text.get_text() for text in ax.get_legend().get_texts()]
    (speed,), (torque,) = line(ax, "_worst").get_data()
    worst = ls.motor_load(ls.example("press"), weak, ratio=10.0, theta2=[float(load.torque_margin_min_at)])
    np.testing.assert_allclose([speed, torque], [worst.motor_speed.item(), worst.motor_torque.item()], rtol=1e-9)
    np.testing.assert_allclose(load.torque_margin_min, worst.torque_margin_min, rtol=1e-9)
    assert f"{float(load.torque_margin_min):.4g}".replace("-", "−") in texts(ax)[0]
