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
    - `arc_start`, `arc_end` (arc) [degree]: the one or two arcs of theta2 where it can be assembled; NaN for no arc
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
    lengths = [xr.DataArray(length).astype(float) for length in scene.mechanism.lengths().values()]
    variables = _classes(*lengths) | _angles(*lengths, xr.DataArray(scene.mechanism.ground_angle).astype(float))
    dims = {dim for variable in variables.values() for dim in variable.dims}
    coordinates = {k: v for k, v in design_coordinates(scene).items() if dims.issuperset(v.dims)}
    coordinates["toggle"] = xr.Variable("toggle", list(TOGGLES))
    return xr.Dataset(variables, coordinates, origin_attributes(scene, "linksweep.check(scene)"))


def _classes(*lengths: xr.DataArray) -> dict[str, xr.Variable]:
    """What the lengths alone decide."""
    a, b, c, d = xr.broadcast(*lengths)
    found = limits(a.values, b.values, c.values, d.values)
    angle = _angle("smallest acute angle between coupler and rocker")
    return {
        "grashof": xr.Variable(a.dims, found.grashof, flags("Grashof class", GRASHOF)),
        "assembly": xr.Variable(a.dims, found.assembly, flags("crank angles at which it can be assembled", ASSEMBLY)),
        "transmission_angle_min": xr.Variable(a.dims, found.transmission_angle_min, angle),
    }


def _angles(*lengths_and_ground_angle: xr.DataArray) -> dict[str, xr.Variable]:
    """Crank angles, which turn with the frame."""
    a, b, c, d, ground_angle = xr.broadcast(*lengths_and_ground_angle)
    found = limits(a.values, b.values, c.values, d.values)
    start, end = arcs(found, ground_angle.values)
    toggles = np.stack([found.folded, found.stretched, -found.stretched, -found.folded], axis=-1)
    toggles = np.mod(toggles + ground_angle.values[..., None], 360.0)
    return {
        "arc_start": xr.Variable((*a.dims, "arc"), start, _angle("crank angle at which an assembled arc starts")),
        "arc_end": xr.Variable((*a.dims, "arc"), end, _angle("crank angle at which it ends (may pass 360)")),
        "toggle_angle": xr.Variable((*a.dims, "toggle"), toggles, _angle("coupler and rocker in one line")),
    }


def _angle(long_name: str) -> dict[str, str]:
    return {"units": "degree", "long_name": long_name}
