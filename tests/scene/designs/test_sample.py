"""sample draws even, normal and repeatable designs; scene_at selects one of them."""

import math
import re
import warnings
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from refusals import SCENE

import linksweep as ls
from linksweep.base.fields import numbers
from linksweep.scene.designs.sampling import METHODS
from linksweep.scene.parameters import replaced

PRESS = ls.example("press")
RANGE = {"coupler.length": (0.2, 0.24)}
EVEN = [method for method in METHODS if method != "random"]


def drawn(distribution, n=4096, path="coupler.length", scene=PRESS, **options) -> np.ndarray:
    return ls.sample(scene, {path: distribution}, n=n, **options).arrays[path].values


def refused(*arguments, **options) -> list[str]:
    with pytest.raises(ValueError) as error:  # noqa: PT011
        ls.sample(*arguments, **options)
    return str(error.value).split("\n")


@pytest.mark.parametrize("name", ["press", "engine", "quick-return", "loop"])
def test_every_number_can_be_replaced_by_its_path_and_nothing_else_changes(name):
    scene = ls.example(name)
    for path, value, kind in numbers(scene):
        if isinstance(value, float) and kind:
            other = replaced(scene, {path: value * 1.001 + 1e-9})
            result = {at: number for at, number, _ in numbers(other)}
            assert result.pop(path) == value * 1.001 + 1e-9
            assert result == {at: number for at, number, _ in numbers(scene) if at != path}
    assert replaced(scene, {}) is scene


def test_paths_reach_links_loads_springs_and_cycles():
    spring = ls.Spring(("ground", 0.3, 0.1), ("rocker", 0.1, 15.0), rate=10.0, free_length=0.1)
    scene = replaced(ls.Scene(SCENE.mechanism, omega2=30.0, loads=[spring]), {"loads[1].to[3]": 20.0})
    assert scene.loads[0].to == ("rocker", 0.1, 20.0)
    kinds = {path: kind for path, _, kind in numbers(scene)}
    assert [kinds[f"loads[1].from_[{k}]"] for k in (2, 3)] == ["length", "length"]
    assert [kinds[f"loads[1].to[{k}]"] for k in (2, 3)] == ["length", "angle"]
    engine = replaced(ls.example("engine"), {"loads[1].pressure.compression_ratio": 9.0})
    assert engine.loads[0].pressure.compression_ratio == 9.0


def test_several_numbers_are_replaced_together():
    """One at a time, a coupler of 2 m or a ground of 2 m would not close with links of 0.08 and 0.2 m."""
    assert replaced(PRESS, {"coupler.length": 2.0, "ground": 2.0}).mechanism.ground == 2.0
    with pytest.raises(ValueError, match="longer"):
        replaced(PRESS, {"coupler.length": 2.0})


# ------------------------------------------------------------------------------------------------ drawing


@pytest.mark.parametrize("method", METHODS)
def test_a_range_is_drawn_evenly(method):
    values = drawn((0.2, 0.24), method=method)
    assert values.min() > 0.2 and values.max() < 0.24
    assert values.mean() == pytest.approx(0.22, abs=4 * 0.04 / math.sqrt(12 * 4096))
    assert values.std() == pytest.approx(0.04 / math.sqrt(12), rel=0.03)


@pytest.mark.parametrize("method", ["sobol", "latin_hypercube"])
def test_each_of_n_equal_slices_has_one_design(method):
    values = drawn((0.2, 0.24), n=256, method=method)
    slices = np.floor((values - 0.2) / 0.04 * 256).astype(int)
    assert sorted(slices) == list(range(256))


@pytest.mark.parametrize("method", EVEN)
def test_even_designs_estimate_a_mean_much_better_than_chance_does(method):
    values = drawn((0.2, 0.24), n=1000, method=method)
    by_chance = 0.04 / math.sqrt(12 * 1000)
    assert abs(values.mean() - 0.22) < 0.1 * by_chance


@pytest.mark.parametrize("method", METHODS)
def test_parameters_are_independent(method):
    made = ls.sample(PRESS, {**RANGE, "crank.length": (0.07, 0.08), "omega2": (20, 30)}, n=4096, method=method)
    table = np.corrcoef([array.values for array in made.arrays.values()])
    assert np.abs(table - np.eye(3)).max() < 4 / math.sqrt(4096)


