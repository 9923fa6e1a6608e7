"""Geometry of a mechanism's motion: stroke, swing, time ratio, transmission angles, and the curve that a point draws.

A four-bar's rocker turns round where crank (a) and coupler (b) lie in one line, and pin C is f = b + a or f = b − a
from A; ψ is the rocker's angle at D, from the line D→A, φ that of the line A→C from A→D:

    cos ψ = (c² + d² − f²)/(2cd)        cos φ = (d² + f² − c²)/(2df)        swing = ψ(b + a) − ψ(b − a)

with the crank at φ(b + a), and at φ(b − a) + 180°. A slider turns round where crank and rod lie in one line:

    stroke = √((b + a)² − e²) − √((b − a)² − e²)        at asin(e/(b + a)) and 180° + asin(e/(b − a))

The time ratio is that of the larger to the smaller angle between these, which a crank at a steady speed takes as times.

Source: R. L. Norton, Design of Machinery, chapters "Graphical Linkage Synthesis" (limiting conditions, time ratio) and
"Position Analysis" (transmission angle).
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.degrees import cos_sin
from linksweep.base.validate import choice_problems, refuse
from linksweep.mechanisms import FourBar, InvertedSliderCrank, LoopTrack, SliderCrank
from linksweep.mechanisms.rows.crank import BRANCH_SIGN
from linksweep.physics.algebra import planar
from linksweep.results.check import check
from linksweep.results.compute import compute, require_scene
from linksweep.results.dataset import design_coordinates, provenance, variable
from linksweep.results.peaks import peaks
from linksweep.results.sweep import sweep
from linksweep.scene.checked_number import checked_pair
from linksweep.scene.grid import crank_grid
from linksweep.scene.loads.load import AT
from linksweep.scene.scene import Scene

SAID = {
    "swing": ("degree", "angle through which the rocker swings"),
    "stroke": ("m", "travel of the slider from one dead centre to the other"),
    "time_ratio": ("1", "crank angle of the slower way over that of the faster one"),
    "reversal_angle": ("degree", "crank angle at which it turns round: stretched, folded"),
}
CURVE = {
    "P": ("m", "position of the point from A"),
    "vP": ("m s-1", "velocity of the point"),
    "aP": ("m s-2", "acceleration of the point"),
}


def geometry(scene: Scene, threads: int | None = None) -> xr.Dataset:
    """How far it moves, how evenly, and how well it transmits.

    Parameters
    ----------
    scene : Scene of a mechanism of links
    threads : at most so many (default: all cores)

    Returns
    -------
    Dataset over the design dims:

    - `swing` [degree] of a rocker, or `stroke` [m] of a slider; NaN where it does not swing, or the crank does not turn
      fully
    - `time_ratio`: the slower way's crank angle over the faster one's; `reversal_angle` (…, limit) [degree], the crank
      angles at which it turns round, stretched and folded; of an inverted slider-crank along `reversal`
    - `transmission_angle_max`, `_min` and where they are, `_max_at`, `_min_at` [degree], as from `linksweep.peaks`

    Raises
    ------
    ValueError
        For a car in a loop.

    Notes
    -----
    Closed forms, and the exact peaks of the transmission angle; neither looks at loads or speeds. Equations and source:
    `linksweep.analysis.design.geometry`.

    Examples
    --------
    >>> import linksweep as ls
    >>> found = ls.geometry(ls.example("engine"))
    >>> round(float(found.stroke), 12), round(float(found.time_ratio), 12)
    (0.086, 1.0)
    """
    require_scene(scene)
    refuse(["scene is of a LoopTrack, which has no links: give another"] * isinstance(scene.mechanism, LoopTrack))
    unloaded = replace(scene, omega2=1.0, alpha2=0.0, loads=())
    with np.errstate(invalid="ignore"):
        found = _limits(unloaded)
    angles = peaks(unloaded, of=["transmission_angle"], threads=threads)
    told = xr.Dataset({**found, **angles.drop_vars(["status", "transmission_angle_peak"]).data_vars})
    coordinates = {name: of for name, of in design_coordinates(scene).items() if {*of.dims} <= {*told.dims}}
    return told.assign_coords(coordinates).assign_attrs(provenance(scene, "linksweep.geometry(scene)", coordinates))


def _limits(scene: Scene) -> dict[str, Any]:
    mechanism: Any = scene.mechanism
    if isinstance(mechanism, InvertedSliderCrank):
        told = check(scene)
        return {name: told[name] for name in ("swing", "time_ratio", "reversal_angle")}
    found = _of_rocker(mechanism) if isinstance(mechanism, FourBar) else _of_slider(mechanism)
    turns = check(scene)["assembly"] == 0
    found = {name: xr.DataArray(number).where(turns) for name, number in found.items()}
    between = np.mod(found["folded"] - found["stretched"], 360.0)
    found["time_ratio"] = np.maximum(between, 360.0 - between) / np.minimum(between, 360.0 - between)
    ends = xr.concat([found.pop("stretched"), found.pop("folded")], "limit", coords="minimal", compat="override")
    found["reversal_angle"] = np.mod(ends, 360.0).assign_coords(limit=["stretched", "folded"]).transpose(..., "limit")
    return {name: array.assign_attrs(units=SAID[name][0], long_name=SAID[name][1]) for name, array in found.items()}


def _of_rocker(mechanism: FourBar) -> dict[str, Any]:
    a, b, c, d = (xr.DataArray(length) for length in mechanism.lengths().values())
    rocker, line = [], []
    for f in (b + a, b - a):
        rocker.append(_degrees((c * c + d * d - f * f) / (2.0 * c * d)))
        line.append(_degrees((d * d + f * f - c * c) / (2.0 * d * f)))
    side, swing = _sign(mechanism), rocker[0] - rocker[1]
    stretched, folded = (mechanism.ground_angle + side * angle for angle in line)
    swings = ~np.isnan(swing)
    return {"swing": swing, "stretched": stretched.where(swings), "folded": (folded + 180.0).where(swings)}


def _of_slider(mechanism: SliderCrank) -> dict[str, Any]:
    a, b, e = (xr.DataArray(length) for length in (mechanism.crank.length, mechanism.rod.length, mechanism.offset))
    far, near = ((reach - e) * (reach + e) for reach in (b + a, b - a))
    ahead = xr.where(_sign(mechanism) > 0.0, 0.0, 180.0) + mechanism.slide_angle
    at_far, at_near = (np.degrees(np.arcsin(e / reach)) for reach in (b + a, b - a))
    stretched, folded = ahead + _sign(mechanism) * at_far, ahead + 180.0 + _sign(mechanism) * at_near
    return {"stroke": np.sqrt(far) - np.sqrt(near), "stretched": stretched, "folded": folded}


def _sign(mechanism: FourBar | SliderCrank) -> xr.DataArray:
    """1 of the open branch, −1 of the crossed one; over `branch` where both are meant."""
    if mechanism.branch in BRANCH_SIGN:
        return xr.DataArray(BRANCH_SIGN[mechanism.branch])
    return xr.DataArray(list(BRANCH_SIGN.values()), {"branch": list(BRANCH_SIGN)}, "branch")


def _degrees(cos: xr.DataArray) -> xr.DataArray:
    """Angle of a cosine; NaN where there is none."""
    return xr.DataArray(np.degrees(np.arccos(cos)))


def coupler_curve(
    scene: Scene, at: tuple[Any, Any], theta2: Any = 720, link: str | None = None, threads: int | None = None
) -> xr.Dataset:
    """The curve that a point of a link draws, with velocity and acceleration.

    Parameters
    ----------
    scene : Scene of a mechanism of links
    at : the point in the link's own polar coordinates: (distance from its first pin [m], angle from its line of pins
        [degree]); each may be a DataArray of design dims
    theta2 : count of crank angles, or angles [degree], as `linksweep.sweep` takes them
    link : by name; by default the coupler or rod, of an inverted slider-crank the rocker
    threads : at most so many (default: all cores)

    Returns
    -------
    Dataset over (…, theta2): position `Px`, `Py` from A [m], velocity `vPx`, `vPy` [m/s], acceleration `aPx`, `aPy`
    [m/s²], and `status`; NaN where that is not ok.

    Raises
    ------
    ValueError
        For an unknown link, and a point that is none.

    Examples
    --------
    >>> import linksweep as ls
    >>> curve = ls.coupler_curve(ls.example("press"), at=(0.10, 15.0), theta2=360)
    >>> curve.Py.dims, curve.aPy.units
    (('theta2',), 'm s-2')
    """
    require_scene(scene)
    bodies = {body.role: body for body in scene.mechanism.bodies}
    refuse([] if bodies else [f"scene is of a {type(scene.mechanism).__name__}, which has no links: give another"])
    role = next(name for name in ("coupler", "rod", "rocker") if name in bodies) if link is None else link
    refuse(choice_problems("link", role, bodies))
    at = checked_pair("at", at, AT, "(distance in m, angle in degrees)")
    body, cycle = bodies[role], sweep(scene, theta2, ["status"], threads=threads)
    k = body.number
    position, velocity, acceleration = (
        _numbers(scene, theta2, pair, threads) for pair in (body.pin_position, body.pin_velocity, body.pin_acceleration)
    )
    line = _numbers(scene, theta2, (f"r{k}x", f"r{k}y"), threads)
    omega, alpha = _numbers(scene, theta2, (f"omega{k}", f"alpha{k}"), threads)
    length = getattr(getattr(scene.mechanism, role, None), "length", 1.0)  # a block's axes are of unit length
    cos, sin = cos_sin(at[1])
    arm = planar.to_ground_axes(at[0] * cos, at[0] * sin, length, *line)
    found = {
        "P": planar.vector_sum(*position, *arm),
        "vP": planar.point_velocity(*velocity, omega, *arm),
        "aP": planar.point_acceleration(*acceleration, omega, alpha, *arm),
    }
    variables = {
        f"{name}{axis}": xr.DataArray(part).where(cycle["status"] == 0).assign_attrs(_said(name, role, axis))
        for name, pair in found.items()
        for axis, part in zip("xy", pair, strict=True)
    }
    command = f"linksweep.coupler_curve(scene, at=..., link={role!r})"
    return xr.Dataset({**variables, "status": cycle["status"]}, cycle.coords, cycle.attrs | {"command": command})


def _said(name: str, role: str, axis: str) -> dict[str, str]:
    units, text = CURVE[name]
    return {"units": units, "long_name": f"{text} of the {role}, component along {axis}"}


def _numbers(scene: Scene, theta2: Any, sources: tuple[Any, Any], threads: int | None) -> tuple[Any, Any]:
    """Two quantities of the table by name, also such as no result shows; a number is itself."""
    grid = crank_grid(theta2, scene.period, scene.mechanism.index)
    sampled = scene.at(grid)
    names = tuple(source for source in sources if isinstance(source, str))
    fields = compute(sampled, grid, names, threads) if names else {}
    order = (*sampled.inputs.sizes, grid.dim)

    def number(source: Any) -> Any:
        return xr.DataArray(variable(fields[source], "", "", order)) if isinstance(source, str) else source

    return number(sources[0]), number(sources[1])
