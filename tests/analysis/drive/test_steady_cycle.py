"""Machines on their motor over the cycle that repeats: against scipy's DOP853 on equations written apart, closed forms,
energy, inverse dynamics fed with the motion, and what is said of machines that do not keep turning."""

from dataclasses import replace

import numpy as np
import oracle_motion
import pytest
import xarray as xr
from scipy.optimize import brentq

import linksweep as ls

CRANK, ROD, ROCKER = (0.08, 0.5, 1e-3, 0.03, 20.0), (0.22, 0.7, 3e-3, 0.1, -10.0), (0.18, 0.6, 2e-3, 0.08, 5.0)
ANGLES = np.arange(720) / 2.0
DC = ls.DCMotor(stall_torque=6.0, no_load_speed=160.0)
INDUCTION = ls.InductionMotor("1500 rpm", "15 N m", rated_torque="6 N m", rated_speed="1425 rpm", inertia=0.004)


def four_bar(torque, damping, sign=1.0):
    """Return a four-bar with a torque on its rocker and dampers, as a scene and as the reference has it."""
    links = [ls.Link(*numbers) for numbers in (CRANK, ROD, ROCKER)]
    dampers = [ls.TorsionDamper("ground", "crank", damping), ls.TorsionDamper("ground", "rocker", 0.1)]
    loads = [ls.Load("rocker", torque=torque), *dampers]
    scene = ls.Scene(ls.FourBar(*links, ground=0.2), sign * 30.0, gravity=(0.0, -9.81), loads=loads)
    bodies = [oracle_motion.Body(*numbers) for numbers in (CRANK, ROD, ROCKER)]
    return scene, oracle_motion.FourBar(*bodies, 0.2, -9.81j, torque, damping, 0.1)


@pytest.mark.parametrize(("torque", "wheel"), [(-12.0, 0.0), (-20.0, 0.05)])
def test_a_four_bar_against_lagrange_and_dop853(torque, wheel):
    """Its speed changes by 50 % and more."""
    scene, reference = four_bar(torque, 0.25)
    cycle = ls.steady_cycle(scene, DC, ratio=5.0, flywheel=wheel)
    machine = oracle_motion.OnMotor(reference, lambda speed: 6.0 * (1.0 - speed / 160.0), 5.0, wheel)
    omega = machine.steady(float(cycle.omega2[0]) + 0.1, ANGLES, cycles=5)
    assert float(cycle.fluctuation) > 0.4 and float(cycle.deviation_factor) < 1e-2
    np.testing.assert_allclose(cycle.omega2, omega, rtol=1e-10)


def test_a_slider_crank_with_friction_against_newton_euler_and_dop853():
    """The damper follows the slider, by a spring line so long that it lies along the guide."""
    heavy = (0.08, 0.5, 2e-2, 0.03, 20.0)
    machine = ls.SliderCrank(ls.Link(*heavy), ls.Link(*ROD), slider_mass=0.8, offset=0.03, friction=0.15)
    damper = ls.Damper(("ground", -1000.0, 0.03), ("slider", 0.0, 0.0), coefficient=8.0)
    scene = ls.Scene(machine, 30.0, gravity=(0.0, -9.81), loads=[ls.Load("slider", force=-60.0), damper])
    cycle = ls.steady_cycle(scene, ls.InductionMotor("1500 rpm", 12.0, breakdown_slip=0.2), ratio=5.0)
    bodies = oracle_motion.Body(*heavy), oracle_motion.Body(*ROD)
    reference = oracle_motion.SliderCrank(*bodies, 0.8, 0.03, 0.15, -60.0, 8.0, -9.81j)

    def kloss(speed):
        slip = 1.0 - speed / (50.0 * np.pi)
        return 24.0 / (slip / 0.2 + 0.2 / slip)

    dead_centres = np.degrees([np.arcsin(0.03 / 0.30), np.pi + np.arcsin(0.03 / 0.14)])
    omega = oracle_motion.OnMotor(reference, kloss, 5.0).steady(
        float(cycle.omega2[0]) + 0.1, ANGLES, cycles=2, kinks=dead_centres
    )
    assert float(cycle.fluctuation) > 0.01 and float(cycle.deviation_factor) < 1e-6
    np.testing.assert_allclose(cycle.omega2, omega, rtol=1e-10)


