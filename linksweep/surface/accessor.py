"""The accessor `.linksweep` of Datasets: plots of a cycle, and the scene that it was computed from."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import xarray as xr

from linksweep.scene.scene import Scene
from linksweep.surface import plot
from linksweep.surface.storage import scene_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@xr.register_dataset_accessor("linksweep")
class Cycle:
    """What a Dataset from `linksweep.sweep` can show of itself, as ``ds.linksweep``.

    Examples
    --------
    >>> import linksweep as ls
    >>> cycle = ls.sweep(ls.example("press"))
    >>> cycle.linksweep.scene == ls.example("press")
    True
    """

    def __init__(self, ds: xr.Dataset) -> None:
        self._ds = ds

    @property
    def scene(self) -> Scene:
        """The scene that the Dataset was computed from. Raises ValueError where it has lost it."""
        return scene_of(self._ds)

    def forces(self, names: Iterable[str] | None = None, ax: Axes | None = None) -> Axes:
        """Plot pin forces [N] over the crank angle: see `linksweep.surface.plot.forces`."""
        return plot.forces(self._ds, names, ax)

    def torque(self, ax: Axes | None = None) -> Axes:
        """Plot the torque of the drive [N m] over the crank angle: see `linksweep.surface.plot.torque`."""
        return plot.torque(self._ds, ax)

    def bearing(self, pin: str = "F32", frame: str = "ground", ax: Axes | None = None) -> Axes:
        """Plot the bearing load diagram of a pin [N]: see `linksweep.surface.plot.bearing`."""
        return plot.bearing(self._ds, pin, frame, ax)

    def mechanism(
        self,
        theta2: float = 45.0,
        ax: Axes | None = None,
        point: tuple[float, float] | None = None,
        forces: bool = False,
    ) -> Axes:
        """Draw the mechanism at a crank angle [degree]: see `linksweep.surface.plot.mechanism`."""
        return plot.mechanism(self._ds, theta2, ax, point, forces)

    def loop(self) -> Figure:
        """Plot the track of a car in a loop and the force on it [N]: see `linksweep.surface.plot.loop`."""
        return plot.loop(self._ds)

    def cycle(self) -> Figure:
        """Plot mechanism, forces, torque and a bearing on one page: see `linksweep.surface.plot.cycle`."""
        return plot.cycle(self._ds)