@pytest.mark.parametrize("method", METHODS)
def test_a_normal_has_its_mean_deviation_and_tails(method):
    values = drawn(ls.Normal(0.22, 0.002), n=8192, method=method)
    away = (values - 0.22) / 0.002
    assert away.mean() == pytest.approx(0.0, abs=4 / math.sqrt(8192))
    assert away.std() == pytest.approx(1.0, rel=0.03)
    for most in (1.0, 2.0, 3.0):  # of a normal, erf(k/√2) lies within k deviations
        share = math.erf(most / math.sqrt(2.0))
        assert np.mean(abs(away) < most) == pytest.approx(share, abs=4 * math.sqrt(share * (1 - share) / 8192))


def test_a_normal_without_a_mean_uses_the_scenes_own_value():
    assert drawn(ls.Normal(deviation="0.2 mm")) == pytest.approx(drawn(ls.Normal("22 cm", 2e-4)), rel=1e-15)


def test_a_normal_truncated_by_within():
    values = drawn(ls.Normal(0.22, 0.001, within=2))
    assert abs(values - 0.22).max() <= 0.002
    # the variance of a normal cut at ±2: 1 − 2·2φ(2)/(2Φ(2) − 1)
    density = math.exp(-2.0) / math.sqrt(2.0 * math.pi)
    variance = 1.0 - 4.0 * density / math.erf(2.0 / math.sqrt(2.0))
    assert values.std() == pytest.approx(0.001 * math.sqrt(variance), rel=0.01)


def test_a_tolerance_is_uniform_around_the_scenes_own_value():
    values = drawn(ls.Tolerance("-0.1 mm", "0.3 mm"))
    assert 0.2199 < values.min() < 0.21991 and 0.22029 < values.max() < 0.2203
    assert values.mean() == pytest.approx(0.2201, abs=1e-6)


def test_a_tolerance_around_a_value_with_dims():
    lengths = xr.DataArray([0.2, 0.22, 0.24], dims="variant")
    made = ls.sample(replaced(PRESS, {"coupler.length": lengths}), {"coupler.length": ls.Tolerance(-1e-4, 1e-4)}, n=64)
    length = made.mechanism.coupler.length
    assert dict(length.sizes) == {"variant": 3, "design": 64}
    assert float(abs(length - lengths).max()) <= 1e-4


@pytest.mark.parametrize("values", [[100, 150], ["1000 rpm", 100, 150.0], np.array([1.0, 2.0, 3.0, 4.0, 5.0])])
def test_values_of_a_list_are_equally_likely(values):
    levels, counts = np.unique(
        drawn(values if isinstance(values, np.ndarray) else list(values), path="omega2"), return_counts=True
    )
    assert len(levels) == len(values)
    assert counts.max() - counts.min() <= 2  # of 4096, by Sobol


def test_distributions_of_scipy():
    stats = pytest.importorskip("scipy.stats")
    values = drawn(stats.expon(scale=2.0), path="loads[2].torque", n=8192)
    assert values.min() > 0.0
    assert values.mean() == pytest.approx(2.0, rel=0.01)
    assert np.median(values) == pytest.approx(2.0 * math.log(2.0), rel=0.01)
    assert set(drawn(stats.binom(2, 0.5), path="omega2")) == {0.0, 1.0, 2.0}


def test_units_as_in_scene_files():
    values = drawn(("60 deg", "2 rad"), path="loads[1].at[2]")
    assert values.min() > 60.0 and values.max() < math.degrees(2.0)
    assert drawn(("20 cm", 0.24)) == pytest.approx(drawn((0.2, "240 mm")), rel=1e-15)


def test_the_same_seed_gives_the_same_designs():
    for method in METHODS:
        first, again, other = (drawn((0.2, 0.24), n=100, method=method, seed=seed) for seed in (1, 1, 2))
        assert (first == again).all()
        assert not (first == other).any()
    assert not (drawn((0.2, 0.24), n=8, seed=None) == drawn((0.2, 0.24), n=8, seed=None)).any()


@pytest.mark.parametrize("n", [1, 3, 1000, 100_000])
def test_any_number_of_designs_gives_no_warning(n):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        made = ls.sample(PRESS, {**RANGE, "omega2": ls.Normal(30, 1)}, n=n)
    assert made.omega2.shape == (n,)
    assert made.omega2.design.values.tolist() == list(range(n))


