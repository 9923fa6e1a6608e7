"""Forces of loads as arrows: the point of a link at which each acts, and its components, over the cycle."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.degrees import cos_sin
from linksweep.mechanisms.drawing import Drawing
from linksweep.plot.kit import signals
from linksweep.plot.kit.shape import axes_of
from linksweep.scene.loads.kinds import Load
from linksweep.scene.scene import Scene


def load_arrows(
    scene: Any, drawing: Drawing, motion: xr.Dataset, places: dict[str, np.ndarray], angles: int
) -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    """Yield the name of each load with a force, its point [m] over the motion, and its force [N] over the cycle."""
    joined = getattr(scene.mechanism, "topology", None)
    if joined is None:  # of a machine with a table of its own
        return
    sampled: Any = scene.at(scene.grid(angles)).loads
    for k, (load, now) in enumerate(zip(scene.loads, sampled, strict=True), 1):
        if isinstance(load, Load) and load.force is not None:
            axes = _axes(scene, drawing, motion, load.link)
            first, *_ = joined.pins_of(load.link) or joined.on_guides[load.link]
            force = np.array([_over(part, angles) for part in now.force])
            if load.frame == "link":
                force = _turned(np.tile(axes, angles // axes.shape[1]), force)
            yield f"load {k}", places[first] + _turned(axes, _at(scene, load)), force


def _axes(scene: Scene, drawing: Drawing, motion: xr.Dataset, role: str) -> np.ndarray:
    number = next(body.number for body in scene.mechanism.bodies if body.role == role)
    return axes_of(scene, motion, drawing.frames[number])


def _at(scene: Scene, load: Load) -> np.ndarray:
    """Return the point of a load in its link's axes, (2, 1)."""
    own: Any = load.at
    if load.origin == "pin":
        return _polar(*own)
    mass = scene.mechanism.masses()[load.link]
    return _polar(*own) + _polar(mass.cg_distance, mass.cg_angle)


def _polar(distance: Any, angle: Any) -> np.ndarray:
    return float(distance) * np.array([[float(part)] for part in cos_sin(angle)])


def _over(number: Any, angles: int) -> np.ndarray:
    """Return a number at every angle."""
    return signals.spread(number, angles) if isinstance(number, xr.DataArray) else np.full(angles, float(number))


def _turned(axes: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """Return a vector in the ground's axes, of one in axes whose x has these directions."""
    (x, y), (along, across) = axes, vector
    return np.array([along * x - across * y, along * y + across * x])
