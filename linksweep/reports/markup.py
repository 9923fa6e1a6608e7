"""HTML in small pieces, and numbers as text.

Text is escaped wherever it is put into a piece; only a Markup goes in as it stands.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from html import escape
from typing import Any

from linksweep.plot.kit import signals
from linksweep.tables.cells import fixed

NONE, THIN = "–", "\u202f"  # where there is no number; the narrow space within one, that no line breaks at
VOID = ("img",)  # elements that have no contents
RAISED = str.maketrans("0123456789−", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")
LOWERED = str.maketrans("0123456789s", "₀₁₂₃₄₅₆₇₈₉ₛ")


class Markup(str):
    """Text that is HTML already."""

    __slots__ = ()


def safe(content: Any) -> Markup:
    """Return content as HTML: a Markup as it is, anything else as escaped text."""
    return content if isinstance(content, Markup) else Markup(escape(str(content)))


def joined(*pieces: Any) -> Markup:
    """Join pieces of content."""
    return Markup("".join(map(safe, pieces)))


def tag(name: str, *contents: Any, **attributes: str) -> Markup:
    """Return an element with its contents; ``class_`` stands for the attribute class."""
    words = "".join(f' {key.rstrip("_")}="{escape(value)}"' for key, value in attributes.items())
    end = "" if name in VOID else f"</{name}>"
    return Markup(f"<{name}{words}>{joined(*contents)}{end}")


def table(header: Sequence[Any], rows: Iterable[Sequence[Any]], **attributes: str) -> Markup:
    """Return a table; the first cell of each row is its head."""
    lines = [tag("tr", tag("th", row[0], scope="row"), *(tag("td", cell) for cell in row[1:])) for row in rows]
    head = [tag("thead", tag("tr", *(tag("th", cell, scope="col") for cell in header)))] if header else []
    return tag("table", *head, tag("tbody", *lines), **attributes)


def section(title: str, *contents: Markup) -> Markup:
    """Return a part of a page under its title; nothing where there is nothing to show."""
    return tag("section", tag("h2", title), *contents) if any(contents) else Markup()


def number(value: float, unit: str = "", text: str = "") -> Markup:
    """Return a number with its unit, in four significant digits or as `text`.

    The whole of the number stands in the element's value, for whoever reads the page by a program.
    """
    if math.isnan(value):
        return safe(NONE)
    digits = written(text or signals.number(value)) if math.isfinite(value) else "∞" if value > 0.0 else "−∞"
    return joined(tag("data", digits, value=repr(float(value))), with_unit("", unit))


def tiny(value: float) -> Markup:
    """Return a number in two digits, where only its order of magnitude matters."""
    return number(value, text=f"{value:.1e}" if value else "0")


def angle(value: float, digits: int = 1) -> Markup:
    """Return an angle [degree]."""
    return number(value, "°", fixed(value, digits))


def with_unit(text: str, unit: str) -> str:
    """Return a number's text and its unit without a line break between them."""
    return text + (unit if unit in ("", "°") else THIN + unit)


def written(text: str) -> str:
    """Return a number's digits in groups of three where there are five or more, its power of ten raised."""
    digits, _, power = text.replace("-", "−").partition("e")
    whole, point, rest = digits.partition(".")
    if len(whole.lstrip("−")) > 4:
        whole = re.sub(r"(?<=\d)(?=(\d{3})+$)", THIN, whole)
    raised = f"·10{str(int(power.replace('−', '-'))).replace('-', '−').translate(RAISED)}" if power else ""
    return whole + point + rest + raised


def symbol(name: str) -> str:
    """Return F32 as F₃₂; a name in words without its underscores."""
    letter, rest = name[:1], name[1:]
    numbered = re.fullmatch(r"\d+(_\d+)?|s", rest)
    return letter + rest.replace("_", ",").translate(LOWERED) if numbered else name.replace("_", " ")
