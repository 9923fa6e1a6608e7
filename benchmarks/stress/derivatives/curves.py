"""Curves that loads follow, in 50 digits: tables by the polynomials of their pieces, and waves as functions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from scipy.interpolate import CubicSpline, PchipInterpolator, PPoly

from benchmarks.stress.decimals import RADIAN, Array, directions, exactly


@dataclass(frozen=True)
class Wave:
    """A function of an angle [degree] or a position: mean + amplitude·cos(rate·x + phase), rate in degrees per unit."""

    mean: float
    amplitude: float
    rate: float
    phase: float = 0.0

    def __call__(self, x: Any) -> Any:
        return self.mean + self.amplitude * np.cos(np.radians(self.rate * x + self.phase))

    def at(self, x: Array, design: Array, order: int = 0) -> Array:
        """Return values at decimals, or derivatives of an order."""
        mean, amplitude, rate, phase = exactly(np.array([self.mean, self.amplitude, self.rate, self.phase]))
        turned = directions(rate * x + phase + 90 * order).x
        return amplitude * turned * (rate * RADIAN) ** order + (0 if order else mean)


@dataclass(frozen=True)
class Table:
    """A curve by pieces; beyond its ends it is periodic, or holds."""

    pieces: PPoly
    period: float = 0.0

    def at(self, x: Array, design: Array, order: int = 0) -> Array:
        """Return values at decimals, one of each design, or derivatives of an order."""
        start, end = exactly(self.pieces.x[[0, -1]])
        if self.period:
            x = x - exactly(self.period * np.floor((x - start).astype(float) / self.period))
        held = np.clip(x, start, end)
        piece = np.clip(np.searchsorted(exactly(self.pieces.x), held, side="right") - 1, 0, len(self.pieces.x) - 2)
        away = held - exactly(self.pieces.x[piece])
        c = self.pieces.derivative(order).c if order else self.pieces.c
        rows = (row[piece] if row.ndim == 1 else row[piece, design] for row in c)
        total: Any = 0
        for row in rows:
            total = total * away + exactly(row)
        return total * ((held == x) * 1) if order else total


def over_angle(value: Any, interpolation: str | None = None) -> Table | Wave:
    """Return the curve of a function of theta2 or of an array over it, whose period is as many turns as it spans."""
    if isinstance(value, Wave):
        return value
    table = value.sortby("theta2").transpose("theta2", ...)
    known, values = table.theta2.values.astype(float), table.values.astype(float)
    period = 360.0 * max(np.ceil((known[-1] - known[0]) / 360.0), 1.0)
    if interpolation in (None, "periodic cubic"):
        closed = np.append(known, known[0] + period), np.concatenate([values, values[:1]])
        return Table(CubicSpline(*closed, bc_type="periodic"), period)
    turns = np.concatenate([known + k * period for k in (-1, 0, 1)]), np.concatenate([values] * 3)
    return Table(_part(_pieces(*turns, interpolation), known[0], period), period)


def over_position(table: xr.DataArray, interpolation: str | None) -> Table:
    """Return the curve of an array over positions, whose end values hold beyond its ends."""
    table = table.sortby("position")
    known, values = table.position.values.astype(float), table.values.astype(float)
    if interpolation == "step":
        known, values = np.append(known, known[-1] + 1.0), np.append(values, values[-1])
    return Table(_pieces(known, values, interpolation or "linear"))


def _pieces(known: Array, values: Array, interpolation: str) -> PPoly:
    if interpolation == "pchip":
        return PchipInterpolator(known, values)
    if interpolation == "step":
        return PPoly(values[None, :-1], known)
    rise = np.diff(values, axis=0) / np.diff(known).reshape(-1, *[1] * (values.ndim - 1))
    return PPoly(np.stack([rise, values[:-1]]), known)


def _part(pieces: PPoly, start: float, period: float) -> PPoly:
    """Return the pieces of one period."""
    first, last = np.searchsorted(pieces.x, [start, start + period])
    return PPoly(pieces.c[:, first:last], pieces.x[first : last + 1])
