"""check(scene): Grashof class, where it can be assembled, and its toggles, in closed form for every design."""

from __future__ import annotations

import numpy as np
import xarray as xr

from linksweep.mechanisms.four_bar_limits import ASSEMBLY, GRASHOF, arcs, limits
from linksweep.results.record import design_coordinates, flags, origin_attributes
from linksweep.scene.scene import Scene

TOGGLES = ("folded", "stretched", "stretched_mirrored", "folded_mirrored")


def check(scene: Scene) -> xr.Dataset:
    """Can it be assembled, at which crank angles, and how well does it transmit?

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    Dataset over the design dims that the lengths depend on:

    - `grashof`: by the shortest link, crank_rocker, double_crank, double_rocker, rocker_crank; triple_rocker (no link
      turns fully); change_point (shortest + longest equals the other two, but for rounding)
    - `assembly`: everywhere, partly, never
    - `arc_start`, `arc_end` (arc) [degree]: the one or two arcs of theta2 that can be assembled; NaN where there is none
    - `toggle_angle` (toggle) [degree]: theta2 at which coupler and rocker lie in one line; NaN where there is none
    - `transmission_angle_min` [degree]: smallest acute angle between coupler and rocker on those arcs

    Source: triangle inequality for pins B, C, D; equations in `linksweep.mechanisms.four_bar_limits`.

    Examples
    --------
    >>> import linksweep as ls
    >>> scene = ls.example("press")
    >>> found = ls.check(scene)
    >>> round(float(found.transmission_angle_min), 3)
    33.03
    """
    given = [*scene.mechanism.lengths().values(), scene.mechanism.ground_angle]
    a, b, c, d, ground_angle = xr.broadcast(*(xr.DataArray(number).astype(float) for number in given))
    dims = tuple(map(str, a.dims))
    found = limits(a.values, b.values, c.values, d.values)
    start, end = arcs(found, ground_angle.values)
    toggles = np.stack([found.folded, found.stretched, -found.stretched, -found.folded], axis=-1)
    toggles = np.mod(toggles + ground_angle.values[..., None], 360.0)
    variables = {
        "grashof": (dims, found.grashof, flags("Grashof class", GRASHOF)),
        "assembly": (dims, found.assembly, flags("crank angles at which it can be assembled", ASSEMBLY)),
        "arc_start": ((*dims, "arc"), start, _angle("crank angle at which an assembled arc starts")),
        "arc_end": ((*dims, "arc"), end, _angle("crank angle at which an assembled arc ends (may pass 360)")),
        "toggle_angle": ((*dims, "toggle"), toggles, _angle("crank angle with coupler and rocker in one line")),
        "transmission_angle_min": (
            dims,
            found.transmission_angle_min,
            _angle("smallest acute angle between coupler and rocker"),
        ),
    }
    coordinates = {k: v for k, v in design_coordinates(scene).items() if set(v.dims) <= set(dims)}
    coordinates["toggle"] = xr.Variable("toggle", list(TOGGLES))
    return xr.Dataset(variables, coordinates, origin_attributes(scene, "linksweep.check(scene)"))


def _angle(long_name: str) -> dict[str, str]:
    return {"units": "degree", "long_name": long_name}
