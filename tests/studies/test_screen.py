"""Screenings: against the same designs computed at once; equal for all chunks and threads; restart; refusals."""

import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import openpyxl
import pint
import pytest
import scipy.stats
import xarray as xr
from studies import PRESS, content, refused

import linksweep as ls
from linksweep.scene.designs.drawing import levels
from linksweep.studies import screen as screen_module
from linksweep.studies.screening import Screening
from linksweep.studies.tally import Tally, best

LENGTHS = {"coupler.length": ("20 cm", "24 cm"), "rocker.length": ls.Normal(0.18, 2e-3), "crank.length": [0.07, 0.08]}
N = 1500
SAMPLES = {"theta2": 36}  # the largest of samples, which are quicker to compute than exact peaks


def screened(**more) -> xr.Dataset:
    request = {
        "n": N,
        "minimize": "F32_peak",
        "maximize": "omega2",
        "subject_to": {"T12_max": (None, 20.0), "F32_peak": (310.0, 500.0)},
    }
    return ls.screen(PRESS, LENGTHS | {"omega2": (20, 40)}, **request | SAMPLES | more)


@pytest.fixture(scope="module")
def every():
    """Return the peaks of all designs, drawn and computed at once."""
    designs = ls.draw(PRESS, LENGTHS | {"omega2": (20, 40)}, designs=range(N))
    return ls.peaks(designs, of=["F32", "T12"], **SAMPLES)


@pytest.fixture(scope="module")
def screening():
    return screened()


# -------------------------------------------------------------------------------------------- designs


def test_levels_of_a_design_are_words_of_philox():
    """By numpy's generator from its start: the counter of design k stands behind the words of all designs before it."""
    words = np.random.Philox(key=5).random_raw(8 * 100).reshape(100, 8)[:, :6]
    expected = (words >> np.uint64(12)).astype(float) * 2.0**-52 + 2.0**-53
    np.testing.assert_array_equal(levels(6, np.arange(100), 5), expected.T)
    np.testing.assert_array_equal(levels(6, np.array([99, 3, 4]), 5), expected[[99, 3, 4]].T)


def test_levels_are_even_and_independent():
    drawn = levels(5, np.arange(10**12, 10**12 + 20_000), 1)
    assert min(scipy.stats.kstest(row, "uniform").pvalue for row in drawn) > 1e-3
    assert np.abs(np.corrcoef(drawn) - np.eye(5)).max() < 4.0 / np.sqrt(20_000)
    assert np.abs(np.corrcoef(drawn[:, :-1], drawn[:, 1:])[:5, 5:]).max() < 4.0 / np.sqrt(20_000)


def test_a_design_is_the_same_alone_and_with_others():
    together = ls.draw(PRESS, LENGTHS, designs=range(1000), seed=2**100)
    for number in (0, 17, 999):
        alone = ls.draw(PRESS, LENGTHS, designs=[number], seed=2**100)
        for path, array in alone.arrays.items():
            assert array.identical(together.arrays[path].sel(design=[number]))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((LENGTHS, []), "designs = []: must be numbers of designs, whole and from 0, such as [17, 20] or range(100)"),
        ((LENGTHS, 3), "designs = 3: must be numbers of designs"),
        ((LENGTHS, [2**63 + 5]), "designs = [9223372036854775813]: must be numbers of designs"),
        ((LENGTHS, [-1]), "designs = [-1]: must be numbers"),
        ((LENGTHS, [0.5]), "designs = [0.5]: must be numbers"),
        (({"coupler.lenth": (0.2, 0.3)}, [1]), "parameters: nothing is named 'coupler.lenth'"),
        (({}, [1]), "parameters = {}: must name what varies"),
        (({"omega2": scipy.stats.norm(5.0, [1.0, 2.0])}, [1, 2]), "omega2: a distribution of shape (2,): must have"),
    ],
)
def test_what_cannot_be_drawn_is_refused(arguments, message):
    assert refused(ls.draw, PRESS, arguments[0], designs=arguments[1]).startswith(message)


# -------------------------------------------------------------------------------------------- results