def test_a_hundred_thousand_designs_of_three_distributions():
    coupler, rocker = ls.Link(0.22, 0.7, 3e-3, 0.11), ls.Link(0.18, 0.5, 2e-3, 0.09)
    scene = ls.Scene(ls.FourBar(ls.Link(0.08, 0.2, 1e-4), coupler, rocker, 0.2), omega2=100.0)
    may_be = {"coupler.length": (0.1, 0.3), "rocker.cg_angle": ls.Normal(0, 2), "omega2": [100, 150]}
    made = ls.sample(scene, may_be, n=100_000, method="sobol", seed=1)
    assert {path: array.dims for path, array in made.arrays.items()} == dict.fromkeys(may_be, ("design",))
    assert made.mechanism.coupler.length.values.mean() == pytest.approx(0.2, abs=1e-5)
    assert made.mechanism.rocker.cg_angle.values.std() == pytest.approx(2.0, rel=1e-3)
    assert (made.omega2 == 150.0).mean() == pytest.approx(0.5, abs=1e-3)


def test_a_normal_is_finite_where_the_uniform_draw_is_0(monkeypatch):
    """The normal would be −∞ there; it stays within the finest step of Sobol points, 6.2 deviations."""
    zeros = SimpleNamespace(random=np.zeros)
    monkeypatch.setattr(np.random, "default_rng", lambda seed: zeros)
    (value,) = drawn(ls.Normal(0.0, 1.0), n=1, path="omega2", method="random")
    assert 0.5 * math.erfc(-value / math.sqrt(2.0)) == pytest.approx(2.0**-31, rel=1e-6)


def test_fewer_designs_are_the_first_of_more():
    assert (drawn((0.2, 0.24), n=100) == drawn((0.2, 0.24), n=1000)[:100]).all()


def test_derived_numbers_of_a_bar_follow():
    made = ls.sample(PRESS, {"rocker.width": (0.01, 0.03)}, n=16).mechanism.rocker
    expected = [7750.0 * 0.18 * width * 0.02 for width in made.width.values]
    assert made.mass.values == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize(
    ("name", "may_be"),
    [
        ("engine", {"rod.length": (0.14, 0.15), "loads[1].pressure.peak_pressure": ("50 bar", "60 bar")}),
        ("quick-return", {"crank.length": ls.Tolerance(-1e-4, 1e-4), "ground": (0.4, 0.5)}),
        ("loop", {"speed": ("90 km/h", "400 km/h"), "radius": (20, 30), "thrust": [1e4, 2e4]}),
    ],
)
def test_samples_of_every_machine(name, may_be):
    scene = ls.example(name)
    made = ls.sample(scene, may_be, n=4)
    grid = {scene.mechanism.index: 12}
    peaks = ls.peaks(made, **grid)
    assert peaks.status.sizes == {"design": 4} or not peaks.status.dims
    assert set(peaks.coords) >= {"design", *may_be}
    assert equal(ls.peaks(ls.scene_at(peaks, design=3), **grid), peaks.isel(design=3))


@pytest.mark.filterwarnings("ignore::linksweep.OvershootWarning")  # few angles, through a spline all the same
def test_a_tolerance_around_a_load_over_the_angle():
    torque = xr.DataArray([1.0, 2.0, 3.0], {"theta2": [0.0, 120.0, 240.0]}, "theta2")
    scene = replaced(PRESS, {"loads[2].torque": torque})
    made = ls.sample(scene, {"loads[2].torque": ls.Tolerance(-0.5, 0.5)}, n=4)
    offset = made.loads[1].torque - torque
    assert float(offset.max()) <= 0.5 and float(np.ptp(offset.values, axis=0).max()) < 1e-15
    assert equal(ls.sweep(ls.scene_at(made, design=2), theta2=6), ls.sweep(made, theta2=6).isel(design=2))
    (line,) = refused(replaced(PRESS, {"omega2": math.cos}), {"omega2": ls.Normal(deviation=1.0)}, n=4)
    assert line.startswith("omega2: Normal(mean=None, deviation=1.0, within=inf) is around the scene's own value")


def test_dims_of_the_scene_stay_and_another_dim_may_be_named():
    made = ls.sample(ls.sample(PRESS, RANGE, n=4), {"omega2": (20, 30)}, n=3, dim="run", seed=1)
    assert dict(ls.peaks(made, of=["F32"], theta2=8).F32_peak.sizes) == {"design": 4, "run": 3}


