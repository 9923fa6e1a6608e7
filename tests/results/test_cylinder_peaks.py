"""Peaks, duty and flywheel of several cylinders: against sums of single sweeps made here, closed forms and energy."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from refusals import refusal
from scipy.integrate import solve_ivp

import linksweep as ls

ENGINE = ls.example("engine")
CRANK, ROD = ENGINE.mechanism.crank, ENGINE.mechanism.rod
PLACES = [-0.15, -0.05, 0.05, 0.15]
FIRING = [0, 540, 180, 360]
FOUR = ls.MultiCylinder(ENGINE, FIRING, positions=PLACES)
ONE = ls.MultiCylinder(ENGINE, [0])
TWIN = ls.MultiCylinder(ENGINE, [0, 450], bank_angles=[45, -45], positions=[-0.01, 0.01])
MACHINES = {"inline four": FOUR, "V-twin": TWIN}
NAMES = ("T12", "Fsx", "Fsy", "Ms", "F12x", "F12y")


def by_hand(machine, theta2):
    """Sums of sweeps of single cylinders at shifted angles, each with its guide turned instead of its axes."""
    total = dict.fromkeys((*NAMES, "Msx", "Msy"), 0.0)
    for ahead, bank, z in zip(machine.crank_angles, machine.bank_angles, machine.positions, strict=True):
        engine = machine.engine
        turned = replace(engine, mechanism=replace(engine.mechanism, slide_angle=engine.mechanism.slide_angle + bank))
        cycle = ls.sweep(turned, np.mod(theta2 + ahead, 720.0), of=NAMES)
        each = {name: cycle[name].values for name in NAMES}
        each |= {"Msx": -z * each["Fsy"], "Msy": z * each["Fsx"]}
        total = {name: total[name] + each[name] for name in total}
    total["Fs"] = np.hypot(total["Fsx"], total["Fsy"])
    return total


@pytest.mark.parametrize("machine", MACHINES.values(), ids=MACHINES)
def test_peaks_are_those_of_the_sum_of_single_cylinders(machine):
    """The turned guide of a bank moves the cycle of the gas with it, so that its crank is ahead by φ as it stands."""
    result, step = ls.peaks(machine), 0.05
    dense = by_hand(machine, np.arange(0.0, 720.0, step) + 0.013)
    for name in ("T12", "Ms", "Msx", "Msy"):
        size = max(np.abs(dense[name]).max(), 1e-4 * dense["Fs"].max())  # else rounding of what cancels
        for end, sign in (("max", 1.0), ("min", -1.0)):
            highest, peak = (sign * dense[name]).max(), sign * float(result[f"{name}_{end}"])
            assert -1e-11 * size <= peak - highest <= 2e-3 * size, (name, end)  # beside a jump, a step is first order
            at = float(result[f"{name}_{end}_at"]) + np.array([-1e-6, 0.0, 1e-6])
            assert sign * float(result[f"{name}_{end}"]) == pytest.approx(
                (sign * by_hand(machine, at)[name]).max(), rel=1e-6, abs=1e-11 * size
            )
    assert float(result.Fs_peak) == pytest.approx(dense["Fs"].max(), rel=1e-5)
    assert int(result.status) == 0


def test_an_inline_four_shakes_most_half_way():
    """Pairs of pistons 180 degrees apart: m·r·ω²·λ/√(1 − λ²) of each, where cranks are square to the guide."""
    ratio = CRANK.length / ROD.length
    mass = ENGINE.mechanism.slider_mass + ROD.mass * ROD.cg_distance / ROD.length
    expected = 4.0 * mass * CRANK.length * ENGINE.omega2**2 * ratio / np.sqrt(1.0 - ratio**2)
    peaks = ls.peaks(FOUR, of=["Fs", "Fs_bound"])
    assert float(peaks.Fs_peak) == pytest.approx(expected, rel=1e-12)
    assert float(peaks.Fs_peak_at) % 180.0 == pytest.approx(0.0, abs=1e-5) or float(peaks.Fs_peak_at) % 180.0 > 179.9999
    assert float(peaks.Fs_bound) < 1e-9 * expected


def test_one_cylinder_has_the_peaks_of_its_scene():
    one = ls.peaks(ls.MultiCylinder(ENGINE, [0.0]), of=["T12", "Fs", "Ms", "power_fed_mean", "T12_rms"])
    scene = ls.peaks(ENGINE, of=["T12", "Fs", "Ms", "power_fed_mean", "T12_rms"])
    for name in {*scene.data_vars} - {"Fs_peak_at", "Ms_max_at", "Ms_min_at"}:  # those are the same in both turns
        np.testing.assert_allclose(one[name], scene[name], rtol=1e-10, atol=1e-5 if name.endswith("_at") else 0.0)


def test_means_and_work_add_up():
    one, four = ls.duty(ENGINE), ls.duty(FOUR)
    for name in ("effort_mean", "power_mean", "work", "work_of_loads", "work_of_friction"):
        assert float(four[name]) == pytest.approx(4.0 * float(one[name]), rel=1e-10), name
    assert float(four.work) == pytest.approx(float(four.work_fed - four.work_regenerated), rel=1e-10)
    assert float(four.work_fed) < float(one.work_fed)  # what one cylinder takes, another gives


@pytest.mark.parametrize("machine", MACHINES.values(), ids=MACHINES)
def test_the_flywheel_keeps_the_speed_by_the_equation_of_motion(machine):
    """d/dθ [½ (J_f + J) ω²] = T_d − T_s, integrated by Runge and Kutta from sums of single sweeps made here; of T12 at
    constant speed Ω the part that turns the links' own inertia, ½ J' Ω², is none of T_s."""
    wheel = ls.flywheel(machine, fluctuation=0.005)
    assert float(wheel.flywheel_inertia) > 0.0
    theta = np.arange(0.0, 720.5, 0.5)
    drive, torque, inertia = 0.0, 0.0, 0.0
    for ahead, bank in zip(machine.crank_angles, machine.bank_angles, strict=True):
        turned = replace(ENGINE, mechanism=replace(ENGINE.mechanism, slide_angle=90.0 + bank))
        cycle = ls.sweep(turned, np.mod(theta + ahead, 720.0), of=["T12", "reduced_inertia"])
        torque, inertia = torque + cycle.T12.values, inertia + cycle.reduced_inertia.values
        drive += float(ls.duty(turned).effort_mean)
    total = float(wheel.flywheel_inertia) + inertia

    def slope(at, energy):
        return np.radians(drive - np.interp(at, theta, torque))

    start = 0.5 * total[0] * float(wheel.speed[0]) ** 2
    energy = solve_ivp(slope, (0.0, 720.0), [start], t_eval=theta, max_step=0.5, rtol=1e-9).y[0]
    speed = np.sqrt((2.0 * energy + ENGINE.omega2**2 * (inertia - inertia[0])) / total)
    assert (speed.max() - speed.min()) / ENGINE.omega2 == pytest.approx(0.005, rel=5e-3)
    assert 0.5 * (speed.max() + speed.min()) == pytest.approx(ENGINE.omega2, rel=1e-4)


JAMMING = replace(ENGINE, loads=(), mechanism=replace(ENGINE.mechanism, friction=4.0))


def test_motion_counts_only_at_angles_where_friction_jams_no_cylinder():
    """Against dense samples of two cylinders that are both ok, beyond which the kinetic energy is larger."""
    names, machine, step = ["kinetic_energy", "Fs"], ls.MultiCylinder(JAMMING, [0, 100]), 0.01
    result = ls.peaks(machine, of=[*names, "kinetic_energy_mean", "Fs_mean"])
    theta2 = np.arange(0.0, 360.0, step) + 0.003
    one, other = (
        ls.sweep(JAMMING, (theta2 + ahead) % 360.0, of=["kinetic_energy", "Fsx", "Fsy"]) for ahead in (0, 100)
    )
    ok = (one.status.values == 0) & (other.status.values == 0)
    x, y, energy = (one[name].values[ok] + other[name].values[ok] for name in ("Fsx", "Fsy", "kinetic_energy"))
    for values, name, end in ((energy, "kinetic_energy", "max"), (np.hypot(x, y), "Fs", "peak")):
        assert float(result[f"{name}_{end}"]) == pytest.approx(values.max(), rel=1e-5)
        assert float(result[f"{name}_mean"]) == pytest.approx(values.mean(), rel=1e-4)
        there = machine.sweep([float(result[f"{name}_{end}_at"])], of=[name])[name]
        assert float(there[0]) == pytest.approx(float(result[f"{name}_{end}"]), rel=1e-10)


def test_means_over_jamming_friction_have_no_bound():
    """Beside a jam T12 grows as 1/(θ − θ_jam), power likewise: neither they nor their squares have an integral there,
    as those of one scene have none; the shaking force has no pole."""
    means = ["T12_mean", "T12_rms", "power_mean", "Fs_mean"]
    for machine in (ls.MultiCylinder(JAMMING, [0]), ls.MultiCylinder(JAMMING, [0, 100])):
        peaks = ls.peaks(machine, of=means)
        assert [float(abs(peaks[name])) for name in means[:3]] == [np.inf] * 3
        assert float(peaks.Fs_mean) < np.inf
        assert int(peaks.status) == 3
        duty = ls.duty(machine)
        assert float(abs(duty.effort_mean)) == float(duty.effort_rms) == np.inf


def test_each_cylinder_has_the_pin_forces_of_one():
    result, one = ls.peaks(FOUR, of=["F32", "F12_mean", "T12"]), ls.peaks(ENGINE, of=["F32", "F12_mean"])
    assert result.F32_peak.dims == ("cylinder",)
    assert list(result.cylinder.values) == [1, 2, 3, 4]
    np.testing.assert_allclose(result.F32_peak, float(one.F32_peak), rtol=1e-12)
    np.testing.assert_allclose(result.F12_mean, float(one.F12_mean), rtol=1e-9)
    np.testing.assert_allclose(result.F32_peak_at, [(float(one.F32_peak_at) - ahead) % 720.0 for ahead in FIRING])
    assert result.T12_max.dims == ()


@pytest.mark.parametrize("bank", [0.0, 38.3])
def test_angles_of_pin_forces_lie_in_the_cycle(bank):
    """Gas fires at 90 degrees of a cylinder's own crank, and loads its pin most: at 0 of the engine's, not at 720,
    where rounding puts that cylinder ahead by an ulp more."""
    machine = ls.MultiCylinder(replace(ENGINE, gravity=(0.0, 0.0)), [90.0 + bank], [bank])
    assert ls.peaks(machine, of=["F32"]).F32_peak_at.values.tolist() == [0.0]


def test_cylinders_that_jump_together_do_so_to_the_digit():
    """One fires as another turns round below: what is between the two jumps is rounding, and no load.

    The bearing holds as much at 90 as at 270 degrees, where the cylinders on its other side fire and turn round.
    """
    peaks = ls.peaks(FOUR, of=["F_main2", "F_main2_bound"])
    for at in (90.0, 270.0):
        beside = FOUR.sweep(at + np.array([-1e-6, 1e-6]), of=["F_main2"]).F_main2
        assert float(peaks.F_main2_peak) == pytest.approx(float(beside.max()), rel=1e-6)
    assert float(peaks.F_main2_peak_at) in (pytest.approx(90.0, abs=1e-5), pytest.approx(270.0, abs=1e-5))
    assert float(peaks.F_main2_bound) < 1e-9 * float(peaks.F_main2_peak)


CLOSING = xr.DataArray([-5000.0, 0.0, 300.0], {"position": [0.0, 0.012, 0.03]}, "position")
ON_STROKE = ls.Load("slider", force=CLOSING, over="slider.to_end", while_="closing", interpolation="step")
RUBBING = replace(ENGINE, mechanism=replace(ENGINE.mechanism, offset=0.0185, friction=0.05))
JUMPING = {
    "torsion spring": (replace(ENGINE, loads=[ls.TorsionSpring("ground", "crank", 30.0, 40.0)]), [0], [0], ["T12"]),
    "over the stroke": (replace(ENGINE, loads=[ON_STROKE]), [0, 137.5, 540], [0, 20, -50], ["T12", "power"]),
    "gas and friction": (RUBBING, [90, 360], [0, 90], ["F_main1", "F_main2", "F_main3"]),
}


@pytest.mark.parametrize(("engine", "cranks", "banks", "names"), JUMPING.values(), ids=JUMPING)
def test_a_sweep_at_the_angle_of_a_peak_at_a_jump_has_its_value(engine, cranks, banks, names):
    machine = ls.MultiCylinder(engine, cranks, banks, [0.1 * k for k in range(len(cranks))])
    result, jumps = ls.peaks(machine, of=names), 0
    for name in names:
        for end in ("peak",) if f"{name}_peak_at" in result else ("max", "min"):
            at, peak = float(result[f"{name}_{end}_at"]), float(result[f"{name}_{end}"])
            there, *beside = machine.sweep([at, at - 3e-9, at + 3e-9], of=[name])[name].values
            assert there == pytest.approx(peak, rel=1e-9)
            jumps += np.ptp(beside) > 1e-3 * abs(peak)
    assert jumps


@pytest.mark.parametrize("mains", [(), (-0.25, -0.06, 0.02, 0.15)])
def test_main_bearings_hold_the_throws_in_balance(mains):
    """Forces and their moments about the axes square to the shaft are those of the throws, at every angle."""
    machine = ls.MultiCylinder(ENGINE, FIRING, [0, 10, -20, 30], PLACES, mains)
    names = [f"F_main{k}{axis}" for k in range(1, len(machine.mains) + 1) for axis in "xy"]
    theta2 = np.arange(0.0, 720.0, 7.3)
    cycle = machine.sweep(theta2, of=names)
    for axis in "xy":
        carried = np.array([cycle[name] for name in names if name.endswith(axis)])
        force, moment = 0.0, 0.0
        for ahead, bank, z in zip(machine.crank_angles, machine.bank_angles, machine.positions, strict=True):
            turned = replace(ENGINE, mechanism=replace(ENGINE.mechanism, slide_angle=90.0 + bank))
            throw = ls.sweep(turned, np.mod(theta2 + ahead, 720.0), of=[f"F12{axis}"])[f"F12{axis}"].values
            force, moment = force + throw, moment + z * throw
        np.testing.assert_allclose(carried.sum(axis=0), force, rtol=1e-9, atol=1e-6)
        np.testing.assert_allclose(np.array(machine.mains) @ carried, moment, rtol=1e-9, atol=1e-6)


def test_bounds_are_unknown_of_what_a_function_that_cannot_be_followed_changes_alone():
    """The shaking force and its moment depend on no load."""

    def jagged(theta2):
        return 1e5 + 5e4 * np.round(20.0 * np.cos(np.radians(theta2)) + 3.0 * np.sin(np.radians(1331.0 * theta2)))

    engine = replace(ENGINE, loads=[ls.GasPressure(0.08, jagged)])
    machine = ls.MultiCylinder(engine, [0], positions=[0.0], main_positions=[-0.1, 0.1])
    peaks = ls.peaks(machine, of=["T12_bound", "F_main1_bound", "F12_bound", "Fs", "Fs_bound", "Ms", "Ms_bound"])
    assert float(peaks.T12_bound) == float(peaks.F_main1_bound) == float(peaks.F12_bound[0]) == np.inf
    assert float(peaks.Fs_bound) < 1e-10 * float(peaks.Fs_peak)
    assert float(peaks.Ms_bound) < 1e-10 * float(peaks.Ms_peak)


def test_no_main_bearing_lies_between_places_that_differ_by_rounding():
    """0.1 + 0.2 is not 0.3 in the last digit; places 1e-6 m apart are two."""
    vee = ls.MultiCylinder(ENGINE, [0, 0, 180], [45, -45, 45], positions=[0.3, 0.1 + 0.2, 0.5])
    np.testing.assert_allclose(vee.mains, [0.2, 0.4, 0.6], rtol=1e-14)
    shares = [[0.5, 0.5, 0.0], [0.5, 0.5, 0.0], [0.0, 0.5, 0.5]]
    np.testing.assert_allclose([throw.shares for throw in vee.throws], shares, atol=1e-14)
    assert ls.MultiCylinder(ENGINE, [0, 0], positions=[0.3, 0.1 + 0.2]).mains == ()
    assert len(ls.MultiCylinder(ENGINE, [0, 0], positions=[0.3, 0.300001]).mains) == 3


def test_designs_go_along():
    speeds = xr.DataArray([100.0, 200.0], {"speed": [1, 2]}, "speed")
    peaks = ls.peaks(replace(FOUR, engine=replace(ENGINE, omega2=speeds)), of=["Fs", "T12", "F32"])
    assert (peaks.Fs_peak.dims, peaks.F32_peak.dims) == (("speed",), ("cylinder", "speed"))
    assert float(peaks.Fs_peak[1]) == pytest.approx(4.0 * float(peaks.Fs_peak[0]), rel=1e-9)
    for k, speed in enumerate(speeds.values):
        alone = ls.peaks(replace(FOUR, engine=replace(ENGINE, omega2=float(speed))), of=["T12"])
        assert float(peaks.T12_max[k]) == float(alone.T12_max)


def test_designs_that_move_over_part_of_a_turn_have_no_sums():
    pump = ls.SliderCrank(ls.Bar(0.2, 0.02, 0.02, 7750), ls.Bar(0.1, 0.02, 0.02, 7750), slider_mass=1.0)
    peaks = ls.peaks(ls.MultiCylinder(ls.Scene(pump, omega2=10.0), [0, 180]), of=["T12", "T12_mean"])
    assert int(peaks.status) == 1
    assert np.isnan(peaks.T12_max) and np.isnan(peaks.T12_mean)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ls.peaks(FOUR, of=["T21"]), "of: nothing is named 'T21'; did you mean \"T12\"?"),
        (lambda: ls.peaks(FOUR, of=["F32x"]), "of: nothing is named 'F32x'; did you mean \"F32\"?"),
        (lambda: ls.peaks(FOUR, theta2=720), "theta2 = 720: must be left out: peaks of several cylinders are exact"),
        (lambda: FOUR.sweep(of=["F_mian1"]), "of: nothing is named 'F_mian1'; did you mean \"F_main1\"?"),
        (
            lambda: ls.peaks(ONE, of="F_main1"),
            "of = 'F_main1': places of the main bearings are unknown; give two places",
        ),
        (
            lambda: ONE.sweep(of=["F_main2x"]),
            "of = 'F_main2x': places of the main bearings are unknown; give two places",
        ),
        (lambda: ls.sweep(FOUR), "scene is a MultiCylinder: must be a Scene, such as its engine"),
        (lambda: ls.breakdown(FOUR, "F32"), "scene is a MultiCylinder: must be a Scene, such as its engine"),
        (lambda: ls.flywheel(FOUR, fluctuation=2.0), "fluctuation = 2.0: must be less than 2"),
        (
            lambda: replace(FOUR, main_positions=(0.0, 0.2)),
            "positions[1] = -0.15 m: must lie between the first and the last main bearing, at 0 m and 0.2 m",
        ),
        (lambda: replace(FOUR, main_positions=[0.2, -0.2]), "main_positions = [0.2, -0.2]: must be two places or more"),
        (lambda: replace(FOUR, main_positions=0.2), "main_positions = 0.2: must be a list of numbers"),
    ],
)
def test_refusals(call, message):
    assert message in refusal(call)[0]


def test_main_bearings_live_as_their_loads_let_them():
    """P³ is the mean of F³ over the shaft's turning, here of dense samples of the throws beside each main."""
    capacity, step = 30e3, 0.05
    parameters = {f"main{k}": ls.Bearing(diameter=0.05, length=0.02, capacity=capacity) for k in range(1, 6)}
    bearings = ls.bearings(FOUR, parameters)
    theta2 = np.arange(0.0, 720.0, step) + 0.5 * step
    throws = [ls.sweep(ENGINE, np.mod(theta2 + ahead, 720.0), of=["F12x", "F12y"]) for ahead in FIRING]
    loads = [(each.F12x.values, each.F12y.values) for each in throws]
    for k, beside in enumerate([[0], [0, 1], [1, 2], [2, 3], [3]]):
        x, y = (sum(0.5 * loads[throw][axis] for throw in beside) for axis in (0, 1))
        load = np.hypot(x, y)
        one = bearings.sel(main=f"main{k + 1}")
        equivalent = np.mean(load**3) ** (1.0 / 3.0)
        assert float(one.equivalent_load) == pytest.approx(equivalent, rel=1e-5)
        hours = (capacity / equivalent) ** 3 * 1e6 / (ENGINE.omega2 / (2.0 * np.pi) * 3600.0)
        assert float(one.L10h) == pytest.approx(hours, rel=3e-5)
        assert float(one.rotation) == pytest.approx(720.0, rel=1e-12)
        assert 0.0 <= float(one.F_peak) / load.max() - 1.0 < 2e-3
        assert float(one.pressure.max()) == pytest.approx(float(one.F.max()) / (0.05 * 0.02), rel=1e-12)
        np.testing.assert_allclose(np.hypot(one.Fx, one.Fy), one.F.broadcast_like(one.Fx), rtol=1e-12)
    np.testing.assert_allclose(bearings.main_position, [-0.2, -0.1, 0.0, 0.1, 0.2], atol=1e-15)
    assert int(abs(bearings.life_status).max()) == 0


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ls.bearings(FOUR, {"A": ls.Bearing()}), "pins: nothing is named 'A'; there are main1, main2"),
        (lambda: ls.bearings(FOUR, theta2=[0.0, 90.0]), "theta2 = [0.0, 90.0]: must be a whole number"),
        (lambda: ls.bearings(ls.MultiCylinder(ENGINE, [0])), "main_positions: places of the main bearings are unknown"),
    ],
)
def test_refusals_of_main_bearings(call, message):
    assert message in refusal(call)[0]
