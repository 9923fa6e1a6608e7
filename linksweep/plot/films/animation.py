"""Make the film of a machine: of one scene, or of an engine of several cylinders."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import xarray as xr

from linksweep.base.checked_number import one_pair
from linksweep.base.fields import POLAR_POINT
from linksweep.base.memory import require_memory
from linksweep.base.validate import count_problems, quote, refuse
from linksweep.files.netcdf import scene_from
from linksweep.plot.films.cylinder_film import film_of_cylinders
from linksweep.plot.films.frames import DPI, SAMPLES, SIZE
from linksweep.plot.films.machine_film import film_of_crank, film_of_track
from linksweep.plot.kit.style import small_type
from linksweep.plot.machine import drawing_with_point
from linksweep.results.cylinders.multi_cylinder import MultiCylinder
from linksweep.scene.scene import Scene

if TYPE_CHECKING:
    from linksweep.plot.kit.film import Film


def animate(
    scene: xr.Dataset | Scene | MultiCylinder,
    *,
    frames: int = 72,
    point: tuple[float, float] | None = None,
    link: str | None = None,
    title: str | None = None,
) -> Film:
    """Make a film of a machine over its cycle: forces as arrows at the pins, dots on their curves and the drive's.

    Parameters
    ----------
    scene : Scene, Dataset or MultiCylinder
        Scene of one design, or a Dataset from `linksweep.sweep` that holds it: then of its angles, where they are no
        whole cycle.
    frames : int, default 72
        Count of frames in a cycle, 25 a second.
    point : tuple of float, default None
        Point whose curve is drawn, (distance [m], angle [degree]) as `mechanism` takes it.
    link : str, default None
        Role of the link of that point, as `mechanism` takes it.
    title : str, default None
        Heading of the film in a notebook or page; None for the kind of mechanism.

    Returns
    -------
    Film
        Film that a notebook shows as the last expression of a cell. ``film.save("machine.gif")`` and
        ``film.save("machine.html")`` write it. Arrows are to one scale, that of the curves below them; where forces
        grow without bound, they end a little beyond it.

    Raises
    ------
    ValueError
        For more than one design, for a point that is none, and where there is no result at two angles or more.

    Examples
    --------
    >>> import linksweep as ls
    >>> film = ls.plot.animate(ls.example("press"), frames=24)
    >>> len(film)
    24
    """
    refuse(count_problems("frames", frames))
    if frames < 2:
        refuse([f"frames = {frames}: must be 2 or more"])
    require_memory(f"frames = {quote(frames)}", float(frames * math.prod(SIZE) * DPI**2))
    if isinstance(scene, MultiCylinder):
        refuse([f"point = {quote(point)}: must be left out for several cylinders"] if point is not None else [])
        with small_type():
            return film_of_cylinders(scene.in_memory, frames, title or f"Engine of {len(scene.crank_angles)} cylinders")
    point = None if point is None else one_pair("point", point, POLAR_POINT)
    one = scene_from(scene, whole=False)
    index = one.mechanism.index
    sound = isinstance(scene, Scene) or index in scene.dims
    refuse([] if sound else [f"scene has no dimension {index}: take what ls.sweep returns"])
    angles: Any = SAMPLES if isinstance(scene, Scene) else scene[index].values
    heading = title or one.mechanism.title or type(one.mechanism).__name__
    with small_type():
        if one.mechanism.track:
            return film_of_track(one, one.mechanism.track, angles, frames, heading)
        return film_of_crank(one, drawing_with_point(one, link), angles, frames, point, heading)
