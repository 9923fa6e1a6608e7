"""Forces against speed: F = A·ω2² + B·α2 + C at every crank angle, and the highest speed below a limit of force.

For a limit X the square of the force is |A w + S|² with w = ω2², S = B·α2 + C: a parabola in w, open upwards. The
largest of all of them, the peak squared, is therefore convex in w: the speeds that keep it below X² are one interval.
Its upper end is approached from above: where the exact peak at a speed lies beyond X, the parabola of its angle gives
the next, lower speed (Kelley's cutting planes, J. SIAM 8 (1960) 703, with parabolas for planes).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from linksweep.analysis.pins.breakdown import forces_of
from linksweep.base.checked_number import one_number
from linksweep.base.validate import Rule, refuse
from linksweep.engine.threads import limits_threads
from linksweep.results.changed import quantities_with
from linksweep.results.compute import quantity_problems, requested, requested_one, require, require_one_branch
from linksweep.results.dataset import design_coordinates, origin_attributes, with_units
from linksweep.results.peaks import peaks
from linksweep.results.sweep import sweep
from linksweep.scene.pairs import quantities_at
from linksweep.scene.scene import Scene

LIMITS = {"N": Rule("force", above=0.0), "N m": Rule("torque", above=0.0)}
CUTS = 30
SAMPLES = 720
CLOSE = 1e-12
NO_WEIGHT = {"gravity_x": 0.0, "gravity_y": 0.0}
TERMS = {
    "per_omega2_squared": ({"omega2": 1.0, "alpha2": 0.0} | NO_WEIGHT, "s^2/rad^2", "A of A·omega2² + B·alpha2 + C in"),
    "per_alpha2": ({"omega2": 0.0, "alpha2": 1.0} | NO_WEIGHT, "s^2/rad", "B of A·omega2² + B·alpha2 + C in"),
    "static": ({"omega2": 0.0, "alpha2": 0.0}, "", "C, at rest, of A·omega2² + B·alpha2 + C in"),
}
"""Each term by its ending: the numbers that isolate it, its unit beside the force's, and its description."""


@limits_threads
def speed_separation(
    scene: Scene, of: str | Iterable[str] | None = None, *, theta2: Any = 720, threads: int | None = None
) -> xr.Dataset:
    """Separate forces and torques into A·ω2² + B·α2 + C, valid for all speeds.

    Parameters
    ----------
    scene : Scene
        Scene of a machine with a crank, without friction and dampers; its omega2 and alpha2 do not matter.
    of : str or iterable of str, default None
        Names of components of pin forces, or of the drive's torque or force; None for all of them.
    theta2 : int or array_like, default 720
        Count of crank angles, or angles [degree], as in `linksweep.sweep`.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Over the dims of a sweep, `F32x_per_omega2_squared` [N s²/rad²], `F32x_per_alpha2` [N s²/rad] and `F32x_static`
        [N] for each.

    Raises
    ------
    ValueError
        If a name is a magnitude (give its components), or the scene has friction, dampers or no crank.

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
    quantities = scene.table.quantity
    known = [name for name in forces_of(scene) if not quantities[name].squared]
    unknowns = scene.mechanism.unknowns(scene.drive)
    names = tuple(name for name in known if name in unknowns) if of is None else tuple(requested("of", of, scene))
    magnitudes = [quantities[name] for name in names if name in quantities and quantities[name].squared]
    no_sum = "is a magnitude, which is no sum of these terms; name its components"
    refuse([f"of: {size.name} {no_sum}, {', '.join(size.components)}" for size in magnitudes])
    refuse([problem for name in names for problem in quantity_problems("of", name, known, scene)])
    grid = scene.grid(theta2)
    sampled = scene.at(grid)
    bare = replace(sampled, loads=())
    cycle = sweep(scene, theta2, of=names)
    terms = {}
    for ending, (changed, units, words) in TERMS.items():
        forces = quantities_with(changed, sampled if ending == "static" else bare, grid, names)
        for name in names:
            term, whole = forces[name].where(cycle["status"] == 0), cycle[name]
            terms[f"{name}_{ending}"] = (term, f"{whole.units} {units}".strip(), f"{words}: {whole.long_name}")
    command = f"linksweep.speed_separation(scene, {list(names)}, ...)"
    return cycle[["status"]].assign(with_units(terms)).assign_attrs(command=command)


@limits_threads
def speed_limit(scene: Scene, of: str, *, below: float, threads: int | None = None) -> xr.Dataset:
    """Compute the highest crank speed at which the exact peak of a force or torque stays below a limit.

    Parameters
    ----------
    scene : Scene
        Scene of a machine with a crank, without friction and dampers; alpha2 is kept, omega2 gives the direction.
    of : str
        Name of a pin force, of one of its components, or of the drive's torque or force.
    below : float
        Limit [N, N m].
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Results over the design dims:

        - `omega2_limit` [rad/s], not negative: inf where no speed exceeds the limit, NaN where none keeps it, because
          the force at rest is beyond it and no speed relieves it, or forces grow without bound; NaN of a design that
          closes at no angle
        - `omega2_limit_at` [degree]: crank angle of the peak at that speed.

    Raises
    ------
    ValueError
        If `of` is no name of one force, the limit is not one positive number, the scene has friction or dampers
        (compute the peaks over an array of speeds instead), branch="both", or no crank.

    Examples
    --------
    >>> import linksweep as ls
    >>> from dataclasses import replace
    >>> press = ls.example("press")
    >>> limit = float(ls.speed_limit(press, "F32", below=1000.0).omega2_limit)
    >>> print(f"{limit:.2f} rad/s")
    69.29 rad/s
    >>> round(float(ls.peaks(replace(press, omega2=limit), of=["F32"]).F32_peak), 6)  # N
    1000.0
    """
    require(scene, "drives")
    name = requested_one("of", of, scene)
    refuse(_problems(scene))
    require_one_branch(scene)
    refuse(quantity_problems("of", name, forces_of(scene), scene))
    below = one_number("below", below, LIMITS[scene.table.quantity[name].units])
    parts = scene.table.quantity[name].components
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
    long_name = f"highest angular velocity of the crank at which {name} stays below {below:g}"
    at = angle.where(np.isfinite(squared)), "degree", f"crank angle of the largest {name} at that speed"
    results = with_units({"omega2_limit": (squared**0.5, "rad/s", long_name), "omega2_limit_at": at})
    command = f"linksweep.speed_limit(scene, {name!r}, below={below:g})"
    variables = {name: item.reset_coords(drop=True) for name, item in results.items()}
    return xr.Dataset(variables, design_coordinates(scene), origin_attributes(scene, command))


def _problems(scene: Scene) -> list[str]:
    """Return why the forces of a scene are not A·omega2² + B·alpha2 + C."""
    advice = "take ls.peaks with an array of omega2 instead"
    problems = [f"mechanism.friction: its force does not grow with omega2²; {advice}"] if scene.mechanism.rubs else []
    if scene.mechanism.teeth:
        problems.append(f"mechanism.gears: teeth with a pressure angle part whichever way they drive; {advice}")
    dampers = [k for k, load in enumerate(scene.loads, 1) if load.form.damps]
    return problems + [f"loads[{k}] is a damper, whose force grows with omega2; {advice}" for k in dampers]


def _one_each(scene: Scene) -> xr.DataArray:
    """Return a speed of 1 rad/s in the scene's own direction, for each design."""
    sizes = scene.at_one_angle.inputs.sizes
    omega2 = scene.at_one_angle.omega2
    sign = xr.where(xr.DataArray(omega2) < 0.0, -1.0, 1.0).drop_vars(scene.mechanism.index, errors="ignore")
    sign = sign.isel({scene.mechanism.index: 0}, missing_dims="ignore")
    return (xr.DataArray(np.ones(tuple(sizes.values())), dims=tuple(sizes)) * sign).transpose(*sizes)


