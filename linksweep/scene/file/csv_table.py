"""A column of a CSV file as a DataArray over theta2: an indicator diagram, a measured torque.

::

    theta2,P
    0,11.2
    5,12.9
    ...

The first line names the columns; the first column is theta2 [degree], in rising order, over one turn (360) or
several. The last row may close the cycle by repeating the first. In a scene file the column stands in place of a
number: ``{csv = "indicator.csv", column = "P", unit = "kN"}``, the file's place relative to the scene file's; `column`
may be left out where there are but two, and `unit` where the values are in SI units. `interpolation` says how it goes
on between its rows, as that of a `Load`: with "step" each row holds up to the next, and need not go all the way round.
The first column of a load over a position is `position` [m] or [degree], in rising order. A column may state its unit
in the first line, as those of results that were saved do: ``position [in],P [lbf]``.
"""

from __future__ import annotations

import csv
import math
import re
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.base.units import accepted_unit, as_toml, key_as_toml, quantity
from linksweep.base.validate import did_you_mean, name_problems, refuse
from linksweep.scene.curves.interpolation import interpolation_attribute
from linksweep.scene.file.text_file import text_of

KEYS = ("csv", "column", "unit", "interpolation")
OVER = ("theta2", "position")
"""Names of the first column."""
HEADING = re.compile(r"(.*?)\s*\[([^\[\]]+)\]")
LONGEST_CELL = 1000
"""Characters that a cell may have."""
MOST_SHOWN = 5
"""Bad cells of a file that a message lists one by one."""


class Row(NamedTuple):
    line: int
    cells: list[str]


class Heading(NamedTuple):
    name: str
    unit: str | None


class Sample(NamedTuple):
    line: int
    angle: float
    value: float


def csv_column(table: dict[str, Any], kind: str, folder: Path, position_kind: str | None) -> xr.DataArray:
    """Read the inline table that stands in place of a number: ``{csv = "indicator.csv", column = "P", unit = "kN"}``.

    Parameters
    ----------
    table : dict
        `csv`, the file; `column`, its name in the first line; `unit` of its values; their `interpolation`.
    kind : str
        Kind of the quantity: a key of `KINDS`.
    folder : Path
        Folder to which the file's place is relative.
    position_kind : str or None
        Kind of the position that the column's load follows, "length" or "angle"; None where it follows none.

    Returns
    -------
    DataArray
        Values [`KINDS[kind].unit`] over theta2 [degree], or position; the interpolation among its attributes.

    Raises
    ------
    ValueError
        One problem a line, each starting with its key in the table; those of the file with its name and line.
    """
    listed = f"; a CSV column has {', '.join(KEYS)}"
    refuse([f"{key_as_toml(key)}: unknown key{did_you_mean(key, KEYS) or listed}" for key in table if key not in KEYS])
    unit, attributes = _unit(table, kind), interpolation_attribute(table)
    if not isinstance(table["csv"], str) or not table["csv"].isprintable():
        raise ValueError(f'csv = {as_toml(table["csv"])}: must be the name of a file, as in csv = "indicator.csv"')
    name, rows = table["csv"], _rows(table["csv"], folder)
    headings = [_heading(cell) for cell in rows[0].cells]
    column, over, first_line = _column(table, headings), headings[0].name, f"csv: {name}:{rows[0].line}"
    unit = _unit_of_column(first_line, headings[column], kind, unit)
    over_kind = "angle" if over == "theta2" else position_kind
    if over_kind is None:
        must = 'give the load the position that it follows, as in over = "slider.position", or a first column theta2'
        raise ValueError(f"{first_line}: the first column is position, but over is missing; {must}")
    samples = _at_si_places(first_line, _samples(name, rows, column), headings[0], over_kind)
    refuse(_order_problems(name, samples, over))
    if over == "theta2":
        refuse(_angle_problems(name, samples, steps=table.get("interpolation") == "step"))
    angles = np.array([sample.angle for sample in samples])
    values = [_in_si(name, sample, kind, unit) for sample in samples]
    return xr.DataArray(values, {over: angles}, over, attrs=attributes)


def _unit(table: dict[str, Any], kind: str) -> str | None:
    try:
        return accepted_unit(str(table["unit"]), kind) if "unit" in table else None
    except ValueError as error:
        raise ValueError(f"unit = {as_toml(table['unit'])}: {error}") from None


def _rows(name: str, folder: Path) -> list[Row]:
    """Return the lines of the file that are not empty, with their line numbers."""
    text = text_of(folder / name, f"csv: {name}", ".csv", f" in {folder}", "; give its place from there")
    header = next((line for line in text.splitlines() if line.strip()), "")
    delimiter = max(",;\t", key=header.count)
    reader = csv.reader(text.splitlines(), delimiter=delimiter)
    rows = []
    try:
        for cells in reader:
            row = Row(reader.line_num, [cell.strip() for cell in cells])
            if max(map(len, row.cells), default=0) > LONGEST_CELL:
                raise ValueError(f"csv: {name}:{row.line}: a cell has more than {LONGEST_CELL} characters")
            rows += [row] * any(row.cells)
    except csv.Error as error:
        raise ValueError(f"csv: {name}:{reader.line_num}: cannot be read as CSV: {error}") from None
    refuse(_header_problems(name, rows))
    return rows


