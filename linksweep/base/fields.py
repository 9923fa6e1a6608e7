"""Fields of dataclasses: what each holds is declared once, on the field, by its kind.

Conversion, checks, paths, scene files and reports follow `declared(cls)`; none of them knows a field by its name.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import MISSING, dataclass, field, fields
from functools import cache, cached_property
from typing import Any, NamedTuple

import numpy as np

from linksweep.base.conversion import to_float64
from linksweep.base.units import KINDS, text_problems
from linksweep.base.validate import Rule, choice_problems, is_array, is_quantity, number_problems, quote


@dataclass(frozen=True, kw_only=True)
class FieldKind:
    """A field that may hold anything, such as a word: its owner checks it.

    Parameters
    ----------
    example : how a scene file writes it
    inline : whether the paths of what it holds leave this field's name out
    """

    example: str = '"..."'
    inline: bool = False

    @property
    def requirement(self) -> str:
        """The value that the field requires, in words."""
        return f"a text, such as {self.example}"

    def sound(self, value: Any) -> bool:
        """Return whether a value needs no conversion and has no problems, as far as one look tells."""
        return False

    def converted(self, value: Any) -> Any:
        """Return the value with its numbers as float64 in the units of their kinds; anything else as it is."""
        return value

    def items(self, value: Any) -> tuple[FieldKind, ...] | None:
        """Return the kinds of the items of a list; None for a value that is not such a list."""
        return None

    def problems(self, path: str, value: Any) -> list[str]:
        """Return the problems of a converted value, each with its path."""
        return []


@dataclass(frozen=True)
class NumberField(FieldKind):
    """A field that holds a number under a rule, or an object of a class in `parts`, which its owner checks."""

    rule: Rule
    parts: Collection[type] = ()

    @property
    def requirement(self) -> str:
        return f'{self.rule.number}, or a text such as "{KINDS[self.rule.kind].example}"'

    def sound(self, value: Any) -> bool:
        return type(value) is float and self.rule.allows(value)

    def converted(self, value: Any) -> Any:
        return to_float64(value, self.rule.kind)

    def problems(self, path: str, value: Any) -> list[str]:
        if isinstance(value, str):
            return text_problems(path, value, self.rule.kind)
        return [] if isinstance(value, tuple(self.parts)) else number_problems(path, value, self.rule)


class PlainNumber(NumberField):
    """An item of a `RowField`: a number that is the same for all designs."""

    def problems(self, path: str, value: Any) -> list[str]:
        if is_array(value):
            return [f"{path} is an array: must be {self.rule.number}, for all designs the same"]
        return super().problems(path, value)


@dataclass(frozen=True)
class ChoiceField(FieldKind):
    """A field that holds one of a few words."""

    allowed: tuple[str, ...]

    def problems(self, path: str, value: Any) -> list[str]:
        return choice_problems(path, value, self.allowed)


class ListField(FieldKind):
    """A field that holds a list, each item of a kind of its own."""

    def converted(self, value: Any) -> Any:
        kinds = self.items(value)
        return value if kinds is None else tuple(kind.converted(item) for kind, item in zip(kinds, value, strict=True))

    def problems(self, path: str, value: Any) -> list[str]:
        kinds = self.items(value)
        if kinds is None:
            return [f"{path} = {quote(value)}: must be {self.requirement}"]
        items = enumerate(zip(kinds, value, strict=True), 1)
        return [problem for k, (kind, item) in items for problem in kind.problems(f"{path}[{k}]", item)]


@dataclass(frozen=True)
class PairField(ListField):
    """A field that holds two numbers; a scene file may give the first alone where the class takes it (`or_first`)."""

    first: Rule
    second: Rule
    meaning: str
    or_first: bool = False

    @property
    def requirement(self) -> str:
        return f"a pair {self.meaning}"

    def may_be_first(self, value: Any) -> bool:
        """Return whether a value may be the first number alone."""
        return self.or_first and value is not None and not isinstance(value, str) and not _is_row(value)

    def sound(self, value: Any) -> bool:
        return type(value) is tuple and len(value) == 2 and all(map(NumberField.sound, self.numbers, value))

    def converted(self, value: Any) -> Any:
        alone = self.may_be_first(value) or (self.or_first and isinstance(value, str))
        return self.numbers[0].converted(value) if alone else super().converted(value)

    @cached_property
    def numbers(self) -> tuple[NumberField, NumberField]:
        """The kinds of the two numbers."""
        return NumberField(self.first), NumberField(self.second)

    def items(self, value: Any) -> tuple[FieldKind, ...] | None:
        return self.numbers if _is_row(value, 2) else None


@dataclass(frozen=True)
class RowField(ListField):
    """A field that holds any number of plain numbers of one kind."""

    rule: Rule

    @property
    def requirement(self) -> str:
        return f"a list, each item {self.rule.number}"

    def items(self, value: Any) -> tuple[FieldKind, ...] | None:
        return (PlainNumber(self.rule),) * len(value) if _is_row(value) else None


@dataclass(frozen=True)
class PartField(FieldKind):
    """A field that holds an object of one of several dataclasses, which a scene file names by its `type`.

    Parameters
    ----------
    classes : the classes
    base : their common base, of which a value must be
    default : the class of a table without a `type`, if any
    """

    classes: Collection[type]
    base: Any
    default: type | None = None

    @property
    def by_name(self) -> dict[str, type]:
        """Return the classes by name, the default first."""
        return {cls.__name__: cls for cls in sorted(self.classes, key=lambda cls: cls is not self.default)}

    @property
    def words(self) -> str:
        """The names of the classes in words: "Link, Bar or Disk"."""
        *others, last = self.by_name
        return f"{', '.join(others)} or {last}" if others else last

    @property
    def requirement(self) -> str:
        return f"a {self.words}"

    def problems(self, path: str, value: Any) -> list[str]:
        return [] if isinstance(value, self.base) else [f"{path} = {quote(value)}: must be {self.requirement}"]


@dataclass(frozen=True)
class CheckedPartField(PartField):
    """A field that holds an object of one of several dataclasses, whose own fields it checks."""

    def problems(self, path: str, value: Any) -> list[str]:
        return super().problems(path, value) or field_problems(value, below(path, self))


@dataclass(frozen=True)
class PartsField(ListField):
    """A field that holds any number of objects, each as a `PartField` of its own; a single one counts as a list."""

    each: PartField

    @property
    def requirement(self) -> str:
        return f"a {self.each.words}, or a list of them"

    def converted(self, value: Any) -> Any:
        if isinstance(value, self.each.base):
            return (value,)
        other = isinstance(value, str | Mapping | np.ndarray) or is_array(value) or not isinstance(value, Iterable)
        return value if other else tuple(value)

    def items(self, value: Any) -> tuple[FieldKind, ...] | None:
        return (self.each,) * len(value) if isinstance(value, tuple | list) else None


class Declared(NamedTuple):
    """A field of a dataclass: its name, what it holds, and its default (MISSING where it has none)."""

    name: str
    kind: FieldKind
    default: Any


ANYTHING = FieldKind()
POLAR_POINT = PairField(Rule("length", at_least=0.0, polar=True), Rule("angle"), "(distance in m, angle in degrees)")
"""A point in a link's own polar coordinates: distance from its first pin, angle from its line of pins."""