# ------------------------------------------------------------------------------------------------ refusals


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"coupler.lenght": (1, 2)}, 'parameters: nothing is named \'coupler.lenght\'; did you mean "coupler.length"?'),
        ({"loads[0].torque": (1, 2)}, "parameters: nothing is named 'loads[0].torque'; did you mean \"loads"),
        ({"coupler.length": (0.3, 0.1)}, "coupler.length: (0.3, 0.1): low must be less than high; swap them"),
        ({"coupler.length": (0.3, 0.3)}, "coupler.length: (0.3, 0.3): low must be less than high; give"),
        ({"coupler.length": (0.3, 0.4, 0.5)}, "coupler.length: (0.3, 0.4, 0.5): must be a range (low, high); a list"),
        ({"coupler.length": ("8 kg", "9 cm")}, 'coupler.length: low = "8 kg": kg is a unit of mass'),
        ({"coupler.length": []}, "coupler.length: []: must be a list of one value or more"),
        ({"coupler.length": [0.1, "x"]}, 'coupler.length: [2] = "x": must be a number'),
        ({"coupler.length": 0.2}, "coupler.length: 0.2: must be a range (low, high), a list"),
        ({"coupler.length": ls.Normal(0.2)}, "coupler.length: deviation = 0.0: must be greater than 0"),
        ({"coupler.length": ls.Normal(0.2, 0.1, within=-1)}, "coupler.length: within = -1: must be greater than 0"),
        ({"coupler.length": ls.Normal("x", 1)}, 'coupler.length: mean = "x": must be a number'),
        ({"coupler.length": ls.Tolerance(1, 0)}, "coupler.length: Tolerance(1, 0): low must be less than high"),
        ({"loads[1].torque": ls.Tolerance(0, 1)}, "loads[1].torque: Tolerance(lower=0, upper=1) is around"),
        ({}, "parameters = {}: must name what varies"),
        (["omega2"], "parameters = ['omega2']: must name what varies"),
        ({"speed": (1, 2)}, "parameters: nothing is named 'speed'"),
    ],
)  # fmt: skip
def test_refused_parameters(parameters, message):
    (line,) = refused(PRESS, parameters, n=8)
    assert line.startswith(message), line


def test_all_problems_at_once():
    assert len(refused(PRESS, {"coupler.length": (2, 1), "omega2": ()}, n=8)) == 2
    lines = refused(PRESS, {"nothing": (1, 2)}, n=0, method="sobel", seed=-1, dim="theta2")
    assert [re.match(r"\w+", line)[0] for line in lines] == ["parameters", "n", "method", "seed", "dim"]
    assert 'did you mean "sobol"' in lines[2]


def test_an_existing_dimension_is_refused():
    made = ls.sample(PRESS, RANGE, n=8)
    (line,) = refused(made, {"omega2": (1, 2)}, n=8)
    assert line.startswith("dim = 'design': the scene has this dimension already; give another name")
    (line,) = refused("press", RANGE, n=8)
    assert line == "scene is a str: must be a Scene"


def test_values_that_the_scene_refuses_are_counted():
    """A normal of mean 2 deviations from 0: 2.3 % lie below."""
    (line,) = refused(PRESS, {"coupler.length": ls.Normal(0.2, 0.1)}, n=1024)
    more = re.match(
        r"coupler\.length = -[\d.]+ m at design = \d+ \(and (\d+) more of 1024\): must be greater than 0; or", line
    )
    assert int(more[1]) + 1 == pytest.approx(1024 * 0.5 * math.erfc(2.0 / math.sqrt(2.0)), abs=2)
    assert line.endswith("or draw from a range (low, high), or from ls.Normal(..., within=3)")


# ------------------------------------------------------------------------------------------------ scene_at

MANY = {
    "coupler.length": (0.2, 0.24),
    "rocker.width": ls.Normal(0.02, 1e-3),
    "omega2": [20.0, 30.0],
    "gravity[2]": (-10, 0),
    "loads[1].at[2]": ls.Tolerance(-5, 5),
}


def equal(one: xr.Dataset, other: xr.Dataset) -> bool:
    assert one.data_vars.keys() == other.data_vars.keys()
    return all(one[name].values.tobytes() == other[name].values.tobytes() for name in one.data_vars)


def test_scene_at_gives_equal_bits():
    made = ls.sample(PRESS, MANY, n=32)
    study, worst = ls.sweep(made, theta2=36), ls.peaks(made, theta2=36)
    for k in (0, 17, 31):
        for scene in (ls.scene_at(made, design=k), ls.scene_at(study, design=k), ls.scene_at(worst, design=k)):
            assert not scene.arrays
            assert equal(ls.sweep(scene, theta2=36), study.isel(design=k))
            assert equal(ls.peaks(scene, theta2=36), worst.isel(design=k))


