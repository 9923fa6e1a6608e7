"""Check a scene: Grashof class, arcs on which it can be assembled, toggles, jams, dead centres."""

from __future__ import annotations

import numpy as np
import xarray as xr

from linksweep.chains.finding import Checks, Finding
from linksweep.results.compute import counts_without_angles, require_scene
from linksweep.results.dataset import design_coordinates, flags, origin_attributes
from linksweep.results.search_checks import search_checks
from linksweep.scene.designs.lazy import in_memory
from linksweep.scene.dimensions import side_by_side
from linksweep.scene.revolution import Revolution
from linksweep.scene.scene import Scene


def check(scene: Scene) -> xr.Dataset:
    """Check where each design can be assembled, and how well it transmits.

    Parameters
    ----------
    scene : Scene
        Scene of any number of designs.

    Returns
    -------
    Dataset
        Variables over the design dims that they depend on; those of the machine, as listed in the notes.

    Raises
    ------
    ValueError
        For anything but a Scene.

    Notes
    -----
    Closed forms, but for a Linkage. Variables for a FourBar:

    - `grashof`: by the shortest link, crank_rocker, double_crank, double_rocker, rocker_crank; triple_rocker (no link
      turns fully); change_point (shortest + longest equals the other two, but for rounding)
    - `assembly`: everywhere, partly, never
    - `arc_start`, `arc_end` (arc) [degree]: the one or two arcs of theta2 on which it can be assembled; NaN for no arc
    - `toggle_angle` (toggle) [degree]: theta2 at which coupler and rocker lie in one line; NaN for no toggle
    - `transmission_angle_min` [degree]: smallest acute angle between coupler and rocker on those arcs

    For a SliderCrank all of these but `grashof`, and

    - `jam_angle` (side) [degree]: friction wedges the slider between upper and upper_beyond, and between lower_beyond
      and lower
    - `friction_to_jam` [1]: the least coefficient of friction that wedges it at any angle

    For an InvertedSliderCrank also `rocker_motion` (swings, turns_fully, limited), `swing` and `reversal_angle`
    [degree] and `time_ratio` [1] of a rocker that swings; with drive="cylinder" `slide_at_dead_centre` [m], its least
    and greatest size where the block stands still; with other drives `jam_angle` (side) and `friction_to_jam`.

    For a Linkage, by the exact search for peaks:

    - `assembly`, `arc_start`, `arc_end` as above, of any number of arcs
    - `fails_at`: the pin, or link past a pin, that fails first at most crank angles where a design never closes, as in
      `status_at`; none of other designs
    - `toggle_angle` (pin, toggle) [degree]: theta2 at which the links that find this pin lie in one line, or a rod
      stands square to its guide; NaN where other pins or designs have more toggles
    - `transmission_angle_min`, `transmission_angle_max` (pin) [degree]: extreme acute transmission angles on those
      arcs; `transmission_angle_min_at`, `transmission_angle_max_at` (pin) [degree]: their theta2, NaN where the angle
      does not change
    - `jam_start`, `jam_end` (jam) [degree]: arcs on which friction of a guide or slot jams, and `jam_place` (jam), the
      pin, or link past a pin, where it does, as in `status_at`; NaN and 0 where other designs have more

    Of these machines, with another drive than the crank, `dead_centre_angle` (dead_centre) [degree], where the driving
    link or cylinder stands still and cannot drive, labelled by branch if it differs between branches of a machine with
    closed forms.

    For a scene with both alpha2 and an omega2 that changes with theta2:

    - `alpha2_difference` [rad/s²], `alpha2_difference_at` [degree]: largest difference of alpha2 from ω2·dω2/dθ2, and
      its angle, among 720 angles a turn

    For a LoopTrack, over the design dims of the scene:

    - `lap`: whole, leaves_track or stalls, in one lap from the bottom
    - `leaves_track_at`, `stalls_at` [degree]: first position at which the car does; NaN if it does not
    - `least_entry_speed` [m/s]: least speed at the bottom (profile="constant": everywhere) with which it goes round

    For a scene with arrays over theta2 that a spline interpolates (`interpolation` of a Load):

    - `overshoot` (spline) [1]: distance by which each spline leaves the range of its values, relative to that range;
      a spline with more than 0.01 rings, as it does beside steps

    Source: triangle inequality for pins B, C, D; equations in `linksweep.chains.on_crank.rrr`.

    Examples
    --------
    >>> import linksweep as ls
    >>> print(ls.check(ls.example("press")).linksweep)
    Grashof class:             crank-rocker
    can be assembled:          everywhere
    at theta2 from:            0.0000° to 360.0000°
    toggles at theta2:         none
    least transmission angle:  33.0302°
    """
    require_scene(scene)
    scene = in_memory(scene)
    driven = scene.mechanism.driven_findings(scene.motion | {"drive": scene.drive})
    variables, labels = evaluated((*scene.mechanism.findings(), *driven))
    variables |= search_checks(scene) | _acceleration(scene)
    overshoots = {path: curve.overshoot for path, curve in scene.curves.items() if curve.overshoot is not None}
    if overshoots:
        words = "how far its spline leaves the range of an array, relative to that range"
        variables["overshoot"] = _described(xr.DataArray(list(overshoots.values()), dims="spline"), "1", words)
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
    """Return the largest difference of alpha2 from the one that a changing omega2 has by itself, and its angle."""
    if scene.alpha2 is None or not scene.changes_speed:
        return {}
    count = next(iter(counts_without_angles(scene).values()), round(2.0 * scene.period))  # else 720 a turn
    revolution = Revolution(scene, scene.grid(count))
    difference = abs(revolution.alpha2 - revolution.derived_alpha2)
    at = difference["theta2"][difference.argmax("theta2")]
    words = "of alpha2 from omega2·d(omega2)/d(theta2)"
    return {
        "alpha2_difference": _described(difference.max("theta2"), "rad/s^2", f"largest difference {words}"),
        "alpha2_difference_at": _described(at, "degree", f"crank angle of the largest difference {words}"),
    }


def _described(array: xr.DataArray, units: str, long_name: str) -> xr.Variable:
    return xr.Variable(array.dims, array.values, {"units": units, "long_name": long_name})


def _variable(finding: Finding, dims: tuple) -> xr.Variable:
    """Return a finding over the dims of its numbers, and over its own dim if it has one."""
    dims = (*dims, finding.along[0]) if finding.along else dims
    units = {"units": finding.units, "long_name": finding.long_name}
    return xr.Variable(dims, finding.values, flags(finding.long_name, finding.words) if finding.words else units)
