"""The crank angles that samples of what changes over the revolution must not miss."""

from __future__ import annotations

import numpy as np

from linksweep.base.frozen import with_sound
from linksweep.scene.scene import Scene

ASIDE = 1e-7
"""Distance from a jump [degree] at which its one-sided limit agrees in all digits that a page or a plot prints."""


def angles_of_changes(scene: Scene) -> np.ndarray:
    """Return the angles [degree] of the whole period at which arrays have values, and loads are quick or jump."""
    own = [array["theta2"].values for array in scene.arrays.values() if "theta2" in array.coords]
    jumps = np.array(scene.jumps(), dtype=float)
    beside = np.add.outer([-ASIDE, 0.0, ASIDE], jumps[np.isfinite(jumps)]).ravel()
    quick = with_sound(scene, omega2=1.0, alpha2=0.0).quick.angles  # a speed is refused where it jumps
    turns = np.arange(0.0, scene.period, scene.mechanism.period)
    every = np.add.outer(turns, np.concatenate([*own, beside, quick]))
    return np.unique(np.mod(every, scene.period))
