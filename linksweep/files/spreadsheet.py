"""Results as an Excel file: the table of `linksweep.files.table`, the meaning of its columns, and the scene."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

import xarray as xr

from linksweep.base.validate import refuse
from linksweep.files.atomic import ending_of, whole, write_from_memory
from linksweep.files.table import header_of, to_pandas, without_counts
from linksweep.results.origin.in_shown_units import in_shown_units

if TYPE_CHECKING:
    from openpyxl import Workbook

MOST_ROWS = 1_048_575
"""Rows of an Excel sheet below its header."""
LONGEST_CELL = 32_767
"""Characters that a cell may have."""


def to_excel(ds: xr.Dataset, path: str | os.PathLike[str]) -> None:
    """Write a Dataset as an Excel file, whole or not at all, with the columns of `to_pandas`.

    The sheet "results" has a row for each design, or for each design and crank angle, in the units in which results are
    shown (see `linksweep.units`); NaN is an empty cell, infinity a text. The sheet "columns" says what each column
    means; "scene" has the text of the scene file. No text is a formula.

    Parameters
    ----------
    ds : Dataset
        Dataset of linksweep.
    path : str or PathLike
        File to write, "study.xlsx".

    Raises
    ------
    ValueError
        When the name of the file does not end in .xlsx, and for more rows than a sheet has.
    ImportError
        When openpyxl is not installed.
    OSError
        When the folder is missing, cannot be written or is full; an existing file stays.
    """
    ending_of(path, (".xlsx",))
    new_book, ds = _workbook_class(), without_counts(in_shown_units(ds))
    table = to_pandas(ds)
    most = f"ds has {len(table)} rows: an Excel sheet holds {MOST_ROWS}; write a .csv or a .nc file"
    refuse([most] if len(table) > MOST_ROWS else [])
    with whole(path) as temporary:
        book = new_book(write_only=True)
        _write(book, "results", table.columns, table.itertuples(index=False))
        _write(book, "columns", ("column", "unit", "meaning"), _meanings(ds))
        if isinstance(text := ds.attrs.get("scene"), str):
            _write(book, "scene", (), ([line] for line in text.splitlines()))
        write_from_memory(temporary, book.save)


def _workbook_class() -> type[Workbook]:
    try:
        from openpyxl import Workbook
    except ImportError:
        raise ImportError('Excel files need openpyxl: pip install "linksweep[excel]", or write a .csv file') from None
    return Workbook


def _meanings(ds: xr.Dataset) -> Iterator[tuple[str, str, str]]:
    for name, values in ds.variables.items():
        yield header_of(ds[name]), str(values.attrs.get("units", "")), str(values.attrs.get("long_name", ""))


def _write(book: Any, title: str, header: Iterable[str], rows: Iterable[Iterable[Any]]) -> None:
    """Write a sheet, its header bold and standing."""
    from openpyxl.styles import Font

    sheet, names = book.create_sheet(title), [*header]
    for k, name in enumerate(names):
        sheet.column_dimensions[_letters(k)].width = max(12.0, min(1.15 * len(name) + 2.0, 60.0))
    if names:
        sheet.freeze_panes = "A2"
        cells = [_cell(sheet, name) for name in names]
        for cell in cells:
            cell.font = Font(bold=True)
        sheet.append(cells)
    for row in rows:
        sheet.append([_cell(sheet, value) for value in row])


def _letters(column: int) -> str:
    from openpyxl.utils import get_column_letter

    return get_column_letter(column + 1)


def _cell(sheet: Any, value: Any) -> Any:
    """Return the content of a cell: a number as it is, NaN as nothing, a text as text and never as a formula."""
    from openpyxl.cell import WriteOnlyCell
    from openpyxl.cell.cell import ILLEGAL_CHARACTERS_RE

    plain = value.item() if hasattr(value, "item") else value
    if isinstance(plain, float) and not math.isfinite(plain):
        return None if math.isnan(plain) else str(plain)
    if not isinstance(plain, str):
        return plain
    cell = WriteOnlyCell(sheet, ILLEGAL_CHARACTERS_RE.sub("", plain)[:LONGEST_CELL])
    cell.data_type = "s"
    return cell
