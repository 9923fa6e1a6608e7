"""Numbers as a text has them, in a scene file or in Python: ``"8 cm"``, ``"1500 rpm"``, ``"0.4 lbf in s^2"``.

The grammar is one decimal number, a space, one unit. A unit is a product of factors, in any order, then its
divisors: ``lbf in s^2``, ``rad/s^2``; also ``*``, ``·``, ``-`` between factors, ``²``, ``**2`` for ``^2``.

A short list has the spellings that each kind of quantity may use; any other is an error that states what to write.
pint would take "Nm" for number/m, "1 1/2 in" for half an inch and "2,5 mm" for 25 mm. The arithmetic is in fractions:
where a unit is defined exactly the result is the correctly rounded float ("8 cm" is 0.08, to the bit). The sizes of
the listed units stand here, because pint takes half a second to start; it is asked about other units that arrays state.
"""

from __future__ import annotations

import json
import math
import re
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, lru_cache
from typing import Any

from linksweep.base.validate import UNITS, did_you_mean


@dataclass(frozen=True)
class Kind:
    """One kind of quantity: the unit of a plain number, an example, and the spellings a text may use."""

    unit: str
    example: str
    spellings: tuple[str, ...]


_INERTIAS = "kg m^2, kg cm^2, kg mm^2, g cm^2, g mm^2, lb in^2, lb ft^2, slug ft^2, blob in^2, lbf in s^2, lbf ft s^2"
_TORSIONAL_RATES = "N m/rad, N m/deg, N mm/rad, N mm/deg, kN m/rad, lbf in/rad, lbf in/deg, lbf ft/rad, lbf ft/deg"
KINDS = {
    name: Kind(UNITS[name], example, tuple(spellings.split(", ")))
    for name, example, spellings in (
        ("length", "8 cm", "m, mm, cm, km, um, in, ft"),
        ("mass", "0.7 kg", "kg, g, tonne, lb, oz, slug, blob, lbf s^2/ft, lbf s^2/in"),
        ("inertia", "2.8e-3 kg m^2", _INERTIAS),
        ("area", "4 cm^2", "m^2, cm^2, mm^2, in^2"),
        ("section_modulus", "1.3 cm^3", "m^3, cm^3, mm^3, in^3"),
        ("second_moment", "1.3 cm^4", "m^4, cm^4, mm^4, in^4"),
        ("angle", "45 deg", "deg, rad, rev"),
        ("angular_velocity", "1500 rpm", "rad/s, deg/s, rpm, rev/min, rev/s"),
        ("angular_acceleration", "100 rad/s^2", "rad/s^2, deg/s^2, rev/s^2, rpm/s"),
        ("force", "80 N", "N, kN, MN, mN, lbf, kgf"),
        ("torque", "12 N m", "N m, N cm, N mm, kN m, lbf in, lbf ft, kgf m, kgf cm"),
        ("velocity", "100 km/h", "m/s, cm/s, mm/s, km/h, mph, in/s, ft/s"),
        ("acceleration", "9.81 m/s^2", "m/s^2, cm/s^2, mm/s^2, in/s^2, ft/s^2, g0"),
        ("density", "7.75 g/cm^3", "kg/m^3, g/cm^3, lb/in^3, lb/ft^3, slug/ft^3, blob/in^3"),
        ("pressure", "12 bar", "Pa, kPa, MPa, GPa, bar, mbar, psi, ksi, atm"),
        ("power", "1.5 kW", "W, kW, MW, mW, hp"),
        ("energy", "40 J", "J, kJ, MJ, mJ, kWh, cal"),
        ("spring_rate", "12 N/mm", "N/m, N/cm, N/mm, kN/m, lbf/in, lbf/ft"),
        ("damping_coefficient", "300 N s/m", "N s/m, N s/mm, kN s/m, lbf s/in, lbf s/ft"),
        ("torsional_rate", "5 N m/rad", _TORSIONAL_RATES),
        ("torsional_damping", "0.2 N m s/rad", "N m s/rad, N mm s/rad, lbf in s/rad, lbf ft s/rad"),
        ("voltage", "24 V", "V, mV, kV"),
        ("resistance", "0.6 ohm", "ohm, mohm, kohm"),
        ("torque_constant", "0.05 N m/A", "N m/A, N cm/A, mN m/A, lbf in/A, lbf ft/A"),
        ("life", "10000 h", "h, min, s"),
        ("dimensionless", "10 %", "%"),
    )
}

LONGEST_TEXT, LONGEST_UNIT = 1000, 60
"""Characters that a number with its unit, and a unit, may have."""
FINITE = "must be a finite number, at most 1.8e308"

