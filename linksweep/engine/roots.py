"""Roots of many functions at once, each between two places at which its values differ in sign.

Source: Dowell and Jarratt, A modified regula falsi method, BIT 11 (1971).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

STEPS = 100
"""Steps towards a root, at most: more than bisection to the last digit of an angle takes."""


def roots(
    values_at: Callable[[np.ndarray, np.ndarray], np.ndarray], x: np.ndarray, values: np.ndarray, steps: int = STEPS
) -> np.ndarray:
    """Return where functions are 0 between two places x (end, root), to rounding, or nearly, after so many steps: by
    the Illinois method and bisection.

    `values` are those at the places; `values_at` returns them for some roots, by their indices, at places between.
    """
    (a, b), (f_a, f_b) = x.copy(), values.copy()
    for step in range(steps):
        live = np.flatnonzero((np.abs(b - a) > 2.0**-51 * np.abs(b)) & (f_b != 0.0))
        if not len(live):
            break
        with np.errstate(all="ignore"):  # where both ends have the same value, or none
            middle = b[live] - f_b[live] * (b[live] - a[live]) / (f_b[live] - f_a[live])
        inside = (middle - a[live]) * (middle - b[live]) < 0.0
        middle = np.where(inside & (step % 4 != 3), middle, 0.5 * (a[live] + b[live]))
        f = np.nan_to_num(values_at(live, middle))  # where there is no value, as in a jam, the place is near enough
        beyond = (f < 0.0) == (f_b[live] < 0.0)
        a[live], f_a[live] = np.where(beyond, a[live], b[live]), np.where(beyond, 0.5 * f_a[live], f_b[live])
        b[live], f_b[live] = middle, f
    return b
