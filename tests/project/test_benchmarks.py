"""Every benchmark runs once at a tiny size: its rows exist and its rivals agree. No time is asserted."""

import math
from dataclasses import replace

import numpy as np
import pytest
from long import long_but

import linksweep as ls
from benchmarks import __main__ as front_door
from benchmarks.cases import ALL, GENERAL, LENGTHS, QUICK, batch
from benchmarks.machine import FACT, machine, short_name
from benchmarks.report import Run, from_json, keep, page, section
from benchmarks.rivals import limit, peers
from benchmarks.speed import hard_peaks
from benchmarks.timing import FASTER, SHARE, WALL, Race, Row, cores, race, timed

SLOW = ("hard_peaks", "missed", "first", "growth", "skipping")
CHECKED = {"solves", "grids", "unknowns", "peaks", "hard_peaks", "skipping", "mechanisms", "linkages"}
CHECKED |= {"warm", "threads"}
GOALS = {
    "unknowns": {60, 250, 1.05, 1.1, 5, 10e-9 * QUICK.angles, 18e-9 * QUICK.angles},
    "peaks": {200, 0.8},
    "exact": {0.3, 0.35, 0.5, 1.0, 400},
    "hard_peaks": {10e-6 * QUICK.designs, 10e-6 * 10 * QUICK.designs},
    "missed": set(),
    "skipping": {0.35, 0.75},
    "solves": set(),
    "grids": set(),
    "growth": {0.25},
    "mechanisms": {1.0, 1.5},
    "linkages": {250.0, 1.0, 5.0},
    "warm": {0.25e-3, 0.45e-3},
    "first": {0.3, 1.0, 1.5},
    "threads": {1.7},
    "derivatives": {5.0},
    "run_up": set(),
    "steady_cycle": set(),
}


@pytest.fixture(scope="module")
def rows():
    """Return a function that measures a group at the tiny size, once each."""
    measured = {}

    def of(name: str) -> list[Row]:
        return measured[name] if name in measured else measured.setdefault(name, front_door.measured(name, QUICK))

    return of


@pytest.mark.parametrize("name", long_but(front_door.GROUPS, "peaks", nightly=SLOW))
def test_rows_exist_and_rivals_agree(name, rows):
    table = rows(name)
    assert {row.goal for row in table} - {None} == GOALS[name]
    for row in table:
        assert row.note.startswith("not measured") or (math.isfinite(row.ratio) and row.ratio > 0), row
        assert row.agrees, row
        assert name not in CHECKED or row.error is not None or row.note, row


@pytest.mark.skipif(cores() < 2, reason="one core only")
def test_two_threads_give_the_same_bits(rows):
    assert [row.error for row in rows("threads")] == [0.0] * 5 + [None]  # the last moves bytes alone


@pytest.mark.parametrize("name", hard_peaks.LONGEST)
def test_linkages_turn_as_their_rows_say(name):
    turns = {kind: ls.check(hard_peaks.linkages(name, cranks)(20)) for kind, cranks in hard_peaks.KINDS.items()}
    assert [set(checks.assembly.values) for checks in turns.values()] == [{0}, {0}, {1}]
    clear, near, partial = (checks.transmission_angle_min.min() for checks in turns.values())
    assert clear > 10.0 and near < 0.1 and partial < 1e-9


@pytest.mark.long
def test_skipping_takes_fewer_instructions(rows):
    notes = [row.note.split() for row in rows("skipping") if "instructions" in row.note]
    assert len(notes) == 17
    assert all(int(ours) < int(full) for ours, _, full, _ in notes)


# --------------------------------------------------------------------------------- the rivals themselves


@pytest.fixture(scope="module")
def library():
    if limit.compiler() is None:
        pytest.skip("no C compiler on this machine")
    return limit.build()


@pytest.mark.parametrize("n_angles", [1, 17, 720])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_limit_stores_what_the_dense_solve_gives(library, n_angles, sign):
    design, theta2 = replace(GENERAL, sign=sign), peers.grid(n_angles)
    dense = peers.numpy_lapack(design, theta2)
    np.testing.assert_allclose(limit.store(library, design, theta2), dense, rtol=0, atol=1e-12 * np.abs(dense).max())


