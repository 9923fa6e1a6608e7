"""size_links(scene): the thickness, or the width, that gives each bar a required safety.

A bar's mass grows with its measure, and with it the forces: the measure is approached by secants of the logarithm of
the safety over that of the measure, all bars at once.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from linksweep.analysis.strength.material import Material
from linksweep.analysis.strength.strength import beams_of, materials_of, strength
from linksweep.base.checked_number import checked_number
from linksweep.base.validate import Number, Rule, choice_problems, refuse
from linksweep.engine.threads import limits_threads
from linksweep.mechanisms.links import Bar
from linksweep.results.compute import require_scene
from linksweep.results.dataset import design_coordinates, flags, joined, provenance, with_units
from linksweep.scene.designs.lazy import in_memory
from linksweep.scene.dimensions import argument_problems
from linksweep.scene.parameters import replaced
from linksweep.scene.scene import Scene

STEEPNESS = {"thickness": 1.0, "width": 2.0}
"""Power of the measure with which a bar's section modulus grows."""
ROUNDS, CLOSE, FARTHEST = 40, 1e-7, np.log(4.0)
"""Most rounds of secants, and logarithms: of the safety over the required one at the end, of the longest step."""
BEYOND = np.log(1e3)
"""Logarithm of a measure over its start beyond which no safety is sought."""
SAFETY = Rule("dimensionless", above=0.0)
MEANINGS = ("ok", "not_reached")


@limits_threads
def size_links(
    scene: Scene,
    material: Material | Mapping[str, Material],
    *,
    safety: Number,
    vary: str = "thickness",
    links: str | Iterable[str] | None = None,
    stress_concentration: Number = 1.0,
    effective_length: tuple[Number, Number] = (1.0, 1.0),
    threads: int | None = None,
) -> xr.Dataset:
    """Compute the thickness, or the width, with which each bar has a required safety.

    Parameters
    ----------
    scene : Scene
        Scene whose bars are sized; their measures are the start.
    material : Material or mapping of str to Material
        Material of all bars, or of each by role.
    safety : float or DataArray
        Least safety against yield, fatigue (Goodman) and buckling [1].
    vary : {"thickness", "width"}, default "thickness"
        Measure to vary: across the plane of motion, or in it.
    links : str or iterable of str, default None
        Roles of the bars to size; None for all.
    stress_concentration : float or DataArray, default 1.0
        As in `linksweep.strength` [1].
    effective_length : pair of float or DataArray, default (1.0, 1.0)
        As in `linksweep.strength` [1].
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Results over `link` and the design dims:

        - `thickness` or `width` [m], `mass` [kg] of the bar, `safety` [1] that it reaches
        - `status`: ok; not_reached where no measure gives that safety, as where a bar's own inertia loads it, or
          nothing does: NaN.

        `linksweep.scene_at` returns the scene with these bars.

    Raises
    ------
    ValueError
        If a link is no Bar, a number is out of bounds, arrays over one dim differ in length or labels, or
        branch="both".

    Notes
    -----
    All bars are sized together: a heavier coupler loads the crank. The sizes give the safety to 1e-6.

    Examples
    --------
    >>> import linksweep as ls
    >>> press, steel = ls.example("press"), ls.material("S235")
    >>> sized = ls.size_links(press, steel, safety=2.0, stress_concentration=2.5)
    >>> (1e3 * sized.thickness).round(2).values.tolist()  # mm, by link
    [7.81, 2.43, 4.11]
    >>> lighter = ls.scene_at(sized)
    >>> worst = ls.strength(lighter, steel, stress_concentration=2.5)
    >>> worst.goodman_safety.round(2).values.tolist()
    [2.0, 2.38, 3.23]
    """
    require_scene(scene)
    refuse(choice_problems("vary", vary, STEEPNESS))
    roles, required = beams_of(scene, links), checked_number("safety", safety, SAFETY)
    refuse([f"links: {role} is no Bar: give it as one, or choose others" for role in _other_than_bars(scene, roles)])
    scene = in_memory(scene)
    options: dict[str, Any] = {
        "links": roles,
        "stress_concentration": stress_concentration,
        "effective_length": effective_length,
    }
    by_role = materials_of(roles, material)
    refuse(argument_problems(scene.arrays, material=material, safety=required, **options))
    without_life = {role: replace(one, slope=None) for role, one in by_role.items()}

    def excess(log: Any) -> Any:
        """Return the logarithm of the safety over the required one, at logarithms of the measures."""
        ds = strength(_with(scene, roles, vary, np.exp(log)), without_life, **options)
        with np.errstate(divide="ignore"):  # where forces are unbounded
            return np.log(_least_safety(ds) / required)

    start = joined([getattr(scene.mechanism.parts[role], vary) for role in roles], "link", roles)
    log: Any = _solved(excess, np.log(start), STEEPNESS[vary])
    left = excess(log)
    good = (abs(left) < 1e-6) & np.isfinite(left)
    sized = _with(scene, roles, vary, np.exp(log).where(good, start))
    bars = [sized.mechanism.parts[role] for role in roles]
    results = {
        vary: (np.exp(log).where(good), "m", f"{vary} of the bar"),
        "mass": (joined([bar.mass for bar in bars], "link", roles).where(good), "kg", "mass of the bar"),
        "safety": ((np.exp(left) * required).where(good), "1", "least safety against yield, fatigue and buckling"),
    }
    coordinates = design_coordinates(sized)
    attributes = provenance(sized, "linksweep.size_links(scene, ...)", coordinates)
    status = xr.where(good, 0, 1).astype(np.int8).assign_attrs(flags("whether the safety is reached", MEANINGS))
    return xr.Dataset({**with_units(results), "status": status}, coordinates, attributes)


def _solved(excess: Callable[[Any], Any], log: Any, steepness: float) -> Any:
    """Return where the excess is 0, by secants; their slopes start at that of the section modulus."""
    start, value, slope = log, excess(log), xr.full_like(log, steepness)
    for _ in range(ROUNDS):
        step = (-value / slope).clip(-FARTHEST, FARTHEST).fillna(0.0)
        after = excess(log + step)
        with np.errstate(invalid="ignore", divide="ignore"):
            secant = (after - value) / step
        slope = xr.where(np.isfinite(secant) & (abs(step) > 1e-12), secant.clip(0.2, 6.0), slope)
        log, value = log + step, after
        away = (abs(log - start) > BEYOND) | value.isnull()
        if bool(((abs(value) < CLOSE) | away).all()):
            break
    return log


def _least_safety(ds: xr.Dataset) -> Any:
    """Return the least safety of each link; where buckling is not known, of the others."""
    buckling = ds["buckling_safety"].min("plane").fillna(np.inf)
    return np.minimum(np.minimum(ds["yield_safety"], ds["goodman_safety"]), buckling)


def _with(scene: Scene, roles: list[str], vary: str, sizes: Any) -> Scene:
    """Copy a scene with other measures of its bars."""
    sizes = sizes.drop_attrs()  # of what they are computed from
    numbers = {f"{role}.{vary}": sizes.sel(link=role).reset_coords(drop=True) for role in roles}
    plain = {path: float(size) if size.ndim == 0 else size for path, size in numbers.items()}
    return replaced(replace(scene, section=None), plain)


def _other_than_bars(scene: Scene, roles: list[str]) -> list[str]:
    return [role for role in roles if not isinstance(scene.mechanism.parts[role], Bar)]