def test_a_gear_with_losses_against_lagrange_and_dop853():
    """Power goes to and fro in each cycle, and is lost both ways; the motor's work is what dampers and gear take."""
    scene, reference = four_bar(-12.0, 0.25)
    motor = replace(DC, inertia=2e-3)
    cycle = ls.steady_cycle(scene, motor, ratio=5.0, flywheel=0.01, efficiency=0.7)
    gear = {"ratio": 5.0, "shaft_inertia": 0.01, "rotor": 25.0 * 2e-3, "efficiency": 0.7}
    machine = oracle_motion.OnMotor(reference, lambda speed: 6.0 * (1.0 - speed / 160.0), **gear)
    omega = machine.steady(float(cycle.omega2[0]) + 0.1, ANGLES, cycles=6)
    assert float(cycle.deviation_factor) < 1e-2
    np.testing.assert_allclose(cycle.omega2, omega, rtol=1e-9)
    passed = 5.0 * cycle.motor_torque - 25.0 * 2e-3 * cycle.alpha2
    assert float(passed.min()) < -1.0 < 1.0 < float(passed.max())
    lost = (passed - np.where(passed > 0.0, 0.7 * passed, passed / 0.7)).mean() * 2.0 * np.pi
    np.testing.assert_allclose(cycle.gear_loss, lost, rtol=1e-4)  # its corners lie between the angles
    taken = -(ls.sweep(cycle.linksweep.scene, 720, of=["load_power"]).load_power / cycle.omega2).mean() * 2.0 * np.pi
    np.testing.assert_allclose(cycle.motor_work, taken + cycle.gear_loss, rtol=1e-7)


@pytest.mark.parametrize(("wheel", "efficiency"), [(0.02, 0.9), (0.2, 0.9), (0.2, 0.8)])
def test_a_motor_that_ends_within_the_cycle_against_lagrange_and_dop853(wheel, efficiency):
    """The gear alone takes power: below 140 rad/s of the motor, and beyond 160, no torque depends on the speed."""
    weight = ls.Load("rocker", torque=-12.0)
    links = [ls.Link(*numbers) for numbers in (CRANK, ROD, ROCKER)]
    scene = ls.Scene(ls.FourBar(*links, ground=0.2), 30.0, gravity=(0.0, -9.81), loads=[weight])
    motor = ls.GovernedMotor(25.0, 140.0, 160.0, inertia=2e-3)
    cycle = ls.steady_cycle(scene, motor, ratio=5.0, flywheel=wheel, efficiency=efficiency)
    bodies = [oracle_motion.Body(*numbers) for numbers in (CRANK, ROD, ROCKER)]
    machine = oracle_motion.OnMotor(
        oracle_motion.FourBar(*bodies, 0.2, -9.81j, -12.0),
        lambda speed: 25.0 * np.clip((160.0 - speed) / 20.0, 0.0, 1.0),
        5.0, wheel, rotor=25.0 * 2e-3, efficiency=efficiency,
    )  # fmt: skip
    assert cycle.status.attrs["flag_meanings"].split()[int(cycle.status)] == "ok"
    omega = machine.steady(float(cycle.omega2[0]) + 0.1, ANGLES, cycles=8)
    np.testing.assert_allclose(cycle.omega2, omega, rtol=1e-9)


def test_a_gear_takes_its_part_of_what_it_passes_on_either_way():
    """η·i·M(i·ω) = c·ω + T while the motor drives, i·M(i·ω)/η where the load drives it."""
    efficiency = xr.DataArray([1.0, 0.8], dims="gear")
    for torque, part in ((-3.0, efficiency), (40.0, 1.0 / efficiency)):
        scene = disk([ls.TorsionDamper("ground", "crank", 0.3), ls.Load("crank", torque=torque)])
        motor = replace(DC, inertia=1e-3)
        cycle = ls.steady_cycle(scene, motor, ratio=2.0, efficiency=efficiency, theta2=24)
        speed = (12.0 * part + torque) / (4.0 * 6.0 / 160.0 * part + 0.3)
        np.testing.assert_allclose(cycle.speed_mean, speed, rtol=1e-13)
        np.testing.assert_allclose(
            cycle.gear_loss, 2.0 * np.pi * abs(1.0 - part) * abs(cycle.motor_torque[:, 0]) * 2.0, rtol=1e-12
        )
        np.testing.assert_allclose(cycle.motor_work, 2.0 * np.pi * (0.3 * speed - torque) + cycle.gear_loss, rtol=1e-12)


def disk(loads):
    """Return a weightless four-bar with a disk of 0.5 kg m² on its crank."""
    weightless = [ls.Link(length, 0.0, 0.0, 0.0) for length in (0.08, 0.22, 0.18)]
    crank = replace(weightless[0], inertia=0.5)
    return ls.Scene(ls.FourBar(crank, *weightless[1:], ground=0.2), 1.0, loads=loads)


