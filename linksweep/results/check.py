"""check(scene): Grashof class, where it can be assembled, and its toggles, in closed form for every design."""

from __future__ import annotations

import numpy as np
import xarray as xr

from linksweep.mechanisms.limits.finding import Checks, Finding
from linksweep.results.compute import require_scene
from linksweep.results.dataset import design_coordinates, flags, origin_attributes
from linksweep.scene.designs.lazy import in_memory
from linksweep.scene.dimensions import side_by_side
from linksweep.scene.grid import crank_grid
from linksweep.scene.revolution import Revolution
from linksweep.scene.scene import Scene


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

    Of a SliderCrank the same but for `grashof`, and where friction wedges the slider:

    - `jam_angle` (side) [degree]: it does between upper and upper_beyond, and between lower_beyond and lower
    - `friction_to_jam`: the least coefficient of friction that wedges at all

    Of an InvertedSliderCrank also `rocker_motion` (swings, turns_fully, limited), `swing` and `reversal_angle` [degree]
    and `time_ratio` of a rocker that swings; with drive="cylinder" `slide_at_dead_centre` [m], its least and greatest
    size where the block stands still; else, as of a SliderCrank, `jam_angle` (side) and `friction_to_jam`.

    With another drive than the crank, `dead_centre_angle` (dead_centre) [degree], where it stands still and cannot
    drive, labelled by branch where that decides.

    Of a scene that gives both an omega2 that changes with theta2 and alpha2:

    - `alpha2_difference` [rad/s²], `alpha2_difference_at` [degree]: how far alpha2 is from ω2·dω2/dθ2 at worst, and
      where, of 720 angles a turn

    Of a LoopTrack, over the design dims of the scene:

    - `lap`: whole, leaves_track, stalls: what becomes of the car in one lap from the bottom
    - `leaves_track_at`, `stalls_at` [degree]: where it first does; NaN where it does not
    - `least_entry_speed` [m/s]: least speed at the bottom (profile="constant": everywhere) with which it goes round

    Of a scene with arrays over theta2 that are interpolated by a spline (`interpolation` of a Load):

    - `overshoot` (spline) [1]: how far each spline leaves the range of its values, relative to that range; where it is
      more than 0.01 it rings, as it does beside steps

    Source: triangle inequality for pins B, C, D; equations in `linksweep.mechanisms.limits.four_bar_limits`.

    Raises
    ------
    ValueError
        For what is no Scene.

    Examples
    --------
    >>> import linksweep as ls
    >>> scene = ls.example("press")
    >>> found = ls.check(scene)
    >>> round(float(found.transmission_angle_min), 3)
    33.03
    """
    require_scene(scene)
    scene = in_memory(scene)
    driven = scene.mechanism.driven_findings(scene.motion | {"drive": scene.drive})
    variables, labels = evaluated((*scene.mechanism.findings(), *driven))
    variables |= _acceleration(scene)
    overshoots = {path: curve.overshoot for path, curve in scene.curves.items() if curve.overshoot is not None}
    if overshoots:
        said = {"units": "1", "long_name": "how far its spline leaves the range of an array, relative to that range"}
        variables["overshoot"] = xr.Variable("spline", list(overshoots.values()), said)
        labels["spline"] = xr.Variable("spline", list(overshoots))
    dims = {dim for variable in variables.values() for dim in variable.dims}
    coordinates = {k: v for k, v in design_coordinates(scene).items() if dims.issuperset(v.dims)} | labels
    return xr.Dataset(variables, coordinates, origin_attributes(scene, "linksweep.check(scene)"))


def evaluated(checks: Checks) -> tuple[dict[str, xr.Variable], dict[str, xr.Variable]]:
    """Return the findings of closed-form checks over the dims of their numbers, and the labels of dims of their own."""
    variables: dict[str, xr.Variable] = {}
    labels: dict[str, xr.Variable] = {}
    for findings, numbers in checks:
        dims, arrays = side_by_side(numbers)
        with np.errstate(all="ignore"):  # lengths and speeds may be near the ends of what a number can hold
            results = findings(*arrays)
        for name, finding in results.items():
            variables[name] = _variable(finding, dims)
            if finding.along and finding.along[1]:
                labels[finding.along[0]] = xr.Variable(finding.along[0], list(finding.along[1]))
    return variables, labels


def _acceleration(scene: Scene) -> dict[str, xr.Variable]:
    """How far an alpha2 stands from that of an omega2 that changes with theta2, at worst, and where."""
    if scene.alpha2 is None or not scene.changes_speed:
        return {}
    grid = crank_grid(_count(scene), scene.period, scene.mechanism.index)
    revolution = Revolution(scene, grid)
    difference = abs(revolution.alpha2 - revolution.derived_alpha2)
    at = difference["theta2"][difference.argmax("theta2")]
    words = "of alpha2 from omega2·d(omega2)/d(theta2)"
    return {
        "alpha2_difference": _told(difference.max("theta2"), "rad s-2", f"largest difference {words}"),
        "alpha2_difference_at": _told(at, "degree", f"crank angle of the largest difference {words}"),
    }


def _count(scene: Scene) -> int:
    """720 angles a turn, or as many as arrays over theta2 have that do not say of which angles they are."""
    index = scene.mechanism.index
    counts = [a.sizes[index] for a in scene.arrays.values() if index in a.dims and index not in a.coords]
    return next(iter(counts), round(2.0 * scene.period))


def _told(array: xr.DataArray, units: str, long_name: str) -> xr.Variable:
    return xr.Variable(array.dims, array.values, {"units": units, "long_name": long_name})


def _variable(found: Finding, dims: tuple) -> xr.Variable:
    dims = (*dims, found.along[0]) if found.along else dims
    said = {"units": found.units, "long_name": found.long_name}
    return xr.Variable(dims, found.values, flags(found.long_name, found.words) if found.words else said)