def _of_samples(scene: Scene, parts: tuple[str, ...], below: float) -> xr.DataArray:
    """Return the largest ω2² that the samples of a grid allow; the continuous revolution can only lower it."""
    index = scene.mechanism.index
    grid = scene.grid(SAMPLES)
    sampled = scene.at(grid)
    ok = sweep(scene, SAMPLES, of=[])["status"].drop_vars(index, errors="ignore") == 0
    growing = quantities_with(TERMS["per_omega2_squared"][0], replace(sampled, loads=()), grid, parts)
    standing = quantities_with({"omega2": 0.0}, sampled, grid, parts)
    roots = _roots([growing[part] for part in parts], [standing[part] for part in parts], below)
    lower, upper = (xr.broadcast(root, ok, scene.omega2)[0] for root in roots)
    least = lower.where(ok, -math.inf).max(index, skipna=False)
    most = upper.where(ok, math.inf).min(index, skipna=False)
    closes = ok.broadcast_like(lower).any(index)
    return most.where(closes & (most >= least) & (most >= 0.0)).transpose(*scene.omega2.dims)


def _roots(growing: list, standing: list, below: float) -> tuple[Any, Any]:
    """Return w where |A w + S|² = X²: minus and plus infinity where it stays below, NaN where it is always beyond."""
    a = sum(A * A for A in growing)
    b = sum(A * S for A, S in zip(growing, standing, strict=True))
    c = sum(S * S for S in standing) - below * below
    with np.errstate(all="ignore"):
        root = np.sqrt(b * b - a * c)
        far = -(b + xr.where(b < 0.0, -root, root))  # the root that does not cancel
        first, second = far / a, c / far
        flat, kept = a == 0.0, xr.where(c <= 0.0, math.inf, math.nan)
        lower = xr.where(flat, -kept, np.minimum(first, second))
        return lower, xr.where(flat, kept, np.maximum(first, second))


def _peak(scene: Scene, name: str) -> tuple[xr.DataArray, xr.DataArray]:
    """Return the exact peak of a magnitude, or of a signed quantity's magnitude, and its angle."""
    worst = peaks(scene, of=[name]).drop_vars("status").reset_coords(drop=True)
    if f"{name}_peak_at" in worst:
        return worst[f"{name}_peak"], worst[f"{name}_peak_at"]
    positive = worst[f"{name}_max"] >= -worst[f"{name}_min"]
    return worst[f"{name}_peak"], xr.where(positive, worst[f"{name}_max_at"], worst[f"{name}_min_at"])


def _cut(scene: Scene, parts: tuple[str, ...], angle: xr.DataArray, below: float) -> xr.DataArray:
    """Return the upper root at this angle of each design, which bounds the speed from above."""
    speed = scene.omega2
    designs, angles = np.arange(speed.size), angle.broadcast_like(speed).transpose(*speed.dims).values.ravel()
    angles = np.where(np.isfinite(angles), angles, 0.0)
    standing = quantities_at(replace(scene, omega2=0.0 * speed), parts, designs, angles)
    with np.errstate(all="ignore"):
        growing = (quantities_at(scene, parts, designs, angles) - standing) / speed.values.ravel() ** 2
    _, upper = _roots([*growing], [*standing], below)
    return speed.copy(data=np.reshape(np.asarray(upper), speed.shape)).where(lambda w: w >= 0.0)