def test_a_disk_turns_where_motor_and_damper_balance():
    """M0·i·(1 − i ω/ω0) = c ω + T, and a deviation of w shrinks as exp(−(c + i² M0/ω0)·time/J), whatever i."""
    ratio, torque = xr.DataArray([1.0, 2.0, 5.0], dims="ratio"), xr.DataArray([0.0, -3.0], dims="load")
    scene = disk([ls.TorsionDamper("ground", "crank", 0.3), ls.Load("crank", torque=torque)])
    cycle = ls.steady_cycle(scene, DC, ratio=ratio, flywheel=0.2, theta2=24)
    i, steep = ratio, ratio**2 * 6.0 / 160.0
    speed = (6.0 * i + torque) / (steep + 0.3)
    np.testing.assert_allclose(cycle.omega2, (speed + 0.0 * cycle.theta2).transpose(*cycle.omega2.dims), rtol=1e-13)
    np.testing.assert_allclose(cycle.speed_mean, speed.transpose(*cycle.speed_mean.dims), rtol=1e-13)
    time = 2.0 * np.pi / speed
    # of w = ω²/2 over the angle: dR/dw = (c + i² M0/ω0)/ω
    factor = np.exp(-(steep + 0.3) * time / 0.7)
    np.testing.assert_allclose(cycle.deviation_factor, factor.transpose(*cycle.deviation_factor.dims), rtol=1e-9)
    np.testing.assert_allclose(
        cycle.motor_work, (2.0 * np.pi * (0.3 * speed - torque)).transpose(*time.dims), rtol=1e-12
    )


def test_a_large_flywheel_leaves_the_fluctuation_of_constant_torque():
    """As ls.flywheel computes it; the rest falls with the inertia."""
    press = ls.example("press")
    gaps = []
    for inertia in (3.0, 30.0):
        cycle = ls.steady_cycle(press, DC, ratio=5.0, flywheel=inertia, theta2=1440)
        mean = 0.5 * float(cycle.speed_max + cycle.speed_min)
        wheel = ls.flywheel(replace(press, omega2=mean), inertia=inertia, theta2=1440)
        gaps.append(abs(float(cycle.fluctuation / wheel.fluctuation) - 1.0))
    assert gaps[1] < 0.15 * gaps[0] < 0.15 * 1e-2


@pytest.mark.parametrize("name", ["press", "engine", "quick-return", "knuckle-press"])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_inverse_dynamics_asks_for_the_motors_torque(name, sign):
    """Through dampers, friction and gas pressure; the motor's work is what loads and friction take."""
    scene = ls.example(name)
    brake = ls.TorsionDamper("ground", "crank", 0.3)
    scene = replace(scene, omega2=sign * 30.0, alpha2=None, loads=[*scene.loads, brake])
    motor = ls.InductionMotor("1500 rpm", 60.0, breakdown_slip=0.2, inertia=0.004)
    cycle = ls.steady_cycle(scene, motor, ratio=5.0, flywheel=0.2)
    assert int(cycle.status) == 0 and sign * float(cycle.omega2.mean()) > 0.0
    moving = cycle.linksweep.scene
    fed = ls.sweep(moving, len(cycle.theta2), of=["T12", "power", "load_power", "gravity_power", "inertia_power"])
    kloss = 120.0 / (cycle.slip / 0.2 + 0.2 / cycle.slip)
    needed = sign * fed.T12 + (0.2 + 25.0 * 0.004) * sign * cycle.alpha2
    np.testing.assert_allclose(needed, 5.0 * kloss, rtol=0.0, atol=1e-10 * float(abs(fed.T12).max()))
    np.testing.assert_allclose(cycle.motor_torque, kloss, rtol=1e-12, atol=1e-10)
    duty = ls.duty(moving)
    taken = -float(duty.work_of_loads) - float(duty.get("work_of_friction", 0.0))
    assert float(cycle.motor_work) == pytest.approx(taken, rel=1e-5)  # the speed of duty is a spline
    assert abs(float(cycle.energy_residual)) < 1e-8 * abs(float(cycle.motor_work))
    assert float(cycle.motor_power_mean * cycle.cycle_time) == pytest.approx(float(cycle.motor_work), rel=1e-12)
    heat = (cycle.motor_torque * (50.0 * np.pi - cycle.motor_speed)).weighted(1.0 / cycle.motor_speed).mean()
    np.testing.assert_allclose(cycle.motor_heat_mean, heat, rtol=1e-3)


