"""Compute backward errors of the nine unknowns: the relative change of the 9×9's numbers after which the results solve
it exactly; residuals are computed in extended precision.

Componentwise (W. Oettli, W. Prager, Numer. Math. 6 (1964) 405) each number may change by itself,

    max |Ax − b| / (sizes of A's terms · |x| + sizes of b's terms)    over the rows.

Arms from a centre of gravity and right sides are sums that may cancel: there the terms may change, to which rounding is
relative. Normwise, as LAPACK's tests bound it by 30 ε, all numbers of the balanced matrix may change by as much as the
largest does:  max |Ax − b| / (max |A| · Σ|x| + max sizes of b's terms).
"""

from __future__ import annotations

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.stress.decimals import Array
from benchmarks.stress.designs import FORCES, LINKS, Designs
from linksweep.results.compute import compute
from linksweep.scene.grid import crank_grid

LEAST = 2.0**-1022
NUMBER = {"crank": 2, "coupler": 3, "rod": 3, "rocker": 4}
SECOND_PIN = {2: ((2, 0, -1), (3, 1, -1)), 3: ((4, 2, 1), (5, 3, 1)), 4: ((4, 6, 1), (5, 7, 1))}
"""For each link: columns of the force at the second pin and at the first, and the sign that makes arms of pins."""


def backward_errors(designs: Designs, cycle: xr.Dataset) -> tuple[Array, Array]:
    """Return componentwise and normwise errors of each design; 0 unless its unknowns are those of a 9×9."""
    n = len(designs)
    if designs.machine == "inverted slider-crank":
        return np.zeros(n), np.zeros(n)
    page = ls.system(designs.scene(), [designs.theta2]).isel(theta2=0)
    A, b = (np.broadcast_to(page[name].values, (n, *shape)) for name, shape in (("matrix", (9, 9)), ("rhs", (9,))))
    x = np.stack([values(cycle, name, n) for name in (*FORCES, "drive")], axis=-1).astype(np.longdouble)
    residual = np.abs((A.astype(np.longdouble) * x[:, None, :]).sum(axis=-1) - b)
    matrix, right_side = sizes(designs, A, b)
    size = (matrix * np.abs(x)[:, None, :]).sum(axis=-1) + right_side
    componentwise = (residual / np.maximum(size, LEAST)).max(axis=-1)
    return componentwise.astype(float), _normwise(A, right_side, x, residual)


def _normwise(A: Array, b: Array, x: Array, residual: Array) -> Array:
    names = (*FORCES, "T")
    finite = np.isfinite(A).all(axis=(-2, -1), keepdims=True)
    balanced, rows, columns = equilibrated(np.where(finite, A, np.eye(9)), names)
    residual, b, x = np.ldexp(residual, -rows), np.ldexp(b, -rows), np.ldexp(np.abs(x), columns)
    size = np.abs(balanced).max(axis=(-2, -1)) * x.sum(axis=-1) + b.max(axis=-1)
    return (residual.max(axis=-1) / np.maximum(size, LEAST)).astype(float)


def equilibrated(matrix: np.ndarray, unknowns: tuple[str, ...]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Scale rows, then columns by powers of two, so that their largest entries lie in [1/2, 1) and no digit changes.

    Columns of torques are first scaled by the largest arm of a force in the same row, so that the unit of length does
    not decide the pivots either. Return the matrix with the exponents of its rows and of its columns.
    """
    torques = np.array([name.startswith("T") for name in unknowns])
    beside = (matrix[..., torques] != 0.0).any(axis=-1)[..., None] & ~torques
    arm = _exponent(np.where(beside, matrix, 0.0), axis=(-2, -1))
    units = np.where(torques, arm[..., None], 0)
    balanced = np.ldexp(matrix, units[..., None, :])
    rows = _exponent(balanced, axis=-1)
    balanced = np.ldexp(balanced, -rows[..., :, None])
    columns = _exponent(balanced, axis=-2)
    return np.ldexp(balanced, -columns[..., None, :]), rows, columns - units


def _exponent(matrix: np.ndarray, axis: int | tuple[int, ...]) -> np.ndarray:
    return np.frexp(np.abs(matrix).max(axis=axis))[1]


def sizes(designs: Designs, A: Array, b: Array) -> tuple[Array, Array]:
    """Return matrix and right side with each entry as the sum of the magnitudes of its terms."""
    matrix, right_side = np.abs(A), np.abs(b)
    terms = _made_of(designs)
    for role in LINKS[designs.machine]:
        k = NUMBER[role]
        row = 3 * (k - 2)
        for column, other, sign in SECOND_PIN[k]:
            arm, first = A[:, row + 2, column], A[:, row + 2, other]
            matrix[:, row + 2, column] = np.abs(first) + np.abs(arm + sign * first)
        mass, inertia = designs.numbers[f"{role}_mass"], designs.numbers[f"{role}_inertia"]
        for j, axis in enumerate("xy"):
            pull = np.abs(terms[f"aG{k}{axis}"]) + np.abs(designs.numbers[f"gravity_{axis}"])
            right_side[:, row + j] = mass * pull + np.abs(terms[f"applied{k}{axis}"])
        turning = np.abs(terms[f"rG{k}x"] * terms[f"applied{k}y"]) + np.abs(terms[f"rG{k}y"] * terms[f"applied{k}x"])
        right_side[:, row + 2] = inertia * np.abs(terms[f"alpha{k}"]) + np.abs(terms[f"M{k}"]) + turning
    if designs.machine == "slider-crank":
        _slider(designs, terms, matrix, right_side)
    return matrix, right_side


def _slider(designs: Designs, terms: dict[str, Array], matrix: Array, right_side: Array) -> None:
    """Fill in the slider's two equations, and the friction equation."""
    x = designs.numbers
    for j, axis in enumerate("xy"):
        pull = np.abs(terms[f"aG4{axis}"]) + np.abs(x[f"gravity_{axis}"])
        right_side[:, 6 + j] = x["slider_mass"] * pull + np.abs(terms[f"applied4{axis}"])
    cos, sin = (np.abs(turn(np.radians(x["slide_angle"]))) for turn in (np.cos, np.sin))
    matrix[:, 8, 6], matrix[:, 8, 7] = cos + x["friction"] * sin, sin + x["friction"] * cos


def _made_of(designs: Designs) -> dict[str, Array]:
    """Return intermediate numbers of the 9×9, by their names in the plan."""
    stems = ("rG{}x", "rG{}y", "aG{}x", "aG{}y", "applied{}x", "applied{}y", "M{}", "alpha{}")
    names = tuple(stem.format(k) for stem in stems for k in (2, 3, 4))
    scene = designs.scene()
    grid = crank_grid([designs.theta2], scene.period)
    fields = compute(scene.at(grid), grid, names)
    arrays = {name: xr.DataArray(field.values, dims=field.dims) for name, field in fields.items()}
    return {name: values(xr.Dataset({name: array}), name, len(designs)) for name, array in arrays.items()}


def values(cycle: xr.Dataset, name: str, n: int) -> Array:
    """Return a variable at the one angle, for each of n designs."""
    array = cycle[name]
    return np.broadcast_to((array.isel(theta2=0) if "theta2" in array.dims else array).values, n)
