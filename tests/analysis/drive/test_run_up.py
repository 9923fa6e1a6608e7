"""Run-up and run-down: an independent integration of Lagrange's equations, closed forms, energy, failures to start."""

from dataclasses import replace

import numpy as np
import oracle_in_time as reference
import pytest
import xarray as xr
from scipy.optimize import brentq

import linksweep as ls

CRANK, ROD, ROCKER = (0.08, 0.5, 1e-3, 0.03, 20.0), (0.22, 0.7, 3e-3, 0.1, -10.0), (0.18, 0.6, 2e-3, 0.08, 5.0)
WHEEL = 0.02
MOTOR = ls.DCMotor(stall_torque=1.5, no_load_speed=120.0, inertia=1e-3)
RATIO = 4.0
SHAFT = WHEEL + RATIO**2 * 1e-3

FOUR_BAR = ls.Scene(
    ls.FourBar(ls.Link(*CRANK), ls.Link(*ROD), ls.Link(*ROCKER), ground=0.2),
    omega2=1.0,
    gravity=(0.0, -9.81),
    loads=[
        ls.Load("rocker", torque=-2.0),
        ls.Spring(("ground", 0.3, 0.1), ("coupler", 0.04, 30.0), rate=200.0, free_length=0.1),
        ls.Damper(("ground", -0.1, 0.1), ("rocker", 0.1, -30.0), coefficient=8.0),
        ls.TorsionDamper("ground", "coupler", coefficient=0.03),
    ],
)
SLIDER_CRANK = ls.Scene(
    ls.SliderCrank(ls.Link(*CRANK), ls.Link(*ROD), slider_mass=0.4, offset=0.02, friction=0.1),
    omega2=1.0,
    gravity=(0.0, -9.81),
    loads=[ls.Damper(("ground", -0.1, 0.1), ("rod", 0.1, -30.0), coefficient=8.0)],
)
WEIGHT = {"gravity": (0.0, -9.81), "shaft_inertia": SHAFT}
BODIES = [reference.Body(*link) for link in (CRANK, ROD, ROCKER)]
OF_FOUR_BAR = reference.Machine(
    BODIES,
    ground=0.2,
    torques={2: -2.0},
    lines=[
        reference.Line((("ground", 0.3, 0.1), (1, 0.04, 30.0)), rate=200.0, free_length=0.1),
        reference.Line((("ground", -0.1, 0.1), (2, 0.1, -30.0)), damping=8.0),
    ],
    turning_dampers={1: 0.03},
    **WEIGHT,
)
OF_SLIDER_CRANK = reference.Machine(
    BODIES[:2],
    slider_mass=0.4,
    offset=0.02,
    friction=0.1,
    lines=[reference.Line((("ground", -0.1, 0.1), (1, 0.1, -30.0)), damping=8.0)],
    **WEIGHT,
)
PINS = ["F12", "F32", "F43", "F14"]
OF_BARS = replace(FOUR_BAR, mechanism=replace(FOUR_BAR.mechanism, coupler=ls.Bar(0.2, 0.02, 0.02, 7750.0)))
LIGHT = tuple(replace(link, mass=0.0, inertia=0.0) for link in (ls.Link(*ROD), ls.Link(*ROCKER)))
FLYWHEEL = ls.Scene(ls.FourBar(ls.Link(0.08, 0.0, 5e-3), *LIGHT, ground=0.2), omega2=1.0)
"""A crank of constant inertia: the other links have no mass."""


def torque(speed):
    return RATIO * 1.5 * (1.0 - RATIO * speed / 120.0)


# ------------------------------------------------------------------------------- an independent integration


