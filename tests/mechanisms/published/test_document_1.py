"""Document 1, Matrix Dynamic Analysis for Four Bar: its numbers, its 9×9, and its full circle.

The page prints no lengths; a = 8, b = 12, c = 11 cm follow from its masses, and d = 22 cm closes the loop. Its
numbers come from angles rounded to 0.1°, so each may be off by 0.05° (in rad) of the largest alike, besides its
own last digit.
"""

from functools import cache

import numpy as np
import pytest
from documents import PAGE_MATRIX, PAGE_RHS
from oracle import FourBarData, largest_torque, solve
from references import FORCES, LinkData, largest_force, mp

import linksweep as ls

STEEL = {"width": 0.02, "thickness": 0.02, "density": 7750.0}
UNKNOWNS = ("F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y", "T12")
ALIKE = (
    ("theta3", "theta4"),
    ("omega3", "omega4"),
    ("alpha3", "alpha4"),
    ("aG2x", "aG2y", "aG3x", "aG3y", "aG4x", "aG4y"),
)
OUTPUTS = [name for alike in ALIKE for name in alike] + ["F12", "F32", "F43", "F14", *UNKNOWNS]
HALF_STEP = float(np.radians(0.05))


@cache
def scene() -> ls.Scene:
    crank, coupler, rocker = (ls.Bar(length=length, **STEEL) for length in (0.08, 0.12, 0.11))
    press = ls.FourBar(crank=crank, coupler=coupler, rocker=rocker, ground=0.22)
    return ls.Scene(press, omega2=-20.0, alpha2=100.0, gravity=(0.0, -9.81))


def bar(length: float) -> LinkData:
    """The page's bar, its mass and inertia in 60 digits."""
    length, width, thickness, density = map(mp.mpf, (length, 0.02, 0.02, 7750.0))
    mass = density * length * width * thickness
    return LinkData(length, mass, mass * (length**2 + width**2) / 12, cg_distance=length / 2)


@cache
def exact() -> dict:
    data = FourBarData(bar(0.08), bar(0.12), bar(0.11), ground=0.22, omega2=-20.0, alpha2=100.0, gravity=(0.0, -9.81))
    result = solve(data, 45.0)
    return result | {"largest_torque": largest_torque(result, data)}


@pytest.mark.parametrize("solver", ["fast", "dense"])
def test_all_values_agree_with_exact_arithmetic_from_the_lengths(solver):
    """To 1e-13 of the largest force; reached: 1e-15."""
    at_45 = ls.sweep(scene(), theta2=[45.0], of=OUTPUTS, solver=solver).isel(theta2=0)
    scale = dict.fromkeys(UNKNOWNS + FORCES, largest_force(exact()))
    scale["T12"] = exact()["largest_torque"]
    for alike in ALIKE:
        scale |= dict.fromkeys(alike, max(abs(exact()[name]) for name in alike))
    error = {name: float(abs(at_45[name].item() - exact()[name]) / scale[name]) for name in OUTPUTS}
    assert max(error.values()) < 1e-13, error


PRINTED = [  # values, half of the last digit, the largest alike; F23 and F34 turned into F32 and F43, cm into m
    ({"theta3": 20.0, "theta4": 117.4}, 0.05, np.degrees(1)),
    ({"omega3": 12.82, "omega4": -6.20}, 0.005, 20.0),
    ({"alpha3": -39.6, "alpha4": 482.5}, 0.05, 482.5),
    ({"aG2x": -14.142, "aG2y": -8.485, "aG3x": -36.725, "aG3y": -22.609}, 0.0005, 43.13),
    ({"aG4x": -22.624, "aG4y": -14.124}, 0.0005, 43.13),
    ({"F12x": -22.236, "F12y": -6.221, "F32x": 18.729, "F32y": 6.550}, 0.0005, 23.09),
    ({"F43x": 5.067, "F43y": 1.788, "F14x": -2.648, "F14y": 0.317}, 0.0005, 23.09),
    ({"T12": 0.81135}, 0.000005, 23.09 * 0.22),
    ({"transmission_angle_signed": 117.4 - 20.0}, 0.1, np.degrees(1)),
    # the arms r of its numeric matrix: rows 3, 6, 9 have −r_y and r_x of the force on the link, F23 = −F32, F34 = −F43
    ({"R12x": -0.02828, "R12y": -0.02828, "R32x": 0.02828, "R32y": 0.02828}, 0.000005, 0.04),
    ({"R23x": -0.05638, "R23y": -0.02052, "R43x": 0.05638, "R43y": 0.02052}, 0.000005, 0.06),
    ({"R34x": -0.02531, "R34y": 0.04883, "R14x": 0.02531, "R14y": -0.04883}, 0.000005, 0.055),
]


@pytest.mark.parametrize(("printed", "half_digit", "largest"), PRINTED)
def test_printed_values_to_their_rounding(printed, half_digit, largest):
    at_45 = ls.sweep(scene(), theta2=[45.0], of=list(printed)).isel(theta2=0)
    for name, value in printed.items():
        assert at_45[name].item() == pytest.approx(value, abs=half_digit + HALF_STEP * largest), name


