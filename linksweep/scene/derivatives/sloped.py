"""Numbers with slopes: each operation on them follows the rules of differentiation, and gives such a number again.

For z = f(x, y) of two numbers that depend on a parameter p,   dz/dp = ∂f/∂x·dx/dp + ∂f/∂y·dy/dp

Parts, loads and machines compute with them as with floats or arrays. (A. Griewank and A. Walther, Evaluating
Derivatives, 2nd ed., section 3.1.)
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.degrees import cos_sin_low_words

RADIAN = np.pi / 180.0

PARTIALS: dict[Any, Callable[..., tuple[Any, ...]]] = {
    np.add: lambda z, x, y: (1.0, 1.0),
    np.subtract: lambda z, x, y: (1.0, -1.0),
    np.multiply: lambda z, x, y: (y, x),
    np.divide: lambda z, x, y: (1.0 / y, -(z / y)),
    np.power: lambda z, x, y: (y * x ** (y - 1.0), z * np.log(x)),
    np.remainder: lambda z, x, y: (1.0, 0.0),
    np.minimum: lambda z, x, y: (1.0 * (x <= y), 1.0 * (x > y)),
    np.maximum: lambda z, x, y: (1.0 * (x >= y), 1.0 * (x < y)),
    np.hypot: lambda z, x, y: (x / z, y / z),
    np.arctan2: lambda z, y, x: (x / (x * x + y * y), -(y / (x * x + y * y))),
    np.negative: lambda z, x: (-1.0,),
    np.positive: lambda z, x: (1.0,),
    np.absolute: lambda z, x: (1.0 - 2.0 * (x < 0.0),),
    np.sqrt: lambda z, x: (0.5 / z,),
    np.square: lambda z, x: (2.0 * x,),
    np.arcsin: lambda z, x: (1.0 / np.sqrt(1.0 - x * x),),
    np.arccos: lambda z, x: (-1.0 / np.sqrt(1.0 - x * x),),
    np.cos: lambda z, x: (-np.sin(x),),
    np.sin: lambda z, x: (np.cos(x),),
    np.degrees: lambda z, x: (1.0 / RADIAN,),
    np.radians: lambda z, x: (RADIAN,),
}
"""Partial derivatives of z = f(x, y), by operation; any other gives plain numbers, as a comparison does."""

Slopes = Mapping[str, Any]
"""Derivative of a number to each parameter on which it depends."""


class Sloped(np.lib.mixins.NDArrayOperatorsMixin):
    """A number, a float or a Variable over design dims, with its slopes to parameters."""

    def __init__(self, value: Any, slopes: Slopes) -> None:
        self.value, self.slopes = value, slopes

    def __repr__(self) -> str:
        return f"Sloped({self.value!r}, {self.slopes!r})"

    def __array_ufunc__(self, ufunc: Any, method: str, *operands: Any, **options: Any) -> Any:
        values = [value_of(x) for x in operands]
        result = ufunc(*values)
        if method != "__call__" or ufunc not in PARTIALS:
            return result
        with np.errstate(all="ignore"):  # of an exponent that does not vary
            partials = PARTIALS[ufunc](result, *values)
        return Sloped(result, _combined(partials, operands))

    def __array_function__(self, function: Any, types: Any, arguments: Any, options: Any) -> Any:
        own: dict[Any, Callable[..., Any]] = {np.where: where, np.clip: _clip}
        return own.get(function, _plain(function))(*arguments, **options)

    def __bool__(self) -> bool:
        return bool(self.value)

    def __float__(self) -> float:
        return float(self.value)

    def low_word(self, name: str, x: Any, y: Any) -> float:
        """Return the low word of a sum or product: 0, as it has no slopes, and values need no low words here."""
        return 0.0

    def marked_low(self) -> float:
        """Return a low word, likewise 0."""
        return 0.0

    def cos_sin_low_words(self) -> tuple[Any, ...]:
        """Return cosine and sine of an angle [degree], and low words, which have no slopes.

        These, too, are numbers with slopes: a Variable refuses to be multiplied by such a one.
        """
        cos, sin, *low_words = cos_sin_low_words(self.value)
        of_cos = {path: -RADIAN * sin * slope for path, slope in self.slopes.items()}
        of_sin = {path: RADIAN * cos * slope for path, slope in self.slopes.items()}
        return Sloped(cos, of_cos), Sloped(sin, of_sin), *(Sloped(low, {}) for low in low_words)

    def through(self, curve: Callable[[Any], Any], slope: Callable[[Any], Any]) -> Sloped:
        """Return a function of the number, of which the slope is known, both functions of numpy's arrays."""
        value, steep = (_mapped(function, self.value) for function in (curve, slope))
        return Sloped(value, {path: steep * own for path, own in self.slopes.items()})

    def fillna(self, number: float) -> Sloped:
        """Return the number, a plain one where it is NaN."""
        return where(np.isnan(self), number, self)


def value_of(number: Any) -> Any:
    """Return a number without slopes: a Variable where it has dims, a float of numpy where it has none."""
    number = number.value if isinstance(number, Sloped) else number
    number = number.variable if isinstance(number, xr.DataArray) else number
    single = isinstance(number, float) or (isinstance(number, xr.Variable) and not number.dims)
    return np.float64(number) if single else number


def slopes_of(number: Any) -> Slopes:
    """Return the slopes of a number; none of a plain one."""
    return number.slopes if isinstance(number, Sloped) else {}


def where(condition: Any, x: Any, y: Any) -> Sloped:
    """Return x where the condition holds, else y, with its slopes."""
    condition = value_of(condition)
    paths = {**slopes_of(x), **slopes_of(y)}
    slopes = {path: _where(condition, *(slopes_of(one).get(path, 0.0) for one in (x, y))) for path in paths}
    return Sloped(_where(condition, value_of(x), value_of(y)), slopes)


def _where(condition: Any, x: Any, y: Any) -> Any:
    labelled = any(hasattr(one, "dims") for one in (condition, x, y))
    return xr.where(condition, x, y) if labelled else np.where(condition, x, y)[()]


def _clip(number: Sloped, low: float, high: float) -> Sloped:
    return where(number < low, low, where(number > high, high, number))


def _combined(partials: tuple[Any, ...], operands: tuple[Any, ...]) -> Slopes:
    """Return the sum of the operands' slopes, each times its partial derivative."""
    total: dict[str, Any] = {}
    for partial, operand in zip(partials, operands, strict=True):
        for path, slope in slopes_of(operand).items():
            part = partial * slope
            total[path] = total[path] + part if path in total else part
    return total


def _mapped(function: Callable[[Any], Any], number: Any) -> Any:
    return number.copy(data=function(number.values)) if hasattr(number, "dims") else function(np.asarray(number))[()]


def _plain(function: Any) -> Callable[..., Any]:
    """Return a function of values alone, such as np.any."""
    return lambda *arguments, **options: function(*map(value_of, arguments), **options)
