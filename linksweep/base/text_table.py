"""Format rows of text as a table for a terminal."""

from __future__ import annotations

from collections.abc import Container, Iterator, Sequence


def aligned(rows: Sequence[tuple[str, ...]], right: Container[int] = (1, 3)) -> Iterator[str]:
    """Yield the lines of a table, with the columns in `right` (numbers) aligned to the right."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        cells = enumerate(zip(row, widths, strict=True))
        yield "  ".join(cell.rjust(width) if k in right else cell.ljust(width) for k, (cell, width) in cells).rstrip()
