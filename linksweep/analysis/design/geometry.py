"""Geometry of a machine's motion: stroke or swing, time ratio, transmission angles, and the curve that a point draws.

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

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import xarray as xr

from linksweep.analysis.design.travel import rate_of, travel
from linksweep.base.checked_number import checked_pair, one_number
from linksweep.base.degrees import cos_sin
from linksweep.base.fields import POLAR_POINT
from linksweep.base.validate import Rule, choice_problems, refuse
from linksweep.engine.run import Field
from linksweep.engine.threads import limits_threads
from linksweep.mechanisms.capabilities import offers
from linksweep.physics.algebra import planar
from linksweep.results.check import evaluated
from linksweep.results.compute import compute, quantity_problems, requested, require
from linksweep.results.dataset import design_coordinates, provenance, variable, with_units
from linksweep.results.peaks import peaks
from linksweep.results.search_checks import STEADY
from linksweep.results.sweep import sweep
from linksweep.scene.designs.lazy import in_memory
from linksweep.scene.dimensions import argument_problems
from linksweep.scene.scene import Scene

ANGLE = "transmission_angle"
TRAVEL_UNITS = ("m", "degree")
ENDS = {"max": "largest", "min": "least"}
DWELL = Rule("dimensionless", above=0.0, below=1.0)
CURVE = {
    "P": ("m", "position of the point from A"),
    "vP": ("m/s", "velocity of the point"),
    "aP": ("m/s^2", "acceleration of the point"),
}


@limits_threads
def geometry(
    scene: Scene, of: str | Iterable[str] | None = None, *, dwell: float = 0.01, threads: int | None = None
) -> xr.Dataset:
    """Compute stroke or swing, time ratio and extreme transmission angles of a machine.

    Parameters
    ----------
    scene : Scene
        Scene of a machine of links.
    of : str or iterable of str, default None
        Names of positions ("theta4", "x_ram", "Ex") whose travel is computed; None for the output in closed form, or
        of a machine without one for all links on ground pins, and all sliders.
    dwell : float, default 0.01
        Part of its travel within which a position counts as at rest [1], below 1.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Results over the design dims:

        - `swing` [degree] of a rocker, or `stroke` [m] of a slider; NaN where it does not swing, the crank does not
          turn fully, or a four-bar passes through two change points, as a parallelogram and a kite do
        - `time_ratio` [1]: the slower way's crank angle over the faster one's
        - `reversal_angle` (…, limit) [degree]: crank angles at which the output reverses, stretched and folded; of an
          inverted slider-crank over the dim `reversal`
        - of each position of `of`, such as x_ram: `x_ram_travel`, its ends `x_ram_max`, `x_ram_min` and where they are,
          `x_ram_max_at`, `x_ram_min_at` [degree], `x_ram_time_ratio` [1], and `x_ram_dwell_max`, `x_ram_dwell_min`
          [degree], the crank angles for which it rests about its ends; NaN where it turns fully. Where it stands
          still, its travel is 0, and ratio, dwells and angles of the ends are NaN; where it grows without bound, its
          travel is inf, and ratio and dwells are NaN.
        - `transmission_angle_max`, `_min` and where they are, `_max_at`, `_min_at` [degree], as from `linksweep.peaks`;
          of a linkage one for each dyad. One that does not change has no angles of its ends, NaN.

    Raises
    ------
    ValueError
        If the machine has no links, as a car in a loop, a name is no position, or dwell is out of bounds.

    Notes
    -----
    Closed forms, zeros of rates, and the exact peaks of transmission angles; none depends on loads or speeds. Equations
    and source: `linksweep.analysis.design.geometry`, and `linksweep.analysis.design.travel` for positions by name.

    Examples
    --------
    >>> import linksweep as ls
    >>> print(ls.geometry(ls.example("engine")).linksweep)
    quantity                      value  unit       at
    stroke                        0.086  m
    time_ratio                        1
    reversal_angle (stretched)       90  °
    reversal_angle (folded)         270  °
    transmission_angle_max           90  °     270.00°
    transmission_angle_min      72.7494  °       0.00°
    """
    require(scene, "bodies")
    bare = in_memory(replace(scene, omega2=1.0, alpha2=0.0, loads=()))
    dwell = one_number("dwell", dwell, DWELL)
    in_closed_form = of is None and offers(bare.mechanism, "stroke_findings")
    variables, labels = evaluated(bare.mechanism.stroke_findings() if in_closed_form else ())
    for name in [] if in_closed_form else _positions(bare, of):
        variables |= _travelled(bare, name, dwell)
    for name in [name for name in bare.table.quantity if name.startswith(ANGLE)]:
        angles = peaks(bare, of=[name]).drop_vars(["status", f"{name}_peak"])
        changes = angles[f"{name}_max"] - angles[f"{name}_min"] > STEADY
        variables |= {
            str(key): (value.where(changes) if str(key).endswith("_at") else value).variable
            for key, value in angles.items()
        }
    dims = {dim for variable in variables.values() for dim in variable.dims}
    coordinates = {name: values for name, values in design_coordinates(scene).items() if {*values.dims} <= dims}
    attributes = provenance(scene, "linksweep.geometry(scene)", coordinates)
    return xr.Dataset(variables, coordinates | labels, attributes)


def _positions(scene: Scene, of: Any) -> list[str]:
    """Return the names of positions in a request; by default of the links on ground pins, and of the sliders."""
    maker = scene.table.maker
    known = [name for name, q in scene.table.quantity.items() if q.units in TRAVEL_UNITS and rate_of(name) in maker]
    if of is None:
        machine = scene.mechanism
        rockers = [f"theta{body.number}" for body in machine.bodies if body.role in machine.on_ground]
        return [name for name in known if name in rockers or name.startswith("x_")]
    names = requested("of", of)
    refuse([problem for name in names for problem in quantity_problems("of", name, known, scene)])
    return names


def _travelled(scene: Scene, name: str, dwell: float) -> dict[str, xr.Variable]:
    """Return the travel of a position as variables."""
    of, units = scene.table.quantity[name].long_name, scene.table.quantity[name].units
    ends = travel(scene, name, dwell)
    whole = Field(ends.max.dims, ends.max.values - ends.min.values)
    parts = {
        "travel": (whole, units, "travel from the least to the largest"),
        **{word: (getattr(ends, word), units, f"{text} value") for word, text in ENDS.items()},
        **{f"{word}_at": (getattr(ends, f"{word}_at"), "degree", f"crank angle of the {ENDS[word]}") for word in ENDS},
        "time_ratio": (ends.time_ratio, "1", "crank angle of the slower way over that of the faster one"),
        "dwell_max": (ends.dwell_max, "degree", f"crank angle for which it rests within {dwell:g} of its largest"),
        "dwell_min": (ends.dwell_min, "degree", f"crank angle for which it rests within {dwell:g} of its least"),
    }
    order = (*scene.at_one_angle.inputs.sizes,)
    return {f"{name}_{word}": variable(*part[:2], f"{part[2]}: {of}", order) for word, part in parts.items()}


@limits_threads
def coupler_curve(
    scene: Scene, at: tuple[Any, Any], *, theta2: Any = 720, link: str | None = None, threads: int | None = None
) -> xr.Dataset:
    """Compute the curve that a point of a link draws, with velocity and acceleration.

    Parameters
    ----------
    scene : Scene
        Scene of a machine of links.
    at : pair of floats or DataArrays
        Point in the link's own polar coordinates: distance from its first pin [m], angle from its line of pins
        [degree].
    theta2 : int or array_like, default 720
        Count of crank angles, or angles [degree], as in `linksweep.sweep`.
    link : str, default None
        Role of the link; None for the coupler or rod, of an inverted slider-crank the rocker.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Over (…, theta2): position `Px`, `Py` from A [m], velocity `vPx`, `vPy` [m/s], acceleration `aPx`, `aPy` [m/s²],
        and `status`; NaN where the status is not ok.

    Raises
    ------
    ValueError
        If the machine has no such link, the point is no pair of a length and an angle, or arrays over one dim differ in
        length or labels.

    Examples
    --------
    >>> import linksweep as ls
    >>> curve = ls.coupler_curve(ls.example("press"), at=(0.10, 15.0), theta2=[0, 90, 180, 270])
    >>> curve.Py.round(4).values.tolist()  # m
    [0.0939, 0.1469, 0.0819, 0.0197]
    """
    require(scene, "bodies")
    bodies = {body.role: body for body in scene.mechanism.bodies}
    role = _floating(scene) if link is None else link
    refuse(choice_problems("link", role, bodies))
    at = checked_pair("at", at, POLAR_POINT)
    refuse(argument_problems(scene.arrays, at=at))
    body, cycle = bodies[role], sweep(scene, theta2, of=["status"])
    k, of_pin = body.number, (*body.pin_position, *body.pin_velocity, *body.pin_acceleration)
    motion = _numbers(scene, theta2, (*of_pin, f"r{k}x", f"r{k}y", f"omega{k}", f"alpha{k}"))
    x, y, vx, vy, ax, ay, *line, omega, alpha = motion
    length = scene.mechanism.parameters()[f"{role}_length"]
    cos, sin = cos_sin(at[1])
    arm = planar.to_ground_axes(at[0] * cos, at[0] * sin, length, *line)
    vectors = {
        "P": planar.vector_sum(x, y, *arm),
        "vP": planar.point_velocity(vx, vy, omega, *arm),
        "aP": planar.point_acceleration(ax, ay, omega, alpha, *arm),
    }
    results = {
        f"{name}{axis}": (part, units, f"{text} of the {role}, component along {axis}")
        for name, (units, text) in CURVE.items()
        for axis, part in zip("xy", vectors[name], strict=True)
    }
    variables = xr.Dataset(with_units(results)).where(cycle["status"] == 0).data_vars
    return cycle.assign(variables).assign_attrs(command=f"linksweep.coupler_curve(scene, at=..., link={role!r})")


def _floating(scene: Scene) -> str:
    """Return the first link, among the parts of the machine, that no ground pin holds; else the last of all links."""
    machine = scene.mechanism
    floating = (b.role for b in machine.bodies if b.role in machine.parts and b.role not in machine.on_ground)
    return next(floating, machine.bodies[-1].role)


def _numbers(scene: Scene, theta2: Any, sources: tuple[Any, ...]) -> list[Any]:
    """Return quantities of the table by name, internal ones too; a number is returned as it is."""
    grid = scene.grid(theta2)
    sampled = scene.at(grid)
    names = tuple(source for source in sources if isinstance(source, str))
    order = (*sampled.inputs.sizes, grid.dim)
    fields = compute(sampled, grid, tuple(dict.fromkeys(names)))
    arrays = {name: xr.DataArray(variable(field, "", "", order)) for name, field in fields.items()}
    return [arrays[source] if isinstance(source, str) else source for source in sources]
