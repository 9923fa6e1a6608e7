"""pareto: against its definition, design by design, on small sets; left-out designs, names, dims, scenes."""

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.results.front import BATCH, front

PRESS = ls.example("press")


def dominated(costs: np.ndarray) -> np.ndarray:
    """Return where another design is nowhere worse and somewhere better: the definition."""
    return np.array([(np.all(costs <= row, axis=1) & np.any(costs < row, axis=1)).any() for row in costs])


def study(n=24, **more) -> xr.Dataset:
    may_be = {"coupler.length": (0.2, 0.24), "rocker.length": (0.15, 0.2), **more}
    return ls.peaks(ls.sample(PRESS, may_be, n=n), of=["F32", "T12"], theta2=36)


@pytest.mark.parametrize("objectives", [1, 2, 3, 4, 6])
@pytest.mark.parametrize("n", [1, 2, 7, 60, 5 * BATCH])
def test_the_front_holds_the_designs_that_none_dominates(n, objectives):
    random = np.random.default_rng(n * 10 + objectives)
    for costs in (random.random((n, objectives)), random.integers(0, 4, (n, objectives)).astype(float)):
        chosen = front(costs)
        assert sorted(chosen) == np.flatnonzero(~dominated(costs)).tolist()
        assert [tuple(row) for row in costs[chosen]] == sorted(tuple(row) for row in costs[chosen])


@pytest.mark.parametrize("objectives", [3, 4])
def test_the_front_of_designs_that_are_equal_in_some_objectives(objectives):
    """In the last objective each is bought by the others, so that many are on the front."""
    random = np.random.default_rng(objectives)
    for n in range(10, 100):
        costs = random.integers(0, 5, (n, objectives)).astype(float)
        costs[:, -1] = random.integers(0, 3, n) - costs[:, :-1].sum(axis=1)
        assert sorted(front(costs)) == np.flatnonzero(~dominated(costs)).tolist()


def test_every_design_may_be_on_the_front():
    """On a circle and a sphere no point dominates another; on a line the first dominates all."""
    angle = np.linspace(0.1, 1.4, 500)
    assert len(front(np.stack([np.cos(angle), np.sin(angle)], axis=-1))) == 500
    points = np.abs(np.random.default_rng(1).normal(size=(500, 3)))
    assert len(front(points / np.linalg.norm(points, axis=1, keepdims=True))) == 500
    assert front(np.stack([angle, angle, angle], axis=-1)).tolist() == [0]


def test_equal_designs_stay_on_the_front():
    assert front(np.array([[1.0, 2.0], [2.0, 1.0], [1.0, 2.0], [2.0, 2.0]])).tolist() == [0, 2, 1]
    assert front(np.array([[3.0], [1.0], [1.0]])).tolist() == [1, 2]


def test_a_study_minimized_and_maximized():
    designs = study()
    chosen = ls.pareto(designs, minimize=["F32_peak"], maximize=["coupler.length"])
    costs = np.stack([designs.F32_peak.values, -designs["coupler.length"].values], axis=-1)
    assert sorted(chosen.design.values) == np.flatnonzero(~dominated(costs)).tolist()
    assert (chosen.F32_peak.diff("design") >= 0).all()
    same = designs.sel(design=chosen.design.values)
    xr.testing.assert_identical(chosen, same.assign_attrs(minimize="F32_peak", maximize="coupler.length"))


def test_one_objective_gives_the_best_design():
    designs = study()
    assert float(ls.pareto(designs, maximize="F32_peak").F32_peak.item()) == float(designs.F32_peak.max())


@pytest.mark.parametrize("dtype", [np.uint8, np.uint64, np.int8])
def test_whole_numbers_are_maximized_as_numbers(dtype):
    score = np.array([3, np.iinfo(dtype).min, 9, 5], dtype=dtype)
    designs = study(n=4).assign(score=("design", score))
    assert ls.pareto(designs, maximize="score").score.values.tolist() == [9]


def test_designs_that_are_not_ok_or_not_finite_are_never_on_the_front():
    designs = study()
    order = designs.F32_peak.argsort().values
    designs.F32_peak[order[0]] = np.nan
    designs.T12_peak[order[1]] = np.inf
    designs.F32_peak[order[2]] = -np.inf
    designs.status[order[3]] = 3
    designs.status[order[4]] = 2
    best = ls.pareto(designs, minimize=["F32_peak"])
    assert best.design.values.tolist() == [order[1]]
    both = ls.pareto(designs, minimize=["F32_peak"], maximize=["T12_peak"])
    assert not set(both.design.values) & set(order[:5])


def test_a_study_without_an_ok_design_has_an_empty_front():
    designs = study(n=4)
    designs["status"][:] = 2
    assert ls.pareto(designs, minimize=["F32_peak"]).sizes["design"] == 0


def test_machines_with_partial_revolutions_are_compared_by_their_peaks():
    designs = study()
    first = int(designs.F32_peak.values.argmin())
    designs.status[first] = 1
    assert ls.pareto(designs, minimize="F32_peak").design.values.tolist() == [first]
    designs.status.attrs["flag_meanings"] = "ok partial_lap never_on_track"  # a car that has left its track
    assert first not in ls.pareto(designs, minimize="F32_peak").design
    del designs.status.attrs["flag_meanings"]
    assert first not in ls.pareto(designs, minimize="F32_peak").design