def test_shares_and_histograms_are_those_of_all_designs(screening, every):
    ok, torque, force = (every[name].values for name in ("status", "T12_max", "F32_peak"))
    low, right = torque <= 20.0, (force >= 310.0) & (force <= 500.0)
    assert screening.within == np.mean((ok <= 1) & low & right)
    assert screening.T12_max_within == np.mean(low) and screening.F32_peak_within == np.mean(right)
    assert 0.01 < screening.within < 0.99
    assert screening.designs_by_status.sum() == N
    for name in ("T12_max", "F32_peak", "omega2"):
        edges = screening[f"{name}_to"].values[:-1]
        counts, _ = np.histogram(every[name], [-np.inf, *edges, np.inf])
        np.testing.assert_array_equal(screening[f"{name}_count"], counts)
        assert screening[f"{name}_count"].sum() == N
        np.testing.assert_array_equal(screening[f"{name}_from"][1:], edges)


def test_the_best_and_the_front_are_those_of_all_designs(every):
    screening = screened(keep=7)
    allowed = every.where((every.T12_max <= 20.0) & (every.F32_peak >= 310.0) & (every.F32_peak <= 500.0), drop=True)
    front = ls.pareto(allowed, minimize=["F32_peak"], maximize=["omega2"])
    lightest, fastest = allowed.sortby("F32_peak").design[:7], allowed.sortby("omega2").design[-7:]
    expected = sorted({*front.design.values, *lightest.values, *fastest.values})
    assert screening.design.values.tolist() == expected
    assert ls.pareto(screening, minimize=["F32_peak"], maximize=["omega2"]).design.equals(front.design)


def test_every_design_that_is_kept_has_the_bits_that_it_has_alone():
    """By exact peaks, and with a quantity that is wanted besides."""
    may_be = {"coupler.length": (0.2, 0.24), "gravity[2]": ls.Normal(-9.81, 0.1)}
    screening = ls.screen(PRESS, may_be, n=300, minimize=["F32_peak", "T12_max"], keep=3, of="F12", chunk=70)
    assert screening.sizes["design"] >= 3
    for number in screening.design.values:
        drawn = ls.draw(PRESS, may_be, designs=[number])
        alone = ls.peaks(drawn, of=["F32", "T12", "F12"])
        kept = screening.sel(design=[number])
        assert all(kept[name].equals(alone[name]) for name in alone.data_vars)
        one = ls.scene_at(screening, design=int(number))
        assert one == ls.scene_at(drawn, design=int(number))
        assert float(ls.peaks(one, of=["F32"]).F32_peak) == float(screening.F32_peak.sel(design=number))


@pytest.mark.parametrize(
    "how", [{"chunk": N}, {"chunk": 1, "n": 40}, {"chunk": 7, "threads": 2}, {"threads": 1, "chunk": 64}]
)
def test_chunks_and_threads_change_nothing(how, screening):
    whole = screening if how.get("n", N) == N else screened(n=how["n"])
    assert screened(**how).drop_attrs().identical(whole.drop_attrs())


def test_of_equal_designs_the_first_is_kept():
    screening = ls.screen(PRESS, {"coupler.length": [0.21, 0.22, 0.23]}, n=500, minimize="F32_peak", keep=4, **SAMPLES)
    drawn = ls.draw(PRESS, {"coupler.length": [0.21, 0.22, 0.23]}, designs=range(500))
    peaks = ls.peaks(drawn, of="F32", **SAMPLES).F32_peak
    assert screening.design.values.tolist() == np.flatnonzero(peaks == peaks.min())[:4].tolist()
    costs = np.array([[1.0, 2.0], [2.0, 1.0], [1.0, 2.0], [2.0, 2.0], [2.0, 1.0]])
    assert best(costs, 1).tolist() == [0, 1]


@pytest.mark.parametrize("objectives", [1, 2, 3])
def test_the_best_of_many_are_those_of_their_definition(objectives):
    rng = np.random.default_rng(objectives)
    for costs in (rng.normal(size=(300, objectives)), rng.integers(0, 5, (300, objectives)).astype(float)):
        dominated = [(np.all(costs <= row, axis=1) & np.any(costs < row, axis=1)).any() for row in costs]
        first = [not (costs[:k] == row).all(axis=1).any() for k, row in enumerate(costs)]
        front = np.flatnonzero(~np.array(dominated) & first) if objectives > 1 else []
        least = [sorted(range(300), key=lambda k: (column[k], k))[:5] for column in costs.T.tolist()]
        assert best(costs, 5).tolist() == sorted({*front, *np.ravel(least).tolist()})


