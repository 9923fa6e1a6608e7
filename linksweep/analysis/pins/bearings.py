"""Bearings in the pins of a machine over a cycle: load diagrams, pressure, friction, life."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from linksweep.analysis.pins.bearing import (
    TEXTS,
    Bearing,
    checked_pins,
    exact_loads,
    journal_results,
    load_results,
    side_by_side,
)
from linksweep.analysis.pins.bearing_life import UNBOUNDED, rotation_under_load
from linksweep.analysis.pins.main_bearings import main_bearings
from linksweep.base.memory import require_memory
from linksweep.base.validate import count_problems, quote, refuse
from linksweep.chains.between_links import force_name
from linksweep.engine.threads import limits_threads
from linksweep.results.compute import angles_missing, part_of, require_results
from linksweep.results.cylinders.multi_cylinder import MultiCylinder
from linksweep.results.dataset import by_command, joined, with_units
from linksweep.results.over_time import reach
from linksweep.results.peak_search.paths import Part
from linksweep.results.sweep import sweep
from linksweep.scene.designs.lazy import in_memory
from linksweep.scene.grid import crank_grid
from linksweep.scene.scene import Scene

WHOLE = 1e-9
"""Difference from 1 that rounding may leave of the sum of all shares of a rotation."""
FRAMES = ("ground", "journal", "bearing")
SAMPLES = 720
"""Samples between the two ends of a part of a turn."""


@limits_threads
def bearings(
    scene: Scene | MultiCylinder,
    pins: Mapping[str, Bearing] | None = None,
    *,
    theta2: Any = 720,
    threads: int | None = None,
) -> xr.Dataset:
    """Compute loads, rotation, friction and life of the bearings in the pins of a machine.

    Parameters
    ----------
    scene : Scene or MultiCylinder
        Machine with pins; of a MultiCylinder the main bearings of its crankshaft, with the dim `main` in place of
        `pin`.
    pins : mapping of str to Bearing, default None
        Bearing of each pin, {"B": ls.Bearing(...)}, or main bearing, {"main1": ls.Bearing(...)}; the others have one
        without sizes.
    theta2 : int or array_like, default 720
        Count of crank angles over the cycle; or, of a machine that moves over part of a turn, the first and the last
        crank angle [degree] of its way, sampled between; or samples [degree], of which the least and the largest are
        the ends of the way.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Results over (design dims…, pin, frame, theta2), each over those that it depends on:

        - `F`, and `Fx`, `Fy` in each `frame` [N]: F12, F32, F43, F14 at A, B, C, D, where Fij is the force of link i on
          link j, and its opposite acts on link i. "ground" are the ground's axes, "journal" and "bearing" those of the
          links that carry them (x along the line of pins; of a slider along its guide). The crank carries the journal
          at A and B, the rocker at D, the coupler at C; in a slider-crank the slider at C, as an engine's piston
          carries the gudgeon pin.
        - `rotation_speed` [rad/s] of link j relative to link i; `rotation_share` [1]: part of the pin's whole rotation
          that each sample stands for
        - `pressure` [Pa], `sliding_speed` [m/s], `pv` [Pa m/s] and `friction_loss` [W], under loads without pin
          friction; `linksweep.pin_friction` couples the two
        - `rotation` [degree] over the cycle, or once over the part of a turn; `equivalent_load` [N], `L10` [million
          revolutions] and `L10h` [hours]: integrals over the continuous angle, which do not depend on the count of
          samples
        - `F_peak` [N], `F_peak_at` [degree] and `F_mean` [N], exact as in `linksweep.peaks`, over the cycle or the part
          of a turn; `pressure_peak` [Pa] under the largest load
        - `status` of each sample; integrals leave out angles that are not ok
        - `life_status` (…, pin): ok, partial_revolution (the life of the angles that are ok), nothing_solved (NaN),
          unbounded_load (equivalent load inf, life 0), no_rotation (NaN).

    Raises
    ------
    ValueError
        If the machine lacks pins, or one of those named, a value is no Bearing, the angles span no part of a cycle,
        an array over theta2 states no angles, or arrays over one dim differ in length or labels.

    Notes
    -----
    Integrals to 1e-10. A machine that moves over part of a turn is assumed to return the way it came. Source: equations
    of `linksweep.analysis.pins.bearing_life` and `linksweep.physics.bearing`.

    Examples
    --------
    >>> import linksweep as ls
    >>> pins = {"C": ls.Bearing(diameter=0.01, length=0.02, capacity=5000.0)}
    >>> print(ls.bearings(ls.example("press"), pins).linksweep)
    pin  largest [N]  mean [N]  equivalent [N]  turns [°]  pressure [MPa]  PV of samples [MPa m/s]  L10h [h]
    A          365.6     268.1           282.9      360.0
    B          354.5     263.1           268.6      360.0
    C          388.3     149.4           196.3      110.5           1.941                  0.09757   2991000
    D          376.3     153.9           194.6      122.6
    """
    if isinstance(scene, MultiCylinder):
        return main_bearings(scene.in_memory, pins, theta2)
    links = checked_pins(scene, pins)
    scene = in_memory(scene)
    part = _part_of_turn(theta2, scene)
    refuse(angles_missing(scene))
    names = [name for pin, pair in links.items() for name in _outputs(scene, pin, pair)]
    cycle = sweep(scene, _samples(theta2, part), of=["omega2", *dict.fromkeys(names)])
    fitted = {pin: (pins or {}).get(pin, Bearing()) for pin in links}
    forces = {pin: force_name(*pair) for pin, pair in links.items()}
    exponents = {pin: bearing.exponent for pin, bearing in fitted.items()}
    rotation = rotation_under_load(scene, forces, exponents, part)
    exact = exact_loads(scene, forces.values(), part)
    weights, speeds = _weights(cycle["theta2"], part), {pin: cycle[f"omega_{pin}"] for pin in links}
    parts = [
        {"F": cycle[forces[pin]]}
        | load_results(exact, forces[pin], bearing)
        | _in_frames(cycle, *links[pin], scene.mechanism.journals[pin])
        | journal_results(cycle, forces[pin], speeds[pin], abs(speeds[pin] / cycle["omega2"]) * weights, bearing)
        | rotation.life(pin, bearing.capacity, bearing.exponent)
        for pin, bearing in fitted.items()
    ]
    results = side_by_side(parts, "pin", links, TEXTS)
    angles = theta2 if part is None else f"<{cycle.sizes['theta2']} angles>"
    attributes = cycle.attrs | by_command(f"linksweep.bearings(scene, ..., theta2={angles})")
    return xr.Dataset({**results, "status": cycle["status"]}, cycle.coords, attributes)


def _part_of_turn(theta2: Any, scene: Scene) -> Part | None:
    """Return the ends [degree] of the way that angles state; None of a count, which states the whole cycle."""
    grid = crank_grid(theta2, scene.period)
    if grid.period:
        return None
    if len(grid.angles) == 2:
        return part_of("theta2", tuple(grid.angles.tolist()), scene)
    first, last = float(grid.angles.min()), float(grid.angles.max())
    ends = f"theta2 = {first:g} … {last:g} degrees"
    refuse([f"{ends}: is one angle; give the ends of a part of a turn, or a count"] if first == last else [])
    too_long = f"{ends}: is more than a cycle of {scene.period:g} degrees; give a part of it, or a count"
    refuse([too_long] if last - first > scene.period else [])
    return first, last


def _samples(theta2: Any, part: Part | None) -> Any:
    """Return the crank angles to sample: between the ends of a part of a turn where those alone are stated."""
    return np.linspace(*part, SAMPLES) if part and len(theta2) == 2 else theta2


def _outputs(scene: Scene, pin: str, links: tuple[int, int]) -> list[str]:
    i, j = links
    force = force_name(*links)
    frames = [f"{force}{axis}_link{k}" for k in (i, j) if k != 1 for axis in "xy"]
    return [force, f"{force}x", f"{force}y", f"omega_{pin}", *frames]


def _weights(angles: xr.DataArray, part: Part | None) -> xr.DataArray:
    """Return weights of the angles: equal over a cycle; over a part of a turn, half the distances to the neighbours."""
    return xr.ones_like(angles) if part is None else angles.copy(data=reach(angles.values))


def _in_frames(cycle: xr.Dataset, i: int, j: int, journal: int) -> dict[str, xr.DataArray]:
    """Return Fx and Fy in the axes of the ground, of the journal's link and of the bearing's."""
    force, bearing = force_name(i, j), i + j - journal
    suffixes = ["" if link == 1 else f"_link{link}" for link in (1, journal, bearing)]
    parts = {f"F{axis}": [cycle[f"{force}{axis}{suffix}"] for suffix in suffixes] for axis in "xy"}
    return {name: joined(arrays, "frame", FRAMES) for name, arrays in parts.items()}


def load_spectrum(ds: xr.Dataset, *, classes: int = 10) -> xr.Dataset:
    """Compute the share of its rotation that each pin makes under loads of each class.

    Parameters
    ----------
    ds : Dataset
        Loads from `linksweep.bearings`.
    classes : int, default 10
        Count of equal classes of load, from none to the largest sample of the pin.

    Returns
    -------
    Dataset
        Over (…, pin, load_class): `class_load` [N], the middle of each class, and `share` [1] of the rotation in it;
        the shares of a pin add up to 1. NaN where a load is unbounded: no classes reach up to it.

    Raises
    ------
    ValueError
        If the Dataset lacks F, rotation_share or life_status, or some of its angles, or classes is no count.

    Examples
    --------
    >>> import linksweep as ls
    >>> spectrum = ls.load_spectrum(ls.bearings(ls.example("press")), classes=5)
    >>> spectrum.share.sel(pin="C").round(3).values.tolist()  # of its rotation, under small to large loads
    [0.36, 0.298, 0.168, 0.086, 0.089]
    """
    require_results(ds, "ls.bearings")
    missing = [name for name in ("F", "rotation_share", "life_status") if name not in ds]
    refuse([f"ds has no {', '.join(missing)}: give what ls.bearings returns"] if missing else [])
    shares = ds["rotation_share"].sum({"theta2"} & {*ds.dims})
    whole = ((abs(shares - 1.0) < WHOLE) | (shares == 0.0)).all()  # 0 of a pin that does not turn
    refuse([] if whole else ["ds has a part of its angles: give all that ls.bearings returns"])
    refuse(count_problems("classes", classes))
    require_memory(f"classes = {quote(classes)}", 8.0 * classes * ds.sizes.get("pin", 1))
    share, largest = xr.apply_ufunc(
        lambda force, share: _histogram(force, share, classes),
        *xr.broadcast(ds["F"], ds["rotation_share"]),
        input_core_dims=[["theta2"], ["theta2"]],
        output_core_dims=[["load_class"], []],
        output_dtypes=[float, float],  # not those of the first, of which no sample may be known
        vectorize=True,
    )
    bounded = ds["life_status"] != UNBOUNDED
    share, largest = share.where(bounded), largest.where(bounded)
    middle = (xr.DataArray(np.arange(classes), dims="load_class") + 0.5) / classes
    results = {
        "share": (share, "1", "share of the rotation of the journal in its bearing under such loads"),
        "class_load": (largest * middle, "N", "load in the middle of the class"),
    }
    return xr.Dataset(with_units(results), attrs=ds.attrs)


def _histogram(force: np.ndarray, share: np.ndarray, classes: int) -> tuple[np.ndarray, float]:
    known = np.isfinite(force) & np.isfinite(share)
    largest = float(np.max(force, initial=0.0, where=known))
    at = np.minimum((force[known] * (classes / (largest or 1.0))).astype(int), classes - 1)
    return np.bincount(at, share[known], classes), largest
