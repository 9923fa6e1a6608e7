"""A table of text, printed in a terminal and shown as HTML, and answers made of tables and remarks."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from html import escape

from linksweep.base.text_table import aligned

Row = tuple[str, ...]

STYLE = (
    "<style>.linksweep table{border-collapse:collapse;margin:.4em 0 .8em}"
    ".linksweep th,.linksweep td{padding:.15em .7em;text-align:left;white-space:nowrap}"
    ".linksweep thead th{border-bottom:1px solid currentColor}"
    ".linksweep tbody th{font-weight:normal;font-family:monospace}"
    ".linksweep .right{text-align:right;font-variant-numeric:tabular-nums}"
    ".linksweep p{margin:.4em 0;max-width:50em}</style>"
)
"""Look of the tables in a notebook: colours are the page's own, so that it also suits a dark one."""


@dataclass(frozen=True)
class Table:
    """Rows of text under a header.

    Parameters
    ----------
    header : tuple of str
        Titles of the columns; empty for a table without a header.
    rows : tuple of tuples of str
        Cells; the first of each row names what the row is about.
    right : collection of int
        Columns of numbers, which are aligned to the right.
    meanings : mapping of str to str
        What names in the first column mean; a notebook shows it where the mouse rests.
    """

    header: Row
    rows: Sequence[Row]
    right: Collection[int] = (1, 3)
    meanings: Mapping[str, str] = field(default_factory=dict)

    def __str__(self) -> str:
        lines = [self.header, *self.rows] if self.header else self.rows
        return "\n".join(aligned(lines, self.right)) if lines else ""

    def html(self) -> str:
        """Return the table as an HTML element."""
        titles = (self._cell("th", k, title) for k, title in enumerate(self.header))
        head = f"<thead><tr>{''.join(titles)}</tr></thead>" if self.header else ""
        return f"<table>{head}<tbody>{''.join(map(self._line, self.rows))}</tbody></table>"

    def _line(self, row: Row) -> str:
        first = self._cell("th", 0, row[0], f' scope="row" title="{escape(self.meanings.get(row[0], ""))}"')
        rest = (self._cell("td", k, cell) for k, cell in enumerate(row[1:], 1))
        return f"<tr>{first}{''.join(rest)}</tr>"

    def _cell(self, tag: str, column: int, text: str, attributes: str = "") -> str:
        side = ' class="right"' if column in self.right else ""
        return f"<{tag}{side}{attributes}>{escape(text)}</{tag}>"


Part = Table | str


@dataclass(frozen=True, repr=False)
class Answer:
    """Tables of a result, and remarks between them."""

    parts: tuple[Part, ...]

    def __repr__(self) -> str:
        return "\n\n".join(filter(None, map(str, self.parts)))

    def _repr_html_(self) -> str:
        pieces = (part.html() if isinstance(part, Table) else _paragraphs(part) for part in self.parts)
        return f'<div class="linksweep">{STYLE}{"".join(pieces)}</div>'


def answer(parts: Iterable[Part]) -> Answer:
    """Return an answer of those parts that are not empty."""
    return Answer(tuple(part for part in parts if (part if isinstance(part, str) else part.rows)))


def _paragraphs(text: str) -> str:
    return "".join(f"<p>{escape(line)}</p>" for line in text.splitlines())
