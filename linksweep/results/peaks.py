"""Compute the largest value of each quantity over the continuous revolution, and its angle."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import xarray as xr
from numpy.typing import ArrayLike

from linksweep.base.validate import choice_problems, quote, refuse
from linksweep.engine.threads import limits_threads
from linksweep.results.compute import angles_of, either, part_of, requested, require_scene
from linksweep.results.cylinders.cylinder_peaks import peaks_of_cylinders
from linksweep.results.cylinders.multi_cylinder import MultiCylinder
from linksweep.results.dask_blocks import by_blocks
from linksweep.results.scene_peaks import peaks_of_scene
from linksweep.scene.scene import Scene

SOLVERS = ("fast", "superposed")
WORDS = ("peak", "max", "min", "peak_at", "max_at", "min_at")
"""Endings of the names of peaks, behind the name of the quantity."""
OF_CYLINDERS = "must be left out: peaks of several cylinders are those of the whole cycle"


@by_blocks(of_samples=False)
@limits_threads
def peaks(
    scene: Scene | MultiCylinder,
    of: str | Iterable[str] | None = None,
    *,
    theta2: ArrayLike | None = None,
    theta: ArrayLike | None = None,
    between: tuple[float, float] | None = None,
    solver: str = "fast",
    threads: int | None = None,
) -> xr.Dataset:
    """Find the exact peak of each quantity over the continuous revolution, and its angle.

    Parameters
    ----------
    scene : Scene or MultiCylinder
        Scene of any number of designs. Quantities of several cylinders are those of `MultiCylinder.sweep`, and the pin
        forces of each cylinder, "F32" and the like, over the dim `cylinder`.
    of : str or iterable of str, default None
        Names of quantities, or of their peaks, such as "F32_peak"; "F32_mean", "T12_rms" give mean and root mean square
        over time, "F32_bound" how much larger the peak could be than the one returned (inf where a function changes too
        quickly to be followed), "F32_samples" how many crank angles were evaluated. None for the forces of all pins and
        slides (of a linkage's F16n and F16t their sum F16), the moments of slides between links, and the drive's torque
        or force.
    theta2 : int or array_like, default None
        Count of crank angles, or angles [degree]: the largest of these samples is returned instead; in means each
        stands for half the way to its neighbours.
    theta : int or array_like, default None
        Count of positions of a car in a loop, or positions [degree], in place of theta2.
    between : (float, float), default None
        First and last crank angle (position of a car) [degree] of the part of the cycle whose exact peaks and means are
        returned, both ends included; None for the whole cycle.
    solver : {"fast", "superposed"}, default "fast"
        As in `linksweep.sweep`; "superposed" needs a count of angles or angles.
    threads : int, default None
        Largest number of threads; None for all cores. Results do not depend on it.

    Returns
    -------
    Dataset
        Over the design dims. A magnitude gives `F32_peak` [N] and `F32_peak_at` [degree]; a signed quantity `T12_max`,
        `T12_max_at`, `T12_min`, `T12_min_at` and `T12_peak` (largest magnitude). `status`: ok, partial_revolution
        (peaks are those of the angles that are ok; sums over several cylinders have none, NaN), cannot_assemble (NaN)
        or unbounded (some peak or mean is inf). Between two angles it is that of these alone, and `F32_peak_at_end`
        says of each extreme whether it stands at an end: inside (0), first (1), last (2) or no_peak (3).

    Raises
    ------
    ValueError
        If a name is unknown, an angle is no finite number, angles end at π, 2π or 4π (radians), `theta` is passed for a
        machine with a crank or `theta2` for a car in a loop, `between` is no part of the cycle or stands beside samples
        or several cylinders, or exact peaks are to be superposed.

    Notes
    -----
    Relative error at most 1e-10 of a peak, 1e-5 degree of its angle, besides the rounding of the forces themselves. The
    angle of a limit at a jump lies on its side: a sweep at the angle of a peak has the peak's value.

    Samples that are dense where a machine comes near a toggle find every rise; between them the plan is evaluated until
    nothing is left to gain. One-sided limits at jumps of friction and loads count, not what stands between them where
    a slide turns round; so do the limits at the ends of a revolution that toggles cut short. What grows there without
    bound has the peak inf.

    Springs and dampers are sampled more densely where their ends pass each other; functions of theta2 every 0.02
    degrees, or more densely where they change more quickly; arrays at least as densely as their angles. A narrower
    event is found if the load's `breaks` name its angle.

    In means over time each small angle dθ2 counts by the time ``dθ2/|ω2|``. A crank whose speed is 0 at some angle, as
    where it changes its sign, takes infinite time to pass it and ends no cycle: its means are NaN, its peaks are not.
    Of a crank that stands still at all angles (omega2=0) they are means over the angle.

    Examples
    --------
    >>> import linksweep as ls
    >>> scene = ls.example("press")
    >>> worst = ls.peaks(scene, of=["F32", "T12"])
    >>> float(worst.F32_peak.round(3)), float(worst.F32_peak_at.round(2))  # N, degrees
    (354.538, 300.27)
    >>> print(worst.linksweep)
    quantity     value  unit  at theta2
    F32_peak   354.538  N       300.27°
    T12_max    20.5233  N m     324.69°
    T12_min   -21.2235  N m     183.20°

    Over a part of the turn, from whose first angle on this force decreases:

    >>> ls.peaks(scene, of=["F12"], between=(-60.0, 60.0)).F12_peak_at_end.item()
    1
    """
    word, angles = either(theta2=theta2, theta=theta)
    refuse(_solver_problems(solver, angles))
    names = None if of is None else requested("of", of, scene)
    samples = f"is of exact peaks, {word} of samples: give one of them"
    refuse([] if angles is None or between is None else [f"between = {quote(between)}: {samples}"])
    if isinstance(scene, MultiCylinder):
        refuse([] if between is None else [f"between = {quote(between)}: {OF_CYLINDERS}"])
        exact = "must be left out: peaks of several cylinders are exact"
        refuse([] if angles is None else [f"{word} = {quote(angles)}: {exact}"])
        return peaks_of_cylinders(scene.in_memory, names)
    require_scene(scene)
    sampled, part = angles_of(scene, theta2=theta2, theta=theta), part_of("between", between, scene)
    return peaks_of_scene(scene, names, sampled, solver, part)


def quantity_of(name: str) -> str:
    """Return the quantity of a peak's name, F32 of F32_peak; means have names of their own in `peaks`."""
    return next((name.removesuffix(f"_{word}") for word in WORDS if name.endswith(f"_{word}")), name)


def _solver_problems(solver: Any, angles: Any) -> list[str]:
    problems = choice_problems("solver", solver, SOLVERS)
    missing = 'solver = "superposed": is for samples, which designs share; exact peaks have each their own: give theta2'
    return problems or ([missing] if solver == "superposed" and angles is None else [])
