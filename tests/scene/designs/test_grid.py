"""`ls.grid`: every combination of values, along dims of the parameters' names."""

from dataclasses import replace
from itertools import product

import numpy as np
import pint
import pytest
import xarray as xr

import linksweep as ls

PRESS, CAR = ls.example("press"), ls.example("loop")


def test_every_combination_is_the_design_with_these_numbers():
    lengths, pulls = [0.20, 0.22, 0.24], [-80.0, 0.0]
    designs = ls.grid(PRESS, {"coupler.length": lengths, "loads[1].force[2]": pulls})
    peaks = ls.peaks(designs, of=["F32", "T12"])
    assert dict(peaks.T12_max.sizes) == {"coupler.length": 3, "loads[1].force[2]": 2}
    for length, pull in product(lengths, pulls):
        coupler = replace(PRESS.mechanism.coupler, length=length)
        first, *others = PRESS.loads
        loads = [replace(first, force=(first.force[0], pull)), *others]
        alone = ls.peaks(
            replace(PRESS, mechanism=replace(PRESS.mechanism, coupler=coupler), loads=loads), of=["F32", "T12"]
        )
        one = peaks.sel({"coupler.length": length, "loads[1].force[2]": pull})
        assert [float(one[name]) for name in alone] == [float(alone[name]) for name in alone]


UNITS = pint.UnitRegistry()


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        (["20 cm", 0.21, "8 in"], [0.20, 0.21, 0.2032]),
        (("20 cm", "23 cm", 4), [0.20, 0.21, 0.22, 0.23]),
        ((0.06, 0.09, 4), [0.06, 0.07, 0.08, 0.09]),
        (np.array([0.2, 0.25]), [0.2, 0.25]),
        (np.array([20.0, 25.0]) * UNITS.cm, [0.2, 0.25]),
        (("30 cm", "30 cm", 1), [0.3]),
        (range(1, 3), [1.0, 2.0]),
    ],
)  # fmt: skip
def test_values_are_listed_spaced_or_with_units(values, expected):
    designs = ls.grid(PRESS, {"coupler.length": values})
    length = designs.mechanism.coupler.length
    assert length.dims == ("coupler.length",)
    assert length.values.tolist() == length["coupler.length"].values.tolist() == expected


def test_a_data_array_keeps_its_dims_so_that_two_may_vary_together():
    crank = xr.DataArray([0.07, 0.08], {"size": ["small", "large"]}, "size")
    designs = ls.grid(PRESS, {"crank.length": crank, "coupler.length": 2.5 * crank, "omega2": ["100 rpm", "200 rpm"]})
    peaks = ls.peaks(designs, of=["F32"], theta2=36)
    assert dict(peaks.F32_peak.sizes) == {"size": 2, "omega2": 2}
    assert peaks.F32_peak.sel(size="small").omega2.values.tolist() == pytest.approx([10.471975511966, 20.943951023932])


def test_grids_of_a_grid_and_of_a_sample_have_the_dims_of_both():
    once = ls.grid(PRESS, {"omega2": [10.0, 20.0]})
    twice = ls.grid(once, {"ground": [0.19, 0.20, 0.21]})
    assert dict(ls.peaks(twice, of=["F32"], theta2=36).F32_peak.sizes) == {"ground": 3, "omega2": 2}
    assert ls.grid(once, {"omega2": [5.0]}).omega2.values.tolist() == [5.0]
    drawn = ls.grid(ls.sample(PRESS, {"ground": (0.19, 0.21)}, n=4), {"omega2": [10.0, 20.0]})
    assert dict(ls.peaks(drawn, of=["F32"], theta2=36).F32_peak.sizes) == {"design": 4, "omega2": 2}


def test_results_with_the_name_of_a_dim_are_its_labels():
    """The speed of a press is its own result; that of a car in a loop is another."""
    cycle = ls.sweep(ls.grid(PRESS, {"omega2": [10.0, 20.0]}), 4, of=["omega2", "F32"])
    assert cycle.omega2.dims == ("omega2",) and "omega2" in cycle.indexes and "omega2" not in cycle.data_vars
    cars = ls.sweep(ls.grid(CAR, {"speed": [90.0, 100.0], "thrust": [0.0, 1e4]}), 4)
    assert dict(cars.a_tangential.sizes) == {"speed_set": 2, "thrust": 2, "theta": 4}
    assert cars.speed_set.values.tolist() == [90.0, 100.0]


