"""Records: things that a user names, such as the pins of a linkage, as a frozen dataclass with a field for each name.

Paths, checks, copies and scene files follow the fields of a record like those of any other dataclass.
"""

from __future__ import annotations

import keyword
import re
from collections.abc import Iterator, Mapping
from dataclasses import MISSING, dataclass, make_dataclass
from functools import cache
from typing import Any

from linksweep.base.equality import ByContent, content
from linksweep.base.fields import FieldKind, declared, of_kind
from linksweep.base.validate import quote


class Record(ByContent, Mapping[str, Any]):
    """Named things of one kind: a frozen dataclass that is read like a dict, and equal in any order of its names."""

    _each: FieldKind

    def __getitem__(self, name: str) -> Any:
        if name in self:
            return getattr(self, name)
        raise KeyError(name)

    def __contains__(self, name: object) -> bool:
        return any(name == own for own in self)

    def __iter__(self) -> Iterator[str]:
        return (name for name, *_ in declared(self))

    def __len__(self) -> int:
        return len(declared(self))

    def __eq__(self, other: object) -> bool:
        return content(self) == content(other) if isinstance(other, Mapping) else NotImplemented

    __hash__ = ByContent.__hash__

    def __repr__(self) -> str:
        return repr(dict(self))

    def __reduce__(self) -> tuple[Any, ...]:
        return record, (self._each, dict(self))


def record(each: FieldKind, things: Mapping[str, Any]) -> Record:
    """Return the record of some named things, each of one kind."""
    return _record_class(tuple(things), each)(**things)


@cache
def _record_class(names: tuple[str, ...], each: FieldKind) -> type[Record]:
    fields = [(name, Any, of_kind(each)) for name in names]
    own = {"_each": each, "__module__": __name__}
    return make_dataclass("Record", fields, bases=(Record,), namespace=own, frozen=True, eq=False, repr=False)


@dataclass(frozen=True)
class NamedField(FieldKind):
    """A field that holds any number of named things of one kind, as a mapping.

    Parameters
    ----------
    each : kind of each of them
    meaning : what they are, in words
    """

    each: FieldKind
    meaning: str

    @property
    def requirement(self) -> str:
        return f"a dict of {self.meaning} by name"

    def converted(self, value: Any) -> Any:
        """Return the record of a mapping; anything else, and a mapping with other keys than names, as it is."""
        if not isinstance(value, Mapping) or any(map(_name_problems, value)):
            return value
        own = isinstance(value, Record) and type(value) is _record_class(tuple(value), self.each)
        return value if own else record(self.each, value)

    def problems(self, path: str, value: Any) -> list[str]:
        if not isinstance(value, Mapping):
            return [f"{path} = {quote(value)}: must be {self.requirement}"]
        if names := [f"{path}: {problem}" for name in value for problem in _name_problems(name)]:
            return names
        prefix = "" if self.inline else f"{path}."
        return [problem for name, item in value.items() for problem in self.each.problems(prefix + name, item)]


def named(each: FieldKind, meaning: str, example: str, default: Any = MISSING) -> Any:
    """Return a dataclass field that holds named things: see `NamedField`; `default` is a mapping."""
    kind = NamedField(each, meaning, example=example)
    return of_kind(kind, default if default is MISSING else kind.converted(default))


def _name_problems(name: Any) -> list[str]:
    """Return the problem of a key that cannot name a field of a record."""
    plain = isinstance(name, str) and re.fullmatch(r"[A-Za-z]\w*", name, re.ASCII)
    if plain and not keyword.iskeyword(name) and not hasattr(Record, name):
        return []
    return [f"{quote(name)} is no name: must be letters, digits and _, and no word of Python's own; rename it"]