def test_labels_survive_a_selection_and_a_file(tmp_path):
    made = ls.sample(PRESS, MANY, n=32)
    worst = ls.peaks(made, of=["F32"], theta2=36)
    ls.save(worst.sortby("F32_peak").isel(design=slice(0, 4)), tmp_path / "best.nc")
    with xr.open_dataset(tmp_path / "best.nc") as best:
        for design in best.design:
            assert ls.scene_at(best, design=design) == ls.scene_at(made, design=int(design))
        with pytest.raises(
            ValueError, match=r"design = [\d.]+: must be one of its 4 labels, of which the nearest is \d+"
        ):
            ls.scene_at(best, design=worst.F32_peak.idxmax())


def grid(branch="both") -> ls.Scene:
    crank = xr.DataArray(np.linspace(0.06, 0.09, 4), dims="crank_length")
    crank = crank.assign_coords(crank_length=crank.values)
    mass = xr.DataArray([7000.0, 8000.0], {"steel": ["light", "heavy"]}, "steel")
    torque = xr.DataArray([1.0, 2.0, 3.0], dims="case")
    push = xr.DataArray(np.ones((3, 4)), {"theta2": [0.0, 90.0, 180.0, 270.0]}, ("case", "theta2")) * torque
    scene = replaced(PRESS, {"crank.length": crank, "rocker.density": mass, "branch": branch})
    return replaced(scene, {"loads[2].torque": torque, "loads[1].force[1]": push})


def test_several_dims_by_label_by_number_and_by_position():
    study = ls.peaks(grid(), of=["F32"], theta2=36)
    one = {"branch": "crossed", "crank_length": 0.07, "steel": "heavy", "case": 2}
    for scene in (ls.scene_at(study, one), ls.scene_at(grid(), **one)):
        assert scene.mechanism.branch == "crossed"
        assert scene.mechanism.crank.length == pytest.approx(0.07, rel=1e-15)
        assert scene.mechanism.rocker.density == 8000.0
        assert scene.loads[1].torque == 3.0
        assert scene.loads[0].force[0].values == pytest.approx(3.0, rel=1e-14)
        result = ls.peaks(scene, of=["F32"], theta2=36).F32_peak
        assert float(result) == float(study.F32_peak.sel(branch="crossed", steel="heavy").isel(crank_length=1, case=2))


def test_dims_not_selected_are_kept():
    scene = ls.scene_at(ls.peaks(grid(), of=["F32"], theta2=8), steel="light")
    assert {dim for array in scene.arrays.values() for dim in array.dims} == {"crank_length", "case", "theta2"}
    assert scene.mechanism.branch == "both"


def test_a_design_chosen_by_xarray():
    study = ls.peaks(grid(), of=["F32"], theta2=8)
    chosen = study.sel(branch="open", steel="heavy").isel(crank_length=1)
    one = ls.scene_at(study, branch="open", steel="heavy", crank_length=0.07, case=2)
    assert ls.scene_at(chosen, case=2) == one
    with pytest.raises(ValueError, match=r"case: the Dataset does not say which one it is of; name it here"):
        ls.scene_at(chosen.isel(case=2))


@pytest.mark.parametrize(
    ("where", "message"),
    [
        ({"desing": 1}, "desing = 1: no dim of the designs is 'desing'; did you mean \"design\"?"),
        ({"theta2": 90.0}, "theta2 = 90.0: no dim of the designs is 'theta2'; its dims are design"),
        ({"design": 8}, "design = 8: must be one of its 8 labels, of which the nearest is 7"),
        ({"design": 3.5}, "design = 3.5: must be one of its 8 labels"),
        ({"design": [1, 2]}, "design = [1, 2]: must be one label"),
        ({"design": slice(3)}, "design = slice(None, 3, None): must be one label"),
        ({"design": "best"}, "design = 'best': must be one of its 8 labels, of which the first is 0"),
    ],
)
def test_missing_labels_are_refused(where, message):
    made = ls.sample(PRESS, RANGE, n=8)
    for study in (made, ls.sweep(made, theta2=8, of=["theta4"])):
        with pytest.raises(ValueError) as error:  # noqa: PT011
            ls.scene_at(study, **where)
        assert str(error.value).startswith(message)


def test_a_label_without_its_dim_is_refused():
    with pytest.raises(ValueError, match="where = 17: must name the dim of each label, as in design=17"):
        ls.scene_at(PRESS, 17)


def test_scene_at_refuses_results_without_designs():
    with pytest.raises(ValueError, match="ds = 3: must be a Dataset of linksweep, or a Scene"):
        ls.scene_at(3, design=1)
    with pytest.raises(ValueError, match="holds no scene"):
        ls.scene_at(xr.Dataset(), design=1)