@pytest.mark.parametrize("objectives", [2, 3, 4])
def test_the_best_do_not_depend_on_the_chunks(objectives):
    """In the last objective each is bought by the others, so that many equal ones are on the front."""
    rng, none = np.random.default_rng(objectives), np.zeros(0, dtype=int)
    for n in range(20, 200, 4):
        costs = rng.integers(0, 5, (n, objectives)).astype(float)
        costs[:, -1] = rng.integers(0, 3, n) - costs[:, :-1].sum(axis=1)
        dominated = [(np.all(costs <= row, axis=1) & np.any(costs < row, axis=1)).any() for row in costs]
        first = [not (costs[:k] == row).all(axis=1).any() for k, row in enumerate(costs)]
        least = [sorted(range(n), key=lambda k: (column[k], k))[:2] for column in costs.T.tolist()]
        expected = sorted({*np.flatnonzero(~np.array(dominated) & first).tolist(), *np.ravel(least).tolist()})
        for chunk in (n, 33, 5):
            tally = Tally(none, none, none, none, np.empty((0, objectives)))
            for start in range(0, n, chunk):
                part = start + best(costs[start : start + chunk], 2)
                tally = tally.plus(Tally(none, none, none, part, costs[part]), 2)
            assert tally.numbers.tolist() == expected


def test_designs_that_do_not_close_have_no_part_in_it():
    may_be = {"crank.length": (0.01, 0.9)}
    screening = ls.screen(
        PRESS, may_be, n=400, minimize="F32_peak", bins={"F32_peak": [0.0, 500.0]}, keep=400, **SAMPLES
    )
    every = ls.peaks(ls.draw(PRESS, may_be, designs=range(400)), of=["F32"], **SAMPLES)
    assert screening.designs_by_status.values.tolist() == np.bincount(every.status, minlength=4).tolist()
    assert screening.F32_peak_count.sum() == every.F32_peak.notnull().sum() < 400
    assert screening.design.values.tolist() == every.design[every.F32_peak.notnull()].values.tolist()
    turning = ls.screen(PRESS, may_be, n=400, subject_to={"status": (None, 0)}, **SAMPLES)
    assert turning.within == np.mean(every.status == 0)


def test_where_no_design_is_within_the_limits_none_is_kept(tmp_path):
    screening = screened(subject_to={"F32_peak": (None, 1.0)}, path=tmp_path / "none.nc")
    assert screening.sizes["design"] == 0 and screening.within == 0.0 and screening.F32_peak_count.sum() == N


def test_loads_over_the_angle():
    scene = replace(PRESS, loads=[ls.Load("rocker", torque=lambda theta2: 5.0 * np.cos(np.radians(theta2)))])
    screening = ls.screen(scene, {"coupler.length": (0.2, 0.24)}, n=5, minimize="T12_peak", keep=1)
    peaks = ls.peaks(ls.draw(scene, {"coupler.length": (0.2, 0.24)}, designs=range(5)), of=["T12"]).T12_peak
    assert screening.design.item() == peaks.idxmin() and screening.T12_peak.item() == peaks.min()


def test_a_table_has_a_row_for_each_design_kept_or_for_each_bin(screening, tmp_path):
    kept, edges = screening.sizes["design"], screening["F32_peak_to"].values
    table = screening.linksweep.to_pandas()
    assert len(table) == kept and table["design"].tolist() == screening.design.values.tolist()
    assert not [column for column in table if "count" in column or "outcome" in column or "_from" in column]
    bins = screening[["F32_peak_count"]].linksweep.to_pandas()
    assert len(bins) == len(edges) and bins["F32_peak_count"].sum() == screening.designs_by_status[:2].sum()
    ls.save(screening, tmp_path / "screen.csv")
    ls.save(ls.pareto(screening, minimize=["F32_peak"]), tmp_path / "best.csv")
    assert [len((tmp_path / name).read_text().splitlines()) for name in ("screen.csv", "best.csv")] == [kept + 1, 2]
    ls.save(screening, tmp_path / "screen.xlsx")
    book = openpyxl.load_workbook(tmp_path / "screen.xlsx")
    assert book["results"].max_row == kept + 1 and book["columns"].max_row == len(table.columns) + 1


def test_no_scene_is_chosen_of_a_screening_that_kept_no_design():
    none = screened(subject_to={"F32_peak": (None, 1.0)})
    with pytest.raises(ValueError, match=r"^design = 0: there are no designs along it: choose from results that have"):
        ls.scene_at(none, design=0)


# -------------------------------------------------------------------------------------------- files


