"""Run time against error: the reference of errors, missing rivals, and the figures."""

import math
from dataclasses import replace

import matplotlib.image
import numpy as np
import oracle
import pytest
from references import LinkData

from benchmarks import __main__ as front_door
from benchmarks import plots
from benchmarks.accuracy import grids, solves, truth
from benchmarks.cases import GENERAL, QUICK
from benchmarks.report import from_json
from benchmarks.rivals import numba_dense, peers
from benchmarks.speed import exact, growth
from benchmarks.timing import FASTER, Row

EPS = 2.0**-52


def oracle_data(q):
    return oracle.FourBarData(
        LinkData(q.a, q.m2, q.I2, q.s, q.delta2),
        LinkData(q.b, q.m3, q.I3, q.p, q.delta3),
        LinkData(q.c, q.m4, q.I4, q.u, q.delta4),
        q.d,
        branch="open" if q.sign > 0 else "crossed",
        omega2=q.omega2,
        alpha2=q.alpha2,
        gravity=(q.gx, q.gy),
    )


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_reference_equals_the_9x9_solution_in_60_digits(sign):
    q, theta2 = replace(GENERAL, sign=sign), np.array([0.0, 33.3, 190.0])
    result = np.concatenate([truth.unknowns(q, theta2), truth.rates(q, theta2)])
    names = ("F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y", "T12", *truth.RATES)
    expected = [[float(oracle.solve(oracle_data(q), angle)[name]) for angle in theta2] for name in names]
    np.testing.assert_allclose(result, expected, rtol=EPS)


def test_true_peaks_are_just_above_many_samples():
    """Samples miss the peaks by (π/20 000)²/2 times their curvature."""
    designs = grids.design(exact.crank_rockers(3, 20.0))
    nine = peers.numpy_lapack(designs, peers.grid(20_000))
    samples = [*np.hypot(nine[0:8:2], nine[1:8:2]).max(axis=-1), np.abs(nine[8]).max(axis=-1)]
    excess = truth.peaks(designs) / samples - 1.0
    assert excess.min() > -1e-14
    assert excess.max() < 1e-6


def test_a_peak_is_located_from_nearby_samples():
    """numpy locates a peak to half of the digits; a ten-thousandth of a degree is further away."""
    designs = grids.design(exact.crank_rockers(3, 20.0))
    tops = truth._tops(designs, *truth._brackets(designs))
    for signal in range(5):
        expected, beside = (truth._parabola(designs, signal, tops[signal] + off) for off in (0.0, 1e-4))
        np.testing.assert_allclose(beside, expected, rtol=4 * EPS)


def test_parameters_of_four_bars_for_the_numpy_rival():
    scene = exact.crank_rockers(2, 0.0)
    q = grids.design(scene)
    assert (q.b == scene.mechanism.coupler.length.values[:, None]).all()
    assert (q.delta4 == scene.mechanism.rocker.cg_angle.values[:, None]).all()
    assert (scene.mechanism.coupler.inertia.values[:, None] == q.I3).all()
    assert (q.gx, q.gy, q.sign) == (0.0, -9.81, 1.0)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_plain_loop_for_numba_is_the_dense_solve(sign):
    """Runs as Python, without compilation."""
    q, theta2 = replace(GENERAL, sign=sign), peers.grid(24)
    numbers = np.array([getattr(q, name) for name in numba_dense.NUMBERS])
    result = numba_dense._nine(numbers, np.radians(theta2), peers.FORCE_BALANCE)
    assert peers.difference(result, peers.numpy_lapack(q, theta2)) < 1e-12


def test_a_rival_that_is_missing_or_fails_is_a_missing_row(monkeypatch):
    def fails(q, theta2):
        raise RuntimeError("some other version\nof it")

    methods = {name: solves.NINE_BY[name] for name in (solves.OURS, "numpy closed form")}
    methods |= {"not there": solves.Method(solves._rival("no_such_module")), "other": solves.Method(fails)}
    ours, closed, missing, other = solves._rows(methods, solves.OURS, QUICK)
    assert ours.agrees and closed.agrees and closed.seconds > 0.0
    assert missing.note == "not measured: No module named 'benchmarks.rivals.no_such_module'"
    assert other == Row("other", solves.OURS, solves.TIMES, note="not measured: some other version")