_PI = Fraction("3.14159265358979323846264338327950288419716939937510")
_INCH, _POUND, _GRAVITY = Fraction("0.0254"), Fraction("0.45359237"), Fraction("9.80665")
_FOOT, _LBF = 12 * _INCH, _POUND * _GRAVITY
_PREFIXES = {"G": 9, "M": 6, "k": 3, "": 0, "c": -2, "m": -3, "u": -6}
_POWERS = {"m": 0, "g": -3, "s": 0, "N": 0, "Pa": 0, "bar": 5, "W": 0, "J": 0, "V": 0, "A": 0, "ohm": 0}
_SIZES = {
    prefix + unit: Fraction(10) ** (power + own) for unit, own in _POWERS.items() for prefix, power in _PREFIXES.items()
} | {
    "in": _INCH, "ft": _FOOT, "mph": 5280 * _FOOT / 3600, "g0": _GRAVITY, "min": Fraction(60), "h": Fraction(3600),
    "tonne": Fraction(1000), "lb": _POUND, "oz": _POUND / 16,
    "slug": _LBF / _FOOT, "blob": _LBF / _INCH,  # 1 lbf gives a blob, the inch's slug, 1 in/s^2
    "rad": Fraction(1), "deg": _PI / 180, "rev": 2 * _PI, "rpm": 2 * _PI / 60,
    "lbf": _LBF, "kgf": _GRAVITY, "psi": _LBF / _INCH**2, "ksi": 1000 * _LBF / _INCH**2, "atm": Fraction(101325),
    "hp": 550 * _FOOT * _LBF, "kWh": Fraction(3_600_000), "cal": Fraction("4.184"), "%": Fraction(1, 100),
}  # fmt: skip
"""Sizes of units in SI, of angles in rad: all are exact, but for those with pi, of which these are 50 digits."""

# Common slips for a unit of another kind, or of none: "ft lb" for a torque, "1/s" for rad/s.
_MEANT = {r"\blbm?\b": "lbf", r"\bHz\b": "rev/s", r"^1/s\b": "rad/s", r"^[gG]$": "g0"}

_NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:_[0-9]+)*\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_FRACTION = re.compile(r"([+-]?)(?:([0-9]+)[\s-]+)?([0-9]+)\s*/\s*0*([1-9][0-9]*)(.*)", re.DOTALL)
_COMMAS = re.compile(r"([+-]?[0-9][0-9.]*(?:,[0-9][0-9.]*)+)(.*)", re.DOTALL)
_THOUSANDS = re.compile(r"[+-]?[0-9]{1,3}(,[0-9]{3})+(\.[0-9]*)?")
_UNIT = re.compile(r"[a-z%]\w*(\^-?[0-9]+)?( [a-z%]\w*(\^-?[0-9]+)?)*(/[a-z%]\w*(\^[0-9]+)?)*", re.ASCII | re.I)
_SYMBOLS = {"**": "^", "*": " ", "·": " ", "⋅": " ", "²": "^2", "³": "^3", "µ": "u", "μ": "u"}
_SYMBOLS |= {"°": "deg", "degrees": "deg", "degree": "deg"}


def quantity(value: Any, kind: str, unit: str | None = None) -> float:
    """Read a number, or a text such as "8 cm", as a float in SI units; angles are in degrees.

    Parameters
    ----------
    value : float or str
        A number passes through: it is in SI units already; a quantity of pint is converted. A text is one decimal
        number, a space, one unit.
    kind : str
        Kind of the quantity: a key of `KINDS`.
    unit : str, optional
        The unit of plain numbers, in place of the SI unit.

    Returns
    -------
    float
        The value [`KINDS[kind].unit`], correctly rounded where the unit is defined exactly.

    Raises
    ------
    ValueError
        For any other text, and for a unit of another kind. The message states what to write.

    Examples
    --------
    >>> quantity("8 cm", "length"), quantity("1 blob", "mass"), quantity(45, "angle")
    (0.08, 175.1268352464764, 45.0)
    """
    try:
        if isinstance(value, str):
            _require_short(value, LONGEST_TEXT)
            return _scaled(*_parted(value.strip().replace("−", "-"), kind), kind)
        from linksweep.base.conversion import to_float64  # here: it reads texts by this function

        number = to_float64(value, kind)
        if not isinstance(number, float):
            raise ValueError(f'must be a number or a text such as "{KINDS[kind].example}"')
        return _finite(number) if unit is None else _scaled(repr(_finite(number)), unit, kind)
    except OverflowError:
        raise ValueError(f"{as_toml(value)}: {FINITE}") from None
    except ValueError as error:
        raise ValueError(f"{as_toml(value)}: {error}") from None