def test_a_grid_is_stored_and_found_again(tmp_path):
    designs = ls.grid(PRESS, {"coupler.length": ("20 cm", "24 cm", 3), "gravity[2]": [-9.81, 0.0]})
    with ls.study(designs, tmp_path / "study.nc", of=["F32"]) as ds:
        assert ls.load_scene(tmp_path / "study.nc") == designs
        one = ls.scene_at(ds, {"coupler.length": 0.22, "gravity[2]": 0.0})
    assert (one.mechanism.coupler.length, one.gravity) == (0.22, (0.0, 0.0))
    ls.save(designs, tmp_path / "scene.toml")
    assert ls.load_scene(tmp_path / "scene.toml") == designs


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({}, "parameters = {}: must name what varies"),
        ({"coupler.lenth": [1.0]}, "parameters: nothing is named 'coupler.lenth'; did you mean \"coupler.length\"?"),
        ({"coupler": [0.2]}, "parameters: nothing is named 'coupler'; did you mean \"coupler.length\"?"),
        ({"ground.length": [0.2]}, "parameters: nothing is named 'ground.length'; did you mean \"ground\"?"),
        ({"ground": 0.2}, "ground: 0.2: must be a list of values, a range (low, high, count), or a DataArray"),
        ({"ground": "20 cm"}, "ground: '20 cm': must be a list"),
        ({"ground": []}, r"ground: []: must be a list"),
        ({"ground": np.ones((2, 2))}, "ground: array([[1., 1.], [1., 1.]]): must be a list"),
        ({"ground": (0.19, 0.21)}, "ground: (0.19, 0.21): must be a range (low, high, count); a list [...] holds"),
        ({"ground": (0.19, 0.21, 0)}, "ground: count = 0: must be a whole number, 1 or more"),
        ({"ground": (0.19, 0.21, None)}, "ground: count is missing: give how many values"),
        ({"ground": (0.19, 0.21, 1)}, "ground: (0.19, 0.21, 1): two ends need a count of at least 2; a list"),
        ({"ground": ["20 kg"]}, 'ground: "20 kg": kg is a unit of mass, not of length'),
        ({"ground": [0.2, 0.21, 0.2]}, "ground: has 0.2 more than once: give each value once"),
        ({"ground": xr.DataArray(0.2)}, "ground: is one number: give it to the scene itself, or a DataArray"),
        ({"ground": [0.2, -0.2]}, "ground = -0.2 m at ground = -0.2: must be greater than 0"),
        ({"ground": [0.2, np.nan]}, "ground: nan: must be a finite number"),
    ],
)
def test_what_is_no_grid_is_refused(parameters, message):
    with pytest.raises(ValueError, match=r".") as refused:
        ls.grid(PRESS, parameters)
    assert str(refused.value).startswith(message)


def test_all_problems_are_told_at_once():
    with pytest.raises(ValueError, match=r"^ground: 0.2: .*\nomega2: \[\]: must"):
        ls.grid(PRESS, {"ground": 0.2, "omega2": []})
    with pytest.raises(ValueError, match=r"^scene is a FourBar: must be a Scene"):
        ls.grid(PRESS.mechanism, {"ground": [0.2]})


def test_a_number_of_a_grid_that_is_drawn_again_is_told_why_not():
    lengths = {"coupler.length": [0.2, 0.22]}
    around = {"coupler.length": ls.Tolerance(-1e-4, 1e-4)}
    with pytest.raises(ValueError, match=r"^coupler.length has dimensions .*of its own name it has no other"):
        ls.tolerance(ls.grid(PRESS, lengths), around, of="F32_peak", n=8)
    coupler = replace(PRESS.mechanism.coupler, length=xr.DataArray(lengths["coupler.length"], dims="k"))
    by_hand = replace(PRESS, mechanism=replace(PRESS.mechanism, coupler=coupler))  # as the message says
    assert ls.tolerance(by_hand, around, of="F32_peak", n=8).F32_peak_sigma.dims == ("k",)