def test_rockers_are_compared_by_their_swing():
    links = (ls.Link(length, 1.0, 1e-3) for length in (0.3, 0.25, 0.2))
    swings = ls.FourBar(*links, ground=xr.DataArray([0.4, 0.5, 0.6], dims="design"))
    peaks = ls.peaks(ls.Scene(swings, omega2=10.0), of=["theta4"])
    assert peaks.status.values.tolist() == [1, 1, 1]
    best = int(peaks.theta4_max.values.argmin())
    assert ls.pareto(peaks, minimize="theta4_max").design.values.tolist() == [best]


def test_partial_revolutions_of_a_real_study_are_left_out():
    designs = study(n=64, ground=(0.1, 0.3))
    assert 0 < int((designs.status == 0).sum()) < 64
    chosen = ls.pareto(designs, minimize=["F32_peak", "T12_peak"])
    assert chosen.sizes["design"] > 0 and (chosen.status == 0).all()


def grid() -> xr.Dataset:
    length = xr.DataArray([0.2, 0.22, 0.24], {"length": [0.2, 0.22, 0.24]}, "length")
    scene = ls.sample(PRESS, {"omega2": (20, 30)}, n=4)
    mechanism = ls.FourBar(
        PRESS.mechanism.crank, ls.Bar(length, 0.02, 0.02, 7750.0), PRESS.mechanism.rocker, 0.2, branch="both"
    )
    return ls.peaks(ls.Scene(mechanism, scene.omega2, loads=PRESS.loads), of=["F32", "T12"], theta2=36)


def test_several_dims_are_stacked_along_the_front_and_each_point_is_a_scene(tmp_path):
    designs = grid()
    assert dict(designs.sizes) == {"branch": 2, "design": 4, "length": 3}
    chosen = ls.pareto(designs, minimize=["F32_peak"], maximize=["T12_min", "omega2"])
    assert set(chosen.F32_peak.dims) == {"front"} and chosen.sizes["front"] > 1
    many = designs.broadcast_like(designs.F32_peak).stack(all=("branch", "design", "length"))
    costs = np.stack([many.F32_peak, -many.T12_min, -many.omega2], axis=-1)
    expected = {(b, int(d), float(n)) for b, d, n in many.isel(all=~dominated(costs))["all"].values}
    rows = [chosen.isel(front=k) for k in range(chosen.sizes["front"])]
    assert {(str(f.branch.item()), int(f.design), float(f.length)) for f in rows} == expected
    ls.save(chosen, tmp_path / "front.nc")
    with xr.open_dataset(tmp_path / "front.nc") as again:
        for k in range(chosen.sizes["front"]):
            worst = ls.peaks(ls.scene_at(again, front=k), of=["F32", "T12"], theta2=36)
            assert float(worst.F32_peak) == float(chosen.F32_peak[k])
            assert float(worst.T12_min) == float(chosen.T12_min[k])


def test_dims_without_labels_get_their_positions():
    torque = xr.DataArray([-3.0, -12.0, -1.0], dims="case")
    peaks = ls.peaks(ls.Scene(PRESS.mechanism, 30.0, loads=[ls.Load("rocker", torque=torque)]), of=["F14"], theta2=36)
    best = ls.pareto(peaks, minimize=["F14_peak"])
    assert best.case.values.tolist() == [int(peaks.F14_peak.argmin("case"))]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({}, "minimize: is empty; give names of variables"),
        ({"minimize": ["F32_peek"]}, "minimize: nothing is named 'F32_peek'; did you mean \"F32_peak\"?"),
        ({"maximize": ["design_"]}, "maximize: nothing is named 'design_'; did you mean \"design\"?"),
        ({"minimize": 3}, "minimize = 3: must be names"),
    ],
)
def test_refused_objectives(words, message):
    with pytest.raises(ValueError) as error:  # noqa: PT011
        ls.pareto(study(n=4), **words)
    assert str(error.value).startswith(message)


def test_a_dataset_that_is_not_a_study_is_refused():
    with pytest.raises(ValueError, match="ds holds one design: there is nothing to choose from"):
        ls.pareto(ls.peaks(PRESS, of=["F32"], theta2=8), minimize=["F32_peak"])
    with pytest.raises(ValueError, match=r"ds = 3: must be a Dataset, as from ls.peaks of several designs"):
        ls.pareto(3, minimize=["F32_peak"])
    cycle = ls.sweep(ls.sample(PRESS, {"omega2": (20, 30)}, n=4), theta2=8, of=["F32"])
    with pytest.raises(ValueError, match=r"minimize: F32 depends on theta2, and must not; ls\.peaks"):
        ls.pareto(cycle, minimize=["F32"])
    both = ls.peaks(ls.Scene(ls.FourBar(*(ls.Link(x, 1.0, 0.0) for x in (1, 3, 3)), 3.0, branch="both"), 1.0))
    with pytest.raises(ValueError, match="minimize: branch holds <U7 values, which must be numbers"):
        ls.pareto(both, minimize=["branch"])