@pytest.mark.parametrize(
    ("scene", "machine"), [(FOUR_BAR, OF_FOUR_BAR), (SLIDER_CRANK, OF_SLIDER_CRANK)], ids=["four-bar", "slider-crank"]
)
def test_run_up_against_lagrange(scene, machine):
    pins = PINS[: len(machine.joints())]
    run = ls.run_up(scene, MOTOR, ratio=RATIO, flywheel=WHEEL, start=10.0, until=0.85, of=pins)
    assert int(run.status) == 0
    end = float(run.duration)
    peaks_at = np.array([float(run[f"{name}_peak_time"]) for name in pins])
    beside = np.minimum(np.concatenate([peaks_at - 2e-4 * end, peaks_at + 2e-4 * end]), end)
    even = np.append(np.linspace(0.0, end, 80)[1:], beside)
    times = np.unique(np.concatenate([run.time[1:], peaks_at, even]))
    angle, speed = machine.run(torque, times, theta=np.radians(10.0))
    steps = np.searchsorted(times, run.time[1:])
    np.testing.assert_allclose(np.radians(run.angle[1:]), angle[steps], rtol=0.0, atol=1e-8)
    np.testing.assert_allclose(run.speed[1:], speed[steps], rtol=0.0, atol=1e-8 * 30.0)
    assert float(run.time[-1]) == float(run.duration)
    for k, name in enumerate(pins):
        sizes = [machine.pin_forces(angle[i], speed[i], torque(speed[i]))[k] for i in np.searchsorted(times, even)]
        (i,) = np.searchsorted(times, [peaks_at[k]])
        largest = machine.pin_forces(angle[i], speed[i], torque(speed[i]))[k]
        np.testing.assert_allclose(run[f"{name}_peak"], largest, rtol=1e-8)
        assert max(sizes) <= largest * (1.0 + 1e-9)


def test_clockwise_against_lagrange():
    scene = replace(FOUR_BAR, omega2=-1.0, loads=FOUR_BAR.loads[1:])
    machine = replace(OF_FOUR_BAR, torques={})
    run = ls.run_up(scene, MOTOR, ratio=RATIO, flywheel=WHEEL, start=200.0, until=0.6, of=["F32"])
    angle, speed = machine.run(lambda w: -torque(-w), run.time[1:], theta=np.radians(200.0))
    np.testing.assert_allclose(np.radians(run.angle[1:]), angle, rtol=0.0, atol=1e-8)
    np.testing.assert_allclose(run.speed[1:], speed, rtol=0.0, atol=1e-8 * 30.0)


def test_run_down_against_lagrange():
    scene = replace(SLIDER_CRANK, omega2=25.0)
    run = ls.run_down(scene, MOTOR, ratio=RATIO, flywheel=WHEEL, start=30.0, until=0.9, of=["F32"])
    assert int(run.status) == 0
    angle, speed = OF_SLIDER_CRANK.run(lambda w: 0.0, run.time[1:], theta=np.radians(30.0), omega=25.0)
    np.testing.assert_allclose(np.radians(run.angle[1:]), angle, rtol=0.0, atol=1e-8)
    np.testing.assert_allclose(run.speed[1:], speed, rtol=0.0, atol=1e-8 * 25.0)


def test_energy_from_the_motor_is_stored_or_lifted():
    """Without losses: work of the motor = kinetic energy + potential energy of weights + work against the torque."""
    scene = replace(FOUR_BAR, loads=[ls.Load("crank", torque=-1.0)])
    machine = replace(OF_FOUR_BAR, torques={}, lines=[], turning_dampers={})
    run = ls.run_up(scene, MOTOR, ratio=RATIO, flywheel=WHEEL, start=70.0, until=0.8, of=["F32"])
    first, last = np.radians(run.angle.values[[0, -1]])
    lifted = machine.height_energy(last) - machine.height_energy(first)
    np.testing.assert_allclose(run.motor_work, run.kinetic_energy + lifted + (last - first), rtol=1e-9)
    slip = 1.0 - RATIO * run.speed.values / 120.0
    np.testing.assert_allclose(run.motor_torque, 1.5 * slip, rtol=1e-13)


# ------------------------------------------------------------------------------------------------ closed forms


