"""Scene files: TOML with the same words as the constructors, where a number may carry its unit.

::

    omega2 = "1500 rpm"
    gravity = [0, -9.81]

    [mechanism]
    type = "FourBar"
    ground = "20 cm"

    [mechanism.crank]
    type = "Bar"
    length = {dim = "crank_length", start = "6 cm", stop = "9 cm", num = 31}
    ...

    [[loads]]
    link = "coupler"
    force = [0, "-80 lbf"]
    at = ["10 cm", 15]

    [[loads]]
    type = "Spring"
    from_ = ["ground", 0.3, 0]
    to = ["rocker", "10 cm", 15]
    rate = "2 N/mm"
    free_length = "50 mm"

In place of a number, a design axis is ``{dim = "width", values = [...]}``, or with ``start``, ``stop`` and
``num`` for values; over more dims ``{dims = ["a", "b"], values = [[...], [...]]}``. ``unit = "cm"`` is for
plain numbers, ``coords = {a = [...]}`` are labels, ``theta2 = [...]`` is short for angles [degree] there.
What changes over the revolution may stand in a CSV file, ``{csv = "indicator.csv", column = "P", unit = "kN"}``: see
`linksweep.scene.file.csv_table`. One force in place of two is that on a slider, along its guide.
Without coords, the values of a dim that occurs once in the file are its labels.

All errors of a file are reported at once, one a line: ``scene.toml:12: coupler.lenght: unknown key; did you
mean "length"?``. Paths are those of the constructors; lists count from one, as engineers do: ``loads[1]``.

`SCHEMA` says for each class what its fields hold, read off the dataclasses. A new mechanism is a row of it.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import xarray as xr

from linksweep.base.frozen import unvalidated
from linksweep.base.validate import choice_problems, refuse
from linksweep.mechanisms import FourBar, InvertedSliderCrank, LoopTrack, SliderCrank
from linksweep.mechanisms.links import Bar, Disk, Link
from linksweep.mechanisms.rows.spring_forms import GROUND
from linksweep.scene.curves.over_position import is_function
from linksweep.scene.curves.tabulated import tabulated
from linksweep.scene.file.axis import design_axis
from linksweep.scene.file.csv_table import csv_column
from linksweep.scene.file.errors import Log, Where, document, path_of
from linksweep.scene.file.file_text import document_text
from linksweep.scene.file.text_file import text_of
from linksweep.scene.loads.air_cycle import DieselCycle, OttoCycle
from linksweep.scene.loads.gas_pressure import GasPressure
from linksweep.scene.loads.kinds import ACTIONS
from linksweep.scene.loads.load import Load
from linksweep.scene.loads.springs import Damper, Spring, TorsionDamper, TorsionSpring
from linksweep.scene.scene import Scene
from linksweep.scene.units import KINDS, quantity, shown

FOLLOWING = "of a position"
UNSTEADY = "of theta2 that jumps, or changes too quickly for a file to hold it"
INSTEAD = 'give it as a DataArray, with interpolation="step" where it jumps'
"""Of a function that has no samples which stand for it."""

HEAD = """\
# A scene of linksweep: see it with "linksweep check", "peaks" or "report" and the name of this file.
# Plain numbers are in SI units, angles in degrees; a number with another unit stands in quotes, "8 cm".
"""


@dataclass(frozen=True, kw_only=True)
class Field:
    """What a field holds: here a word, which the constructor judges."""

    example: str = '"..."'

    def read(self, raw: Any, where: Where, log: Log) -> Any:
        return raw

    def advice(self, where: Where) -> str:
        return f"write, for example, {where[-1]} = {self.example}"


@dataclass(frozen=True)
class Number(Field):
    """A number, or a DataArray, of one kind of quantity."""

    kind: str

    def read(self, raw: Any, where: Where, log: Log) -> Any:
        if isinstance(raw, list):
            axis = f'{{dim = "{where[-1]}", values = [...]}}'
            return log.problem(where, f" = {shown(raw)}: must be one number; for a design axis write {axis}")
        if isinstance(raw, dict) and "variable" in raw:
            return log.variable(raw["variable"], where)
        if isinstance(raw, dict) and "function" in raw:
            return log.function(f": was a function {raw['function']}; {INSTEAD}", where)
        try:
            if isinstance(raw, dict) and "csv" in raw:
                return csv_column(raw, self.kind, log.folder)
            if isinstance(raw, dict):
                return log.chosen(design_axis(raw, self.kind, alone=log.dims[str(raw.get("dim"))] == 1))
            return quantity(raw, self.kind)
        except ValueError as error:
            return log.refused(error, where) if isinstance(raw, dict) else log.problem(where, f" = {error}")

    def advice(self, where: Where) -> str:
        return f'write {where[-1]} = "{KINDS[self.kind].example}", or a number in {KINDS[self.kind].unit}'


@dataclass(frozen=True)
class Pair(Field):
    """Two numbers."""

    first: Number
    second: Number

    def read(self, raw: Any, where: Where, log: Log) -> Any:
        if not isinstance(raw, list) or len(raw) != 2:
            return raw  # the constructor says what the two are
        return self.first.read(raw[0], (*where, 0), log), self.second.read(raw[1], (*where, 1), log)


@dataclass(frozen=True)
class Numbers(Field):
    """A list of numbers of one kind, for all designs the same."""

    each: Number

    def read(self, raw: Any, where: Where, log: Log) -> Any:
        if not isinstance(raw, list):
            return raw  # the constructor says what it must be
        return tuple(self.each.read(item, (*where, k), log) for k, item in enumerate(raw))


@dataclass(frozen=True)
class Force(Pair):
    """Two components, or one number: the force on a slider, along its guide."""

    def read(self, raw: Any, where: Where, log: Log) -> Any:
        return super().read(raw, where, log) if isinstance(raw, list) else self.first.read(raw, where, log)


@dataclass(frozen=True)
class End(Field):
    """An end of a spring: a point of the ground, or of a link in its polar coordinates."""

    def read(self, raw: Any, where: Where, log: Log) -> Any:
        if not isinstance(raw, list) or len(raw) != 3:
            return raw  # the constructor says what the three are
        point = _POINT if raw[0] == GROUND else _POLAR
        numbers = (point.first, point.second)
        return raw[0], *(number.read(raw[k], (*where, k), log) for k, number in enumerate(numbers, 1))


@dataclass(frozen=True)
class Table(Field):
    """A table of one of several classes, named by its `type`; without it, of the default class."""

    classes: dict[str, type]
    default: str | None = None

    def read(self, raw: Any, where: Where, log: Log) -> Any:
        if not isinstance(raw, dict):
            return log.problem(where, f" = {shown(raw)}: {self.advice(where)}")
        words = {key: value for key, value in raw.items() if key != "type"}
        likely = max(self.classes, key=lambda name: len(SCHEMA[self.classes[name]].keys() & words.keys()))
        name = raw.get("type", self.default if likely == self.default else None)
        if name is None:
            log.problem((*where, "type"), f': missing; by its keys a {likely}, so write type = "{likely}"')
        elif str(name) not in self.classes:
            log.problem((*where, "type"), choice_problems("", name, self.classes)[0])
        return _built(self.classes.get(str(name), self.classes[likely]), words, where, log)

    def advice(self, where: Where) -> str:
        return f"write a table [{'.'.join(map(str, where))}] with its type ({' or '.join(self.classes)})"


@dataclass(frozen=True)
class NumberOr(Number):
    """A number, or a table of one of several classes, named by its `type`."""

    table: Table

    def read(self, raw: Any, where: Where, log: Log) -> Any:
        named = isinstance(raw, dict) and "type" in raw
        return self.table.read(raw, where, log) if named else super().read(raw, where, log)


@dataclass(frozen=True)
class Tables(Field):
    """A list of tables."""

    each: Table

    def read(self, raw: Any, where: Where, log: Log) -> Any:
        if not isinstance(raw, list) or not all(isinstance(item, dict) for item in raw):
            return log.problem(where, f": must be a list of tables; write [[{where[-1]}]] above each")
        return tuple(self.each.read(item, (*where, i), log) for i, item in enumerate(raw))


def _fields(cls: Any, **special: Field) -> dict[str, Field]:
    """Return what the fields of a class hold: those with a rule a number of its kind, the others a word."""
    rules = {item.name: item.metadata.get("rule") for item in dataclasses.fields(cls) if item.init}
    return {key: Number(rule.kind) if rule else Field() for key, rule in rules.items()} | special


_LINKS = Table({"Link": Link, "Bar": Bar, "Disk": Disk}, default="Link")
_MECHANISMS = Table(
    {
        "FourBar": FourBar,
        "SliderCrank": SliderCrank,
        "InvertedSliderCrank": InvertedSliderCrank,
        "LoopTrack": LoopTrack,
    }
)
_FORCE = Force(Number("force"), Number("force"))
_POLAR = Pair(Number("length"), Number("angle"))
_POINT = Pair(Number("length"), Number("length"))
_ENDS = {"from_": End(example='["ground", 0.3, 0]'), "to": End(example='["rocker", "10 cm", 15]')}
_LINKS_TURNED = {"from_": Field(example='"ground"'), "to": Field(example='"rocker"')}
_CYCLES = Table({"OttoCycle": OttoCycle, "DieselCycle": DieselCycle})
_LOADS = Table({cls.__name__: cls for cls in ACTIONS}, default="Load")
_BREAKS = Numbers(Number("angle"))
_GRAVITY = Pair(Number("acceleration"), Number("acceleration"))

SCHEMA: dict[type, dict[str, Field]] = {
    **{cls: _fields(cls) for cls in _LINKS.classes.values()},
    FourBar: _fields(FourBar, crank=_LINKS, coupler=_LINKS, rocker=_LINKS),
    SliderCrank: _fields(SliderCrank, crank=_LINKS, rod=_LINKS),
    InvertedSliderCrank: _fields(InvertedSliderCrank, crank=_LINKS, rocker=_LINKS),
    LoopTrack: _fields(LoopTrack),
    **{cls: _fields(cls) for cls in ACTIONS},
    Load: _fields(Load, link=Field(example='"coupler"'), force=_FORCE, at=_POLAR, breaks=_BREAKS),
    GasPressure: _fields(GasPressure, pressure=NumberOr("pressure", _CYCLES), breaks=_BREAKS),
    **{cls: _fields(cls) for cls in _CYCLES.classes.values()},
    **{cls: _fields(cls, **_ENDS) for cls in (Spring, Damper)},
    **{cls: _fields(cls, **_LINKS_TURNED) for cls in (TorsionSpring, TorsionDamper)},
    Scene: _fields(Scene, mechanism=_MECHANISMS, gravity=_GRAVITY, loads=Tables(_LOADS)),
}


def read_scene(path: str | Path) -> Scene:
    """Read a scene file.

    Raises
    ------
    ValueError
        When the file is missing or has errors: all of them, one a line, each with file, line and path.

    Examples
    --------
    >>> from importlib.resources import files
    >>> read_scene(files("linksweep.scene.examples") / "press.toml").drive
    'crank'
    """
    path = Path(path)
    return parse_scene(text_of(path, str(path), ".toml"), str(path))


def parse_scene(
    text: str, name: str = "scene", arrays: Mapping[str, xr.DataArray] | None = None, whole: bool = True
) -> Scene:
    """Make a scene of the text of a scene file.

    Parameters
    ----------
    text, name : str
        The TOML text, and what messages call the file.
    arrays : mapping of str to DataArray, optional
        What ``{variable = "coupler.length"}`` in the text refers to, as `write_scene` puts it there.
    whole : bool
        Whether a function that no samples stand for is refused; else those of `arrays` are taken.

    Raises
    ------
    ValueError
        As `read_scene`.
    """
    raw = document(text, name)
    machine = {key for kind in _machines(raw) for key in SCHEMA[kind]}
    log = Log(raw, arrays or {}, SCHEMA[Scene], machine, Path(name).parent, whole)
    scene: Scene = _built(Scene, raw, (), log)
    if log.problems:
        raise ValueError(log.report(text, name))
    return scene


def write_scene(scene: Scene, elsewhere: Collection[str] = ()) -> str:
    """Return the text of a scene file from which `parse_scene` makes an equal scene, to the bit.

    Names and attributes of DataArrays are not kept, nor coordinates other than those of their dims. A function of
    theta2 stands there as `linksweep.scene.curves.tabulated` samples it; of one that has no such samples the text says
    so.

    Parameters
    ----------
    elsewhere : paths of DataArrays that are kept elsewhere: the text has ``{variable = "coupler.length"}``.
    """
    return document_text(_written(scene, (), elsewhere, scene.mechanism.period))


def toml_of(scene: Scene) -> str:
    """Return the text of a scene file for people: see `Scene.to_toml`."""
    require_writable(scene)
    return HEAD + write_scene(scene)


def require_writable(scene: Scene) -> None:
    """Raise ValueError where a function has no samples that stand for it; one of a position has none."""
    turn = scene.mechanism.period
    paths = [path for path, function in scene.functions.items() if tabulated(function, turn) is None]
    refuse([f"{path} is a function {UNSTEADY}: {INSTEAD}" for path in paths])
    follow = [k for k, load in enumerate(scene.loads, 1) if any(map(is_function, load.over_positions))]
    refuse([f"loads[{k}] has a function {FOLLOWING}: {INSTEAD}" for k in follow])


def _built(cls: Any, raw: dict[str, Any], where: Where, log: Log) -> Any:
    """Read the fields of a table and construct its class."""
    schema = SCHEMA[cls]
    for key in [key for key in raw if key not in schema]:
        log.unknown(key, schema, cls.__name__, where)
    words = {key: schema[key].read(raw[key], (*where, key), log) for key in schema if key in raw}
    for key in [key for key in _required(cls, words) if key not in raw]:
        words[key] = log.missing((*where, key), schema[key].advice((*where, key)))
    try:
        return cls(**words)
    except (ValueError, TypeError, AttributeError) as error:
        if isinstance(error, ValueError):
            log.refused(error, where)
        elif not log.problems:  # else it stumbled over a value that was not read
            raise
        # Unchecked, so that the scene can still look at the rest of the file; it never gets out of here.
        return unvalidated(cls, **words)


def _required(cls: Any, words: dict[str, Any]) -> list[str]:
    """What a table must give: fields without a default, and of a scene the first word for its mechanism's motion."""
    none = dataclasses.MISSING
    motion = getattr(words.get("mechanism"), "motion", ())[:1]
    return [*(item.name for item in dataclasses.fields(cls) if item.default is item.default_factory is none), *motion]


