"""Speed and load: F = A·ω2² + B·α2 + C at every crank angle, and the highest speed at which a peak stays below a limit.

For a limit X the square of the force is |A w + S|² with w = ω2², S = B·α2 + C: a parabola in w, open upwards. The
largest of all of them, the peak squared, is therefore convex in w: the speeds that keep it below X² are one interval.
Its upper end is found from above: where the exact peak at a speed lies beyond X, the parabola of its angle gives the
next, lower speed (Kelley's cutting planes, J. SIAM 8 (1960) 703, with parabolas for planes).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from linksweep.analysis.pins.breakdown import forces_of, has_friction
from linksweep.base.validate import Rule, refuse
from linksweep.results.changed import quantities_with
from linksweep.results.compute import quantity_problems, requested, require
from linksweep.results.dataset import design_coordinates
from linksweep.results.peak_search.between import quantities_at
from linksweep.results.peaks import peaks
from linksweep.results.sweep import sweep
from linksweep.scene.checked_number import checked_number
from linksweep.scene.grid import crank_grid
from linksweep.scene.scene import Scene

LIMITS = {"N": Rule("force", above=0.0), "N m": Rule("torque", above=0.0)}
CUTS = 30
SAMPLES = 720
CLOSE = 1e-12
NO_WEIGHT = {"gravity_x": 0.0, "gravity_y": 0.0}
TERMS = {
    "per_omega2_squared": ({"omega2": 1.0, "alpha2": 0.0} | NO_WEIGHT, "s2 rad-2", "A of A·omega2² + B·alpha2 + C in"),
    "per_alpha2": ({"omega2": 0.0, "alpha2": 1.0} | NO_WEIGHT, "s2 rad-1", "B of A·omega2² + B·alpha2 + C in"),
    "static": ({"omega2": 0.0, "alpha2": 0.0}, "", "C, at rest, of A·omega2² + B·alpha2 + C in"),
}
"""Each term by its ending: the numbers that leave it alone, its unit beside the force's, and its words."""


def speed_separation(scene: Scene, of: str | Iterable[str] | None = None, *, theta2: Any = 720) -> xr.Dataset:
    """Forces and torques as A·ω2² + B·α2 + C: one sweep for all speeds.

    Parameters
    ----------
    scene : Scene of a machine with a crank, without friction and dampers; its omega2 and alpha2 do not matter
    of : names of components of pin forces, or of the drive's torque or force; default: all of them
    theta2 : as in `sweep`

    Returns
    -------
    Dataset over the dims of a sweep, with `F32x_per_omega2_squared` [N s²/rad²], `F32x_per_alpha2` [N s²/rad] and
    `F32x_static` [N] for each.

    Raises
    ------
    ValueError
        For magnitudes (take their components), friction and dampers, whose forces do not grow so, and a car in a loop.

    Examples
    --------
    >>> import linksweep as ls
    >>> press = ls.example("press")
    >>> parts = ls.speed_separation(press, "T12")
    >>> again = parts.T12_per_omega2_squared * press.omega2**2 + parts.T12_static
    >>> bool((abs(again - ls.sweep(press).T12) < 1e-13).all())
    True
    """
    require(scene, "drives")
    refuse(_problems(scene))
    known = [name for name in forces_of(scene) if not scene.table.quantity[name].squared]
    unknowns = scene.mechanism.unknowns(scene.drive)
    names = tuple(name for name in known if name in unknowns) if of is None else tuple(requested("of", of))
    refuse([problem for name in names for problem in quantity_problems("of", name, known, scene)])
    grid = crank_grid(theta2, scene.period, scene.mechanism.index)
    sampled = scene.at(grid)
    bare = replace(sampled, loads=())
    cycle = sweep(scene, theta2, of=names)
    made = {}
    for ending, (changed, units, words) in TERMS.items():
        found = quantities_with(changed, sampled if ending == "static" else bare, grid, names)
        for name in names:
            attributes = {"units": f"{cycle[name].units} {units}".strip()}
            attributes["long_name"] = f"{words}: {cycle[name].long_name}"
            made[f"{name}_{ending}"] = found[name].where(cycle["status"] == 0).assign_attrs(attributes)
    command = f"linksweep.speed_separation(scene, {list(names)}, ...)"
    return cycle[["status"]].assign(made).assign_attrs(cycle.attrs | {"command": command})


