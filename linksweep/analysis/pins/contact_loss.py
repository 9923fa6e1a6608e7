"""Contact loss in pins with clearance: where the force in a pin turns so fast that the journal cannot follow it.

In a bush wider by the radial clearance c, the journal's centre lies a distance c from the bush's, in the direction of
the force. Where that direction turns at γ', holding the journal on its circle takes m c γ'² of the force F, with m the
mass that moves against the other link: contact is kept where

    m c γ'²/F < 1          γ' = (F_x F_y' − F_y F_x')/F²

and is surely lost where F vanishes. m is here m_i m_j/(m_i + m_j) of the two links, m_j where the other is the ground.

Earles and Wu's empirical formula needs neither mass nor clearance: contact is lost in a pin where γ'/F, of the forces
without clearance, exceeds a threshold. It has a unit, so that a threshold belongs to machines of one size; 5 rad/N/s is
quoted for the four-bars of their experiments. Therefore γ'/F is a result, and no threshold is built in.

Sources: S. W. E. Earles and C. L. S. Wu, A Determination of Contact-Loss at a Bearing of a Linkage Mechanism, Journal
of Engineering for Industry 99 (1977) 375–380, for the clearance as a link without mass that turns with the force; A
Design Method for Reducing the Effects of Clearances at Revolute Joints, Proceedings of the Institution of Mechanical
Engineers 199 (1985), doi 10.1243/PIME_PROC_1985_199_106_02, for a joint that their formula calls free of contact loss;
M. Bengisu, T. Hidayetoglu and A. Akay, A Theoretical and Experimental Investigation of Contact Loss in the Clearances
of a Four-Bar Mechanism, Journal of Mechanisms, Transmissions, and Automation in Design 108 (1986) 237–244, for a
comparison of criteria.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import Any

import numpy as np
import xarray as xr

from linksweep.analysis.pins.by_pin import Numbers, links_of_pins, numbers_by_pin
from linksweep.base.validate import Number, Rule, refuse
from linksweep.chains.between_links import force_name
from linksweep.engine.threads import limits_threads
from linksweep.results.dataset import by_command, joined, with_units
from linksweep.results.sweep import sweep
from linksweep.scene.designs.lazy import in_memory
from linksweep.scene.dimensions import argument_problems
from linksweep.scene.scene import Scene

STEPS = tuple(0.02 * 0.1**k for k in range(6))
"""Distances of the angles between which forces are subtracted [degree]: the first that is small beside the way to an
angle that is not ok, where forces may grow without bound."""
REACH = 50.0
"""Least way to such an angle, in steps."""
CLEARANCE = Rule("length", above=0.0)
STENCIL = {-2.0: 1.0 / 12.0, -1.0: -2.0 / 3.0, 1.0: 2.0 / 3.0, 2.0: -1.0 / 12.0}
"""Weights of the differences, of fourth order."""


@limits_threads
def contact_loss(
    scene: Scene,
    clearance: Numbers | None = None,
    *,
    theta2: Any = 720,
    threads: int | None = None,
) -> xr.Dataset:
    """Compute at which crank angles clearance in a pin would make it knock.

    Parameters
    ----------
    scene : Scene
        Scene of a machine with pins.
    clearance : float, DataArray or mapping of str to them, default None
        Radial clearance [m] of all pins, or of each by its letter; None where only the turning of forces is asked for.
    theta2 : int or array_like, default 720
        Count of crank angles, or angles [degree], as in `linksweep.sweep`.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Results over `pin` and the dims of a sweep:

        - `F` [N] and `turning_rate` [rad/s], the rate at which the force's direction turns in ground axes
        - `turning_per_force` [rad/N/s], the measure of Earles and Wu: contact is lost where it exceeds a threshold,
          which is quoted as 5 for their four-bars, and belongs to machines of that size
        - `knock` [1] with a clearance: the part of the force that it takes to keep the journal on its circle; contact
          is lost where it exceeds 1, inf where the force vanishes; NaN of a pin whose clearance is not given
        - `status` as in `linksweep.sweep`.

    Raises
    ------
    ValueError
        If a pin is unknown, a clearance is out of bounds, the machine has no pins, or arrays over one dim differ in
        length or labels.

    Notes
    -----
    Forces are those without clearance. They are differentiated over 0.04 degrees on either side, over less within a
    degree of an angle that is not ok: a jump of a load within counts as a turn. Where a force vanishes, its rates are
    NaN. Equations and sources: `linksweep.analysis.pins.contact_loss`.

    Examples
    --------
    >>> import linksweep as ls
    >>> loss = ls.contact_loss(ls.example("press"), clearance=50e-6)
    >>> round(float(loss.knock.max()), 4)  # far below 1: no pin knocks
    0.0015
    >>> round(float(loss.turning_per_force.max()), 2)  # rad/N/s, by Earles and Wu
    0.86
    """
    pins = links_of_pins(scene)
    scene = in_memory(scene)
    gaps = {} if clearance is None else numbers_by_pin("clearance", clearance, pins, CLEARANCE)
    refuse(argument_problems(scene.arrays, clearance=clearance))
    names = [f"{force_name(*pair)}{axis}" for pair in pins.values() for axis in "xy"]
    cycle = sweep(scene, theta2, of=["omega2", *names])
    slopes = _slopes(scene, cycle, names)
    parts = [_of_pin(cycle, slopes, force_name(*pair)) for pair in pins.values()]
    if gaps:
        for pin, part in zip(pins, parts, strict=True):
            part["knock"] = _knock(scene, pins[pin], gaps.get(pin, np.nan), part)
    results = with_units({name: (joined([p[name] for p in parts], "pin", pins), *TEXTS[name]) for name in parts[0]})
    attributes = cycle.attrs | by_command("linksweep.contact_loss(scene, ...)")
    return xr.Dataset({**results, "status": cycle["status"]}, cycle.coords, attributes)


TEXTS = {
    "F": ("N", "magnitude of the pin force"),
    "turning_rate": ("rad/s", "rate at which the direction of the pin force turns, counter-clockwise"),
    "turning_per_force": ("rad/N/s", "magnitude of the turning rate over the pin force"),
    "knock": ("1", "force that keeps the journal on its circle over the pin force; above 1 contact is lost"),
}


def _slopes(scene: Scene, cycle: xr.Dataset, names: list[str]) -> xr.Dataset:
    """Return the derivatives of forces to the crank's angle [N/rad]."""
    slopes = _differences(scene, cycle, names, STEPS[0])
    for step, closer in pairwise(STEPS):
        ends = [_beside(scene, cycle, way * step, []).status != 0 for way in (-REACH, REACH)]
        near = (cycle["status"] == 0) & (ends[0] | ends[1])
        if not near.any():
            break
        slopes = slopes.where(~near, _differences(scene, cycle, names, closer))
    return slopes


