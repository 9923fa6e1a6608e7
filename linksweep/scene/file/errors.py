"""Problems of a scene file with their lines: TOML keeps no line numbers, so they are located again here."""

from __future__ import annotations

import difflib
import re
import tomllib
from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.units import as_toml, key_as_toml
from linksweep.base.validate import did_you_mean
from linksweep.mechanisms.strokes import kind_of_position

Where = tuple[str | int, ...]  # keys and list positions down to a value, as TOML nests them

PROBLEM = re.compile(r"""[\w.\[\]]*("| = |: | has | is | holds | depends )""")
"""Beginning of a problem of a parameter, in contrast to what Python says that stumbles over one that is not sound."""
UNREAD: Any = "(not read)"
"""Stands in for a value with an error, so that the constructors can still look at the others."""


def path_of(where: Where) -> str:
    """Return the path as the constructors name it: without "mechanism", lists counted from one."""
    keys = where[1:] if where[:1] == ("mechanism",) and where[1:] not in ((), ("type",)) else where
    return "".join(f"[{key + 1}]" if isinstance(key, int) else f".{key_as_toml(key)}" for key in keys).lstrip(".")


class Log:
    """The problems of a file by place, and the arrays and files that its numbers refer to.

    Parameters
    ----------
    raw : the whole file
    arrays : arrays that ``{variable = "coupler.length"}`` in it refers to
    top : keys that belong at the top of a file
    machine : keys that belong to a mechanism, whose paths leave out "mechanism"
    folder : folder of the file, and of the files that it names
    whole : True to refuse functions that no samples represent; False to take their samples from `arrays`
    """

    def __init__(
        self,
        raw: dict[str, Any],
        arrays: Mapping[str, xr.DataArray],
        top: Collection[str],
        machine: Collection[str],
        folder: Path,
        whole: bool = True,
    ) -> None:
        named = [str(item) for at, item in _places(raw) if "dim" in at[-1:] or "dims" in at[-2:-1]]
        self.raw, self.arrays, self.dims = raw, arrays, Counter(named)
        self.top, self.machine, self.folder, self.whole = top, machine, folder, whole
        self.problems: list[tuple[Where, str]] = []
        self.misplaced: set[Where] = set()  # where keys that are not understood were meant to be

    def problem(self, where: Where, text: str) -> Any:
        self.problems.append((where, path_of(where) + text))
        return UNREAD

    def missing(self, where: Where, advice: str) -> Any:
        return UNREAD if where in self.misplaced else self.problem(where, f": missing; {advice}")

    def unknown(self, key: str, known: Collection[str], owner: str, where: Where) -> None:
        """Report a key that a table does not have: one of the scene or the mechanism, or misspelt."""
        if key in self.top:
            self.misplaced.add((key,))
            self.problem((*where, key), ": belongs at the top of the file, above the first [table]")
        elif key in self.machine:
            self.misplaced.add(("mechanism", key))
            self.problem((*where, key), ": belongs to the mechanism, right below [mechanism]")
        else:
            self.misplaced |= {(*where, meant) for meant in difflib.get_close_matches(key, known, n=1)}
            listed = f"; a {owner} has {', '.join(known)}"
            self.problem((*where, key), f": unknown key{did_you_mean(key, known) or listed}")

    def position_kind(self, where: Where) -> str | None:
        """Return the kind of the position that the load of a number follows; None where it follows none."""
        part: Any = self.raw
        for key in where[:2]:  # as in ("loads", 0)
            part = part[key]
        return kind_of_position(str(part["over"])) if isinstance(part, dict) and "over" in part else None

    def variable(self, name: Any, where: Where) -> Any:
        if str(name) in self.arrays:
            return self.arrays[name]
        return self.problem(where, f": there is no variable {as_toml(name)}{did_you_mean(name, self.arrays)}")

    def function(self, text: str, where: Where) -> Any:
        samples = self.arrays.get(path_of(where))
        return self.problem(where, text) if self.whole or samples is None else samples

    def chosen(self, array: xr.DataArray) -> xr.DataArray:
        """Return the designs of an array in the text that the Dataset still has, by their labels."""
        for dim in [dim for dim in array.dims if dim != "theta2" and dim in array.coords and dim in self.arrays]:
            labels, known = self.arrays[str(dim)].values, array.indexes[dim]
            if known.is_unique and np.isin(labels, known).all():
                places = known.get_indexer(np.atleast_1d(labels))
                array = array.isel({dim: places if labels.ndim else places[0]}).reset_coords(drop=True)
        return array

    def refused(self, error: ValueError, where: Where) -> Any:
        """Report the problems of a constructor, one a line with its path first, but for values that were not read, and
        what it stumbled over there."""
        known = {*self.misplaced, *(place for place, _ in self.problems)}
        above = {place[:k] for place in known for k in range(len(place))}
        lines = str(error).split("\n")
        for line in [line for line in lines if PROBLEM.match(line)] if self.problems else lines:
            path = re.findall(r"^[\w.\[\]]*", line)[0].rstrip(".")
            keys = tuple(int(key) - 1 if key.isdigit() else key for key in re.findall(r"\w+", path))
            place = (*where, *keys) if where or {*keys[:1]} <= {*self.top} else ("mechanism", *keys)
            if place not in above and known.isdisjoint(place[:k] for k in range(len(place) + 1)):
                self.problem(place, ("." if line.startswith('"') else "") + line[len(path) :])
        return UNREAD

    def report(self, text: str, name: str) -> str:
        """Return the problems, one a line, in the order of the file."""
        lines = _key_lines(text)

        def line(where: Where) -> int:  # what is missing has the line of what it is missing in
            return lines.get(where) or line(where[:-1])

        placed = sorted(((line(where), problem) for where, problem in self.problems), key=lambda p: p[0])
        return "\n".join(f"{name}:{number}: {problem}" for number, problem in placed)


