"""Values that a parameter of a study may take: a range, a few values, a normal distribution, a tolerance.

Each gives the values below which lie given fractions of all (its quantiles), so that any even set of fractions in
(0, 1) becomes an even set of values.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from linksweep.base.units import quantity
from linksweep.base.validate import as_float, is_quantity, quote


class Spread(Protocol):
    """The values that a parameter may take."""

    @property
    def around(self) -> bool:
        """True where they are measured from the scene's own value."""
        ...

    def at(self, levels: np.ndarray, kind: str) -> np.ndarray:
        """Return the values [SI] below which these fractions, in (0, 1), of all values lie."""


@dataclass(frozen=True)
class Normal:
    """A normal distribution of a parameter, for `sample`.

    Parameters
    ----------
    mean : float or str, default None
        Mean in the parameter's [unit], or text with a unit ("8 cm"); None for the scene's own value.
    deviation : float or str, default 0.0
        Standard deviation, likewise [unit].
    within : float, default inf
        Largest distance from the mean in standard deviations [1]; values beyond it are not drawn.

    Notes
    -----
    The `sample` that takes it checks its values, and raises ValueError.

    Examples
    --------
    >>> import linksweep as ls
    >>> gaps = {"crank.length": ls.Normal(deviation="0.02 mm", within=3), "gravity[2]": ls.Normal(-9.81, 0.01)}
    >>> drawn = ls.sample(ls.example("press"), gaps, n=64)
    >>> bool(abs(drawn.mechanism.crank.length - 0.08).max() <= 6e-5)
    True
    """

    mean: float | str | None = None
    deviation: float | str = 0.0
    within: float = math.inf

    @property
    def around(self) -> bool:
        """True where the mean is the scene's own value."""
        return self.mean is None

    def at(self, levels: np.ndarray, kind: str) -> np.ndarray:
        """Return the quantiles.

        Parameters
        ----------
        levels : array
            Fractions [1] of all values that lie below, in (0, 1).
        kind : str
            Kind of the parameter, such as "length".

        Returns
        -------
        array
            Values in the parameter's SI unit.
        """
        from scipy.special import ndtr, ndtri  # here: only samples need it

        mean = 0.0 if self.mean is None else _value("mean", self.mean, kind)
        deviation = _positive("deviation", _value("deviation", self.deviation, kind))
        within = _positive("within", self.within)
        least, most = ndtr((-within, within))
        return mean + deviation * ndtri(least + levels * (most - least))


@dataclass(frozen=True)
class Tolerance:
    """A tolerance on the scene's own value of a parameter, for `sample`: evenly between two limits.

    Parameters
    ----------
    lower : float or str
        Lower limit deviation from the scene's own value in the parameter's [unit], or text with a unit.
    upper : float or str
        Upper limit deviation, likewise [unit].

    Notes
    -----
    The `sample` that takes it checks its values, and raises ValueError.

    Examples
    --------
    >>> import linksweep as ls
    >>> drawn = ls.sample(ls.example("press"), {"crank.length": ls.Tolerance("0 um", "21 um")}, n=64)
    >>> bool((drawn.mechanism.crank.length > 0.08).all())
    True
    """

    lower: float | str
    upper: float | str

    around = True

    def at(self, levels: np.ndarray, kind: str) -> np.ndarray:
        """Return the quantiles.

        Parameters
        ----------
        levels : array
            Fractions [1] of all values that lie below, in (0, 1).
        kind : str
            Kind of the parameter, such as "length".

        Returns
        -------
        array
            Values in the parameter's SI unit.
        """
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


def spread_of(values: Any) -> Spread:
    """Return the spread that a range, a list, or a distribution stands for."""
    if isinstance(values, Normal | Tolerance):
        return values
    if isinstance(values, tuple):
        return _Range(values)
    if isinstance(values, list) or ((isinstance(values, np.ndarray) or is_quantity(values)) and np.ndim(values) == 1):
        return _Choice(list(values))
    quantiles = getattr(values, "ppf", None) or getattr(values, "icdf", None)
    if quantiles is None or isinstance(values, type):
        raise ValueError(
            f"{quote(values)}: must be a range (low, high), a list of values, ls.Normal, ls.Tolerance, or a frozen "
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