def stopping(patch, after: int) -> list[int]:
    """Let so many chunks be computed, then interrupt; return the starts of those that are."""
    starts: list[int] = []
    tally = Screening.tally

    def watched(task, first, last):
        if len(starts) == after:
            raise KeyboardInterrupt
        starts.append(first)
        return tally(task, first, last)

    patch.setattr(Screening, "tally", watched)
    return starts


def test_a_stopped_screening_resumes_with_any_chunk(tmp_path, monkeypatch, screening):
    path = tmp_path / "screen.nc"
    with monkeypatch.context() as until_then:
        stopping(until_then, 3)
        with pytest.raises(KeyboardInterrupt, match=r"^stopped; 600 of 1500 designs are done: to go on from there"):
            screened(path=path, chunk=200)
    assert os.listdir(tmp_path) == ["screen.nc.progress"]
    starts = stopping(monkeypatch, 99)
    resumed = screened(path=path, chunk=500)
    assert starts == [600, 1100]
    assert resumed.identical(screening) and os.listdir(tmp_path) == ["screen.nc"]
    monkeypatch.setattr(Screening, "tally", None)
    assert screened(path=path).identical(screening)
    assert ls.load_scene(path) == ls.draw(PRESS, LENGTHS | {"omega2": (20, 40)}, designs=screening.design.values)


KILLED = """
import sys, time
from linksweep.studies import screen
from linksweep.studies.screening import Screening
screen.INTERVAL, tally = 0.0, Screening.tally
Screening.tally = lambda *arguments: time.sleep(0.02) or tally(*arguments)
from test_screen import screened
screened(path=sys.argv[1], chunk=20)
"""


def test_a_killed_screening_gives_the_identical_result(tmp_path, monkeypatch, screening):
    path, folders = tmp_path / "screen.nc", [Path(__file__).parent, Path(__file__).parents[1] / "helpers"]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([*map(str, folders), os.environ.get("PYTHONPATH", "")])}
    process = subprocess.Popen([sys.executable, "-c", KILLED, str(path)], env=environment)
    progress = tmp_path / "screen.nc.progress"
    while not progress.exists() and process.poll() is None:
        time.sleep(0.001)
    time.sleep(0.1)
    process.kill()
    process.wait()
    assert process.returncode == -signal.SIGKILL
    starts = stopping(monkeypatch, 99)
    assert screened(path=path).identical(screening)
    assert starts[0] > 0


def test_files_do_not_grow_with_the_designs(tmp_path, monkeypatch):
    monkeypatch.setattr(screen_module, "INTERVAL", 0.0)
    sizes = []
    monkeypatch.setattr(screen_module.Progress, "remove", lambda progress: sizes.append(progress.path.stat().st_size))
    for n in (N, 4 * N):
        screened(n=n, maximize=(), path=tmp_path / f"{n}.nc", chunk=500)
    assert abs(sizes[1] - sizes[0]) < 100  # digits of text


def test_files_of_another_screening_are_refused_and_kept(tmp_path, monkeypatch):
    path = tmp_path / "screen.nc"
    screened(path=path)
    edges = [*range(300, 340)]
    screened(path=tmp_path / "edges.nc", bins={"F32_peak": edges})
    before = content(tmp_path)
    message = refused(screened, path=tmp_path / "edges.nc", bins={"F32_peak": [*edges, 350]})
    assert message.startswith(f"{tmp_path}/edges.nc: is of a screening with another bins; go on with that")
    assert refused(screened, path=path, n=N + 1).startswith(
        f"{path}: is of a screening with another n (1500, not 1501)"
    )
    another = f"{path}: is of a screening with another"
    assert refused(screened, path=path, keep=3).startswith(f"{another} keep (100, not 3)")
    assert refused(screened, path=path, seed=1).startswith(f"{another} seed (0, not 1)")
    assert refused(screened, path=path, theta2=37).startswith(f"{another} options ({{'theta2': 36}}, not ")
    assert refused(ls.screen, PRESS, LENGTHS, n=N, minimize="F32_peak", path=path).startswith(f"{another} scene; go on")
    assert content(tmp_path) == before
    stopping(monkeypatch, 1)
    with pytest.raises(KeyboardInterrupt):
        screened(path=tmp_path / "new.nc", chunk=100)
    progress = tmp_path / "new.nc.progress"
    assert refused(screened, path=tmp_path / "new.nc", keep=3).startswith(f"{progress}: is of a screening with another")
    progress.write_bytes(progress.read_bytes()[:-1])
    assert refused(screened, path=tmp_path / "new.nc").startswith(f"{progress}: is damaged, or no file of a screening")


