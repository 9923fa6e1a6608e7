"""The dense 9×9: rows and columns scaled to one size, backward errors of a few last digits, any scale of units."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
import xarray as xr
from oracle import KINDS, LINKS, FourBarData, random_data, random_theta2, to_scene
from references import BRANCHES, LinkData, LoadData

import linksweep as ls

EPS = 2.0**-52
UNKNOWNS = ("F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y", "T12")


def scenes() -> list[tuple[ls.Scene, list[float]]]:
    rng = np.random.default_rng(6)
    data = [random_data(rng, kind=kind, branch=b, drive="crank") for kind, b, _ in product(KINDS, BRANCHES, range(3))]
    return [(to_scene(one), [random_theta2(rng, one) for _ in range(4)]) for one in data]


def solved(scene: ls.Scene, theta2, solver: str) -> np.ndarray:
    cycle = ls.sweep(scene, theta2, of=UNKNOWNS, solver=solver)
    assert not cycle.status.any()
    return np.stack([cycle[name].broadcast_like(cycle.theta2).values for name in UNKNOWNS], axis=-1)


def balanced(matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the matrix with rows and columns scaled by powers of two to entries below 1, and the exponents of both.

    The torque is first measured in units of the largest arm beside it.
    """
    arms = np.abs(matrix[..., 2, :4]).max(axis=-1)
    units = np.zeros((*matrix.shape[:-2], 9), dtype=int)
    units[..., 8] = np.frexp(arms)[1]
    scaled = np.ldexp(matrix, units[..., None, :])
    rows = np.frexp(np.abs(scaled).max(axis=-1))[1]
    scaled = np.ldexp(scaled, -rows[..., None])
    columns = np.frexp(np.abs(scaled).max(axis=-2))[1]
    return np.ldexp(scaled, -columns[..., None, :]), rows, columns - units


def backward_error(matrix: np.ndarray, rhs: np.ndarray, x: np.ndarray) -> np.ndarray:
    """The least relative change of the balanced matrix and right side, row by row, of which x is the exact solution."""
    scaled, rows, columns = balanced(matrix)
    b, y = (np.ldexp(v, k).astype(np.longdouble) for v, k in ((rhs, -rows), (x, columns)))
    rest = np.abs((scaled.astype(np.longdouble) * y[..., None, :]).sum(axis=-1) - b)
    sizes = np.abs(scaled).max(axis=(-2, -1)) * np.abs(y).sum(axis=-1) + np.abs(b).max(axis=-1)
    return (rest.max(axis=-1) / sizes).astype(float)


@pytest.mark.parametrize(("solver", "promised"), [("dense", 10.0 * EPS), ("refined", EPS)])
def test_backward_errors_are_a_few_last_digits(solver, promised):
    for scene, theta2 in scenes():
        page = ls.system(scene, theta2)
        errors = backward_error(page.matrix.values, page.rhs.values, solved(scene, theta2, solver))
        assert errors.max() < promised


def heavy(scale: float = 1.0) -> FourBarData:
    """A crank-rocker in units of length that are so many times smaller."""
    sizes = (0.08, 0.22, 0.18)
    links = (LinkData(x * scale, 1.0, 0.02 * scale * scale, 0.4 * x * scale, 15.0) for x in sizes)
    load = LoadData("coupler", force=(3.0 * scale, -80.0 * scale), at=(0.1 * scale, 15.0))
    return FourBarData(*links, ground=0.2 * scale, omega2=30.0, gravity=(0.0, -9.81 * scale), loads=(load,))


@pytest.mark.parametrize("solver", ["fast", "dense"])
@pytest.mark.parametrize("exponent", [-300, -100, -7, 1, 100, 300])
def test_units_of_length_change_no_digit(exponent, solver):
    """By 2^k, forces in N go with the length, the torque with its square: 2^±300 is 1e±90."""
    theta2 = np.arange(0.0, 360.0, 10.0)
    scale = 2.0**exponent
    plain, scaled = (ls.sweep(to_scene(heavy(s)), theta2, of=(*UNKNOWNS, "cond"), solver=solver) for s in (1.0, scale))
    assert not scaled.status.any()
    for name in UNKNOWNS:
        factor = scale * scale if name == "T12" else scale
        np.testing.assert_array_equal(scaled[name], plain[name] * factor, err_msg=name)
    np.testing.assert_array_equal(scaled.cond, plain.cond)


@pytest.mark.parametrize("scale", [1e-100, 1e100])
def test_condition_knows_no_units(scale):
    near, far = (ls.sweep(to_scene(heavy(s)), 36, of="cond").cond for s in (1.0, scale))
    assert float(abs(far / near).max()) < 4.0
    assert float(abs(near / far).max()) < 4.0
    assert float(near.max()) < 1e3


def light(scale: float) -> FourBarData:
    """Point masses and no loads: nothing that a scene could refuse."""
    data = replace(heavy(scale), loads=(), gravity=(0.0, 0.0))
    return replace(data, **{name: replace(getattr(data, name), inertia=0.0) for name in LINKS})


@pytest.mark.parametrize("solver", ["fast", "dense"])
@pytest.mark.parametrize("scale", [1e-170, 1e-155, 1e-120, 1e-100, 1e100, 1e120, 1e155, 1e170])
def test_far_beyond_all_units_numbers_are_right_or_the_status_says_not(scale, solver):
    theta2 = np.arange(0.0, 360.0, 30.0)
    data, plain_data = light(scale), light(1.0)
    plain = ls.sweep(to_scene(plain_data), theta2, of=UNKNOWNS)
    with np.errstate(all="ignore"):
        cycle = ls.sweep(to_scene(data), theta2, of=UNKNOWNS, solver=solver)
    ok = cycle.status.values == 0
    assert ok.all() if 1e-130 < scale < 1e130 else not ok.any()
    for name in UNKNOWNS[:-1]:
        np.testing.assert_allclose(cycle[name].values[ok] / scale, plain[name].values[ok], rtol=1e-11, err_msg=name)
        assert np.isnan(cycle[name].values[~ok]).all()


def test_a_batch_of_scales_is_solved_side_by_side():
    """One tiny, one huge: neither spoils the other."""
    scales = np.array([1e-100, 1.0, 1e100])
    size = xr.DataArray(scales, dims="design")
    links = (ls.Link(x * size, 1.0, 0.02 * size * size, 0.4 * x * size) for x in (0.08, 0.22, 0.18))
    scene = ls.Scene(ls.FourBar(*links, ground=0.2 * size), omega2=30.0)
    cycle = ls.sweep(scene, 12, of=UNKNOWNS, solver="dense")
    assert not cycle.status.any()
    force = cycle.F32x / size
    assert float(abs(force / force.isel(design=1) - 1.0).max()) < 1e-9