def test_peaks_have_the_fluctuation_in():
    cycle = ls.steady_cycle(ls.example("press"), INDUCTION, ratio=5.0, theta2=360)
    moving = cycle.linksweep.scene
    assert moving.changes_speed and moving.loads == ls.example("press").loads
    peak = float(ls.peaks(moving, of="F32").F32_peak)
    assert peak == pytest.approx(float(ls.sweep(moving, 360, of="F32").F32.max()), rel=1e-4)
    constant = float(ls.peaks(replace(moving, omega2=float(cycle.speed_mean), alpha2=None), of="F32").F32_peak)
    assert abs(peak / constant - 1.0) > 1e-3


def test_the_extremes_are_those_of_a_finer_cycle():
    coarse, fine = (ls.steady_cycle(ls.example("press"), DC, ratio=5.0, theta2=n) for n in (90, 1440))
    np.testing.assert_allclose(coarse.omega2, fine.omega2[::16], rtol=1e-9)
    for name in ("speed_max", "speed_min", "speed_mean", "cycle_time", "motor_torque_rms"):
        np.testing.assert_allclose(coarse[name], fine[name], rtol=1e-7)
    assert float(fine.speed_max) == pytest.approx(float(fine.omega2.max()), rel=1e-5)


def test_the_extremes_of_torque_and_power_are_those_of_the_speeds():
    """The torque of this motor falls over the speed; its power is largest at half its no-load speed, or beside it."""
    scene = ls.example("press")
    brake = ls.TorsionDamper("ground", "crank", xr.DataArray([0.0, 0.8, 2.5], dims="brake"))
    cycle = ls.steady_cycle(replace(scene, loads=[*scene.loads, brake]), DC, ratio=5.0, flywheel=0.2, theta2=90)
    slow, fast = 5.0 * cycle.speed_min, 5.0 * cycle.speed_max
    speeds = [slow, fast, np.clip(80.0, slow, fast)]
    powers = xr.concat([6.0 * (1.0 - speed / 160.0) * speed for speed in speeds], "speed")
    assert [int(each) for each in (slow < 80.0)] == [0, 1, 1] and [int(each) for each in (fast < 80.0)] == [0, 0, 1]
    np.testing.assert_allclose(cycle.motor_torque_max, 6.0 * (1.0 - slow / 160.0), rtol=1e-12)
    np.testing.assert_allclose(cycle.motor_torque_min, 6.0 * (1.0 - fast / 160.0), rtol=1e-12)
    np.testing.assert_allclose(cycle.motor_power_max, powers.max("speed"), rtol=1e-12)
    np.testing.assert_allclose(cycle.motor_power_min, powers.min("speed"), rtol=1e-12)


def test_the_largest_torque_is_at_a_corner_of_the_curve():
    press, brake = ls.example("press"), ls.TorsionDamper("ground", "crank", 0.8)
    curve = ls.Motor((0.0, 151.234567, 170.0), (4.9, 5.0, 0.0))
    cycle = ls.steady_cycle(replace(press, loads=[*press.loads, brake]), curve, ratio=5.0, flywheel=0.2, theta2=90)
    assert 5.0 * float(cycle.speed_min) < 151.234567 < 5.0 * float(cycle.speed_max)
    assert float(cycle.motor_torque_max) == pytest.approx(5.0, rel=1e-12)


def test_a_load_that_jumps_is_followed():
    """A torque on the crank that ends at 100.1°, between angles; beyond the jump w is what energy says."""
    on = 100.1

    def torque(theta2):
        return np.where(np.mod(theta2, 360.0) < on, -8.0, 0.0)

    scene = disk([ls.Load("crank", torque=torque, breaks=[0.0, on]), ls.TorsionDamper("ground", "crank", 0.1)])
    cycle = ls.steady_cycle(scene, DC, ratio=1.0, flywheel=0.0, theta2=72)
    rate, steady = (6.0 / 160.0 + 0.1) / 0.5, [(6.0 + load) / (6.0 / 160.0 + 0.1) for load in (-8.0, 0.0)]

    def turned(load, start, time):
        """Return speed and angle after a time at a constant load: ω = ω∞ + (ω0 − ω∞) exp(−r t)."""
        decay = np.exp(-rate * time)
        end = steady[load] + (start - steady[load]) * decay
        return end, steady[load] * time + (start - steady[load]) * (1.0 - decay) / rate

    def after(load, start, angle):
        time = brentq(lambda t: turned(load, start, t)[1] - angle, 0.0, 3.0 * angle / start, xtol=1e-15)
        return turned(load, start, time)[0]

    start = float(cycle.omega2[0])
    half = after(0, start, np.radians(on))
    assert after(1, half, np.radians(360.0 - on)) == pytest.approx(start, rel=1e-9)
    assert float(cycle.speed_min) == pytest.approx(half, rel=1e-9)
    assert float(cycle.energy_residual) < 1e-8


