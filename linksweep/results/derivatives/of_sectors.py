"""Largest values of a quantity in equal sectors of the cycle, with their derivatives: the rises of a minimax search.

The largest value in a sector is that of a rise, or that at one end of the sector. The derivative of either is that at
its own angle (`linksweep.results.derivatives.of_peaks`), so that it does not jump as a rise passes from one sector into
the next.
"""

from __future__ import annotations

import numpy as np

from linksweep.engine.quantity import opposite_of
from linksweep.results.derivatives.of_peaks import rise_derivatives
from linksweep.results.derivatives.samples import pairs_over
from linksweep.results.peak_search.rises import sector_peaks
from linksweep.scene.derivatives.differentiated import ANGLE, differentiated
from linksweep.scene.pairs import Array
from linksweep.scene.scene import Scene


def sector_derivatives(
    scene: Scene, name: str, signs: tuple[float, ...], sectors: int, to: tuple[str, ...]
) -> tuple[Array, Array]:
    """Return the largest values of a quantity in each sector, and their derivatives (rise, parameter).

    Parameters
    ----------
    scene : scene of any number of designs, each with rises of its own
    name : quantity, of a magnitude its square
    signs : 1 for the quantity's own rises, -1 for those of the opposite quantity
    sectors : number of equal sectors of the cycle
    to : paths of the parameters

    Returns
    -------
    values (rise,), of every sign, design and sector, NaN where there is no motion, and derivatives, 0 there
    """
    signals = tuple(name if sign > 0.0 else opposite_of(name) for sign in signs)
    values, angles = sector_peaks(scene, signals, sectors)
    own = differentiated(scene, (name,), (*to, ANGLE))
    every = pairs_over(own, tuple(own.at_one_angle.inputs.sizes))
    slopes = np.zeros((*values.shape, len(to)))
    for sign, height, angle, slope in zip(signs, values, angles, slopes, strict=True):
        design, sector = np.nonzero(np.isfinite(height))
        at = design, sector
        of_rises, *_ = rise_derivatives(every.some(design), name, to, angle[at], sign * height[at])
        slope[at] = sign * of_rises.T
    return values.ravel(), np.nan_to_num(slopes.reshape(-1, len(to)))
