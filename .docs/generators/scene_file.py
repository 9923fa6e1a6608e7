"""The tables of keys in the page of scene files, from the declared fields and docstrings of each class."""

import json
from collections.abc import Iterator
from dataclasses import MISSING
from pathlib import Path

from numpydoc.docscrape import ClassDoc

from generators.page import Page
from linksweep.base.fields import (
    ChoiceField,
    FieldKind,
    NumberField,
    PairField,
    PartField,
    PartsField,
    RowField,
    declared,
)
from linksweep.base.records import NamedField
from linksweep.base.units import KINDS
from linksweep.mechanisms import MECHANISMS
from linksweep.mechanisms.links import Bar, Cylinder, Disk, Gears, Guide, Link, Slider
from linksweep.scene.loads.action import LOADS
from linksweep.scene.scene import Scene

CHAPTERS = {
    "The top of the file": [Scene],
    "Machines: the table `[mechanism]`": [*MECHANISMS.values()],
    "Parts: tables of links, guides and gears": [Link, Bar, Disk, Slider, Cylinder, Guide, Gears],
    "Loads: each a table `[[loads]]`": [*LOADS.values()],
}


def write(folder: Path) -> None:
    """Write scene_keys.md, which the page of scene files includes."""
    page = Page()
    for chapter, classes in CHAPTERS.items():
        page.heading(chapter)
        for cls in classes:
            doc = ClassDoc(cls)
            page.heading(f"`{cls.__name__}`", " ".join(doc["Summary"]), level=3)
            page.table(("key", "unit", "default", "meaning"), rows_of(cls, doc))
    page.heading("Units", UNITS_TEXT)
    spellings = ((name.replace("_", " "), kind.unit, ", ".join(kind.spellings)) for name, kind in KINDS.items())
    page.table(("number", "unit of a plain number", "units that a text may have"), spellings)
    page.write(folder / "scene_keys.md")


UNITS_TEXT = 'A text is one decimal number, a space, and one of these units: `"8 cm"`, `"0.4 lbf in s^2"`.'


def rows_of(cls: type, doc: ClassDoc) -> Iterator[tuple[str, str, str, str]]:
    """Yield the key, the unit, the default and the meaning of each field that a scene file may have."""
    meanings = {
        name.strip(): " ".join(parameter.desc) for parameter in doc["Parameters"] for name in parameter.name.split(",")
    }
    for name, kind, default in declared(cls):
        if isinstance(kind, NamedField) and kind.inline:
            yield "each name in `links`", f"table: {kind.each.words}", "required", "The part of that name."
            continue
        yield f"`{name}`", _unit(kind), _default(default), meanings.get(name, "")


def _unit(kind: FieldKind) -> str:
    """Return the unit of a field, or what it holds in place of a number."""
    match kind:
        case NumberField():
            return KINDS[kind.rule.kind].unit
        case RowField():
            return f"list of {KINDS[kind.rule.kind].unit}"
        case PairField():
            return ", ".join(KINDS[each.rule.kind].unit for each in kind.numbers)
        case PartsField():
            return f"tables: {kind.each.words}"
        case PartField():
            return f"table: {kind.words}"
        case ChoiceField():
            return " or ".join(f'`"{word}"`' for word in kind.allowed)
        case NamedField():
            return "table of names"
    return "text"


def _default(default: object) -> str:
    """Return a default as TOML has it; nothing where the key may simply be left out."""
    if default is MISSING:
        return "required"
    if default is None or default in ("", (), {}):
        return ""
    return f"`{json.dumps(default)}`"
