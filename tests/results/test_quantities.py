"""Every listed quantity can be computed, over the dims and in the units that the list states."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.engine.trace.plan import plan

PRESS = ls.example("press")
OF_SAMPLES = {"cond", "status", "status_at"}
"""Quantities that have no peaks."""
NAMES = ("press", "engine", "quick-return", "loop", "watt-1", "jansen-leg")
"""Examples with all kinds of quantities; tests/scene/test_machines.py sweeps the others."""
MASSES = xr.DataArray([0.5, 0.7, 0.9], dims="mass")
WEIGHTY = ls.Link(0.22, MASSES, 2.8e-3, cg_distance=0.11)
PUSHES = xr.DataArray([[10.0, 20.0]] * 8, dims=("theta2", "push"))
SCENES = {
    **{name: ls.example(name) for name in NAMES},
    "both branches": replace(PRESS, mechanism=replace(PRESS.mechanism, branch="both")),
    "many masses": replace(PRESS, mechanism=replace(PRESS.mechanism, coupler=WEIGHTY)),
    "driven by its rocker": replace(PRESS, drive="rocker"),
    "speed over the angle": replace(PRESS, omega2=lambda theta2: 30.0 + np.cos(np.radians(theta2))),
    "load of samples": replace(PRESS, loads=[ls.Load("rocker", torque=PUSHES)]),
    "many loops": ls.Scene(ls.LoopTrack(30.0, xr.DataArray([700.0, 800.0], dims="car")), speed=100.0),
}


@pytest.mark.parametrize("scene", SCENES.values(), ids=list(SCENES))
def test_each_quantity_listed_is_swept_as_it_says(scene):
    table = ls.quantities(scene)
    cycle = ls.sweep(scene, 8, of=table.names)
    swept = {
        name: (v.dims, v.attrs.get("units", "1"), v.attrs["long_name"])
        for name, v in cycle.variables.items()
        if name in table
    }
    assert swept == {row.name: (row.dims, row.units, row.long_name) for row in table}


@pytest.mark.parametrize("scene", SCENES.values(), ids=list(SCENES))
def test_a_default_sweep_has_what_is_marked_so(scene):
    assert {row.name for row in ls.quantities(scene) if row.default} == {*ls.sweep(scene, 8).data_vars}


@pytest.mark.parametrize("name", NAMES)
def test_peaks_have_all_but_cond_and_status(name):
    scene = ls.example(name)
    names = ls.quantities(scene).names
    listed = [name for name in names if name not in OF_SAMPLES]
    peaks = ls.peaks(scene, of=listed, **{scene.mechanism.index: 8})
    assert {str(n).removesuffix("_peak") for n in peaks if str(n).endswith("_peak")} == {*listed}
    for other in OF_SAMPLES & {*names}:
        with pytest.raises(ValueError, match=f"nothing is named '{other}'"):
            ls.peaks(scene, of=other)


@pytest.mark.parametrize("name", ["engine", "watt-2"])
def test_all_quantities_are_planned_together(name):
    """A plan for each took 10 s for the 164 quantities of a Watt six-bar, where one takes 0.5 s."""
    scene = ls.example(name)
    names = [name for name in ls.quantities(scene).names if name not in OF_SAMPLES]

    def plans(names):
        plan.cache_clear()
        ls.peaks(scene, of=names, theta2=8)
        return plan.cache_info().misses

    assert len(names) > 80 and plans(names) == plans(names[:4])


def test_a_variable_has_only_the_dims_that_it_depends_on():
    table = ls.quantities(SCENES["many masses"])
    assert table["theta3"].dims == ("theta2",)  # of lengths and the angle alone
    assert table["F32"].dims == ("mass", "theta2")
    assert table["omega2"].dims == ()
    assert ls.quantities(SCENES["both branches"])["theta3"].dims == ("branch", "theta2")


def test_reactions_are_listed_beside_what_they_oppose():
    table = ls.quantities(PRESS)
    assert {"F12", "F21", "F32", "F23", "F43", "F34", "F14", "F41"} <= {*table.names}
    assert "T13" not in table and "T13" in ls.quantities(replace(PRESS, drive="coupler"))


def test_nothing_is_computed_of_lazy_numbers():
    dask = pytest.importorskip("dask.array")

    def never(block):
        raise AssertionError("computed")

    masses = xr.DataArray(dask.ones(5, chunks=5).map_blocks(never, dtype=float, meta=np.ones(0)), dims="mass")
    lazy = replace(PRESS, mechanism=replace(PRESS.mechanism, coupler=replace(WEIGHTY, mass=masses)))
    assert ls.quantities(lazy).names == ls.quantities(SCENES["many masses"]).names
    assert ls.quantities(lazy)["T12"].dims == ("mass", "theta2")


def test_search_takes_all_words_in_any_case():
    assert ls.quantities(PRESS, "SHAKING force").names == ("Fsx", "Fsy", "Fs")
    assert ls.quantities(PRESS, "N m drive link").names == ("T12",)
    assert len(ls.quantities(PRESS, "no such thing")) == 0


def test_a_table_is_a_sequence_with_names():
    table = ls.quantities(PRESS)
    assert table[0] == table[table.names[0]] == next(iter(table))
    assert table[:2].names == table.names[:2]
    assert "F32" in table and table["F32"] in table and "F33" not in table and 7 not in table
    assert len(table) == len({*table.names})
    with pytest.raises(ValueError, match="quantity: nothing is named 'F33'; did you mean"):
        table["F33"]
    with pytest.raises(ValueError, match="scene is a FourBar: must be a Scene"):
        ls.quantities(PRESS.mechanism)


def test_a_table_shows_as_text_html_and_dataframe():
    table = ls.quantities(PRESS, "mechanical advantage")
    header, line = repr(table).splitlines()
    assert header.split() == ["name", "unit", "dims", "default", "meaning"]
    assert line.startswith("mechanical_advantage  1     theta2") and line.index("theta2") == header.index("dims")
    made = ls.QuantityTable((replace(table[0], long_name="a < b & c"),))._repr_html_()
    assert "<th>unit</th>" in made and "<td>mechanical_advantage</td><td>1</td>" in made
    assert "<td>a &lt; b &amp; c</td>" in made
    frame = ls.quantities(PRESS).to_pandas()
    assert frame.loc["F32x", "units"] == "N" and frame.loc["F32x", "default"] and not frame.loc["F23x", "default"]