def test_vectors_by_hand_agree_with_the_loop(library):
    theta2, by_hand = peers.grid(37), limit.build(flags=limit.SCHEDULED)
    call, nine = limit.bind_store(by_hand, GENERAL, theta2, "store_wide")
    call()
    np.testing.assert_allclose(nine, limit.store(library, GENERAL, theta2), rtol=1e-12)


@pytest.mark.parametrize("n_angles", [16, 100, 720])
def test_the_limit_finds_the_peaks_of_the_dense_solve(library, n_angles):
    designs = batch(7, *ALL)
    values, at = limit.peaks(library, designs, n_angles)
    dense, dense_at = peers.numpy_lapack_peaks(designs, n_angles, chunk=3)
    np.testing.assert_allclose(values, dense, rtol=1e-11)
    np.testing.assert_array_equal(at, dense_at)


def test_the_closed_form_is_the_dense_solve():
    designs, theta2 = batch(5, *LENGTHS), peers.grid(90)
    assert peers.difference(peers.numpy_closed_form(designs, theta2), peers.numpy_lapack(designs, theta2)) < 1e-12


# -------------------------------------------------------------------------------- timing and front door


def test_calls_are_timed_in_turn():
    order = []
    calls = {name: lambda name=name: order.append(name) for name in "AB"}
    measured = race(calls, replace(QUICK, rounds=3))
    assert "".join(order[-6:]) == "ABABAB"
    assert [len(seconds) for seconds in measured.seconds.values()] == [3, 3]


def test_a_call_during_which_the_clock_stands_still_is_timed_again():
    calls, ticks = [], iter([1.0, 1.0, 2.0, 2.5])
    assert timed(lambda: calls.append(1), lambda: next(ticks)) == 0.5
    assert len(calls) == 2


def test_a_rows_figure_is_the_median_of_the_rounds_ratios():
    measured = Race({"ours": [1.0, 2.0, 1.0], "theirs": [4.0, 6.0, 50.0]})
    assert measured.row(FASTER, "ours", "theirs").figure == 4.0
    assert measured.row(SHARE, "ours", "theirs").figure == 0.25
    assert measured.row(WALL, "ours", "theirs").figure == 1.0


@pytest.mark.parametrize(
    ("kind", "goal", "met"), [(FASTER, 4, True), (FASTER, 5, False), (SHARE, 0.3, True), (SHARE, 0.2, False)]
)
def test_a_figure_meets_its_goal_or_not(kind, goal, met):
    assert Race({"ours": [1.0], "theirs": [4.0]}).row(kind, "ours", "theirs", goal).met is met


def test_a_missing_rival_states_the_reason():
    row = Race({"ours": [1.0]}).row(SHARE, "ours", "limit.c", 1.3)
    assert (row.figure, row.met, row.note) == (None, None, "not measured: no C compiler found")


def cells(line: str) -> list[str]:
    return [cell.strip() for cell in line.strip("|").split("|")]


def test_the_table_is_markdown_without_the_columns_that_are_empty():
    rows = [Race({"ours": [2e-3], "theirs": [8e-3]}, 1000).row(FASTER, "ours", "theirs", 3, error=2e-15)]
    title, _, header, rule, line = section("a group", {"Intel Xeon": rows}).splitlines()
    assert (title, set(rule)) == ("## a group", {"|", "-"})
    assert cells(header) == ["ours", "against", "figure", "goal", "Intel Xeon", "takes", "met", "error"]
    assert cells(line) == ["ours", "theirs", FASTER, "≥ 3", "4", "2 µs", "yes", "2e-15"]