def speed_limit(scene: Scene, of: str, *, below: float) -> xr.Dataset:
    """The highest crank speed at which the exact peak of a force or torque stays below a limit.

    Parameters
    ----------
    scene : Scene of a machine with a crank, without friction and dampers; alpha2 is kept, omega2 gives the direction
    of : name of a pin force, of one of its components, or of the drive's torque or force
    below : the limit, in its unit [N or N m]

    Returns
    -------
    Dataset over the design dims.

    - `omega2_limit` [rad/s], not negative: inf where no speed exceeds the limit, NaN where none keeps it, because the
      force at rest is beyond it and no speed relieves it, or forces grow without bound
    - `omega2_limit_at` [degree]: the crank angle of the peak there

    Raises
    ------
    ValueError
        For a name that is no force, a limit that is not positive, friction and dampers (take the peaks over an
        array of speeds instead), branch="both", and a car in a loop.

    Examples
    --------
    >>> import linksweep as ls
    >>> from dataclasses import replace
    >>> press = ls.example("press")
    >>> limit = float(ls.speed_limit(press, "F32", below=1000.0).omega2_limit)
    >>> round(float(ls.peaks(replace(press, omega2=limit), of=["F32"]).F32_peak), 6)
    1000.0
    """
    require(scene, "drives")
    (name,) = requested("of", of)[:1] or [""]
    refuse(_problems(scene))
    refuse(_branch_problems(scene))
    refuse(quantity_problems("of", name, forces_of(scene), scene))
    below = checked_number("below", below, LIMITS[scene.table.quantity[name].units])
    parts = (f"{name}x", f"{name}y") if scene.table.quantity[name].squared else (name,)
    unit_speed = replace(scene, omega2=_one_each(scene))
    squared, angle = _of_samples(unit_speed, parts, below), xr.DataArray(math.nan)
    for _ in range(CUTS):
        at_speed = replace(scene, omega2=unit_speed.omega2 * np.sqrt(squared.where(np.isfinite(squared), 0.0)))
        peak, angle = _peak(at_speed, name)
        cut = _cut(at_speed, parts, angle, below).where(np.isfinite(peak))
        over = np.isfinite(squared) & (peak > below * (1.0 + CLOSE)) & ~(cut >= squared)
        squared = squared.where(~over, cut)
        if not bool(over.any()):
            break
    said = f"highest angular velocity of the crank at which {name} stays below {below:g}"
    made = {
        "omega2_limit": (squared**0.5).assign_attrs(units="rad s-1", long_name=said),
        "omega2_limit_at": angle.where(np.isfinite(squared)).assign_attrs(
            units="degree", long_name=f"crank angle of the largest {name} at that speed"
        ),
    }
    found = xr.Dataset({name: item.reset_coords(drop=True) for name, item in made.items()})
    return found.assign_coords(design_coordinates(scene)).assign_attrs(
        command=f"linksweep.speed_limit(scene, {name!r}, below={below:g})"
    )


def _problems(scene: Scene) -> list[str]:
    """Why its forces are not A·omega2² + B·alpha2 + C."""
    advice = "take ls.peaks with an array of omega2 instead"
    problems = [f"mechanism.friction: its force does not grow with omega2²; {advice}"] if has_friction(scene) else []
    dampers = [k for k, load in enumerate(scene.loads, 1) if load.form.damps]
    return problems + [f"loads[{k}] is a damper, whose force grows with omega2; {advice}" for k in dampers]


def _branch_problems(scene: Scene) -> list[str]:
    both = "branch" in scene.mechanism.coordinates()
    return ['mechanism.branch = "both": must be one of open, crossed; ask for each'] if both else []