def test_a_flywheel_on_a_motor_with_a_straight_curve():
    """ω = ω0 (1 − e^(−t/τ)), τ = J ω0/M0; the winding takes ½ J ω0² (1 − e^(−2t/τ))."""
    ratio, wheel = xr.DataArray([4.0, 8.0], dims="gear"), xr.DataArray([0.0, 0.05], dims="wheel")
    run = ls.run_up(FLYWHEEL, MOTOR, ratio=ratio, flywheel=wheel, until=0.95, of=["F12"])
    inertia, speed = 5e-3 + ratio**2 * 1e-3 + wheel, 120.0 / ratio
    tau = inertia * speed / (1.5 * ratio)
    part = 0.95
    xr.testing.assert_allclose(run.duration, -tau * np.log(1.0 - part), rtol=1e-9)
    turns = (-speed * tau * np.log(1.0 - part) - speed * tau * part) / (2.0 * np.pi)
    xr.testing.assert_allclose(run.turns, turns, rtol=1e-9)
    energy = 0.5 * inertia * speed**2
    xr.testing.assert_allclose(run.motor_work, energy * part**2, rtol=1e-9)
    xr.testing.assert_allclose(run.kinetic_energy, energy * part**2, rtol=1e-12)
    xr.testing.assert_allclose(run.motor_heat, energy * (1.0 - (1.0 - part) ** 2), rtol=1e-9)
    xr.testing.assert_allclose(run.operating_speed, speed + 0.0 * wheel, rtol=1e-10)


def test_a_gear_with_losses():
    """The rotor speeds up without loss, the rest through the gear: η (i M − i² J_r dω/dt) = J dω/dt."""
    efficiency = xr.DataArray([1.0, 0.75], dims="gear")
    run = ls.run_up(FLYWHEEL, MOTOR, ratio=RATIO, flywheel=WHEEL, efficiency=efficiency, until=0.95, of=["F12"])
    rest, rotor, speed = 5e-3 + WHEEL, RATIO**2 * 1e-3, 120.0 / RATIO
    tau = (rest + efficiency * rotor) * speed / (efficiency * 1.5 * RATIO)
    xr.testing.assert_allclose(run.duration, -tau * np.log(0.05), rtol=1e-9)
    lost = (1.0 / efficiency - 1.0) * 0.5 * rest * (0.95 * speed) ** 2
    np.testing.assert_allclose(run.gear_loss, lost, rtol=1e-8)
    np.testing.assert_allclose(run.motor_work, run.kinetic_energy + run.gear_loss, rtol=1e-8)

    damped = replace(FLYWHEEL, omega2=25.0, loads=[ls.TorsionDamper("ground", "crank", coefficient=0.5)])
    stop = ls.run_down(damped, MOTOR, ratio=RATIO, flywheel=WHEEL, efficiency=efficiency, until=0.1, of=["F12"])
    xr.testing.assert_allclose(stop.duration, (rest + efficiency * rotor) / 0.5 * np.log(10.0), rtol=1e-9)
    np.testing.assert_allclose(stop.gear_loss, (1.0 - efficiency) * 0.5 * rotor * 25.0**2 * 0.99, rtol=1e-8)

    held = replace(FLYWHEEL, loads=[ls.Load("crank", torque=-2.0)])
    usual = ls.run_up(held, MOTOR, ratio=RATIO, efficiency=0.75, until=0.9, of=["F12"]).operating_speed
    np.testing.assert_allclose(usual, speed * (1.0 - 2.0 / (0.75 * 1.5 * RATIO)), rtol=1e-12)


def test_the_operating_point_by_hand():
    """A damper takes c ω: on a straight curve, M0 (1 − i ω/ω0) i = c ω; a load of constant torque besides."""
    loads = [ls.TorsionDamper("ground", "crank", coefficient=0.3), ls.Load("crank", torque=-2.0)]
    run = ls.run_up(replace(FLYWHEEL, loads=loads), MOTOR, ratio=RATIO, until=0.9, of=["F12"])
    speed = (1.5 * RATIO - 2.0) / (1.5 * RATIO**2 / 120.0 + 0.3)
    np.testing.assert_allclose(run.operating_speed, speed, rtol=1e-12)
    np.testing.assert_allclose(run.speed[-1], 0.9 * speed, rtol=1e-12)