def test_linksweep_keeps_its_digits_near_a_toggle_where_plain_formulas_lose_theirs():
    assert 5e-7 < truth._exact(solves.TOGGLE, np.zeros(1))["mu"] < 1e-6
    assert solves._near(solves.NINE_BY[solves.OURS]) < 1e-10
    assert solves._near(solves.RATES_BY[solves.RATES]) < 1e-10
    assert solves._near(solves.NINE_BY["numpy closed form"]) > 1e-6


def test_a_wrong_answer_is_not_allowed():
    wrong = solves.Method(solves._numpy(lambda q, theta2: peers.numpy_closed_form(q, theta2) * 1.001))
    _, row = solves._rows({solves.OURS: solves.NINE_BY[solves.OURS], "wrong": wrong}, solves.OURS, QUICK)
    assert not row.agrees
    assert row.error == pytest.approx(1e-3, rel=0.01)


def test_memory_is_the_peak_of_this_process():
    before = growth.peak_memory()
    assert np.ones(40_000_000).sum() == 4e7  # 0.32 GB
    assert 0.25 < growth.peak_memory() < 20.0
    assert growth.peak_memory() >= before


# ------------------------------------------------------------------------------------------------ drawings


def solved(job, against, seconds, error, near=None):
    return Row(
        job, against, solves.TIMES, 1.0, seconds, 1e-8, 1, error=error, figures={solves.NEAR: near} if near else {}
    )


SOLVED = [
    solved(solves.OURS, solves.OURS, 1e-8, 2e-15, 1e-11),
    solved("one", solves.OURS, 1.0e-6, 5e-15, 1e-4),
    solved("another of the same", solves.OURS, 1.1e-6, 5e-15),
    solved("a third of the same", solves.OURS, 1.2e-6, 5e-15),
    Row("missing", solves.OURS, solves.TIMES, note="not measured: not there"),
    solved(solves.RATES, solves.RATES, 1e-8, 0.0),
]


MEASURED = {file.stem: from_json(file.read_text())["solves"].rows for file in (plots.HERE / "results").iterdir()}


@pytest.mark.parametrize("rows", [SOLVED, *MEASURED.values()], ids=["drawn up", *MEASURED])
def test_labels_of_methods_do_not_overlap(rows):
    rows = [row for row in rows if row.seconds]
    panels = plots.FIGURES["solves"](rows).axes
    for ax, against in zip(panels, (solves.OURS, solves.RATES), strict=True):
        names = [name for name in ax.texts if name.get_text()]  # others are lines to their points
        assert {name.get_text() for name in names} == {row.job for row in rows if row.against == against}
        boxes = [name.get_window_extent() for name in names]
        assert not any(box.overlaps(other) for k, box in enumerate(boxes) for other in boxes[:k])


def test_figures_are_written_where_results_exist(tmp_path, monkeypatch):
    note, figures = next(iter(grids.POPULATIONS)), {grids.MEDIAN: 1e-4, grids.MOST: 1e-3}
    peak = Row("", grids.EXACT, solves.TIMES, 1.0, error=1e-2, note=note, allowed=math.inf, figures=figures)
    peaks = [replace(peak, job=f"ls.peaks, {n} samples", seconds=n * 1e-8) for n in grids.SAMPLES]
    groups = {"solves": SOLVED, "grids": peaks, "threads": [Row("ours", "theirs", FASTER)]}
    for name, rows in groups.items():
        monkeypatch.setitem(front_door.GROUPS, name, front_door.Group(name, lambda size, rows=rows: rows))
    monkeypatch.setattr(front_door, "RESULTS", tmp_path / "RESULTS.md")
    assert front_door.main(["--write", *(word for name in groups for word in ("--only", name))]) == 0
    assert {path.name for path in tmp_path.iterdir()} == {"RESULTS.md", "results", "solves.png", "grids.png"}
    assert matplotlib.image.imread(tmp_path / "grids.png").std() > 0.01
    assert "near a toggle 1e-11" in front_door.RESULTS.read_text()
