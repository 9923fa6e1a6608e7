"""Derivatives of the crank angles at which a quantity is zero, such as a velocity at the end of a stroke.

Where r(θ*, p) = 0,        dθ*/dp = −∂r/∂p / ∂r/∂θ
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from linksweep.engine.run import Field
from linksweep.engine.trace.derivatives import derivative_of
from linksweep.results.derivatives.samples import Pairs, pairs_over
from linksweep.scene.derivatives.differentiated import ANGLE, differentiated
from linksweep.scene.pairs import Array
from linksweep.scene.scene import Scene

STEPS = 3
"""Newton steps from the angles of a search."""
MOST = 1e-3
"""Largest of them [rad]."""


def zero_derivatives(scene: Scene, name: str, angle: Field, to: tuple[str, ...]) -> tuple[Pairs, Array]:
    """Return the derivatives (parameter, design) of angles [degree] at which a quantity is zero, from near ones."""
    pairs = pairs_over(differentiated(scene, (name,), (*to, ANGLE)), angle.dims)
    return pairs, zero_angles(pairs, name, pairs.numbers(angle), to)[1]


def zero_angles(
    pairs: Pairs, name: str, at: Array, to: tuple[str, ...], excess: Callable[[Array], Array] = np.asarray
) -> tuple[Array, Array]:
    """Return the angles [degree] at which the excess of a quantity over a constant is zero, from near ones, and their
    derivatives (parameter, design)."""
    steep = derivative_of(name, ANGLE)
    with np.errstate(all="ignore"):
        for _ in range(STEPS):
            value, slope = pairs.at((name, steep), at)
            at = at - np.degrees(np.clip(np.nan_to_num(excess(value) / slope), -MOST, MOST))
        of_angle, *of_parameters = pairs.at((steep, *(derivative_of(name, path) for path in to)), at)
        return at, -np.degrees(np.array(of_parameters).reshape(len(to), len(at)) / of_angle)