def test_a_motor_brakes_loads_that_drive_the_machine_beyond_its_own_speed():
    """M0 (1 − i ω/ω0) i = −2 η; an induction motor brakes at the least of two slips, a measured curve not at all."""
    driven = replace(FLYWHEEL, loads=[ls.Load("crank", torque=2.0)])
    run = ls.run_up(driven, MOTOR, ratio=RATIO, efficiency=0.75, of=["F12"])
    speed = 120.0 / RATIO * (1.0 + 1.5 / (1.5 * RATIO))
    np.testing.assert_allclose([run.operating_speed, run.speed[-1]], [speed, 0.99 * speed], rtol=1e-12)
    kloss = ls.InductionMotor(30.0, 5.0, breakdown_slip=0.1)  # −5 N m at the slip −0.1: −2 at s + 0.01/s = −0.5
    np.testing.assert_allclose(ls.run_up(driven, kloss, of=["F12"]).operating_speed, 30.0 * 1.0208712152522, rtol=1e-12)
    curve = ls.run_up(driven, ls.Motor([0.0, 30.0], [5.0, 0.0]), of=["F12"])
    assert meaning(curve) == ["ok"] and np.isnan(curve.operating_speed)


def test_heat_of_an_induction_motor_is_the_energy_of_its_flywheel():
    """Whatever its curve: M (ω_s − ω) dt = J (ω_s − ω) dω."""
    motor = ls.InductionMotor(157.0, 15.0, rated_torque=6.0, rated_speed=149.0, inertia=4e-3)
    run = ls.run_up(FLYWHEEL, motor, ratio=5.0, flywheel=0.02, until=0.9, of=["F12"])
    energy = 0.5 * (5e-3 + 0.02 + 25.0 * 4e-3) * (157.0 / 5.0) ** 2
    np.testing.assert_allclose(run.motor_heat, energy * (1.0 - 0.1**2), rtol=1e-9)


def test_a_constant_torque_speeds_up_uniformly():
    motor = ls.GovernedMotor(20.0, cut_from=90.0, cut_to=100.0)
    run = ls.run_up(FLYWHEEL, motor, flywheel=0.1, until=0.8, of=["T12"])
    np.testing.assert_allclose(run.duration, 80.0 * 0.105 / 20.0, rtol=1e-10)
    np.testing.assert_allclose(run.turns, 0.5 * 80.0**2 * 0.105 / 20.0 / (2.0 * np.pi), rtol=1e-10)
    np.testing.assert_allclose(run.acceleration, 20.0 / 0.105, rtol=1e-10)
    np.testing.assert_allclose(run.T12_peak, 20.0 * 0.005 / 0.105, rtol=1e-10)  # what the flywheel leaves
    assert np.isnan(run.motor_heat)


def test_run_down_with_a_damper():
    """ω = ω0 e^(−c t/J)."""
    damped = replace(FLYWHEEL, omega2=-40.0, loads=[ls.TorsionDamper("ground", "crank", coefficient=0.5)])
    run = ls.run_down(damped, flywheel=0.1, until=0.05, of=["T12"])
    np.testing.assert_allclose(run.duration, 0.105 / 0.5 * np.log(20.0), rtol=1e-9)
    np.testing.assert_allclose(run.turns, 40.0 * 0.95 * 0.105 / 0.5 / (2.0 * np.pi), rtol=1e-9)
    np.testing.assert_allclose(run.speed, -40.0 * np.exp(-0.5 / 0.105 * run.time), rtol=1e-9)
    np.testing.assert_allclose(run.kinetic_energy, 0.5 * 0.105 * 1600.0, rtol=1e-13)


def test_run_down_to_standstill():
    """A constant torque against the crank brings it to rest uniformly."""
    braked = replace(FLYWHEEL, omega2=40.0, loads=[ls.Load("crank", torque=-15.0)])
    run = ls.run_down(braked, flywheel=0.1, until=0.0, of=["F12"])
    np.testing.assert_allclose(run.duration, 40.0 * 0.105 / 15.0, rtol=1e-9)
    np.testing.assert_allclose(run.turns, 0.5 * 1600.0 * 0.105 / 15.0 / (2.0 * np.pi), rtol=1e-9)


# ----------------------------------------------------------------------------------------------- narrow loads


def pulsed(torque, width, centre, omega2=1.0):
    """Return a crank of constant inertia against one pulse of torque in each turn."""
    angles = {"theta2": [0.0, centre - 0.5 * width, centre + 0.5 * width]}
    against = xr.DataArray([0.0, -np.sign(omega2) * torque, 0.0], angles, "theta2")
    return replace(FLYWHEEL, omega2=omega2, loads=[ls.Load("crank", torque=against, interpolation="step")])


