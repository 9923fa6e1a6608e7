"""The square system of a textbook's page, row by row."""

from __future__ import annotations

from collections.abc import Iterator

import xarray as xr

from linksweep.tables.cells import digits
from linksweep.tables.table import Part, Table


def system_parts(ds: xr.Dataset) -> Iterator[Part]:
    """Yield the table of the system at each angle: a row for each equation, a column for each unknown."""
    ds = ds if "theta2" in ds.dims else ds.expand_dims("theta2")
    unknowns = [str(name) for name in ds["unknown"].values]
    for angle in ds["theta2"].values:
        one = ds.sel(theta2=angle)
        matrix, rhs = one["matrix"].transpose("equation", "unknown").values, one["rhs"].values
        names = map(str, ds["equation"].values)
        rows = [(name, *map(digits, row), digits(side)) for name, row, side in zip(names, matrix, rhs, strict=True)]
        title = f"theta2 = {float(angle):.2f}°"
        yield Table((title, *unknowns, "= right side"), rows, right=range(1, len(unknowns) + 2))