def test_the_scene_of_a_load_that_jumps_is_right_at_its_own_angles():
    """Without a flywheel the drive gives all that the motor does; beside a jump a spline through alpha2 does not."""
    torque = xr.DataArray([-8.0, 0.0], {"theta2": [0.0, 100.1]}, "theta2")
    loads = [ls.Load("crank", torque=torque, interpolation="step"), ls.TorsionDamper("ground", "crank", 0.1)]
    cycle = ls.steady_cycle(disk(loads), DC, theta2=72)
    samples = ls.sweep(cycle.linksweep.scene, cycle.theta2.values, of=["T12"])
    np.testing.assert_allclose(samples.T12, 6.0 * (1.0 - cycle.omega2 / 160.0), rtol=1e-9)
    with pytest.warns(ls.OvershootWarning, match="^alpha2: .*at its own angles alone: sweep at these"):
        ls.peaks(cycle.linksweep.scene, of=["T12"])


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_narrow_pulses_are_not_missed(sign):
    """Against a heavy flywheel the motor gives the mean of the pulses, 0.5 N m, and in a cycle their energy."""
    ends = [0.0, 200.15, 200.199, 200.201, 200.25]
    torque = xr.DataArray(np.zeros((2, 5)), {"theta2": ends}, ("width", "theta2"))
    torque[0, 1:4], torque[1, 2] = -180.0 / 0.1, -180.0 / 0.002
    scene = disk([ls.Load("crank", torque=sign * torque, interpolation="step")])
    cycle = ls.steady_cycle(replace(scene, omega2=sign), DC, flywheel=1e3, theta2=36)
    np.testing.assert_allclose(cycle.motor_work, np.radians(180.0), rtol=1e-9)
    np.testing.assert_allclose(cycle.speed_mean, 160.0 * (1.0 - 0.5 / 6.0), rtol=1e-7)
    np.testing.assert_allclose(cycle.energy_residual, 0.0, atol=1e-8)


def test_designs_are_those_one_by_one_and_blocks_change_nothing(monkeypatch):
    length = xr.DataArray([0.21, 0.22, 0.30, 0.23], {"coupler": list("abcd")}, "coupler")
    press = ls.example("press")
    machine = replace(press.mechanism, coupler=replace(press.mechanism.coupler, length=length))
    motor = replace(INDUCTION, breakdown_torque=xr.DataArray([15.0, 20.0], dims="size"))
    scene = replace(press, mechanism=machine)
    many = ls.steady_cycle(scene, motor, ratio=5.0, theta2=120)
    for name in "abcd":
        one = replace(
            press, mechanism=replace(machine, coupler=replace(machine.coupler, length=length.sel(coupler=name).item()))
        )
        alone = ls.steady_cycle(one, replace(motor, breakdown_torque=20.0), ratio=5.0, theta2=120)
        part = many.sel(coupler=name).isel(size=1)
        assert int(part.status) == int(alone.status) == (1 if name == "c" else 0)
        np.testing.assert_allclose(part.omega2, alone.omega2, rtol=1e-10)
    monkeypatch.setattr("linksweep.analysis.drive.steady_cycle.TOGETHER", 2)
    xr.testing.assert_allclose(ls.steady_cycle(scene, motor, ratio=5.0, theta2=120), many, rtol=1e-10)
    ok = many.isel(coupler=many.status.isel(size=0) == 0)
    moving = ok.linksweep.scene
    assert moving.omega2.sizes == {"coupler": 3, "size": 2, "theta2": 120}
    fed = ls.sweep(moving, 120, of="T12").T12
    np.testing.assert_allclose(fed, ok.drive_torque, rtol=0.0, atol=1e-10 * float(abs(fed).max()))


