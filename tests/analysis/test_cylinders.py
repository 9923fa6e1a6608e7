"""MultiCylinder: known orders of inline engines and V-twins, and a bank against a rotated guide."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from refusals import SCENE, refusal

import linksweep as ls

ENGINE = ls.example("engine")
CRANK, ROD = ENGINE.mechanism.crank, ENGINE.mechanism.rod
FIRST = (ENGINE.mechanism.slider_mass + ROD.mass * ROD.cg_distance / ROD.length) * CRANK.length * ENGINE.omega2**2
"""m_rec·r·ω² of one cylinder."""
ROTATING = ROD.mass * (1.0 - ROD.cg_distance / ROD.length) * CRANK.length * ENGINE.omega2**2
RATIO = CRANK.length / ROD.length
THETA = np.radians(np.arange(360.0))
SECOND = FIRST * 4.0 * abs(np.mean(np.sqrt(1.0 - (RATIO * np.sin(THETA)) ** 2) * np.cos(2.0 * THETA))) * 2.0 / RATIO
"""Amplitude of the second order: 2² times that of the piston's travel, b·√(1 − λ²·sin²θ), by Fourier."""
SPACING = 0.1
ORDERS = [1, 2, 3, 4, 5, 6]


def amplitudes(machine, *names):
    orders = ls.orders(machine.sweep(theta2=1440), list(names), n=6).sel(order=ORDERS)
    return [orders[f"{name}_amplitude"].values for name in names]


def along(count):
    """Return positions of `count` cylinders about the middle."""
    return [SPACING * (k - 0.5 * (count - 1)) for k in range(count)]


def test_one_cylinder_equals_the_sweep():
    one, cycle = ls.MultiCylinder(ENGINE, [0.0]).sweep(), ls.sweep(ENGINE, of=["T12", "Fsx", "Fsy", "Fs", "Ms"])
    for name in ("T12", "Fsx", "Fsy", "Ms"):
        np.testing.assert_array_equal(one[name], cycle[name])
    np.testing.assert_allclose(one.Fs, cycle.Fs, rtol=1e-15)
    assert float(abs(one.Msx).max() + abs(one.Msy).max()) == 0.0


def test_the_shaking_force_of_one_cylinder_is_that_of_its_slider():
    x, y = amplitudes(ls.MultiCylinder(ENGINE, [0.0]), "Fsx", "Fsy")
    assert y[0] == pytest.approx(FIRST + ROTATING, rel=1e-12)
    assert x[0] == pytest.approx(ROTATING, rel=1e-12)
    assert y[1] == pytest.approx(SECOND, rel=1e-12)


def test_an_inline_four_has_the_second_order_only():
    """First orders cancel, second orders add up, the moment is zero; of higher orders the even ones remain."""
    four = ls.MultiCylinder(ENGINE, [0, 540, 180, 360], positions=along(4))
    x, y, tilt, yaw = amplitudes(four, "Fsx", "Fsy", "Msx", "Msy")
    assert y[1] == pytest.approx(4.0 * SECOND, rel=1e-12)
    np.testing.assert_allclose(y[[0, 2, 4]], 0.0, atol=1e-11 * FIRST)
    np.testing.assert_allclose([x, tilt, yaw], 0.0, atol=1e-11 * FIRST)


def test_four_strokes_of_four_cylinders_fire_twice_a_turn():
    """With even firing the torque repeats every 180 degrees, that of one cylinder every 720."""
    torque = ls.MultiCylinder(ENGINE, [0, 540, 180, 360]).sweep().T12
    np.testing.assert_allclose(torque, np.roll(torque, 180), rtol=1e-9, atol=1e-9 * float(abs(torque).max()))
    one = ls.sweep(ENGINE, of=["T12"]).T12
    assert float(torque.mean()) == pytest.approx(4.0 * float(one.mean()), rel=1e-12)


def test_an_inline_three_has_shaking_moments_only():
    """Forces of orders 1 and 2 cancel; the moments are √3·F·spacing: forces 120 degrees apart on arms −1, 0, 1."""
    three = ls.MultiCylinder(ENGINE, [0, 240, 480], positions=along(3))
    x, y, tilt = amplitudes(three, "Fsx", "Fsy", "Msx")
    np.testing.assert_allclose([x[:2], y[:2]], 0.0, atol=1e-11 * FIRST)
    assert tilt[0] == pytest.approx(np.sqrt(3.0) * SPACING * (FIRST + ROTATING), rel=1e-12)
    assert tilt[1] == pytest.approx(np.sqrt(3.0) * SPACING * SECOND, rel=1e-12)


def test_an_inline_six_is_smooth_to_the_sixth_order():
    six = ls.MultiCylinder(ENGINE, [0, 600, 120, 480, 240, 360], positions=along(6))
    shaking = np.array(amplitudes(six, "Fsx", "Fsy", "Msx", "Msy"))
    assert shaking[1, 5] > 1e-6 * FIRST
    np.testing.assert_allclose(shaking[:, :5], 0.0, atol=1e-11 * FIRST)


def test_a_v_twin_at_90_degrees_has_no_first_order():
    """A counterweight balances all rotating and half of the reciprocating masses; the second order remains,
    √2 times one cylinder's, perpendicular to the middle of the V."""
    throw = ls.with_counterweights(ENGINE, ls.counterweights(ENGINE, radius=0.05, fraction=0.5))
    twin = ls.MultiCylinder(throw, crank_angles=[0, 0], bank_angles=[45, -45])
    x, y = amplitudes(twin, "Fsx", "Fsy")
    np.testing.assert_allclose([x[0], y[0]], 0.0, atol=1e-11 * FIRST)
    assert x[1] == pytest.approx(np.sqrt(2.0) * SECOND, rel=1e-12)
    assert y[1] == pytest.approx(0.0, abs=1e-11 * FIRST)
    wider = ls.MultiCylinder(throw, crank_angles=[0, 0], bank_angles=[30, -30])
    assert min(amplitudes(wider, "Fsx")[0][0], amplitudes(wider, "Fsy")[0][0]) > 0.1 * FIRST


