"""Units in which tables, plots, reports, films and CSV files show results: SI, or those of a shop.

Results themselves are always in SI. A system of units is a text such as ``"in, lbf, rpm"``: a few units, from which the
others follow, a torque in ``lbf in``, an inertia in ``lb in^2``, a pressure in ``psi``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from types import TracebackType
from typing import Any

from linksweep.base.fields import FieldKind
from linksweep.base.text_table import aligned
from linksweep.base.units import KINDS, accepted_unit, as_toml, size_of
from linksweep.base.validate import did_you_mean

SYSTEMS = {"SI": "", "US": "in, lbf, lb, rpm, psi, hp", "mm": "mm, N, N m, rpm, MPa"}
"""Systems by name."""
IN_METRES = {si: (si, 1.0) for si in ("1", "m/s", "m/s^2", "kg m^2", "kg m^2/rad", "kg/m^3")}
"""Units that stay as they are where lengths are in millimetres."""
POUNDS = ("lbf",)
LISTED = ("length", "force", "torque", "mass", "inertia", "angular_velocity", "velocity", "pressure", "power", "energy")
"""Kinds of quantity that a printed system states."""


@dataclass(frozen=True)
class UnitSystem:
    """Units in which results are shown, made by `unit_system`.

    Parameters
    ----------
    text : str
        The units that were chosen, such as "in, lbf, rpm"; "" for SI.
    chosen : mapping of str to str
        The chosen unit of each kind.
    """

    text: str
    chosen: tuple[tuple[str, str], ...] = ()

    def unit(self, si: str) -> str:
        """Return the unit in which a quantity is shown whose SI unit is this."""
        return self._unit_and_size(si)[0]

    def value(self, number: Any, si: str) -> Any:
        """Return a number of SI units, or an array of them, in the unit in which it is shown."""
        size = self._unit_and_size(si)[1]
        return number if size == 1.0 else number / size

    def size(self, si: str) -> float:
        """Return the size of the shown unit in SI units."""
        return self._unit_and_size(si)[1]

    def _unit_and_size(self, si: str) -> tuple[str, float]:
        return _unit_and_size(self, si) if self.chosen and si else (si, 1.0)

    @cached_property
    def units(self) -> Mapping[str, tuple[str, float]]:
        """Unit and size, by SI unit, of what is not put together from others."""
        own = dict(self.chosen)
        imperial = own.get("force") in POUNDS
        if imperial:
            own = {"mass": "lb", "pressure": "psi", "power": "hp"} | own
        elif own.get("length") == "mm" and own.get("force", "N") == "N":
            own = {"pressure": "MPa"} | own
        known = {KINDS[kind].unit: (spelling, size_of(spelling, kind)) for kind, spelling in own.items()}
        known = ({} if imperial else IN_METRES) | known
        if "N m" not in known:
            known["N m"] = _joined([known.get("N", ("N", 1.0)), known.get("m", ("m", 1.0))])
        return {"J": known["N m"], "1": ("1", 1.0)} | known if imperial else known

    def __repr__(self) -> str:
        rows = ((kind.replace("_", " "), self.unit(KINDS[kind].unit)) for kind in LISTED)
        return "\n".join(aligned([("quantity", "shown in"), *rows], right=()))

    def _repr_html_(self) -> str:
        return f"<pre>{self!r}</pre>"


SI = UnitSystem("")


def unit_system(text: Any) -> UnitSystem:
    """Return the system of units of a text: a name of `SYSTEMS`, or units with commas between.

    Raises ValueError for what is no unit, and for two units of one kind.
    """
    if not isinstance(text, str):
        raise ValueError(_not_a_system(text))
    return _of_text(text)


@lru_cache(maxsize=64)
def _of_text(text: str) -> UnitSystem:
    chosen: dict[str, str] = {}
    for word in filter(None, map(str.strip, SYSTEMS.get(text, text).split(","))):
        kind, spelling = _kind_of(word)
        if kind in chosen:
            raise ValueError(
                f'units = {as_toml(text)}: "{chosen[kind]}" and "{word}" are both units of {kind}; keep one'
            )
        chosen[kind] = spelling
    return UnitSystem(text, tuple(chosen.items())) if chosen else SI


def _kind_of(word: str) -> tuple[str, str]:
    """Return the kind of a unit, and its listed spelling."""
    for kind in KINDS:
        try:
            return kind, accepted_unit(word, kind)
        except ValueError:
            continue
    raise ValueError(_not_a_system(word))


def _not_a_system(word: Any) -> str:
    known = [*SYSTEMS, *(spelling for kind in KINDS.values() for spelling in kind.spellings)]
    names = ", ".join(map(as_toml, SYSTEMS))
    return f'units: {as_toml(word)} is no unit{did_you_mean(word, known)}; write {names}, or units as in "in, lbf, rpm"'


@lru_cache(maxsize=512)
def _unit_and_size(system: UnitSystem, si: str) -> tuple[str, float]:
    """Return the unit in which an SI unit is shown, and its size: its factors one by one, longest first."""
    if si in system.units:
        return system.units[si]
    above, *below = si.split("/")
    parts = [_joined([*_factors(system, above)])] if above != "1" else []
    under = [_joined([*_factors(system, divisor)]) for divisor in below]
    text, size = _joined(parts)
    for divisor, of_divisor in under:
        text, size = f"{text or '1'}/{divisor}", size / of_divisor
    return text, size


def _factors(system: UnitSystem, product: str) -> Iterator[tuple[str, float]]:
    """Yield unit and size of the factors of a product such as "N m s" or "kg m^2"."""
    rest = product
    while rest:
        known = (
            unit for unit in sorted(system.units, key=len, reverse=True) if re.match(rf"{re.escape(unit)}( |$)", rest)
        )
        unit = next(known, rest.split(" ")[0])
        rest = rest[len(unit) :].lstrip()
        name, _, power = unit.partition("^")
        text, size = system.units.get(unit) or system.units.get(name, (name, 1.0))
        if unit in system.units or not power:
            yield text, size
        else:
            yield f"{text}^{power}", size ** int(power)


def _joined(parts: list[tuple[str, float]]) -> tuple[str, float]:
    """Return the product of units and of their sizes."""
    size = 1.0
    for _, each in parts:
        size *= each
    return " ".join(text for text, _ in parts), size


class UnitsField(FieldKind):
    """A field that holds the units in which results are shown."""

    def problems(self, path: str, value: Any) -> list[str]:
        try:
            unit_system(value)
        except ValueError as error:
            return [str(error)]
        return []


UNITS_FIELD = UnitsField(example='"in, lbf, rpm"')


_session: list[UnitSystem] = []
"""The system that `units` chose for the session, if any."""


class Chosen:
    """The units of a session; as a context manager it restores those before."""

    def __init__(self, system: UnitSystem | None, before: list[UnitSystem]) -> None:
        self._system, self._before = system, before

    def __enter__(self) -> Chosen:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        _session[:] = self._before

    def __repr__(self) -> str:
        return "units as each scene states them, or SI" if self._system is None else repr(self._system)


def units(system: str | None) -> Chosen:
    """Choose the units of all tables, plots, reports, films and CSV files of this session.

    Datasets, and the NetCDF files of them, stay in SI units. Angles are always in degrees.

    Parameters
    ----------
    system : str or None
        "SI", "US" (in, lbf, lb, rpm, psi, hp), "mm" (mm, N, N m, rpm, MPa), or units with commas between, from which
        the others follow: "ft, lbf, rpm". None for what each scene states as its own `units`, which is SI where it
        states none.

    Returns
    -------
    Chosen
        The units by kind of quantity, to print; in a ``with`` statement they hold in its block alone.

    Raises
    ------
    ValueError
        For what is no unit, and for two units of one kind.

    Examples
    --------
    >>> import linksweep as ls
    >>> with ls.units("US"):
    ...     print(ls.peaks(ls.example("press"), of=["F32", "T12"]).linksweep)
    quantity     value  unit    at theta2
    F32_peak   79.7034  lbf       300.27°
    T12_max    181.647  lbf in    324.69°
    T12_min   -187.844  lbf in    183.20°
    """
    before = [*_session]
    chosen = None if system is None else unit_system(system)
    _session[:] = [] if chosen is None else [chosen]
    return Chosen(chosen, before)


def shown_units(own: str = "") -> UnitSystem:
    """Return the units in which to show results: those of the session, or else a scene's own, or else SI."""
    return _session[0] if _session else unit_system(own)
