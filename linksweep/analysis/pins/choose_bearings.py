"""Choose the rolling bearing of each pin by life and static safety.

    P = (∫ F^p |dψ| / ∫ |dψ|)^(1/p)    equivalent load over the relative rotation ψ, as of `linksweep.bearings`
    C ≥ P·L^(1/p)                      L: the life asked for, in million revolutions of the pin; p = 3, of rollers 10/3
    C0 ≥ s0·F_peak                     s0: the static safety asked for; F_peak: the exact largest load

A pin that does not turn needs its static rating alone. Source: ISO 281, ISO 76.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from linksweep.analysis.pins.bearing import EXPONENTS, Bearing, checked_pins
from linksweep.analysis.pins.bearings import bearings
from linksweep.analysis.pins.catalogue import SIZES, DeepGroove, catalogue
from linksweep.base.units import quantity
from linksweep.base.validate import as_float, choice_problems, listed, name_problems, quote, refuse
from linksweep.engine.threads import limits_threads
from linksweep.results.dataset import by_command, flags, with_units
from linksweep.scene.scene import Scene

SAMPLES = 24
"""Angles of the cycle whose integrals are taken, which do not depend on it."""
NONE, SIZE = "none", "_size"
TEXTS = {
    "required_capacity": ("N", "basic dynamic load rating C that the life asks for"),
    "required_static_capacity": ("N", "basic static load rating C0 that the static safety asks for"),
    "F_peak": ("N", "largest load of the pin"),
    "equivalent_load": ("N", "constant load of the same life as the cycle's loads"),
    "rotation": ("degree", "angle that the journal turns in its bearing on the crank's way, to and fro added up"),
    "bore": ("m", "bore of the chosen bearing"),
    "outside": ("m", "outside diameter of the chosen bearing"),
    "width": ("m", "width of the chosen bearing"),
    "capacity": ("N", "basic dynamic load rating C of the chosen bearing"),
    "static_capacity": ("N", "basic static load rating C0 of the chosen bearing"),
    "L10h": ("h", "running time that nine of ten of the chosen bearings reach"),
    "static_safety": ("1", "C0 of the chosen bearing over the largest load"),
}


@limits_threads
def choose_bearings(
    scene: Scene,
    *,
    life: float | str,
    static_safety: float = 1.0,
    kind: str = "ball",
    series: Iterable[str] = ("60", "62", "63"),
    bore: float | str | Mapping[str, float | str] | None = None,
    outside: float | str | Mapping[str, float | str] | None = None,
    theta2: Any = None,
    threads: int | None = None,
) -> xr.Dataset:
    """Choose the smallest deep-groove ball bearing of each pin that reaches a life and a static safety.

    Bores from 10 to 50 mm with dimensions of ISO 15, and load ratings by the formulas of ISO 281 and ISO 76, as of
    `linksweep.analysis.pins.catalogue`: a size to begin with, for makers' own ratings differ by up to 15 %.

    Parameters
    ----------
    scene : Scene
        Machine with pins, of any number of designs.
    life : float or str
        Running time that nine of ten bearings are to reach, in hours [h] or a text with a unit, "10000 h".
    static_safety : float, default 1.0
        Least ratio of the static rating C0 to the largest load [1]: 1 for quiet running, 2 where it must be very quiet
        or there are shocks.
    kind : str, default "ball"
        "ball" with p = 3; or "roller" with p = 10/3, of which only the required ratings are computed.
    series : iterable of str, default ("60", "62", "63")
        Series to choose from.
    bore : float, str or mapping, default None
        Least bore [m] or text with a unit, of all pins, or by pin, {"B": "20 mm"}; None for any.
    outside : float, str or mapping, default None
        Largest outside diameter, likewise [m]; None for any.
    theta2 : array_like, default None
        First and last crank angle [degree] of the way of a machine that moves over part of a turn, or angles as in
        `linksweep.bearings`; None, or a count, for the whole cycle.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Over (design dims…, pin):

        - `equivalent_load` [N], `rotation` [degree], `F_peak` [N]; `required_capacity` and `required_static_capacity`
          [N], infinite where a load is unbounded
        - `choice`: number of the bearing among its `flag_meanings`, "none" where none of the catalogue is large enough,
          then "6000" and so on; of least outside diameter, of equal ones the narrowest
        - of the chosen one `bore`, `outside`, `width` [m], `capacity`, `static_capacity` [N], `L10h` [h] and
          `static_safety` [1]; NaN without one

    Raises
    ------
    ValueError
        If the machine has no pins, or a parameter is out of bounds.

    Notes
    -----
    Loads are radial, without shocks beyond the computed ones. Swings so small that the paths of the balls do not
    overlap want more care.

    Examples
    --------
    >>> import linksweep as ls
    >>> print(ls.choose_bearings(ls.example("press"), life="10000 h", bore="20 mm").linksweep)
    pin  largest [N]  equivalent [N]  C ≥ [N]  C0 ≥ [N]  bearing  size [mm]      L10h [h]     s0
    A          365.6           282.9     1598     365.6  6004     20 × 42 × 12    2475000  14.63
    B          354.5           268.6     1517     354.5  6004     20 × 42 × 12    2893000  15.08
    C          388.3           196.3    747.7     388.3  6004     20 × 42 × 12  2.414e+07  13.77
    D          376.3           194.6    767.2     376.3  6004     20 × 42 × 12  2.234e+07  14.21
    """
    links = checked_pins(scene, None)
    hours = _hours(life)
    series = listed(series)
    refuse(choice_problems("kind", kind, EXPONENTS) + _problems(static_safety, series))
    bores, outsides = _limits("bore", bore, links, 0.0), _limits("outside", outside, links, np.inf)
    pins = {pin: Bearing(capacity=1.0, kind=kind) for pin in links}
    loads = bearings(scene, pins, theta2=SAMPLES if theta2 is None else theta2)
    largest = loads["F_peak"]
    turning = loads["L10h"].notnull() | (loads["rotation"] != 0.0)
    required = xr.where(turning, (hours / loads["L10h"]) ** (1.0 / EXPONENTS[kind]), 0.0)  # L10h ~ C^p, here of C = 1 N
    required_static = float(static_safety) * largest
    results = {"equivalent_load": loads["equivalent_load"], "rotation": loads["rotation"], "F_peak": largest}
    results |= {"required_capacity": required, "required_static_capacity": required_static}
    choice = {}
    if kind == "ball":
        known = [one for one in catalogue() if one.series in series]
        at = _first(known, required, required_static, bores, outsides)
        results |= _of_chosen(known, at, loads["L10h"], largest)
        names = flags(
            "smallest bearing of the catalogue that reaches life and static safety",
            [NONE, *(o.designation for o in known)],
        )
        choice["choice"] = (at + 1).astype(np.int8).transpose(..., "pin").assign_attrs(names)
    attributes = loads.attrs | by_command(
        f"linksweep.choose_bearings(scene, life={life!r}, static_safety={static_safety}, ...)"
    )
    described = with_units({name: (values.transpose(..., "pin"), *TEXTS[name]) for name, values in results.items()})
    designs = {name: values for name, values in loads.coords.items() if not {"theta2", "frame"} & {*values.dims}}
    return xr.Dataset({**choice, **described, "life_status": loads["life_status"]}, designs, attributes)


def _first(
    known: list[DeepGroove], required: xr.DataArray, required_static: xr.DataArray, bores: Any, outsides: Any
) -> xr.DataArray:
    """Return the place of the first bearing that suffices, −1 where none does."""
    sizes = {name: xr.DataArray([getattr(one, name) for one in known], dims=SIZE) for name in DeepGroove._fields[2:]}
    enough = (sizes["capacity"] >= required) & (sizes["static_capacity"] >= required_static)
    enough = enough & (sizes["bore"] >= bores) & (sizes["outside"] <= outsides)
    return xr.where(enough.any(SIZE), enough.argmax(SIZE), -1)


def _of_chosen(
    known: list[DeepGroove], at: xr.DataArray, life_of_1_newton: xr.DataArray, largest: xr.DataArray
) -> dict[str, xr.DataArray]:
    """Return sizes and ratings of the chosen bearings, with the life and the safety that they reach."""

    def field(name: str) -> xr.DataArray:
        values = np.array([getattr(one, name) for one in known])
        return at.copy(data=values[at.values]).where(at >= 0)

    chosen = {name: field(name) for name in DeepGroove._fields[2:]}
    life = life_of_1_newton * chosen["capacity"] ** EXPONENTS["ball"]
    return chosen | {"L10h": life, "static_safety": chosen["static_capacity"] / largest}


def _hours(life: Any) -> float:
    """Return a running time in hours."""
    try:
        hours = quantity(life, "life")
    except ValueError as error:
        raise ValueError(f"life = {error}") from None
    refuse([] if hours > 0.0 else [f"life = {quote(life)}: must be greater than 0"])
    return hours


def _problems(static_safety: Any, series: list[Any]) -> list[str]:
    number = as_float(static_safety)
    sound = number is not None and 0.0 < number < np.inf
    problems = [] if sound else [f"static_safety = {quote(static_safety)}: must be a number greater than 0"]
    problems += [] if series else ["series: is empty; name one or more of 60, 62, 63"]
    return problems + [line for name in series for line in choice_problems("series", name, SIZES)]


def _limits(path: str, limit: Any, links: Iterable[str], missing: float) -> xr.DataArray:
    """Return the limit of a diameter [m] for each pin."""
    by_pin = limit if isinstance(limit, Mapping) else {} if limit is None else dict.fromkeys(links, limit)
    refuse([line for pin in by_pin for line in name_problems(path, pin, links)])
    values, problems = dict.fromkeys(links, missing), []
    for pin, text in by_pin.items():
        try:
            values[pin] = quantity(text, "length")
        except ValueError as error:
            problems.append(f"{path} = {error}")
        else:
            problems += [] if values[pin] > 0.0 else [f"{path} = {quote(text)}: must be greater than 0"]
    refuse(list(dict.fromkeys(problems)))
    return xr.DataArray(list(values.values()), {"pin": list(values)}, "pin")