def _header_problems(name: str, rows: list[Row]) -> list[str]:
    """Return the problem of a first line that does not name the columns; a file of another kind is not quoted."""
    line, cells = rows[0] if rows else (1, [])
    if len(cells) > 1 and _heading(cells[0]).name in OVER:
        return []
    known = [cell for cell in cells if "theta" in cell.lower()]
    there = f"its columns are {', '.join(map(as_toml, cells))}: " if known else ""
    must = "the first line must name the columns, the first of them theta2 (in degrees) or position, as in theta2,P"
    return [f"csv: {name}:{line}: {there}{must}"]


def _heading(cell: str) -> Heading:
    """Return the name of a column and the unit that it states, as in "P [lbf]"."""
    match = HEADING.fullmatch(cell)
    return Heading(match[1], match[2].strip()) if match else Heading(cell, None)


def _column(table: dict[str, Any], headings: list[Heading]) -> int:
    """Return the position of the column that the table names, with its unit or without."""
    names = [heading.name for heading in headings]
    if "column" not in table:
        listed = ", ".join(names[1:])
        refuse([] if len(names) == 2 else [f"csv: column is missing; write column = one of {listed}"])
        return 1
    column = table["column"]
    if isinstance(column, str) and _heading(column) in headings[1:]:
        return 1 + headings[1:].index(_heading(column))
    refuse(name_problems("column", column, names[1:]))
    return 1 + names[1:].index(column)


def _unit_of_column(place: str, heading: Heading, kind: str, unit: str | None) -> str | None:
    """Return the unit of a column's values: that of the table or that of its heading, which must not contradict."""
    if heading.unit is None:
        return unit
    stated = _accepted(place, heading, kind)
    refuse([] if unit in (None, stated) else [f'{place}: {heading.name} is in {stated}; leave unit = "{unit}" out'])
    return stated


def _at_si_places(place: str, samples: list[Sample], over: Heading, kind: str) -> list[Sample]:
    """Return samples with their angles in degrees, or positions in SI units."""
    if over.unit is None:
        return samples
    spelling = _accepted(place, over, kind)
    return [sample._replace(angle=quantity(sample.angle, kind, spelling)) for sample in samples]


def _accepted(place: str, heading: Heading, kind: str) -> str:
    """Return the listed spelling of the unit of a heading, which must be of this kind."""
    try:
        return accepted_unit(str(heading.unit), kind)
    except ValueError as error:
        raise ValueError(f"{place}: {heading.name} [{heading.unit}]: {error}") from None


def _samples(name: str, rows: list[Row], column: int) -> list[Sample]:
    header, *body = rows
    problems, samples = [], []
    for line, cells in body:
        if len(cells) != len(header.cells):
            problems.append(f"csv: {name}:{line}: has {len(cells)} cells, but the first line names {len(header.cells)}")
            continue
        angle, value = _number(cells[0]), _number(cells[column])
        for k, number in {0: angle, column: value}.items():
            if not math.isfinite(number):
                comma = ", with a decimal point" if "," in cells[k] else ""
                problems.append(f"csv: {name}:{line}: {header.cells[k]} = {as_toml(cells[k])}: must be a number{comma}")
        samples.append(Sample(line, angle, value))
    if len(problems) > MOST_SHOWN:
        problems[MOST_SHOWN:] = [f"csv: {name}: and {len(problems) - MOST_SHOWN} more lines like these"]
    refuse(problems)
    return samples


def _number(cell: str) -> float:
    try:
        return float(cell)
    except ValueError:
        return math.nan


def _in_si(name: str, sample: Sample, kind: str, unit: str | None) -> float:
    try:
        return quantity(sample.value, kind, unit)
    except ValueError as error:
        raise ValueError(f"csv: {name}:{sample.line}: {error}") from None


def _order_problems(name: str, samples: list[Sample], over: str) -> list[str]:
    """Return the problem of angles, or positions, that do not rise."""
    rises = np.diff([sample.angle for sample in samples])
    if len(rises) < 1:
        return [f"csv: {name}: has {len(samples)} rows of numbers: give at least 2"]
    if not (rises > 0.0).all():
        k = int(np.argmin(rises > 0.0))
        advice = "is less than the one before: sort the rows"
        if rises[k] == 0.0:
            advice = "stands twice: give each angle once"
        return [f"csv: {name}:{samples[k + 1].line}: {over} = {samples[k + 1].angle:.15g} {advice}"]
    return []


def _angle_problems(name: str, samples: list[Sample], steps: bool) -> list[str]:
    """Return the problem of angles that do not go all the way round, in one turn or several; a step holds for any."""
    if len(samples) < 4 and not steps:
        return [f"csv: {name}: has {len(samples)} rows of numbers: give at least 4, all the way round"]
    angles = np.array([sample.angle for sample in samples])
    rises = np.diff(angles)
    span = float(angles[-1] - angles[0])
    period = 360.0 * max(np.ceil(span / 360.0), 1.0)
    open_ = period - span > 1.5 * rises.max() or rises.max() > 180.0
    if span > period or (open_ and not steps):
        return [
            f"csv: {name}: its angles run from {angles[0]:.15g} to {angles[-1]:.15g} degrees, steps at most "
            f"{rises.max():.6g}: they must go round whole turns (360, 720, …)"
        ]
    if span == period and samples[0].value != samples[-1].value:
        return [
            f"csv: {name}:{samples[-1].line}: its values at {angles[0]:.15g} and {angles[-1]:.15g} degrees differ, but "
            f"they are the same position; make them equal or leave one out"
        ]
    return []