def test_rows_of_two_processors_stand_side_by_side(tmp_path):
    """A job that only one of them measured has no figure of the other; the same job with two notes is two rows."""
    small, large = (Row("ours", "C", SHARE, 0.5, 1e-3, goal=0.6, note=note) for note in ("small", "large"))
    runs = {
        "AMD EPYC 9B14 96-Core Processor": [small, large],
        "Intel(R) Xeon(R) Processor @ 2.60GHz": [replace(small, ratio=0.7), replace(large, ratio=0.4)],
    }
    for processor, rows in runs.items():
        keep(tmp_path, "peaks", Run({"processor": processor, "cores": "2"}, [Row("old", "C", SHARE, 9.0)]))
        keep(tmp_path, "peaks", Run({"processor": processor, "cores": "2"}, rows))
    keep(tmp_path, "exact", Run({"processor": "Intel(R) Xeon(R) Processor @ 2.60GHz", "cores": "4"}, [small]))
    assert {file.name for file in tmp_path.iterdir()} == {"amd-epyc-9b14.json", "intel-xeon.json"}
    lines = page(tmp_path, {"peaks": "Peaks", "exact": "Exact peaks", "warm": "Warm calls"}).splitlines()
    tables = [cells(line) for line in lines if line.startswith("| ")]
    assert tables == [
        ["", "AMD EPYC 9B14", "Intel Xeon"],
        ["processor", *runs],
        ["cores", "2", "2; 4 for exact"],
        ["ours", "against", "figure", "goal", "AMD EPYC 9B14", "takes", "met", "Intel Xeon", "takes", "met", "note"],
        ["ours", "C", SHARE, "≤ 0.6", "0.5", "1 ms", "yes", "0.7", "1 ms", "no", "small"],
        ["ours", "C", SHARE, "≤ 0.6", "0.5", "1 ms", "yes", "0.4", "1 ms", "yes", "large"],
        ["ours", "against", "figure", "goal", "Intel Xeon", "takes", "met", "note"],
        ["ours", "C", SHARE, "≤ 0.6", "0.5", "1 ms", "yes", "small"],
    ]


def test_processors_of_one_name_have_columns_of_their_own():
    clocked, masked, wide = (
        {"processor": "Intel(R) Xeon(R) Processor @ 2.60GHz, family 6, model 143"},
        {"processor": "AMD EPYC, family 23, model 1", "vectors": "AVX2"},
        {"processor": "AMD EPYC, family 25, model 17", "vectors": "AVX-512"},
    )
    assert short_name(clocked) == "Intel Xeon, family 6, model 143"
    assert short_name(masked) == "AMD EPYC, family 23, model 1, AVX2"
    assert short_name(wide) == "AMD EPYC, family 25, model 17"


def test_facts_of_a_processor_are_read_line_by_line():
    """A line without a value, before another or an empty one, has no part in the next line's name."""
    text = "power management:\n\ncpu family\t: 23\nmicrocode:\nmodel\t\t: 1\nmodel name\t: AMD EPYC\n"
    assert dict(FACT.findall(text)) == {"cpu family": "23", "model": "1", "model name": "AMD EPYC"}


def test_the_command_writes_its_table(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(front_door, "RESULTS", tmp_path / "RESULTS.md")
    monkeypatch.setattr(front_door, "QUICK", replace(QUICK))  # another size than that whose times mean nothing
    monkeypatch.setattr(front_door, "FULL", QUICK)
    file = tmp_path / "rows.json"
    assert front_door.main(["--only", "threads", "--json", str(file), "--write"]) == 0
    printed, written = capsys.readouterr().out, front_door.RESULTS.read_text()
    (kept,) = (tmp_path / "results").iterdir()
    assert kept.read_text() == file.read_text()
    stored = from_json(file.read_text())["threads"]
    assert "## Two threads against one" in printed
    assert "## Two threads against one" in written
    assert short_name(stored.machine) in written
    assert stored.machine == machine()
    assert all(value in written for value in machine().values())
    assert len(stored.rows) == 6


def test_times_that_mean_nothing_are_not_written(capsys):
    with pytest.raises(SystemExit):
        front_door.main(["--quick", "--write"])
    assert "mean nothing" in capsys.readouterr().err


def test_disagreement_is_an_error_a_slow_run_is_not(tmp_path, monkeypatch):
    def group(error: float) -> front_door.Group:
        return front_door.Group("t", lambda size: [Row("ours", "theirs", FASTER, 0.1, goal=60.0, error=error)])

    for error, code in ((1e-15, 0), (1e-3, 1), (math.nan, 1)):
        monkeypatch.setitem(front_door.GROUPS, "unknowns", group(error))
        assert front_door.main(["--only", "unknowns"]) == code