EXACT_TO_FOUR_DECIMALS = {  # from the lengths, by others' exact arithmetic
    "theta3": 20.0105,
    "theta4": 117.4316,
    "omega3": 12.8188,
    "omega4": -6.1967,
    "F12x": -22.2289,
    "F12y": -6.2164,
    "F32x": 18.7217,
    "F32y": 6.5449,
    "F43x": 5.0578,
    "F43y": 1.7910,
    "F14x": -2.6449,
    "F14y": 0.3267,
    "T12": 0.8114,
}


def test_default_sweep_has_kinematics_the_nine_unknowns_and_magnitudes_of_pin_forces():
    at_45 = ls.sweep(scene(), theta2=[45.0]).isel(theta2=0)
    kinematics = [name for alike in ALIKE[:3] for name in alike]
    assert list(at_45.data_vars) == [*kinematics, *UNKNOWNS, "F12", "F32", "F43", "F14", "status"]
    for name, value in EXACT_TO_FOUR_DECIMALS.items():
        assert at_45[name].item() == pytest.approx(value, abs=0.5e-4), name
    for pin in ("F12", "F32", "F43", "F14"):
        x, y = (EXACT_TO_FOUR_DECIMALS[f"{pin}{axis}"] for axis in "xy")
        assert at_45[pin].item() == pytest.approx(np.hypot(x, y), abs=0.5e-4 * np.sqrt(2)), pin


# ---- the 9×9 beside the page -----

MOMENT_ROWS = [2, 5, 8]


def page_in_si() -> tuple[np.ndarray, np.ndarray]:
    """The page's system in F12, F32, F43, F14 [N], T12 [N m]: F32 = −F23, F43 = −F34; moments in N m."""
    matrix, rhs = np.array(PAGE_MATRIX, dtype=float), np.array(PAGE_RHS)
    matrix[:, 2:6] *= -1.0
    matrix[MOMENT_ROWS, :8] /= 100.0
    rhs[MOMENT_ROWS] /= 100.0
    return matrix, rhs


def test_system_lies_beside_the_page():
    page = ls.system(scene(), theta2=45.0).isel(theta2=0)
    matrix, rhs = page_in_si()
    assert page.matrix.dims == ("equation", "unknown")
    assert tuple(page.unknown.values) == UNKNOWNS
    assert len(set(page.equation.values)) == 9
    moment = np.isin(np.arange(9), MOMENT_ROWS)
    arm = moment[:, None] & (np.arange(9) < 8)
    np.testing.assert_array_equal(page.matrix.values[~arm], matrix[~arm])
    assert np.all(abs(page.matrix.values - matrix) < HALF_STEP * 0.06 + 0.5e-5)
    heaviest = np.where(moment, 0.17138, 16.04)  # J_G4 alpha4, and m3 A_G3's length
    assert np.all(abs(page.rhs.values - rhs) < HALF_STEP * heaviest)


def test_crank_row_of_the_system_is_exact():
    """At 45° no rounded angle of the page enters this row, whose signs its symbolic matrix has reversed."""
    row = ls.system(scene(), theta2=45.0).matrix.isel(theta2=0, equation=2).values
    arm = 0.04 * np.sqrt(0.5)
    np.testing.assert_allclose(row, [arm, -arm, -arm, arm, 0, 0, 0, 0, 1], rtol=1e-15, atol=0.0)


def test_solution_of_the_system_is_the_sweep():
    angles = [-80.0, 0.0, 45.0, 86.0]
    page, cycle = ls.system(scene(), angles), ls.sweep(scene(), angles)
    solution = np.linalg.solve(page.matrix.values, page.rhs.values[..., None])[..., 0]
    for k, name in enumerate(UNKNOWNS):
        np.testing.assert_allclose(solution[:, k], cycle[name], rtol=0.0, atol=1e-11 * abs(solution).max())


# ---- the full circle of a triple rocker -----


def limit() -> float:
    """Largest crank angle [degree] that closes: coupler and rocker in line, by the law of cosines."""
    a, b, c, d = map(mp.mpf, (0.08, 0.12, 0.11, 0.22))
    return float(mp.degrees(mp.acos((a**2 + d**2 - (b + c) ** 2) / (2 * a * d))))


@pytest.mark.parametrize("count", [720, 3600])
def test_full_circle_has_nan_outside_its_limits(count):
    assert limit() == pytest.approx(86.906, abs=5e-4)
    cycle = ls.sweep(scene(), theta2=count, of=[*OUTPUTS, "transmission_angle", "power", "cond", "Cx"])
    closes = (cycle.theta2.values < limit()) | (cycle.theta2.values > 360.0 - limit())
    meanings = cycle.status.attrs["flag_meanings"].split()
    assert [meanings[k] for k in cycle.status.values] == ["ok" if ok else "cannot_assemble" for ok in closes]
    for name in set(cycle.data_vars) - {"status"}:
        np.testing.assert_array_equal(np.isfinite(cycle[name].values), closes, err_msg=name)


def test_first_and_last_nan_bracket_the_limits():
    """Also a millionth of a degree apart, where rounding alone could decide."""
    near = limit() + np.array([-1e-6, 1e-6])
    status = ls.sweep(scene(), theta2=[*near, *(-near), *(360.0 - near)], of=["T12"]).status
    assert status.values.tolist() == [0, 1] * 3