def _differences(scene: Scene, cycle: xr.Dataset, names: list[str], step: float) -> xr.Dataset:
    total: Any = 0.0
    for steps, weight in STENCIL.items():
        total = total + weight * _beside(scene, cycle, steps * step, names)[names]
    return total / np.radians(step)


def _beside(scene: Scene, cycle: xr.Dataset, aside: float, names: list[str]) -> xr.Dataset:
    """Return quantities at angles beside those of a cycle [degree], under its labels."""
    index = scene.mechanism.index
    angles = cycle[index].values
    return sweep(scene, angles + aside, of=names).assign_coords({index: angles})


def _of_pin(cycle: xr.Dataset, slopes: xr.Dataset, force: str) -> dict[str, Any]:
    """Return the force of a pin, and how fast it turns."""
    x, y, omega = cycle[f"{force}x"], cycle[f"{force}y"], cycle["omega2"]
    squared = x * x + y * y
    with np.errstate(divide="ignore", invalid="ignore"):
        turning = (x * slopes[f"{force}y"] - y * slopes[f"{force}x"]) / squared * omega
        per_force = abs(turning) / np.sqrt(squared)
    return {"F": np.sqrt(squared), "turning_rate": turning, "turning_per_force": per_force}


def _knock(scene: Scene, pair: tuple[int, int], gap: Number, part: Mapping[str, xr.DataArray]) -> xr.DataArray:
    """Return the part of a pin's force that keeps its journal on its circle."""
    of_links = scene.mechanism.masses()
    masses = {body.number: of_links[body.role].mass for body in scene.mechanism.bodies}
    first, second = (masses.get(k, np.inf) for k in pair)  # the ground, and a block without mass of its own
    with np.errstate(divide="ignore", invalid="ignore"):
        moved = 1.0 / (1.0 / xr.DataArray(first) + 1.0 / xr.DataArray(second))
        return (moved * gap * part["turning_rate"] ** 2 / part["F"]).where((part["F"] != 0.0) | np.isnan(gap), np.inf)
