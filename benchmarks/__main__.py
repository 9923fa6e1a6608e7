"""Run the benchmarks: python -m benchmarks [--quick] [--only GROUP] [--json FILE] [--write]."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from benchmarks import plots
from benchmarks.accuracy import grids, missed, solves
from benchmarks.cases import FULL, QUICK, Size
from benchmarks.machine import machine, short_name
from benchmarks.report import Run, Runs, as_json, keep, page, section
from benchmarks.speed import (
    derivatives,
    exact,
    growth,
    hard_peaks,
    latency,
    linkages,
    mechanisms,
    peaks,
    run_up,
    skipping,
    steady_cycle,
    threads,
    unknowns,
)
from benchmarks.timing import Row, can_pin, one_core

RESULTS = Path(__file__).with_name("RESULTS.md")


class Group(NamedTuple):
    """A group of rows with its title; `one_core` where they are timed pinned to one core."""

    title: str
    rows: Callable[[Size], list[Row]]
    one_core: bool = True


GROUPS = {
    "solves": Group("Run time against error: unknowns of one design, {angles:,} angles, one core", solves.rows),
    "grids": Group("Run time against error: peaks of {population:,} random crank-rockers, one core", grids.rows),
    "unknowns": Group("All nine unknowns, {angles:,} angles, one core", unknowns.rows),
    "peaks": Group("Peaks of {designs} designs × {turn} angles, one core", peaks.rows),
    "exact": Group("Exact peaks of many designs, one core", exact.rows),
    "hard_peaks": Group("Exact peaks near toggles, of partial turns, of forces that jump, one core", hard_peaks.rows),
    "missed": Group("Peaks that the search misses of random designs of each kind", missed.rows),
    "skipping": Group("Quantities that are not requested cost nothing, {angles:,} angles, one core", skipping.rows),
    "mechanisms": Group("Other mechanisms against the four-bar, {angles:,} angles, one core", mechanisms.rows),
    "derivatives": Group("Derivatives to ten parameters, a tenth of {angles:,} angles, one core", derivatives.rows),
    "linkages": Group("All unknowns of linkages, a tenth of {angles:,} angles, one core", linkages.rows),
    "run_up": Group("Run-up on a motor, {designs} designs, one core", run_up.rows),
    "steady_cycle": Group("Steady cycle on a motor, {turn} angles, one core", steady_cycle.rows),
    "warm": Group("One warm call, {turn} angles, one core", latency.warm_calls),
    "first": Group("The first minutes, in fresh processes", latency.first_minutes, one_core=False),
    "threads": Group("Two threads against one", threads.rows, one_core=False),
    "growth": Group("How cost grows, in fresh processes", growth.rows, one_core=False),
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the benchmarks and print their table; return 1 where rivals disagree on a result, never for a time."""
    options = _options(arguments)
    size = QUICK if options.quick else FULL
    titles = {name: group.title.format_map(vars(size)) for name, group in GROUPS.items()}
    facts, runs = machine(), {}
    for name in options.only or GROUPS:
        rows = measured(name, size)
        runs[name] = Run(facts, [replace(row, goal=None) for row in rows] if options.quick else rows)
        print(section(titles[name], {short_name(facts): runs[name].rows}), end="\n\n", flush=True)
        if options.write:
            _write(name, runs[name], titles)
    print(_footer(size))
    if options.json:
        options.json.write_text(as_json(runs), encoding="utf-8")
    return int(_disagree(runs))


def _write(name: str, run: Run, titles: dict[str, str]) -> None:
    """Keep a group, and write the page and its figure anew: what is measured stays if a later group fails."""
    folder = RESULTS.parent / "results"
    keep(folder, name, run)
    RESULTS.write_text(page(folder, titles), encoding="utf-8")
    plots.draw(name, run.rows, RESULTS.parent)


def measured(name: str, size: Size) -> list[Row]:
    group = GROUPS[name]
    with one_core() if group.one_core else nullcontext():
        return group.rows(size)


def _disagree(runs: Runs) -> bool:
    return any(not row.agrees for run in runs.values() for row in run.rows)


def _footer(size: Size) -> str:
    if size is QUICK:
        return "Tiny sizes, timed once: the errors count, the times mean nothing."
    if can_pin():
        return "The rows on one core were pinned to the last core that this process may use."
    return "The rows on one core could not be pinned to it here."


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description="linksweep's speed, as ratios.")
    parser.add_argument("--quick", action="store_true", help="tiny sizes, once: to see that all works, not how fast")
    parser.add_argument("--only", action="append", choices=GROUPS, help="this group; may be given more than once")
    parser.add_argument("--json", type=Path, metavar="FILE", help="also write the rows and the machine to FILE")
    parser.add_argument(
        "--write", action="store_true", help="also write these groups to benchmarks/RESULTS.md, and draw"
    )
    options = parser.parse_args(arguments)
    if options.quick and options.write:
        parser.error("the times of --quick mean nothing: they are not for --write")
    return options


if __name__ == "__main__":
    sys.exit(main())
