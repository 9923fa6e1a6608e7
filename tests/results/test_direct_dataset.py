"""Datasets made by xarray's shortcut are those of its public constructor."""

import pickle

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.results import direct_dataset

STEEL = {"width": 0.02, "thickness": 0.02, "density": 7750.0}
LENGTHS = xr.DataArray([0.21, 0.22, 0.23], {"design": ["x", "y", "z"]}, "design")


def press(coupler=0.22, **options):
    bars = [ls.Bar(length, **STEEL) for length in (0.08, coupler, 0.18)]
    return ls.Scene(ls.FourBar(*bars, ground=0.20, **options), 30.0, gravity=(0.0, -9.81))


OVER_ANGLE = ls.Load("rocker", torque=lambda theta2: np.sin(np.radians(theta2)))
SCENES = {
    "one design": press(),
    "labelled designs": press(LENGTHS),
    "designs without labels": press(LENGTHS.drop_vars("design")),
    "two dims, one of texts": press(LENGTHS.rename(design="coupler"), branch="both"),
    "an array without dims": press(xr.DataArray(0.22)),
    "times": press(LENGTHS.assign_coords(design=np.array(["2026-01-01", "2026-01-02", "2026-01-03"], "M8[ns]"))),
    "omega2 over its own dim": ls.Scene(press().mechanism, xr.DataArray([20.0, 30.0], dims="omega2")),
    "a load over the angle": ls.Scene(press().mechanism, 30.0, loads=[OVER_ANGLE]),
    "partial turns": press(0.05),
    "a loop": ls.example("loop"),
    "a linkage": ls.example("watt-1"),
}
RESULTS = {
    "sweep": lambda scene: ls.sweep(scene, 12),
    "subset": lambda scene: ls.sweep(scene, [90.0, 10.0], of="status"),
    "peaks": ls.peaks,
    "largest samples": lambda scene: ls.peaks(scene, theta2=12) if "crank" in str(scene) else ls.peaks(scene, theta=12),
}


def both(monkeypatch, result, scene) -> tuple[xr.Dataset, xr.Dataset]:
    """Return a result made by the shortcut, and by the public constructor."""
    assert direct_dataset._constructor() is direct_dataset.direct
    made = result(scene)
    monkeypatch.setattr(direct_dataset, "_constructor", lambda: direct_dataset.public)
    return made, result(scene)


@pytest.mark.parametrize("result", RESULTS.values(), ids=RESULTS)
@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_datasets_are_those_of_the_public_constructor(scene, result, monkeypatch, tmp_path):
    made, expected = both(monkeypatch, result, scene)
    xr.testing.assert_identical(made, expected)
    assert [*made.variables] == [*expected.variables] and [*made.coords] == [*expected.coords]
    assert [*made.sizes.items()] == [*expected.sizes.items()] and made.encoding == expected.encoding
    for name, variable in expected.variables.items():
        same = made.variables[name]
        assert (type(same), same.dtype, same.dims) == (type(variable), variable.dtype, variable.dims)
        assert same.encoding == variable.encoding and [*same.attrs] == [*variable.attrs]
    assert made.xindexes.keys() == expected.xindexes.keys()
    for dim, index in expected.xindexes.items():
        assert type(made.xindexes[dim]) is type(index) and made.xindexes[dim].equals(index)
        assert made.xindexes[dim].coord_dtype == index.coord_dtype
        assert made.indexes[dim].name == expected.indexes[dim].name == dim
    xr.testing.assert_identical(pickle.loads(pickle.dumps(made)), expected)
    files = [tmp_path / "made.nc", tmp_path / "expected.nc"]
    made.to_netcdf(files[0]), expected.to_netcdf(files[1])
    assert files[0].read_bytes() == files[1].read_bytes()


def test_a_dataset_can_be_changed_without_changing_the_scene_or_another_dataset():
    scene = press(LENGTHS)
    first, second, kept = ls.sweep(scene, 4), ls.sweep(scene, 4), ls.sweep(scene, 4).copy(deep=True)
    for variable in first.variables.values():
        variable.attrs["units"] = "furlong"
        variable.encoding["dtype"] = "float32"
    first.attrs.clear()
    first["F32"] += 1.0
    first["more"] = first.T12 * 2.0
    xr.testing.assert_identical(second, kept)
    xr.testing.assert_identical(ls.sweep(scene, 4), kept)
    assert all(not variable.encoding for variable in second.variables.values())
    assert second.xindexes["theta2"] is ls.sweep(scene, 4).xindexes["theta2"]  # one for all grids of this count


@pytest.mark.parametrize("field", ["_dims", "_data", "_attrs", "_encoding"])
def test_where_variables_have_other_fields_the_public_constructor_is_called(field, monkeypatch):
    make = direct_dataset._direct_variable

    def other(dims, values, attributes):
        made = make(dims, values, attributes)
        delattr(made, field)
        return made

    monkeypatch.setattr(direct_dataset, "_direct_variable", other)
    assert direct_dataset._constructor.__wrapped__() is direct_dataset.public


@pytest.mark.parametrize("broken", [AttributeError, TypeError])
def test_where_the_shortcut_is_missing_the_public_constructor_is_called(broken, monkeypatch):
    def refused(*arguments, **options):
        raise broken("another xarray")

    monkeypatch.setattr(xr.Dataset, "_construct_direct", refused)
    assert direct_dataset._constructor.__wrapped__() is direct_dataset.public


def test_where_the_shortcut_makes_another_dataset_the_public_constructor_is_called(monkeypatch):
    make = xr.Dataset._construct_direct
    monkeypatch.setattr(xr.Dataset, "_construct_direct", lambda every, names, *rest: make(every, set(), *rest))
    assert direct_dataset._constructor.__wrapped__() is direct_dataset.public