def _machines(raw: dict[str, Any]) -> list[type]:
    """The class of a file's mechanism; all of them where its type is not known."""
    table = raw.get("mechanism")
    kind = str(table.get("type")) if isinstance(table, dict) else ""
    return [_MECHANISMS.classes[kind]] if kind in _MECHANISMS.classes else [*_MECHANISMS.classes.values()]


def _written(value: Any, where: Where, elsewhere: Collection[str], turn: float) -> Any:
    """Return what stands in the file for a value of a scene."""
    if type(value) in SCHEMA:
        given = {key: getattr(value, key) for key in SCHEMA[type(value)]}
        turn = 0.0 if given.get("over") else turn  # what follows a position does not come round
        words = {k: _written(word, (*where, k), elsewhere, turn) for k, word in given.items() if not _left_out(word)}
        classes = {**_LINKS.classes, **_MECHANISMS.classes, **_LOADS.classes, **_CYCLES.classes}
        named = type(value) in classes.values() and type(value) is not Load
        return {"type": type(value).__name__, **words} if named else words
    if isinstance(value, (tuple, list)):
        return [_written(item, (*where, i), elsewhere, turn) for i, item in enumerate(value)]
    if isinstance(value, xr.DataArray):
        return {"variable": path_of(where)} if path_of(where) in elsewhere else _array_written(value)
    if callable(value):
        samples = tabulated(value, turn) if turn else None
        return {"function": UNSTEADY if turn else FOLLOWING} if samples is None else _array_written(samples)
    return value if isinstance(value, str) else float(value)


def _left_out(word: Any) -> bool:
    return word is None or (isinstance(word, str | tuple) and not word)


def _array_written(array: xr.DataArray) -> dict[str, Any]:
    coords = {str(dim): _labels_written(array.coords[dim].values) for dim in array.dims if dim in array.coords}
    angles = {"theta2": coords.pop("theta2")} if "theta2" in coords else {}
    dims = {"dim": array.dims[0]} if array.ndim == 1 else {"dims": list(array.dims)}
    return dims | angles | {"values": array.values.tolist()} | ({} if angles and not coords else {"coords": coords})


def _labels_written(labels: Any) -> list[Any]:
    """Return labels as a file has them; numpy knows times in nanoseconds as integers only."""
    listed: list[Any] = (labels.astype("M8[us]") if labels.dtype.kind == "M" else labels).tolist()
    return listed