@pytest.mark.parametrize(
    "more",
    [
        {"minimize": ["T12_peak", "F32_peak"]},
        {"subject_to": {"F32_peak": (310.0, 500.0), "T12_max": (None, 20.0)}},
        {"bins": {"T12_max": [0.0, 20.0], "F32_peak": [300.0, 400.0]}},
    ],
)
def test_a_stopped_screening_does_not_go_on_with_its_names_in_another_order(more, tmp_path, monkeypatch):
    """The numbers of a tally are in the order of the names: those of one would be added to those of another."""
    request = {"minimize": ["F32_peak", "T12_peak"], "bins": {"F32_peak": [300.0, 400.0], "T12_max": [0.0, 20.0]}}
    with monkeypatch.context() as until_then:
        stopping(until_then, 1)
        with pytest.raises(KeyboardInterrupt):
            screened(path=tmp_path / "screen.nc", chunk=700, **request)
    message = refused(screened, path=tmp_path / "screen.nc", chunk=700, **request | more)
    assert f"screen.nc.progress: is of a screening with another {next(iter(more))} (" in message


# -------------------------------------------------------------------------------------------- refused


POUNDS = pint.UnitRegistry().Quantity(np.array([60.0, 75.0]), "lbf")


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"n": 0}, "n = 0: must be"),
        ({"n": None}, "n = None: must be a whole number, 1 or more"),
        ({"keep": None}, "keep = None: must be a whole number"),
        ({"bins": 0}, "bins = 0: must be"),
        ({"seed": -1}, "seed = -1: must be a whole number from 0 to 2^128 − 1"),
        ({"seed": 2**128}, "seed = "),
        ({"minimize": (), "maximize": (), "subject_to": None}, "minimize: give what is asked for"),
        ({"maximize": "F32_peak"}, "maximize: F32_peak is to be small, too; name it once"),
        ({"minimize": "F32_pek"}, "minimize: nothing is named 'F32_pek'"),
        ({"minimize": "F32"}, "minimize: nothing is named 'F32'"),
        ({"subject_to": {"F32": (None, 900.0)}}, "subject_to: nothing is named 'F32'"),
        ({"of": "F3"}, "of: nothing is named 'F3'"),
        ({"subject_to": {"F32_peak": 900.0}}, "subject_to: F32_peak = 900.0: must be (least, most), numbers or one"),
        ({"subject_to": {"F32_peak": (2.0, 1.0)}}, "subject_to: F32_peak = (2.0, 1.0): must be (least, most)"),
        ({"subject_to": {"F32_peak": (None, None)}}, "subject_to: F32_peak = (None, None): must be (least, most)"),
        ({"subject_to": {"F32_peak": (None, np.nan)}}, "subject_to: F32_peak = (None, nan): must be (least, most)"),
        ({"subject_to": ["F32_peak"]}, "subject_to = ['F32_peak']: must give (least, most) by name"),
        ({"bins": {"F32_peak": [1.0, 1.0]}}, "bins: F32_peak = [1.0, 1.0]: must be rising numbers"),
        ({"bins": {"F32_peak": POUNDS}}, "bins: F32_peak = <Quantity([60. 75.], 'force_pound')>: must be rising "),
        ({"path": "screen.csv"}, "screen.csv: its ending must be .nc"),
        ({"client": 3}, "client = 3: must be a client of dask.distributed"),
    ],
)
def test_bad_requests_are_refused(more, message):
    assert refused(screened, **more).startswith(message)


def test_a_scene_of_designs_and_values_that_it_refuses_are_refused_before_anything_is_computed(monkeypatch):
    monkeypatch.setattr(Screening, "tally", None)
    both = ls.Scene(replace(PRESS.mechanism, branch="both"), PRESS.omega2)
    message = refused(ls.screen, both, LENGTHS, n=10, minimize="F32_peak")
    assert message.startswith("scene: has designs along branch; give one design, as of ls.scene_at")
    message = refused(ls.screen, ls.sample(PRESS, LENGTHS, n=4), LENGTHS, n=10, minimize="F32_peak")
    assert message.startswith("scene: has designs along design; give one design, as of ls.scene_at")
    message = refused(ls.screen, PRESS, {"crank.length": ls.Normal(0.08, 0.01)}, n=10, minimize="F32_peak")
    assert message.startswith("crank.length") and "ls.Normal(..., within=3)" in message