@pytest.mark.parametrize("bank", [30.0, -45.0, 180.0])
def test_a_bank_equals_a_rotated_guide(bank):
    """Gas, weights and friction are included; only gravity keeps its direction."""
    turned = replace(ENGINE, mechanism=replace(ENGINE.mechanism, slide_angle=90.0 + bank))
    one = ls.MultiCylinder(ENGINE, [0.0], bank_angles=[bank]).sweep(theta2=48)
    cycle = ls.sweep(turned, theta2=48, of=["T12", "Fsx", "Fsy", "Ms"])
    for name in ("T12", "Fsx", "Fsy", "Ms"):
        largest = float(abs(cycle[name]).max())
        smooth = np.asarray(cycle.theta2) % 180.0 != (90.0 + bank) % 180.0  # the pressure jumps at dead centres
        np.testing.assert_allclose(one[name][smooth], cycle[name][smooth], rtol=1e-9, atol=1e-10 * largest)


def test_results_have_the_title_of_the_whole_machine():
    twin = ls.MultiCylinder(ENGINE, [0, 360])
    assert twin.sweep(8).attrs["title"] == ls.peaks(twin, of="T12").attrs["title"] == "linksweep: MultiCylinder"


def test_designs_are_batched():
    speeds = xr.DataArray([100.0, 200.0], {"speed": [1, 2]}, "speed")
    cycle = ls.MultiCylinder(replace(ENGINE, omega2=speeds), [0, 540, 180, 360]).sweep(theta2=36)
    np.testing.assert_allclose(cycle.Fsy.isel(speed=1), 4.0 * cycle.Fsy.isel(speed=0), rtol=1e-9, atol=1e-8)
    assert cycle.Fsy.units == "N"
    assert int(cycle.status.max()) == 0


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ls.MultiCylinder(SCENE, [0]), "engine is of a FourBar, which has no cylinder: give"),
        (lambda: ls.MultiCylinder(3.0, [0]), "engine is a float: must be a Scene"),
        (lambda: ls.MultiCylinder(ENGINE, 0.0), "crank_angles = 0.0: must be a list of numbers"),
        (lambda: ls.MultiCylinder(ENGINE, []), "crank_angles is empty: give one"),
        (
            lambda: ls.MultiCylinder(ENGINE, [0, 90], [1, 2, 3]),
            "bank_angles has 3 numbers: must have one for each of 2",
        ),
        (lambda: ls.MultiCylinder(ENGINE, [0], positions=[np.nan]), "positions[1] = nan m: must be finite"),
        (
            lambda: ls.MultiCylinder(ENGINE, {0, 180}),
            "must be a list of numbers, one for each cylinder, in their order",
        ),
        (lambda: ls.MultiCylinder(ENGINE, {0: 1, 180: 2}), "crank_angles = {0: 1, 180: 2}: must be a list of numbers"),
        (lambda: ls.MultiCylinder(ENGINE, b"ab"), "crank_angles = b'ab': must be a list of numbers"),
        (lambda: ls.MultiCylinder(ENGINE, np.array(90.0)), "crank_angles = array(90.): must be a list of numbers"),
        (
            lambda: ls.MultiCylinder(ENGINE, [None, 0]),
            "crank_angles[1] = None: must be a number in degrees, the same for all designs",
        ),
        (
            lambda: ls.MultiCylinder(ENGINE, [0, 90], positions=[0, xr.DataArray([0.0, 0.1], dims="design")]),
            "must be a number in m, the same for all designs",
        ),
        (lambda: ls.MultiCylinder(ENGINE, [[0, 90], 0]), "crank_angles[1] = [0, 90]: must be a number in degrees, the"),
        (lambda: ls.MultiCylinder(replace(ENGINE, drive="coupler"), [0]), 'engine.drive = "coupler": must be "crank"'),
        (
            lambda: ls.MultiCylinder(replace(ENGINE, omega2=lambda theta2: 100.0 + np.cos(np.radians(theta2))), [0]),
            "must be the same at every crank angle",
        ),
    ],
)
def test_refusals(call, message):
    line = refusal(call)[0]
    assert message in line


def test_each_wrong_parameter_has_a_line():
    lines = refusal(ls.MultiCylinder, SCENE, ["x", 0], {1, 2}, [0.0])
    assert [line.split()[0] for line in lines] == ["engine", "crank_angles[1]", "bank_angles", "positions"]
    lines = refusal(ls.MultiCylinder, ENGINE, 0.0, "45", [0.0, 0.3], [0.2, 0.1])
    assert [line.split()[0] for line in lines] == ["crank_angles", "bank_angles", "main_positions"]


def test_what_needs_a_scene_states_that_several_cylinders_have_none():
    cycle = ls.MultiCylinder(ENGINE, [0, 360]).sweep(8)
    with pytest.raises(ValueError, match=r"'F14'\]; of a MultiCylinder, sweep its engine$"):
        cycle.linksweep.forces()
    with pytest.raises(ValueError, match=r"keep their attributes; those of a MultiCylinder hold none$"):
        cycle.linksweep.mechanism()
