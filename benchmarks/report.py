"""Format rows as a Markdown table and as JSON, with the machine that measured them."""

from __future__ import annotations

import os
import platform
import re
import subprocess
from collections.abc import Mapping
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path

from benchmarks.rivals import limit
from benchmarks.timing import FASTER, WALL, Row

HEADER = ("ours", "against", "figure", "goal", "met", "ours takes", "the other takes", "error", "note")
UNITS = {"s": 1.0, "ms": 1e3, "µs": 1e6, "ns": 1e9}
Groups = Mapping[str, list[Row]]


def markdown(groups: Groups) -> str:
    return "\n\n".join(f"## {title}\n\n{_table(rows)}" for title, rows in groups.items())


def _table(rows: list[Row]) -> str:
    cells = [HEADER, *map(_cells, rows)]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    lines = ["| " + " | ".join(map(str.ljust, line, widths)) + " |" for line in cells]
    return "\n".join([lines[0], "|" + "|".join("-" * (width + 2) for width in widths) + "|", *lines[1:]])


def _cells(row: Row) -> tuple[str, ...]:
    met = {None: "", True: "yes", False: "no"}[row.met]
    times = (_time(seconds, row.samples) for seconds in (row.seconds, row.against_seconds))
    error = "" if row.error is None else f"{row.error:.0e}"
    return (row.job, row.against, _figure(row), _goal(row), met, *times, error, _note(row))


def _note(row: Row) -> str:
    figures = (f"{name} {value:.0e}" for name, value in row.figures.items())
    return "; ".join(filter(None, (row.note, *figures)))


def _figure(row: Row) -> str:
    if row.ratio is None:
        return ""
    if row.kind == WALL:
        return f"{_time(row.seconds)}, {row.ratio:.2g} of the other"
    return f"{row.ratio:.3g} {row.kind}"


def _goal(row: Row) -> str:
    if row.goal is None:
        return ""
    sign = "≥" if row.kind == FASTER else "≤"
    return f"{sign} {_time(row.goal)}" if row.kind == WALL else f"{sign} {row.goal:g}"


def _time(seconds: float | None, samples: int | None = None) -> str:
    """Return a time as text, per sample if there are samples."""
    if seconds is None:
        return ""
    seconds /= samples or 1
    unit, scale = next((unit, scale) for unit, scale in UNITS.items() if seconds * scale >= 1.0 or unit == "ns")
    return f"{seconds * scale:.3g} {unit}"


def as_json(groups: Groups) -> dict:
    return {
        "machine": machine(),
        "rows": [{"group": title} | asdict(row) | {"met": row.met} for title, rows in groups.items() for row in rows],
    }


def machine() -> dict[str, str]:
    """Return the facts that the figures depend on; no names of hosts, no paths."""
    return {
        "processor": _processor(),
        "cores": str(os.cpu_count()),
        "system": f"{platform.system()} {platform.machine()}",
        "Python": platform.python_version(),
        **{name: version(name) for name in ("linksweep", "numpy", "numba", "xarray")},
        "C compiler": _compiler(),
    }


def _processor() -> str:
    try:
        model = re.search(r"^model name\s*:\s*(.+)$", Path("/proc/cpuinfo").read_text(), re.MULTILINE)
    except OSError:
        model = None
    return model[1] if model else platform.processor() or platform.machine()


def _compiler() -> str:
    cc = limit.compiler()
    if cc is None:
        return "none"
    lines = subprocess.run([cc, "--version"], capture_output=True, text=True, check=False).stdout.splitlines()
    return lines[0] if lines else Path(cc).name
