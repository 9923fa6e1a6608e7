"""The accessor `.linksweep` of Datasets: plots, tables, and the scene that it was computed from."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING

import xarray as xr

from linksweep import plot
from linksweep.files import table
from linksweep.files.netcdf import scene_of
from linksweep.scene.scene import Scene

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linksweep.plot.kit.film import Film


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
        """Plot pin forces [N] over the crank angle: see `linksweep.plot.forces`."""
        return plot.forces(self._ds, names, ax)

    def torque(self, ax: Axes | None = None) -> Axes:
        """Plot the drive's torque [N m] or force [N] over the crank angle: see `linksweep.plot.torque`."""
        return plot.torque(self._ds, ax)

    def bearing(self, pin: str = "F32", frame: str = "ground", ax: Axes | None = None) -> Axes:
        """Plot the bearing load diagram of a pin [N]: see `linksweep.plot.bearing`."""
        return plot.bearing(self._ds, pin, frame, ax)

    def bearings(self, frame: str = "ground") -> Figure:
        """Plot the bearing load diagrams of all pins in one figure: see `linksweep.plot.bearings`."""
        return plot.bearings(self._ds, frame)

    def mechanism(
        self,
        theta2: float = 45.0,
        ax: Axes | None = None,
        point: tuple[float, float] | None = None,
        forces: bool = False,
    ) -> Axes:
        """Draw the mechanism at a crank angle [degree]: see `linksweep.plot.mechanism`."""
        return plot.mechanism(self._ds, theta2, ax, point, forces)

    def animate(self, frames: int = 72, point: tuple[float, float] | None = None) -> Film:
        """Make a film of the mechanism and its forces: see `linksweep.plot.animation.animate`."""
        return plot.animate(self._ds, frames, point)

    def loop(self) -> Figure:
        """Plot the track of a car in a loop and the force on it [N]: see `linksweep.plot.loop`."""
        return plot.loop(self._ds)

    def cycle(self) -> Figure:
        """Plot mechanism, forces, torque and a bearing on one page: see `linksweep.plot.cycle`."""
        return plot.cycle(self._ds)

    def heat_map(
        self,
        name: str,
        x: str | None = None,
        y: str | None = None,
        maximize: bool = False,
        contours: bool | str = False,
        ax: Axes | None = None,
    ) -> Axes:
        """Plot a result over two design dims: see `linksweep.plot.heat_maps.heat_map`."""
        return plot.heat_map(self._ds, name, x, y, maximize, contours, ax)

    def scatter(
        self,
        x: str,
        y: str,
        color: str | None = None,
        maximize: Iterable[str] = (),
        front: bool = True,
        ax: Axes | None = None,
    ) -> Axes:
        """Plot two results of every design, with the Pareto front: see `linksweep.plot.study_plots.scatter`."""
        return plot.scatter(self._ds, x, y, color, maximize, front, ax)

    def parallel_coordinates(
        self,
        names: Iterable[str] | None = None,
        color: str | None = None,
        maximize: bool = False,
        best: int = 5,
        ax: Axes | None = None,
    ) -> Axes:
        """Plot designs from parameter to result: see `linksweep.plot.study_plots.parallel_coordinates`."""
        return plot.parallel_coordinates(self._ds, names, color, maximize, best, ax)

    def to_pandas(self) -> pd.DataFrame:
        """The Dataset as a table, a row for each design (and angle): see `linksweep.files.table.to_pandas`."""
        return table.to_pandas(self._ds)

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Write that table as a CSV file, whole or not at all: see `linksweep.files.table.to_csv`."""
        table.to_csv(self._ds, path)
