"""Format the rows of several processors side by side, as Markdown; keep those of each as JSON in a file of its own."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.machine import Facts, short_name
from benchmarks.timing import FASTER, SHARE, WALL, Row

UNITS = {"s": 1.0, "ms": 1e3, "µs": 1e6, "ns": 1e9}
HEAD = """# Results

Written by `python -m benchmarks --write`; [README](README.md) says what each row means. The column of a processor has
its figure, *takes* the time of *ours* there, for an angle or a design in most rows. Goals in seconds are for this time.
Errors are the largest of all processors."""


class Run(NamedTuple):
    """Rows of one group, and the facts of the machine that measured them."""

    machine: Facts
    rows: list[Row]


Runs = Mapping[str, Run]
"""Runs of one processor, by name of the group."""
Beside = Mapping[str, Row]
"""Rows of the same job, by processor."""


# -------------------------------------------------------------------------------------------- files of processors


def as_json(runs: Runs) -> str:
    stored = {name: {"machine": run.machine, "rows": list(map(asdict, run.rows))} for name, run in runs.items()}
    return json.dumps(stored, indent=1, ensure_ascii=False) + "\n"


def from_json(text: str) -> dict[str, Run]:
    stored = json.loads(text)
    return {name: Run(run["machine"], [Row(**row) for row in run["rows"]]) for name, run in stored.items()}


def keep(folder: Path, name: str, run: Run) -> None:
    """Replace a group in the file of its processor; the other groups there remain."""
    file = folder / (re.sub(r"\W+", "-", short_name(run.machine)).strip("-").lower() + ".json")
    others = from_json(file.read_text(encoding="utf-8")) if file.exists() else {}
    folder.mkdir(exist_ok=True)
    file.write_text(as_json(others | {name: run}), encoding="utf-8")


def page(folder: Path, titles: Mapping[str, str]) -> str:
    """Return the page of all processors that have a file in the folder."""
    files = [from_json(file.read_text(encoding="utf-8")) for file in sorted(folder.glob("*.json"))]
    processors = {short_name(next(iter(runs.values())).machine): runs for runs in files}
    groups = [
        section(title, {processor: runs[name].rows for processor, runs in processors.items() if name in runs})
        for name, title in titles.items()
        if any(name in runs for runs in processors.values())
    ]
    return "\n\n".join([HEAD, _machines(processors), *groups]) + "\n"


def _machines(processors: Mapping[str, Runs]) -> str:
    names = dict.fromkeys(name for runs in processors.values() for run in runs.values() for name in run.machine)
    facts = [(name, *(_fact(runs, name) for runs in processors.values())) for name in names]
    return _markdown([("", *processors), *facts])


def _fact(runs: Runs, name: str) -> str:
    """Return a fact of most groups, then what it was for the others."""
    groups: dict[str, list[str]] = {}
    for group, run in runs.items():
        groups.setdefault(run.machine.get(name, ""), []).append(group)
    most, *others = sorted(groups, key=lambda value: -len(groups[value]))
    return "; ".join([most, *(f"{value} for {', '.join(groups[value])}" for value in others)])


# --------------------------------------------------------------------------------------------------------- tables


def section(title: str, rows: Mapping[str, list[Row]]) -> str:
    """Return the table of a group, below its title; rows are by processor."""
    header = ("ours", "against", "figure", "goal", *_each(rows, lambda name: (name, "takes", "met")), "error", "note")
    return f"## {title}\n\n{_markdown([header, *(_cells(beside, rows) for beside in _matched(rows))])}"


def _matched(rows: Mapping[str, list[Row]]) -> Iterable[Beside]:
    """Match rows by job and rival, and by note where these repeat; in the order of the processor that has most."""
    matched: dict[tuple[str, ...], dict[str, Row]] = {}
    for processor, own in sorted(rows.items(), key=lambda item: -len(item[1])):
        repeated = Counter((row.job, row.against) for row in own)
        for row in own:
            job = row.job, row.against
            matched.setdefault((*job, row.note) if repeated[job] > 1 else job, {})[processor] = row
    return matched.values()


def _cells(beside: Beside, processors: Iterable[str]) -> tuple[str, ...]:
    rows = list(beside.values())
    kind = SHARE if rows[0].kind == WALL else rows[0].kind
    figures = _each(processors, lambda name: _measured(beside[name]) if name in beside else ("", "", ""))
    return (rows[0].job, rows[0].against, kind, _once(map(_goal, rows)), *figures, _error(rows), _note(beside))


def _each(processors: Iterable[str], cells: Callable[[str], tuple[str, ...]]) -> Iterator[str]:
    return (cell for name in processors for cell in cells(name))


def _measured(row: Row) -> tuple[str, ...]:
    ratio = "" if row.ratio is None else _number(row.ratio)
    return ratio, _time(row.seconds, row.samples), {None: "", True: "yes", False: "no"}[row.met]


def _goal(row: Row) -> str:
    if row.goal is None:
        return ""
    sign = "≥" if row.kind == FASTER else "≤"
    return f"{sign} {_time(row.goal, row.samples)}" if row.kind == WALL else f"{sign} {row.goal:g}"


def _error(rows: list[Row]) -> str:
    errors = [row.error for row in rows if row.error is not None]
    return _digit(errors) if errors else ""


def _note(beside: Beside) -> str:
    """Return the note that all share, or that of each; then the further errors."""
    notes = {name: row.note for name, row in beside.items()}
    same = len({*notes.values()}) == 1
    texts = notes.values() if same else (f"{name}: {note}" for name, note in notes.items() if note)
    names = dict.fromkeys(name for row in beside.values() for name in row.figures)
    figures = {name: [row.figures[name] for row in beside.values() if name in row.figures] for name in names}
    return _once([*texts, *(f"{name} {_digit(values)}" for name, values in figures.items())])


def _once(texts: Iterable[str]) -> str:
    return "; ".join(dict.fromkeys(filter(None, texts)))


def _number(value: float) -> str:
    """Return three digits, without an exponent where they are large."""
    return f"{float(f'{value:.3g}'):,.0f}" if value >= 1000.0 else f"{value:.3g}"


def _digit(values: list[float]) -> str:
    """Return the first digit of the largest; NaN where one is."""
    largest = np.max(values)
    return "0" if largest == 0.0 else f"{largest:.0e}"


def _time(seconds: float | None, samples: int | None = None) -> str:
    """Return a time as text, per sample if there are samples."""
    if seconds is None:
        return ""
    seconds /= samples or 1
    unit, scale = next((unit, scale) for unit, scale in UNITS.items() if seconds * scale >= 1.0 or unit == "ns")
    return f"{seconds * scale:.3g} {unit}"


def _markdown(lines: list[tuple[str, ...]]) -> str:
    """Return a table, its header first, without the columns that are empty."""
    columns = [column for column in zip(*lines, strict=True) if any(column[1:])]
    widths = [max(map(len, column)) for column in columns]
    header, *rows = ("| " + " | ".join(map(str.ljust, line, widths)) + " |" for line in zip(*columns, strict=True))
    return "\n".join([header, "|" + "|".join("-" * (width + 2) for width in widths) + "|", *rows])