def declared(owner: Any) -> tuple[Declared, ...]:
    """Return the fields of a dataclass, or of an object of one, that its constructor takes."""
    return _declared(owner if isinstance(owner, type) else type(owner))


@cache
def _declared(cls: Any) -> tuple[Declared, ...]:
    return tuple(Declared(f.name, f.metadata.get("kind", ANYTHING), f.default) for f in fields(cls) if f.init)


@cache
def field_rules(cls: Any) -> Mapping[str, Rule]:
    """Return the rules of those fields of a dataclass that hold a number, by name."""
    return {name: kind.rule for name, kind, _ in declared(cls) if isinstance(kind, NumberField)}


def of_kind(kind: FieldKind, default: Any = MISSING) -> Any:
    """Return a dataclass field of a kind."""
    return field(default=default, metadata={"kind": kind})


def parameter(kind: str, default: Any = MISSING, parts: Collection[type] = (), **bounds: Any) -> Any:
    """Return a dataclass field that holds a number under a `Rule` of this kind and bounds, or one of some `parts`."""
    return of_kind(NumberField(Rule(kind, **bounds), parts), default)


def word(example: str, default: Any = MISSING) -> Any:
    """Return a dataclass field that holds a word; `example` is how a scene file may write it."""
    return of_kind(FieldKind(example=example), default)


