"""Read the value of a key as the kind of its field requires; errors go to the log of the file."""

from __future__ import annotations

import re
from dataclasses import MISSING
from functools import singledispatch
from typing import Any

from linksweep.base.fields import FieldKind, ListField, NumberField, PairField, PartField, PartsField, declared
from linksweep.base.frozen import unvalidated
from linksweep.base.records import NamedField
from linksweep.base.units import KINDS, as_toml, quantity
from linksweep.base.validate import choice_problems
from linksweep.scene.file.axis import design_axis
from linksweep.scene.file.csv_table import csv_column
from linksweep.scene.file.errors import UNREAD, Log, Where

INSTEAD = 'give it as a DataArray, with interpolation="step" where it jumps'
"""Advice for a function that no samples represent."""


@singledispatch
def read(kind: FieldKind, raw: Any, where: Where, log: Log) -> Any:
    """Return the value of a key, converted as its kind requires; a word as it is, for the constructor to check."""
    return raw


@read.register
def _number(kind: NumberField, raw: Any, where: Where, log: Log) -> Any:
    """Read a number with its unit, a design axis, a CSV column, or a table of one of the kind's classes."""
    if kind.parts and isinstance(raw, dict) and "type" in raw:
        return read(PartField(kind.parts, tuple(kind.parts)), raw, where, log)
    if isinstance(raw, list):
        axis = f'{{dim = "{where[-1]}", values = [...]}}'
        return log.problem(where, f" = {as_toml(raw)}: must be one number; for a design axis write {axis}")
    try:
        return _number_table(kind, raw, where, log) if isinstance(raw, dict) else quantity(raw, kind.rule.kind)
    except ValueError as error:
        return log.refused(error, where) if isinstance(raw, dict) else log.problem(where, f" = {error}")


def _number_table(kind: NumberField, raw: dict[str, Any], where: Where, log: Log) -> Any:
    """Read the inline table that stands in place of a number. Raises ValueError."""
    if "variable" in raw:
        return log.variable(raw["variable"], where)
    if "function" in raw:
        return log.function(f": was a function {raw['function']}; {INSTEAD}", where)
    if "csv" in raw:
        return csv_column(raw, kind.rule.kind, log.folder, log.position_kind(where))
    alone, position_kind = log.dims[str(raw.get("dim"))] == 1, log.position_kind(where) or "length"
    return log.chosen(design_axis(raw, kind.rule.kind, alone, position_kind))


@read.register
def _list(kind: ListField, raw: Any, where: Where, log: Log) -> Any:
    """Read each item of a list; a list of another length is left for the constructor, which says what it must be."""
    kinds = kind.items(raw) if isinstance(raw, list) else None
    return raw if kinds is None else tuple(read(each, raw[k], (*where, k), log) for k, each in enumerate(kinds))


@read.register
def _pair(kind: PairField, raw: Any, where: Where, log: Log) -> Any:
    """Read two numbers, or the first alone."""
    alone = kind.or_first and not isinstance(raw, list)
    return _number(NumberField(kind.first), raw, where, log) if alone else _list(kind, raw, where, log)


@read.register
def _part(kind: PartField, raw: Any, where: Where, log: Log) -> Any:
    """Read a table of one of several classes, named by its `type`; without it, of the default class."""
    if not isinstance(raw, dict):
        return log.problem(where, f" = {as_toml(raw)}: {advice(kind, where)}")
    classes, words = kind.by_name, {key: value for key, value in raw.items() if key != "type"}
    likely = max(classes, key=lambda name: len(kinds_of(classes[name]).keys() & words.keys()))
    name = raw.get("type", likely if classes[likely] is kind.default else None)
    if name is None:
        log.problem((*where, "type"), f': missing; by its keys a {likely}, so write type = "{likely}"')
    elif str(name) not in classes:
        log.problem((*where, "type"), choice_problems("", name, classes)[0])
    return build(classes.get(str(name), classes[likely]), words, where, log)


@read.register
def _parts(kind: PartsField, raw: Any, where: Where, log: Log) -> Any:
    """Read a list of tables."""
    if not isinstance(raw, list) or not all(isinstance(item, dict) for item in raw):
        return log.problem(where, f": must be a list of tables; write [[{where[-1]}]] above each")
    return _list(kind, raw, where, log)


@read.register
def _named(kind: NamedField, raw: Any, where: Where, log: Log) -> Any:
    """Read a table of named things."""
    if not isinstance(raw, dict):
        return log.problem(where, f" = {as_toml(raw)}: must be a table; {advice(kind, where)}")
    return {name: read(kind.each, item, (*where, name), log) for name, item in raw.items()}


@singledispatch
def advice(kind: FieldKind, where: Where) -> str:
    """Return how to write the value of a key that is missing."""
    return f"write, for example, {where[-1]} = {kind.example}"


@advice.register
def _number_advice(kind: NumberField, where: Where) -> str:
    return f'write {where[-1]} = "{KINDS[kind.rule.kind].example}", or {kind.rule.number}'


@advice.register
def _part_advice(kind: PartField, where: Where) -> str:
    return f"write a table [{'.'.join(map(str, where))}] with its type ({' or '.join(kind.by_name)})"


def kinds_of(cls: type) -> dict[str, FieldKind]:
    """Return the kind of each key of the table of a class; things that it names inline have keys of their own."""
    return {name: kind for name, kind, _ in declared(cls) if name not in _inline_fields(cls)}


def _inline_fields(cls: type) -> dict[str, NamedField]:
    """Return the fields of a class whose things stand in its own table."""
    return {name: kind for name, kind, _ in declared(cls) if isinstance(kind, NamedField) and kind.inline}


def _inline_keys(kinds: dict[str, FieldKind], raw: dict[str, Any]) -> list[str]:
    """Return the names that things of a table may have: the words of its texts, such as "rod B-C"."""
    words = [word for text in raw.values() if isinstance(text, str) for word in re.findall(r"\w+", text)]
    return [word for word in dict.fromkeys(words) if word not in kinds]


def build(cls: Any, raw: dict[str, Any], where: Where, log: Log) -> Any:
    """Read the fields of a table and construct its class."""
    kinds, inline = kinds_of(cls), _inline_fields(cls)
    names = _inline_keys(kinds, raw) if inline else []
    for key in [key for key in raw if key not in (*kinds, *names)]:
        log.unknown(key, (*kinds, *names), cls.__name__, where)
    words = {key: read(kind, raw[key], (*where, key), log) for key, kind in kinds.items() if key in raw}
    for field, kind in inline.items():
        words[field] = read(kind, {name: raw[name] for name in names if name in raw}, where, log)
    words |= {key: UNREAD for key in kinds if key not in raw and (*where, key) in log.misplaced}  # not its default
    for key in [key for key in _required(cls, words) if key not in raw]:
        words[key] = log.missing((*where, key), advice(kinds[key], (*where, key)))
    try:
        return cls(**words)
    except (ValueError, TypeError, AttributeError, LookupError, ArithmeticError) as error:
        if isinstance(error, ValueError):
            log.refused(error, where)
        elif not log.problems:  # else it stumbled over a value that was not read
            raise
        # Unchecked, so that the scene can still look at the rest of the file; it never gets out of here.
        return unvalidated(cls, **words)


def _required(cls: Any, words: dict[str, Any]) -> list[str]:
    """Return the keys that a table must give: fields without a default, and a scene's required motion."""
    motion = getattr(words.get("mechanism"), "motion", ())[:1]
    return [*(name for name, _, default in declared(cls) if default is MISSING), *motion]
