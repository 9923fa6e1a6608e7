"""The cycle with friction in the pins, coupled to the loads that it changes.

A pin of radius r, loaded by F, resists with the moment ρ·F against its rotation: on link j of its force Fij and,
opposite, on link i. F thus passes the pin's centre at the distance ρ = μ·r/√(1 + μ²), the radius of the friction circle
(see `linksweep.physics.bearing`). F depends on these moments in turn: they are computed from the forces, and the forces
with them, until nothing changes.

Source: the friction circle of textbooks on the theory of machines, such as R. S. Khurmi and J. K. Gupta, Theory of
Machines, chapter "Friction".
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from itertools import chain
from typing import NamedTuple

import numpy as np
import xarray as xr

from linksweep.analysis.pins.bearing import Bearing, checked_pins
from linksweep.base.validate import Number, count_problems, refuse
from linksweep.chains.between_links import force_name
from linksweep.engine.threads import limits_threads
from linksweep.mechanisms.machine import Machine
from linksweep.physics.bearing import friction_circle
from linksweep.results.compute import require_one_branch
from linksweep.results.dataset import flags, joined, require_own_names, with_units
from linksweep.results.sweep import sweep
from linksweep.scene.loads.load import Load
from linksweep.scene.scene import Scene

TOLERANCE = 1e-12
"""Change of a moment, relative to the largest at that sample, at which it has converged."""
MEANINGS = ("converged", "not_converged")
Arrays = dict[str, xr.DataArray]


class RubbingPin(NamedTuple):
    """A pin with friction: links i and j of its force Fij, and the radius of its friction circle [m]."""

    i: int
    j: int
    radius: Number

    @property
    def force(self) -> str:
        return force_name(self.i, self.j)


@limits_threads
def pin_friction(
    scene: Scene,
    pins: Mapping[str, Bearing],
    *,
    theta2: int = 720,
    of: Iterable[str] | None = None,
    iterations: int = 100,
    threads: int | None = None,
) -> xr.Dataset:
    """Sweep a scene with friction in its pins.

    Parameters
    ----------
    scene : Scene
        Scene of one branch.
    pins : mapping of str to Bearing
        Bearing with diameter and friction of each pin; the others turn without friction.
    theta2 : int, default 720
        Count of crank angles over the cycle.
    of : iterable of str, default None
        Names of quantities, as in `linksweep.sweep`.
    iterations : int, default 100
        Largest number of iterations.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Cycle as from `linksweep.sweep`; its scene has the moments of friction as loads, each at its pin. Besides:

        - `friction_torque` (…, pin, theta2) [N m]: moment of link i on link j of the pin's force Fij
        - `friction_loss` (…, pin, theta2) [W], never negative
        - `convergence` (…, theta2): converged or not_converged; where not converged, friction in the pins locks the
          machine or nearly does, and forces and torques are NaN
        - `efficiency` (…) [1]: part of the energy fed in a cycle, by the drive, by cylinders that change their length
          or by loads, that is returned at the others; all friction counts as lost, in a guide too.

    Raises
    ------
    ValueError
        If the machine lacks pins, or one of those named, a bearing has friction but no diameter, arrays over one
        dim differ in length or labels, or branch="both".

    Notes
    -----
    A pin that stands still in its bearing has no friction. The friction circle is that of exact Coulomb friction, of
    radius μ·r/√(1 + μ²); textbooks' μ·r is 0.5 % more at μ = 0.1. Equation and
    source: `linksweep.analysis.pins.pin_friction`.

    Examples
    --------
    >>> import linksweep as ls
    >>> cycle = ls.pin_friction(ls.example("engine"), {"B": ls.Bearing(diameter=0.05, friction=0.01)})
    >>> round(float(cycle.efficiency), 3)
    0.923
    """
    rubbing = _rubbing(scene, pins)
    refuse(count_problems("theta2", theta2) + count_problems("iterations", iterations))
    speeds = sweep(scene, theta2, of=[f"omega_{pin}" for pin in rubbing])
    speed = {pin: xr.DataArray(speeds[f"omega_{pin}"]) for pin in rubbing}
    senses = {pin: xr.DataArray(-np.sign(omega)).fillna(0.0) for pin, omega in speed.items()}  # of moments on link j
    with_friction, torques, change = _converged(scene, rubbing, senses, theta2, iterations)
    cycle = sweep(with_friction, theta2, of=of)
    fast = ~(change <= TOLERANCE) & (cycle["status"] == 0)
    losses = [abs(torque * speed[pin]) for pin, torque in torques.items()]
    moment = "moment of friction on link j of the pin force Fij, counter-clockwise"
    results = {
        "friction_torque": (joined(torques.values(), "pin", torques), "N m", moment),
        "friction_loss": (joined(losses, "pin", torques), "W", "power that friction in the pin takes, never negative"),
    }
    cycle = cycle.assign(with_units(results))
    forces = [name for name in cycle.data_vars if name not in (*scene.mechanism.kinematics(), "status")]
    cycle = cycle.assign({name: cycle[name].where(~fast).assign_attrs(cycle[name].attrs) for name in forces})
    agreement = flags("whether pin friction and pin forces agree; forces are NaN where they do not", MEANINGS)
    loss = cycle["friction_loss"].sum("pin", skipna=False)
    own = {
        "convergence": fast.astype(np.int8).assign_attrs(agreement),
        "efficiency": _efficiency(with_friction, loss, theta2),
    }
    require_own_names(own)
    return cycle.assign(own).assign_attrs(command=f"linksweep.pin_friction(scene, ..., theta2={theta2})")


def _rubbing(scene: Scene, pins: Mapping[str, Bearing]) -> dict[str, RubbingPin]:
    """Return the pins that have friction."""
    links = checked_pins(scene, pins)
    rubs = {pin: bearing for pin, bearing in (pins or {}).items() if np.any(bearing.friction)}
    refuse([f"pins.{pin} has friction but no diameter: give it" for pin, b in rubs.items() if b.diameter is None])
    refuse([] if rubs else ['pins: no pin has friction; give it, as in {"B": ls.Bearing(diameter=0.02, friction=0.1)}'])
    require_one_branch(scene)
    return {pin: RubbingPin(*links[pin], friction_circle(b.friction, b.diameter)) for pin, b in rubs.items()}


def _converged(
    scene: Scene, pins: Mapping[str, RubbingPin], senses: Arrays, theta2: int, iterations: int
) -> tuple[Scene, Arrays, xr.DataArray]:
    """Return the scene with friction as loads, its moments by pin, and their last change, relative to the largest."""
    forces = [pin.force for pin in pins.values()]
    torques = {pin: 0.0 * senses[pin] for pin in pins}
    for _ in range(iterations):
        with_friction = replace(scene, loads=(*scene.loads, *_as_loads(scene, pins, torques, theta2)))
        cycle = sweep(with_friction, theta2, of=forces)
        new = {pin: senses[pin] * rub.radius * cycle[rub.force].fillna(0.0) for pin, rub in pins.items()}
        change = _largest(new[pin] - torques[pin] for pin in pins) / _largest(new.values()).clip(min=1e-300)
        runaway = ~np.isfinite(change)
        torques = {pin: torque.where(~runaway, 0.0) for pin, torque in new.items()}
        if (change <= TOLERANCE).all() or runaway.all():
            break
    return with_friction, torques, change


def _as_loads(scene: Scene, pins: Mapping[str, RubbingPin], torques: Arrays, theta2: int) -> list[Load]:
    """Return the moments of friction as torques on the moving links, each at its pin."""
    angles = xr.Variable("theta2", np.arange(theta2) * (scene.period / theta2))
    loads = []
    for pin, rub in pins.items():
        on_j = torques[pin].broadcast_like(xr.DataArray(angles, {"theta2": angles}))
        acting = {rub.i: -on_j, rub.j: on_j}
        for body in (one for one in scene.mechanism.bodies if one.number in acting):
            torque, at = acting[body.number], scene.mechanism.pin_place(body.role, pin.partition(":")[0])
            # a moment jumps where its pin turns back: a spline would ring there
            loads.append(Load(body.role, torque=_bare(torque), at=at, interpolation="pchip"))
    return loads


def _bare(array: xr.DataArray) -> xr.DataArray:
    """Return values and labels alone, without attributes of their origin."""
    labels = {dim: array[dim].values for dim in array.dims if dim in array.coords}
    return xr.DataArray(array.values, labels, array.dims)


def _largest(arrays: Iterable[xr.DataArray]) -> xr.DataArray:
    """Return the largest magnitude of all; NaN where one is."""
    every = xr.broadcast(*map(abs, arrays))
    return xr.concat(every, "pin", coords="minimal", compat="override").max("pin", skipna=False)


def _efficiency(scene: Scene, loss: xr.DataArray, theta2: int) -> xr.DataArray:
    """Return the efficiency by energies over time: a sample stands for the time that the crank takes to the next.

    What the drive, the cylinders that change their length and the loads feed over the cycle is lost in all.
    """
    names = [name for name in ("power", "omega2", "friction_power") if name in scene.table.quantity]
    struts = scene.mechanism.topology.struts if isinstance(scene.mechanism, Machine) else ()
    cylinders = [(f"force_{role}", f"rate_{role}") for role in struts]
    cycle = sweep(scene, theta2, of=[*names, *chain.from_iterable(cylinders)])
    pushed = [cycle[force] * cycle[rate] for force, rate in cylinders]
    powers = [loss - cycle.get("friction_power", 0.0), cycle["power"], *pushed]
    with np.errstate(divide="ignore", invalid="ignore"):  # of a machine that stands still
        over_time = ((power / abs(cycle["omega2"])).broadcast_like(cycle["theta2"]) for power in powers)
        lost, *driven = (power.sum("theta2", skipna=False) for power in over_time)
        fed = sum(energy.clip(min=0.0) for energy in (*driven, lost - sum(driven)))
        efficiency = ((fed - lost) / fed).clip(min=0.0)
    attributes = {"units": "1", "long_name": "energy that comes out of the machine in a cycle over the energy fed"}
    return efficiency.assign_attrs(attributes)