def test_designs_with_gas_and_friction_are_those_one_by_one():
    """Each has its jumps and corners elsewhere, and is solved over elements that are split where others have theirs."""
    engine = ls.example("engine")
    engine = replace(engine, loads=[*engine.loads, ls.TorsionDamper("ground", "crank", 0.2)])
    offset, motor = xr.DataArray([0.0, 0.004, 0.011], dims="offset"), ls.DCMotor(60.0, 300.0)
    machine = replace(engine.mechanism, offset=offset)
    many = ls.steady_cycle(replace(engine, mechanism=machine), motor, flywheel=0.2, theta2=240)
    for k, one in enumerate(offset.values):
        alone = replace(engine, mechanism=replace(engine.mechanism, offset=one))
        cycle = ls.steady_cycle(alone, motor, flywheel=0.2, theta2=240)
        for name in ("omega2", "motor_torque_max", "speed_mean", "deviation_factor"):
            np.testing.assert_allclose(many[name].isel(offset=k), cycle[name], rtol=2e-9)


@pytest.mark.parametrize(
    ("torque", "damping", "word"),
    [(-65.0, 0.25, "ok"), (-66.0, 0.25, "stalls"), (-12.0, 4.0, "ok"), (-90.0, 0.0, "stalls")],
)
def test_a_motor_too_weak_stalls_where_the_integrated_machine_does(torque, damping, word):
    """The reference, released at the no-load speed, comes to rest or to a cycle."""
    scene, reference = four_bar(torque, damping)
    cycle = ls.steady_cycle(scene, DC, ratio=5.0, theta2=360)
    assert cycle.status.attrs["flag_meanings"].split()[int(cycle.status)] == word
    machine = oracle_motion.OnMotor(reference, lambda speed: 6.0 * (1.0 - speed / 160.0), 5.0)
    slowest = machine.slowest(32.0, cycles=3)
    assert (slowest == 0.0) == (word == "stalls")
    if word == "ok":
        assert float(cycle.speed_min) == pytest.approx(slowest, rel=2e-3)


def test_what_machines_do_that_do_not_turn_steadily():
    """A load too heavy, one that drives, one that no speed brakes, nothing that depends on the speed, a half turn."""

    def status(scene, motor):
        cycle = ls.steady_cycle(scene, motor, theta2=36)
        word = cycle.status.attrs["flag_meanings"].split()[int(cycle.status)]
        assert np.isnan(cycle.omega2).all() == np.isnan(cycle.motor_work) == (word != "ok")
        sentence = {
            "ok": "mean speed",
            "not_whole": "the machine does not turn fully",
            "stalls": "on its motor the machine stalls",
            "runs_away": "on its motor the machine runs away",
            "not_found": "no motion was found that repeats",
        }
        assert sentence[word] in repr(cycle.linksweep)
        return word

    curve = ls.Motor((0.0, 100.0, 200.0), (1.0, 1.0, 0.0))
    brake = ls.TorsionDamper("ground", "crank", 0.01)
    heavy, driving = ls.Load("crank", torque=-20.0), ls.Load("crank", torque=3.0)
    assert status(disk([heavy]), DC) == "stalls"
    assert status(disk([driving]), DC) == "ok"  # which brakes
    assert status(disk([driving]), curve) == "runs_away"
    assert status(disk([brake]), curve) == "ok"
    assert status(disk([]), curve) == "not_found"
    press = ls.example("press")
    half = replace(press, mechanism=replace(press.mechanism, ground=0.35))
    assert status(half, INDUCTION) == "not_whole"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"motor": 3.0}, "motor = 3.0: must be a Motor, InductionMotor, DCMotor or GovernedMotor"),
        ({"motor": ls.Motor((0.0, 9.0), (4.0, 1.0))}, "motor.torques: must end with 0, at the speed at which"),
        ({"ratio": "3 m"}, 'ratio = "3 m": m is a unit of length'),
        ({"efficiency": 1.2}, "efficiency = 1.2: must be greater than 0 and at most 1"),
        ({"theta2": 0}, "theta2 = 0: must be a whole number, 1 or more"),
        ({"threads": 0}, "threads = 0: must be a whole number, 1 or more"),
        ({"scene": ls.example("excavator")}, "must be the crank, for its motor to turn it"),
    ],
)
def test_refused_steady_cycles(words, message):
    with pytest.raises(ValueError, match=message):
        ls.steady_cycle(**{"scene": ls.example("press"), "motor": INDUCTION} | words)


def test_a_table_of_the_machine_on_its_motor():
    text = repr(ls.steady_cycle(ls.example("press"), INDUCTION, ratio=5.0, theta2=72).linksweep)
    for words in ("mean speed", "rad/s", "motor torque, root mean square", "work of the motor in a cycle"):
        assert words in text
