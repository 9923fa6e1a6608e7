"""What a parameter of a study may be: a range, a few values, a normal distribution, a tolerance.

Each gives the values below which lie given fractions of all (its quantiles), so that any even set of fractions in
(0, 1) becomes an even set of values.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from linksweep.base.validate import as_float, is_quantity, quote
from linksweep.scene.units import quantity


class Spread(Protocol):
    """What a parameter may be. `around` says that it is measured from the scene's own value."""

    @property
    def around(self) -> bool: ...

    def at(self, levels: np.ndarray, kind: str) -> np.ndarray:
        """Its values, in SI, below which lie these fractions, in (0, 1), of all."""


@dataclass(frozen=True)
class Normal:
    """A normal distribution of a parameter, for `sample`.

    Parameters
    ----------
    mean : in the parameter's unit, or text with a unit ("8 cm"); None (default): the scene's own value
    deviation : standard deviation, likewise
    within : at most so many deviations from the mean; what lies beyond is not drawn. None beyond by default

    Values are checked by the `sample` that takes it: ValueError there.

    Examples
    --------
    >>> import linksweep as ls
    >>> gaps = {"crank.length": ls.Normal(deviation="0.02 mm", within=3), "gravity[2]": ls.Normal(-9.81, 0.01)}
    >>> made = ls.sample(ls.example("press"), gaps, n=64)
    >>> bool(abs(made.mechanism.crank.length - 0.08).max() <= 6e-5)
    True
    """

    mean: float | str | None = None
    deviation: float | str = 0.0
    within: float = math.inf

    @property
    def around(self) -> bool:
        return self.mean is None

    def at(self, levels: np.ndarray, kind: str) -> np.ndarray:
        from scipy.special import ndtr, ndtri  # here: only samples need it

        mean = 0.0 if self.mean is None else _value("mean", self.mean, kind)
        deviation = _positive("deviation", _value("deviation", self.deviation, kind))
        within = _positive("within", self.within)
        least, most = ndtr((-within, within))
        return mean + deviation * ndtri(least + levels * (most - least))


@dataclass(frozen=True)
class Tolerance:
    """A tolerance on the scene's own value of a parameter, for `sample`: evenly anywhere between two limits.

    Parameters
    ----------
    lower, upper : limit deviations from the scene's own value, in the parameter's unit, or text with a unit

    Values are checked by the `sample` that takes it: ValueError there.

    Examples
    --------
    >>> import linksweep as ls
    >>> made = ls.sample(ls.example("press"), {"crank.length": ls.Tolerance("0 um", "21 um")}, n=64)
    >>> bool((made.mechanism.crank.length > 0.08).all())
    True
    """

    lower: float | str
    upper: float | str

    around = True

    def at(self, levels: np.ndarray, kind: str) -> np.ndarray:
        return _between("Tolerance", self.lower, self.upper, levels, kind)


@dataclass(frozen=True)
class _Range:
    """Evenly anywhere between two ends."""

    ends: tuple

    around = False

    def at(self, levels: np.ndarray, kind: str) -> np.ndarray:
        if len(self.ends) != 2:
            raise ValueError(f"{quote(self.ends)}: must be a range (low, high); a list [...] is a choice among values")
        return _between("", *self.ends, levels, kind)


@dataclass(frozen=True)
class _Choice:
    """One of a few values, each as likely as the others."""

    values: list

    around = False

    def at(self, levels: np.ndarray, kind: str) -> np.ndarray:
        if not self.values:
            raise ValueError("[]: must be a list of one value or more")
        values = np.array([_value(f"[{k}]", value, kind) for k, value in enumerate(self.values, 1)])
        return values[(levels * len(values)).astype(int)]


@dataclass(frozen=True)
class _Scipy:
    """A frozen distribution of scipy.stats."""

    quantiles: Any

    around = False

    def at(self, levels: np.ndarray, kind: str) -> np.ndarray:
        return np.asarray(self.quantiles(levels), dtype=float)


def spread_of(given: Any) -> Spread:
    """What was given for a parameter, as what it may be."""
    if isinstance(given, Normal | Tolerance):
        return given
    if isinstance(given, tuple):
        return _Range(given)
    if isinstance(given, list) or ((isinstance(given, np.ndarray) or is_quantity(given)) and np.ndim(given) == 1):
        return _Choice(list(given))
    quantiles = getattr(given, "ppf", None) or getattr(given, "icdf", None)
    if quantiles is None or isinstance(given, type):
        raise ValueError(
            f"{quote(given)}: must be a range (low, high), a list of values, ls.Normal, ls.Tolerance, or a frozen "
            "distribution of scipy.stats"
        )
    return _Scipy(quantiles)


def _between(name: str, low: Any, high: Any, levels: np.ndarray, kind: str) -> np.ndarray:
    least, most = (_value(end, value, kind) for end, value in (("low", low), ("high", high)))
    if not least < most:
        fixed = "swap them" if least > most else "give the scene itself a value that does not vary"
        raise ValueError(f"{name}({least:.15g}, {most:.15g}): low must be less than high; {fixed}")
    return least + levels * (most - least)


def _value(name: str, value: Any, kind: str) -> float:
    try:
        return quantity(value, kind)
    except ValueError as error:
        raise ValueError(f"{name} = {error}") from None


def _positive(name: str, value: Any) -> float:
    if (number := as_float(value)) is not None and number > 0.0:
        return number
    raise ValueError(f"{name} = {quote(value)}: must be greater than 0")