@pytest.mark.parametrize(
    ("torque", "width", "centre", "omega2"),
    [(20.0, 5.0, 90.0, 30.0), (20.0, 5.0, 200.3, 30.0), (50.0, 2.0, 90.0, -30.0), (20000.0, 0.01, 123.4, 30.0)],
)
def test_run_down_against_pulses(torque, width, centre, omega2):
    """Each pulse takes the same energy, at a constant deceleration; between them the crank keeps its speed."""
    run = ls.run_down(pulsed(torque, width, centre, omega2), flywheel=0.1, until=0.9, of=["T12"])
    inertia, wide = 0.105, np.radians(width)
    pulses = 0.5 * inertia * omega2**2 * (1.0 - 0.9**2) / (torque * wide)
    first = centre if omega2 > 0.0 else 360.0 - centre
    np.testing.assert_allclose(
        run.turns, int(pulses) + (first - 0.5 * width + (pulses % 1.0) * width) / 360.0, rtol=1e-9
    )
    speeds = np.sqrt(omega2**2 - 2.0 * torque * wide / inertia * np.arange(int(pulses) + 1))  # between pulses
    within = (abs(omega2) - 0.9 * abs(omega2)) * inertia / torque  # of all pulses together
    free = np.radians(np.append(first, np.full(int(pulses), 360.0)) - [0.5 * width, *[width] * int(pulses)])
    np.testing.assert_allclose(run.duration, within + np.sum(free / speeds), rtol=1e-9)
    np.testing.assert_allclose(run.T12_peak, torque * 0.1 / inertia, rtol=1e-9)  # what the flywheel does not give


@pytest.mark.parametrize(("torque", "width", "centre"), [(50.0, 5.0, 90.0), (250.0, 1.0, 200.3), (25e3, 0.01, 300.0)])
def test_run_up_against_pulses(torque, width, centre):
    """dω/dt = (ω_end − ω)/τ, τ = J ω0/M0, with ω_end = ω0 (1 − T/M0): in closed form between the ends of pulses."""
    motor = ls.DCMotor(stall_torque=10.0, no_load_speed=60.0)
    run = ls.run_up(pulsed(torque, width, centre), motor, flywheel=0.1, until=0.8, of=["T12"])
    usual, tau = 60.0 * (1.0 - torque * width / 3600.0), 0.105 * 6.0
    np.testing.assert_allclose(run.operating_speed, usual, rtol=1e-10)
    time, angle, speed, against, end = 0.0, 0.0, 0.0, 0.0, centre - 0.5 * width
    while True:
        to, way = 60.0 * (1.0 - 0.1 * against), np.radians(end) - angle

        def left(t, speed=speed, to=to, way=way):
            return to * t + (speed - to) * tau * (1.0 - np.exp(-t / tau)) - way

        at_rest = tau * np.log1p(-speed / to) if to < 0.0 else 10.0
        needed = brentq(left, 0.0, at_rest, xtol=1e-15)
        after = to + (speed - to) * np.exp(-needed / tau)
        if after > 0.8 * usual:
            break
        time, angle, speed, against = time + needed, np.radians(end), after, torque - against
        end += width if against else 360.0 - width
    np.testing.assert_allclose(run.duration, time + tau * np.log((to - speed) / (to - 0.8 * usual)), rtol=1e-9)


def test_the_operating_point_of_a_press():
    """A punch of 20 J a stroke takes 20/2π N m on average, however short it is."""
    motor, light = ls.DCMotor(stall_torque=20.0, no_load_speed=30.0), replace(SLIDER_CRANK.mechanism, friction=0.0)
    scene = replace(SLIDER_CRANK, mechanism=light)
    for height in (0.012, 1e-4):
        force = xr.DataArray([-20.0 / height, 0.0], {"position": [0.0, height]}, "position")
        punch = ls.Load("slider", force=force, over="slider.to_end", while_="closing", interpolation="step")
        run = ls.run_up(replace(scene, loads=[punch]), motor, until=0.01, start=90.0, of=["T12"])
        np.testing.assert_allclose(run.operating_speed, 30.0 * (1.0 - 1.0 / (2.0 * np.pi)), rtol=1e-10)


# -------------------------------------------------------------------------------------- what comes to nothing