def text_problems(path: str, text: str, kind: str) -> list[str]:
    """Return the problem of a text that is no number with a unit of this kind."""
    try:
        quantity(text, kind)
    except ValueError as error:
        return [f"{path} = {error}"]
    return []


def _require_short(text: str, longest: int) -> None:
    if len(text) > longest:
        raise ValueError(f"has {len(text)} characters: must have at most {longest}")


@lru_cache(maxsize=1024)
def accepted_unit(unit: str, kind: str) -> str:
    """Return the listed spelling of `unit`, or raise a ValueError that lists the units of this kind."""
    _require_short(unit, LONGEST_UNIT)
    key = _factors(unit)
    for spelling in KINDS[kind].spellings:
        if _factors(spelling) == key:
            return spelling
    raise ValueError(_not_accepted(unit, kind))


def size_of(spelling: str, kind: str) -> float:
    """Return the size of a listed unit in the SI unit of its kind: 0.0254 of an inch."""
    return float(_factor(spelling, kind))


def unit_problems(path: str, stated: Any, kind: str) -> list[str]:
    """Return the problem of the unit that an array states: values are not converted, so it must be that of the kind."""
    unit = KINDS[kind].unit
    if not stated or stated == unit or (len(str(stated)) <= LONGEST_UNIT and _is_si(str(stated), kind)):
        return []
    there = f'{path} has attrs["units"] = {as_toml(str(stated))}'
    return [f'{there}: must be in {unit}; convert its values, and say units="{unit}", or make it an array of pint']


def as_toml(value: object) -> str:
    """Return a value as it stands in a file, cut where it is long."""
    try:
        text = repr(value) if isinstance(value, float) else json.dumps(value, ensure_ascii=False, default=str)
    except ValueError:  # an int of too many digits
        text = f"<{type(value).__name__}>"
    text = "".join(c if c.isprintable() else f"\\u{ord(c):04x}" for c in text)  # a message is one line
    return text if len(text) <= 60 else text[:57] + "..."


def key_as_toml(key: str) -> str:
    """Return a key as it stands in a file: bare, or in quotes where it needs them, cut where it is long."""
    return key if re.fullmatch(r"[\w-]{1,60}", key) else as_toml(key)


def _parted(text: str, kind: str) -> tuple[str, str]:
    """Split "8 cm" into its number and its unit."""
    if advice := _comma(text) or _fraction(text):
        raise ValueError(advice)
    match = _NUMBER.match(text)
    if not match:
        raise ValueError(_no_number(text, kind))
    number, rest = match[0], text[match.end() :]
    if advice := _bad_shape(number, rest, kind):
        raise ValueError(advice)
    unit = accepted_unit(rest.strip(), kind)
    if not rest[0].isspace():
        raise ValueError(f'needs a space between the number and the unit; write "{number} {rest}"')
    return number, unit


def _comma(text: str) -> str | None:
    """Advise on "2,5 mm" and "1,500 rpm", of which the decimal is written so that it does not look like thousands."""
    if not (match := _COMMAS.match(text)):
        return None
    number, rest = match.groups()
    point, plain = number.replace(",", "."), number.replace(",", "")
    meant = [f"{float(point):.15g}"] if _NUMBER.fullmatch(point) else []
    meant += [plain] if _THOUSANDS.fullmatch(number) or not meant else []
    written = " or ".join(f'"{item}{rest}"' for item in meant)
    return f"a comma in a number is not read; write {written}"


def _fraction(text: str) -> str | None:
    """Advise on "1 1/2 in"."""
    if not (match := _FRACTION.match(text)):
        return None
    sign, whole, upper, lower, rest = match.groups()
    decimal = float(int(whole or 0) + Fraction(int(upper), int(lower)))
    return f'a fraction is not read; write the decimal number, "{sign}{decimal:.12g}{rest}"'


def _no_number(text: str, kind: str) -> str:
    """Advise where no number starts the text."""
    finite = "a finite number" if re.match(r"[+-]?(nan|inf)", text, re.IGNORECASE) else "a number"
    return f'must be {finite}, a space and a unit, as in "{KINDS[kind].example}"'


def _bad_shape(number: str, rest: str, kind: str) -> str | None:
    """Advise where the number is not followed by one unit."""
    unit = KINDS[kind].unit
    if not rest:
        if unit == "1":
            return f"has no unit; write {number} without the quotes"
        return f'has no unit; write "{number} {unit}", or {number} without the quotes, which is in {unit}'
    if not re.match(r"\s*[A-Za-zµμ°%]|\s+1/", rest):
        return f'must be one number, a space and one unit, as in "{KINDS[kind].example}"'
    return None