def _one_each(scene: Scene) -> xr.DataArray:
    """A speed of 1 rad/s in the scene's own direction, for each design."""
    sizes = scene.at_one_angle.inputs.sizes
    omega2 = scene.at_one_angle.omega2
    sign = xr.where(xr.DataArray(omega2) < 0.0, -1.0, 1.0).drop_vars(scene.mechanism.index, errors="ignore")
    sign = sign.isel({scene.mechanism.index: 0}, missing_dims="ignore")
    return (xr.DataArray(np.ones(tuple(sizes.values())), dims=tuple(sizes)) * sign).transpose(*sizes)


def _of_samples(scene: Scene, parts: tuple[str, ...], below: float) -> xr.DataArray:
    """The largest ω2² that the samples of a grid allow, which the continuous revolution can only lower."""
    index = scene.mechanism.index
    grid = crank_grid(SAMPLES, scene.period, index)
    sampled = scene.at(grid)
    ok = sweep(scene, SAMPLES, of=[])["status"].drop_vars(index) == 0
    growing = quantities_with(TERMS["per_omega2_squared"][0], replace(sampled, loads=()), grid, parts)
    standing = quantities_with({"omega2": 0.0}, sampled, grid, parts)
    roots = _roots([growing[part] for part in parts], [standing[part] for part in parts], below)
    lower, upper = (xr.broadcast(root, ok, scene.omega2)[0] for root in roots)
    least = lower.where(ok, -math.inf).max(index, skipna=False)
    most = upper.where(ok, math.inf).min(index, skipna=False)
    return most.where((most >= least) & (most >= 0.0)).transpose(*scene.omega2.dims)


def _roots(growing: list, standing: list, below: float) -> tuple[Any, Any]:
    """Where |A w + S|² = X²; from minus to plus infinity where it never gets there, NaN where it is always beyond."""
    a = sum(A * A for A in growing)
    b = sum(A * S for A, S in zip(growing, standing, strict=True))
    c = sum(S * S for S in standing) - below * below
    with np.errstate(all="ignore"):
        root = np.sqrt(b * b - a * c)
        far = -(b + xr.where(b < 0.0, -root, root))  # of the two, the one that does not cancel
        first, second = far / a, c / far
        flat, kept = a == 0.0, xr.where(c <= 0.0, math.inf, math.nan)
        lower = xr.where(flat, -kept, np.minimum(first, second))
        return lower, xr.where(flat, kept, np.maximum(first, second))


def _peak(scene: Scene, name: str) -> tuple[xr.DataArray, xr.DataArray]:
    """The exact peak of a magnitude, or of a signed quantity's magnitude, and its angle."""
    found = peaks(scene, of=[name]).drop_vars("status")
    found = found.drop_vars([coordinate for coordinate in found.coords if coordinate not in found.dims])
    if f"{name}_peak_at" in found:
        return found[f"{name}_peak"], found[f"{name}_peak_at"]
    positive = found[f"{name}_max"] >= -found[f"{name}_min"]
    return found[f"{name}_peak"], xr.where(positive, found[f"{name}_max_at"], found[f"{name}_min_at"])


def _cut(scene: Scene, parts: tuple[str, ...], angle: xr.DataArray, below: float) -> xr.DataArray:
    """The upper root at this angle of each design: as low as this, the speed must be."""
    speed = scene.omega2
    designs, angles = np.arange(speed.size), angle.broadcast_like(speed).transpose(*speed.dims).values.ravel()
    angles = np.where(np.isfinite(angles), angles, 0.0)
    standing = quantities_at(replace(scene, omega2=0.0 * speed), parts, designs, angles)
    with np.errstate(all="ignore"):
        growing = (quantities_at(scene, parts, designs, angles) - standing) / speed.values.ravel() ** 2
    _, upper = _roots([*growing], [*standing], below)
    return speed.copy(data=np.reshape(np.asarray(upper), speed.shape)).where(lambda w: w >= 0.0)