def meaning(run):
    words = run.status.attrs["flag_meanings"].split()
    return [words[k] for k in np.ravel(run.status)]


def test_a_weak_motor_does_not_start_or_stalls():
    """Against 3 N m and the weight of the crank, m g s cos θ; of the motors that start, one is too weak on average."""
    stall = xr.DataArray([2.0, 2.5, 8.0], dims="motor")
    motor = ls.DCMotor(stall_torque=stall, no_load_speed=120.0)
    light = replace(FLYWHEEL, mechanism=replace(FLYWHEEL.mechanism, crank=ls.Link(0.08, 2.0, 5e-3, 0.05, 0.0)))
    weighed = replace(light, gravity=(0.0, -9.81), loads=[ls.Load("crank", torque=-3.0)])
    run = ls.run_up(weighed, motor, start=180.0, until=0.5, of=["F12"])
    assert meaning(run) == ["does_not_start", "stalls", "ok"]
    assert np.isfinite(run.duration).values.tolist() == [False, False, True]
    assert float(run.speed[1].max()) > 0.0


def test_a_machine_that_does_not_turn_fully_breaks_off():
    rocking = replace(FOUR_BAR, mechanism=replace(FOUR_BAR.mechanism, ground=0.35))
    run = ls.run_up(rocking, MOTOR, ratio=RATIO, start=120.0, of=["F32"])
    assert meaning(run) == ["breaks_off"] and np.isnan(run.operating_speed)


def test_a_machine_without_inertia_at_its_dead_centre_breaks_off_there():
    """At 0 degrees the slider stands still: nothing but a rotor turns with a crank and a rod without masses."""
    inertia = xr.DataArray([0.0, 1e-3], dims="rotor")
    light = ls.SliderCrank(*(ls.Link(link[0], 0.0, 0.0) for link in (CRANK, ROD)), slider_mass=0.4)
    run = ls.run_up(ls.Scene(light, 1.0), ls.DCMotor(stall_torque=1.5, no_load_speed=20.0, inertia=inertia), of=["F32"])
    assert meaning(run) == ["breaks_off", "ok"]


def test_friction_holds_a_crank_at_rest():
    """The slider's weight presses with 3.9 N on its guide: friction of 0.1 takes about 0.03 N m of the crank."""
    light = [ls.Link(link[0], 0.0, 0.0) for link in (CRANK, ROD)]
    motor = ls.DCMotor(stall_torque=0.015, no_load_speed=20.0, inertia=1e-3)
    friction = xr.DataArray([0.0, 0.1], dims="guide")
    scene = ls.Scene(ls.SliderCrank(*light, slider_mass=0.4, friction=friction), 1.0, gravity=(0.0, -9.81))
    run = ls.run_up(scene, motor, start=90.0, until=0.1, of=["F32"])
    assert meaning(run) == ["ok", "does_not_start"]


def test_what_never_ends_is_told():
    """A curve with a gap lets the speed settle below; without losses nothing ever stops."""
    gap = ls.Motor(speeds=(0.0, 10.0, 14.0, 18.0, 100.0), torques=(50.0, 50.0, 10.0, 50.0, 0.0))
    held = replace(FLYWHEEL, loads=[ls.Load("crank", torque=-20.0)])
    run = ls.run_up(held, gap, flywheel=0.1, until=0.9, of=["F12"])
    assert meaning(run) == ["settles_below"]
    np.testing.assert_allclose(run.speed[-1], 13.0, rtol=1e-7)  # where the curve falls through 20 N m
    assert np.isnan(run.duration) and np.isnan(run.F12_peak)
    free = replace(FOUR_BAR, omega2=25.0, loads=FOUR_BAR.loads[1:2])
    assert meaning(ls.run_down(free, flywheel=0.2, of=["F32"])) == ["keeps_turning"]
    damped = replace(FOUR_BAR, omega2=25.0, loads=FOUR_BAR.loads[3:])
    assert meaning(ls.run_down(damped, flywheel=5.0, turns=2.0, of=["F32"])) == ["takes_more_turns"]


# ------------------------------------------------------------------------------------------ designs and input