def choice(default: str, *others: str) -> Any:
    """Return a dataclass field that holds one of a few words."""
    return of_kind(ChoiceField((default, *others)), default)


PLAIN_MARK = "_plain"


def field_problems(owner: Any, prefix: str = "") -> list[str]:
    """Return the problems of a dataclass's fields by their kinds, each with its path; a default is no problem."""
    if is_plain(owner):
        return []
    problems: list[str] = []
    for name, kind, default in declared(owner):
        value = getattr(owner, name)
        if value is not default and not kind.sound(value):
            problems += kind.problems(prefix + name, value)
    return problems


def converted_fields(owner: Any) -> dict[str, Any]:
    """Return those fields of a dataclass that change when its numbers become float64 in the units of their kinds, and
    the mark that `is_plain` looks for."""
    changed, plain = {}, True
    for name, kind, default in declared(owner):
        value = getattr(owner, name)
        if not (kind.sound(value) or value is default is None):
            plain = False
            if (new := kind.converted(value)) is not value:
                changed[name] = new
    return {PLAIN_MARK: True} if plain else changed


def is_plain(owner: Any) -> bool:
    """Return whether all fields of a dataclass were plain and sound when it was made, or left out: no arrays, and no
    problems."""
    return PLAIN_MARK in vars(owner)


def unstated(value: Any) -> bool:
    """Return whether a value is that of a field of one thing left out: None, or an empty text."""
    return not value if isinstance(value, str) else value is None


def left_out(value: Any) -> bool:
    """Return whether a value is that of a field left out: None, or an empty text, list or record."""
    if value is None or isinstance(value, (str, tuple, list)):
        return not value
    return has_fields(value) and isinstance(value, Mapping) and not value


def has_fields(value: Any) -> bool:
    """Return whether a value is an object of a dataclass, and no function that somebody has written as one."""
    # looks as is_dataclass does, in a third of its time
    return hasattr(type(value), "__dataclass_fields__") and not callable(value)


PLAIN = (float, str, type(None))
"""Types of a value that holds no other."""

Numbers = list[tuple[str, Any, str]]
"""Path, value and kind of each number."""


def numbers(owner: Any, prefix: str = "") -> Numbers:
    """Return the path, the value and the kind of each number in a dataclass, and in the dataclasses that it holds.

    Numbers that are the same for all designs are left out.
    """
    listed: Numbers = []
    for name, kind, _ in declared(owner):
        value = getattr(owner, name)
        if type(value) in PLAIN:  # most fields: one look is enough
            if type(kind) is NumberField:
                listed.append((prefix + name, value, kind.rule.kind))
        elif type(kind) is PairField and type(value) is tuple and [*map(type, value)] == [float, float]:
            pair = zip((1, 2), value, kind.numbers, strict=True)
            listed += [(f"{prefix}{name}[{k}]", item, each.rule.kind) for k, item, each in pair]
        else:
            listed += numbers_in(prefix + name, value, kind)
    return listed


def below(path: str, kind: FieldKind) -> str:
    """Return the prefix of the paths of an object's fields, from path and kind of the field that holds it."""
    return "" if kind.inline else path + "."


def numbers_in(path: str, value: Any, kind: FieldKind) -> Numbers:
    """Return the path, the value and the kind of each number in the value of a field."""
    if type(value) is not float and has_fields(value):
        return numbers(value, below(path, kind))
    if isinstance(kind, NumberField):
        return [] if isinstance(kind, PlainNumber) else [(path, value, kind.rule.kind)]
    if not (kinds := kind.items(value)):
        return []
    items = enumerate(zip(value, kinds, strict=True), 1)
    return [number for k, (item, each) in items for number in numbers_in(f"{path}[{k}]", item, each)]


def _is_row(value: Any, count: int | None = None) -> bool:
    """Return whether a value is a list, or a bare array that can only be one, of `count` items unless None."""
    return (isinstance(value, tuple | list) or _is_bare_row(value)) and (count is None or len(value) == count)


def _is_bare_row(value: Any) -> bool:
    return (isinstance(value, np.ndarray) or (is_quantity(value) and not is_array(value))) and np.ndim(value) == 1
