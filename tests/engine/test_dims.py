"""Kernels of any number of dims: Python takes twenty blocks within each other; deeper loops are folded into one.

The kernels run here as the Python that they are written in: what numba compiles is the same.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from fused import EVERY

import linksweep as ls
from linksweep.engine import run
from linksweep.engine.kernel import reduce, writer
from linksweep.engine.peaks import laid_out

PRESS = ls.example("press")
OF = ["F32", "T12"]


@pytest.fixture(autouse=True)
def in_python(monkeypatch):
    """Kernels, never numpy, but uncompiled."""

    def kernel(source: str, *_):
        namespace = vars(reduce) | EVERY | {"number": np.float64, "math": math}
        namespace |= {"in_vectors": whole_row, "in_stages": whole_rows, "places": Waiting, "memory": Waiting}
        namespace["vectorised"] = lambda function: function
        exec(source, namespace)
        return namespace["kernel"]

    monkeypatch.setattr(run, "compiled", kernel)
    monkeypatch.setattr(run, "fits_side_by_side", lambda fused: False)  # its loops over vectors are no Python
    monkeypatch.setattr(run, "COMPILE_AFTER", -1)
    monkeypatch.setattr(laid_out, "INTERPRETED_DESIGNS", math.inf)
    for made in (run.runner, laid_out.evaluators_of):
        made.cache_clear()
    yield
    for made in (run.runner, laid_out.evaluators_of):
        made.cache_clear()


def whole_row(first, last, samples):
    return [slice(first, last)]


def whole_rows(first, last, samples, stages):
    """The row goes through all stages, after rows that were never begun."""
    return [whole_row(first, last, samples) * stages] * stages


class Waiting(dict):
    """Numbers that wait, all of the same row; NaN of rows that were never begun."""

    def __init__(self, *sizes):
        super().__init__()

    def __getitem__(self, place):
        return self.get(place[0] if isinstance(place, tuple) else place, math.nan)


def over(random, sizes: dict[str, int]) -> xr.DataArray:
    return xr.DataArray(random.uniform(0.5, 1.0, list(sizes.values())), dims=list(sizes))


def scene(random, speeds: dict[str, int], masses: dict[str, int]) -> ls.Scene:
    coupler = ls.Link(0.22, over(random, masses), 2e-3, 0.11)
    mechanism = replace(PRESS.mechanism, coupler=coupler)
    return replace(PRESS, mechanism=mechanism, omega2=30.0 * over(random, speeds))


def results(of: ls.Scene) -> list[xr.Dataset]:
    return [ls.sweep(of, 12, of=OF), ls.peaks(of, of=OF), ls.peaks(of, of=OF, theta2=12)]


@pytest.mark.parametrize("count", [18, 19, 20, 30])
def test_so_many_dims(count):
    """Designs in a row have the same bits."""
    sizes = dict.fromkeys((f"d{k}" for k in range(count)), 1) | {"d0": 2, "d16": 2, f"d{count - 1}": 3}
    many = scene(np.random.default_rng(1), sizes, {"d0": 2})
    speeds, coupler = many.omega2, many.mechanism.coupler
    row_coupler = replace(coupler, mass=in_a_row(coupler.mass, speeds))
    row = replace(many, mechanism=replace(many.mechanism, coupler=row_coupler), omega2=in_a_row(speeds, speeds))
    for result, expected in zip(results(many), results(row), strict=True):
        for name, values in expected.data_vars.items():
            if "row" in values.dims:
                wide = in_a_row(result[name], speeds)
                np.testing.assert_array_equal(wide, values.transpose("row", ...), err_msg=name)


def in_a_row(values: xr.DataArray, designs: xr.DataArray) -> xr.DataArray:
    """All designs along one dim, in the order of these."""
    wide = values.broadcast_like(designs).transpose(*designs.dims, ...)
    rest = wide.dims[designs.ndim :]
    return xr.DataArray(wide.values.reshape(designs.size, *(wide.sizes[dim] for dim in rest)), dims=("row", *rest))


@pytest.mark.parametrize("deepest", [1, 2, 3])
@pytest.mark.parametrize(
    ("speeds", "masses"),
    [({"a": 2, "b": 3, "c": 2}, {"d": 2, "b": 3}), ({"a": 2, "b": 2}, {"c": 3, "d": 2}), ({"a": 2}, {"a": 2, "b": 3})],
)
def test_folded_and_nested_loops_give_the_same_bits(deepest, speeds, masses, monkeypatch):
    of = scene(np.random.default_rng(2), speeds, masses)
    nested = results(of)
    monkeypatch.setattr(writer, "DEEPEST", deepest)
    run.runner.cache_clear(), laid_out.evaluators_of.cache_clear()
    for result, expected in zip(results(of), nested, strict=True):
        xr.testing.assert_identical(result, expected)