def test_a_batch_is_its_designs():
    """Each design has its own steps: with others beside it, every bit of them is the same, but for the last one."""
    length = xr.DataArray([0.2, 0.22, 0.25], dims="rod", coords={"rod": [20, 22, 25]})
    start = xr.DataArray([0.0, 90.0], dims="at")
    scene = replace(FOUR_BAR, mechanism=replace(FOUR_BAR.mechanism, coupler=ls.Link(length, *ROD[1:])))
    both = ls.run_up(scene, MOTOR, ratio=RATIO, flywheel=WHEEL, start=start, until=0.5, of=["F32", "T12"])
    assert both.F32_peak.dims == ("rod", "at") and both.rod.values.tolist() == [20, 22, 25]
    one = replace(FOUR_BAR, mechanism=replace(FOUR_BAR.mechanism, coupler=ls.Link(0.25, *ROD[1:])))
    alone = ls.run_up(one, MOTOR, ratio=RATIO, flywheel=WHEEL, start=90.0, until=0.5, of=["F32", "T12"])
    steps, part = alone.sizes["step"] - 1, both.isel(rod=2, at=1)
    for name in ("time", "angle", "speed", "acceleration"):
        assert np.array_equal(part[name][:steps], alone[name][:steps]), name
        assert np.isnan(part[name][steps + 1 :]).all()
    for name in ("duration", "turns", "motor_work", "motor_heat", "F32_peak", "T12_peak", "F32_peak_at"):
        np.testing.assert_allclose(part[name], alone[name], rtol=1e-9)


def test_a_run_down_from_several_speeds_is_its_designs():
    start, wheel = (xr.DataArray(values, dims=dim) for values, dim in (([0.0, 90.0], "at"), ([0.1, 0.2, 0.3], "wheel")))
    several = ls.run_down(ls.grid(FOUR_BAR, {"omega2": [10.0, 20.0]}), start=start, flywheel=wheel, of=["F32"])
    assert dict(several.duration.sizes) == {"omega2": 2, "at": 2, "wheel": 3}
    alone = ls.run_down(replace(FOUR_BAR, omega2=20.0), start=90.0, flywheel=0.3, of=["F32"])
    part = several.sel(omega2=20.0).isel(at=1, wheel=2)
    for name in ("duration", "turns", "kinetic_energy", "F32_peak", "F32_peak_at"):
        np.testing.assert_allclose(part[name], alone[name], rtol=1e-9)
    labelled = replace(FOUR_BAR, omega2=xr.DataArray([10.0, 20.0], {"at": [1, 2]}, "at"))
    with pytest.raises(ValueError, match="has labels along at that are not those of"):
        ls.run_down(labelled, start=start.assign_coords(at=[2, 3]))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ls.run_up(FOUR_BAR, 3.0), "motor = 3"),
        (lambda: ls.run_up(FOUR_BAR, MOTOR, until=1.5), "until = 1.5"),
        (lambda: ls.run_up(FOUR_BAR, MOTOR, until=xr.DataArray([0.5, 0.6], dims="part")), "until: has 1 dims"),
        (lambda: ls.run_up(FOUR_BAR, MOTOR, turns=xr.DataArray([5.0, 6.0], dims="part")), "turns: has 1 dims"),
        (lambda: ls.run_up(FOUR_BAR, MOTOR, ratio=0.0), "ratio = 0"),
        (lambda: ls.run_up(FOUR_BAR, MOTOR, turns=0.0), "turns = 0"),
        (lambda: ls.run_up(FOUR_BAR, MOTOR, of=["F23z"]), "F23z"),
        (lambda: ls.run_up(OF_BARS, MOTOR, of=["bending_moment3"]), "of: bending_moment3 is along a link"),
        (lambda: ls.run_up(replace(FOUR_BAR, drive="rocker"), MOTOR), 'drive = "rocker"'),
        (lambda: ls.run_up(FOUR_BAR, MOTOR, threads=0), "threads = 0"),
        (lambda: ls.run_down(FOUR_BAR, threads=0), "threads = 0"),
        (lambda: ls.run_down(FOUR_BAR, until=1.0), "until = 1"),
        (lambda: ls.run_down(replace(FOUR_BAR, omega2=0.0)), "omega2 = 0"),
    ],
)
def test_input_that_is_not_allowed(call, message):
    with pytest.raises(ValueError, match=message):
        call()