def _not_accepted(unit: str, kind: str) -> str:
    """Explain why a unit is refused: the unit that was probably meant, and all that are accepted."""
    key, spellings = _factors(unit), KINDS[kind].spellings
    listed = f"accepted: {', '.join(spellings)}"
    for other, row in KINDS.items():
        if any(_factors(spelling) == key for spelling in row.spellings):
            wrong = f"{unit} is a unit of {_words(other)}, not of {_words(kind)}"
            return f"{wrong}{_meant(unit, spellings) or ';'} {listed}"
    for spelling in spellings:
        if unit.casefold() == spelling.casefold():
            return f'"{unit}" is written "{spelling}"'
        if unit.casefold() == spelling.replace(" ", "").casefold():
            return f'"{unit}" runs its units together; write them with a space, "{spelling}"'
    near = _meant(unit, spellings) or did_you_mean(unit, spellings)
    return f'"{unit}" is not an accepted unit of {_words(kind)}{near or ";"} {listed}'


def _meant(unit: str, spellings: Iterable[str]) -> str:
    """Advise on the common slips of `_MEANT`."""
    candidates = {_factors(re.sub(slip, right, unit)) for slip, right in _MEANT.items()}
    meant = [spelling for spelling in spellings if _factors(spelling) in candidates]
    return f'; did you mean "{meant[0]}"?' if meant else ""


def _factors(unit: str) -> frozenset[tuple[str, int]] | str:
    """Return a unit's factors, so that order does not matter: "ft lbf" is "lbf ft"; a text that is no unit itself."""
    for symbol, plain in _SYMBOLS.items():
        unit = unit.replace(symbol, plain)
    unit = re.sub(r"\s*([/^])\s*", r"\1", unit.strip())
    unit = re.sub(r"(?<=\w)\s*-\s*(?=[A-Za-z])|\s+", " ", unit)
    if not _UNIT.fullmatch(unit):
        return unit
    powers: dict[str, int] = {}
    for factor in re.split(r" |(?=/)", unit):
        name, _, power = factor.lstrip("/").partition("^")
        name = "lb" if name == "lbm" else name
        powers[name] = powers.get(name, 0) + int(power or 1) * (-1 if factor.startswith("/") else 1)
    return frozenset(powers.items())


def _scaled(number: str, unit: str, kind: str) -> float:
    """Return number times unit in SI, rounded once."""
    factor, rough = _factor(accepted_unit(unit, kind), kind), float(number)
    # 0 and inf stay floats: 1e-999999999 is 0, and a billion digits as a fraction.
    exact = Fraction(number.replace("_", "")) * factor if rough and math.isfinite(rough) else rough
    return _finite(exact)


@lru_cache(maxsize=1024)
def _is_si(unit: str, kind: str) -> bool:
    """Return whether a unit is that of the kind's plain numbers, however it is spelled: "metre", "m s-2"."""
    unit = re.sub(r"(?<=[A-Za-z])(?=-?[0-9])", "^", unit)  # UDUNITS writes powers without a sign
    if _factors(unit) in map(_factors, (KINDS[kind].unit, *KINDS[kind].spellings)):
        return _factors(unit) == _factors(KINDS[kind].unit) or _factor(accepted_unit(unit, kind), kind) == 1
    try:
        one = _pint().Quantity(Fraction(1), unit)
        return "hertz" not in str(one.units) and one.to(KINDS[kind].unit).magnitude == 1  # to pint, Hz is rad/s
    except Exception:  # nothing that pint knows, or of another kind
        return False


def _finite(number: Any) -> float:
    if not abs(number) <= sys.float_info.max:
        raise ValueError(FINITE)
    return float(number)


def _factor(spelling: str, kind: str) -> Fraction:
    """Return the size of a listed unit in the SI unit of its kind."""
    return _size(spelling) / _size(KINDS[kind].unit)


@cache
def _size(unit: str) -> Fraction:
    """Return the size of a product of units, or of the unit "1"."""
    factors = _factors(unit)
    powers = () if isinstance(factors, str) else factors
    return math.prod((_SIZES[name] ** power for name, power in powers), start=Fraction(1))


@cache
def _pint() -> Any:
    import pint  # here, because it takes long to start

    return pint.UnitRegistry(non_int_type=Fraction)


def _words(kind: str) -> str:
    return "a dimensionless number" if kind == "dimensionless" else kind.replace("_", " ")