DEEPEST = 100
"""Tables and lists inside each other; no scene goes so deep, and all that follows would."""


def document(text: str, name: str) -> dict[str, Any]:
    """Parse the TOML; an error says file, line and, for the commonest slip, what to write."""
    try:
        raw = tomllib.loads(text)
        if any(len(place) > DEEPEST for place, _ in _places(raw)):
            raise RecursionError
        return raw
    except RecursionError:
        raise ValueError(f"{name}:1: not TOML of a scene: tables or lists are nested too deep") from None
    except tomllib.TOMLDecodeError as error:
        lines = text.rstrip().split("\n")
        reason, at = str(error).partition(" (at ")[0], re.search(r"at line (\d+)", str(error))
        number = min(int(at[1]) if at else len(lines), len(lines))
        bare = re.match(r"\s*([\w.]+)\s*=\s*([-+.]?\d[^#\"\[{]*[^#\"\[{\s])", lines[number - 1])
        advice = f'; a number with a unit stands in quotes, {bare[1]} = "{bare[2]}"' if bare else ""
        if bare and "," in bare[2]:
            advice = "; a number has a decimal point, no comma; a list stands in brackets"
        raise ValueError(f"{name}:{number}: not TOML: {reason}{advice}") from None
    except ValueError as error:  # Python's own limit
        raise ValueError(f"{name}:1: not TOML of a scene: a number has too many digits ({error})") from None


def _key_lines(text: str) -> dict[Where, int]:
    """Find the line of every key: the text, which is TOML, is cut into the smallest pieces that are TOML alone."""
    lines: dict[Where, int] = {(): 1}
    counts: Counter[Where] = Counter()  # tables of each list so far
    table: Where = ()
    for start, piece in _pieces(text):
        places = [place for place, _ in _places(tomllib.loads(piece))]
        if piece.lstrip().startswith("["):
            table, places = _opened(places[-1], start, lines, counts), []
        for place in places:
            lines.setdefault((*table, *place), start)
    return lines


def _pieces(text: str) -> Iterator[tuple[int, str]]:
    """Yield each header and each key with its value, all its lines, after the number of the first of them."""
    begin, first, number, depth = 0, 1, 1, 0
    for token in _TOKEN.finditer(text + "\n"):
        number += token[0].count("\n")
        depth += (token[0] in "[{") - (token[0] in "]}")
        if token[0] == "\n" and depth == 0:
            yield first, text[begin : token.end()]
            begin, first = token.end(), number


_TOKEN = re.compile(
    r'''
    """(?:\\.|[^\\])*?""""{0,2} | '{3}.*?'{3}'{0,2} | "(?:\\.|[^"\\\n])*" | '[^'\n]*'  # strings
    | \#[^\n]* | [\[\]{}\n]
    ''',
    re.DOTALL | re.VERBOSE,
)
"""Tokens that tell where a value ends: strings, comments, brackets and ends of lines."""


def _opened(header: Where, start: int, lines: dict[Where, int], counts: Counter[Where]) -> Where:
    """Store the line of the table that a header opens, and return its place; a [[header]] ends in 0."""
    table: Where = ()
    for key, following in zip(header, (*header[1:], ""), strict=True):
        if key != 0:
            table = (*table, key)
            so_far = counts[table]
            counts[table] += following == 0
            lines.setdefault(table, start)
            table = (*table, so_far) if following == 0 else (*table, so_far - 1) if so_far else table
            lines.setdefault(table, start)
    return table


def _places(raw: Any, where: Where = ()) -> Iterator[tuple[Where, Any]]:
    """Yield the place and value of every key and list item."""
    items = raw.items() if isinstance(raw, dict) else enumerate(raw) if isinstance(raw, list) else ()
    for key, item in items:
        yield (*where, key), item
        yield from _places(item, (*where, key))
