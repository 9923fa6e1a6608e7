"""Operating point of a machine on its motor: the speed at which the motor gives what the machine takes on average.

At a constant speed w the machine takes the mean T̄(w) over the cycle of the torque of inverse dynamics, by the
quadrature of `duty`; at the operating point i·M(i·w) = T̄(w) + L, with the torque L that the gear takes. Of several such
speeds it is the fastest, which a motor of falling torque keeps. Where the loads drive the machine, the motor brakes it
at the least such speed beyond that at which it no longer drives. The motor's own fluctuation over the cycle shifts the
mean speed by its square only.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import xarray as xr

from linksweep.analysis.drive.in_time.motion_in_time import AT_REST
from linksweep.analysis.drive.in_time.runs import Designs
from linksweep.results.peaks import peaks
from linksweep.scene.pairs import Array

PARTS = np.linspace(0.0, 1.0, 5)
"""Speeds, as parts of the fastest, between which the torque is a polynomial, for a search; without friction it is one
of the second degree."""
BEYOND = 3.0
"""Part of the fastest speed up to which the search looks where loads drive the machine."""
NONE, CLOSE = 1e-9, 1e-12
"""Mean torque, relative to the motor's, that counts as none, and torque that counts as none besides the largest."""
PLACES, ROUNDS = 512, 8
"""Speeds at which the search looks, and most steps of the secant method from there."""
ROUNDING = 1e-14
"""Step of the secant method, relative to the fastest speed, that is its last one."""


def operating_speed(designs: Designs) -> Array:
    """Return the speed of each design at its operating point [rad/s]; NaN where it has none."""
    crank, top = designs.crank(), designs.top_speed

    def load(speed: Array) -> Array:
        """Return the mean torque that machines take at constant speeds; NaN where one does not turn fully."""
        omega2 = designs.over_dims(crank.direction * np.maximum(speed, AT_REST))
        mean = f"{crank.torque}_mean"
        cycle = peaks(replace(designs.scene, omega2=xr.DataArray(omega2)), of=mean)
        return crank.direction * designs.flat(cycle[mean].where(cycle["status"] == 0))

    def supply(speed: Array) -> Array:
        """Return the torque of the motors behind their gears."""
        every = np.arange(designs.count)
        return designs.torque(every, speed) - crank.loss(every, speed, 0.0 * speed)

    def excess(speed: Array) -> Array:
        return supply(speed) - load(speed)

    near = np.stack([load(part * top) for part in PARTS])
    powers = np.linalg.solve(np.vander(PARTS), near)
    driven = near[-1] < -NONE * np.max([supply(part * top) for part in PARTS], axis=0)
    places = np.linspace(1.0, np.where(driven, BEYOND, 0.0), PLACES)
    surplus = np.stack([supply(part * top) - (np.vander(part, len(PARTS)) * powers.T).sum(axis=1) for part in places])
    passed = np.where(driven, -surplus, surplus) >= -CLOSE * np.max(abs(surplus), axis=0)
    first = np.argmax(passed, axis=0)
    last, speed = top * np.take_along_axis(places, np.stack([np.maximum(first - 1, 0), first]), axis=0)
    before = excess(last)
    for _ in range(ROUNDS):
        now = excess(speed)
        with np.errstate(invalid="ignore", divide="ignore"):
            step = now * (speed - last) / (now - before)
        last, before, speed = speed, now, np.where(np.isfinite(step), speed - step, speed)
        if not (abs(speed - last) > ROUNDING * top).any():
            break
    return np.where(passed.any(axis=0), np.where(first == 0, top, speed), np.nan)
