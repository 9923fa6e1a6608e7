"""Values that a parameter of a study may take: a range, a few values, a normal distribution, a tolerance.

Each returns the values below which stated fractions of all lie (its quantiles), so that any even set of fractions in
(0, 1) becomes an even set of values.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from linksweep.base.units import quantity
from linksweep.base.validate import as_float, is_quantity, quote


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


def around_own(choice: Any) -> bool:
    """Return whether values are measured from the scene's own one."""
    return isinstance(choice, Normal | Tolerance) and choice.around


def quantiles(choice: Any, levels: np.ndarray, kind: str) -> np.ndarray:
    """Return the values [SI] below which these fractions, in (0, 1), of all values lie: of a range, a list of values,
    or a distribution."""
    if isinstance(choice, Normal | Tolerance):
        return choice.at(levels, kind)
    if isinstance(choice, tuple):
        if len(choice) != 2:
            raise ValueError(f"{quote(choice)}: must be a range (low, high); a list [...] is a choice among values")
        return _between("", *choice, levels, kind)
    if isinstance(choice, list) or ((isinstance(choice, np.ndarray) or is_quantity(choice)) and np.ndim(choice) == 1):
        values = np.array([_value(f"[{k}]", value, kind) for k, value in enumerate(choice, 1)])
        if not values.size:
            raise ValueError("[]: must be a list of one value or more")
        return values[(levels * len(values)).astype(int)]
    of_scipy = getattr(choice, "ppf", None) or getattr(choice, "icdf", None)
    if of_scipy is None or isinstance(choice, type):
        raise ValueError(
            f"{quote(choice)}: must be a range (low, high), a list of values, ls.Normal, ls.Tolerance, or a frozen "
            "distribution of scipy.stats"
        )
    if shape := np.shape(of_scipy(0.5)):
        raise ValueError(f"a distribution of shape {shape}: must have one number for each of its parameters, no array")
    return np.asarray(of_scipy(levels), dtype=float)


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
