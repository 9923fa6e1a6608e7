"""Regressor: coefficients of the links' mass distributions in forces and torques, which depend on them linearly.

With h = m·(xG, yG) the first moment of a link about its first pin, in its own axes, and J its moment of inertia about
that pin, every force and torque at given angles and speeds is

    F(θ2) = Σ (∂F/∂m · m + ∂F/∂mx · mx + ∂F/∂my · my + ∂F/∂J · J) + the part that the loads alone make

since `linksweep.physics.inertia` is linear in them. The coefficients come from sweeps of links with one of them alone.

Source: W. Khalil and E. Dombre, Modeling, Identification and Control of Robots (identification of the dynamic
parameters), for linkages.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.validate import Number, refuse
from linksweep.engine.threads import limits_threads
from linksweep.mechanisms import Mechanism
from linksweep.mechanisms.balance import MassDistribution
from linksweep.results.compute import quantity_problems, requested, require
from linksweep.results.dataset import joined, provenance, require_own_names
from linksweep.results.sweep import sweep
from linksweep.scene.scene import Scene

PROBE = "_probe"
LINEAR_UNITS = ("N", "N m", "W")
UNITS = {"m": "kg", "mx": "kg m", "my": "kg m", "J": "kg m^2"}
OF_LINK = tuple(UNITS)


@limits_threads
def regressor(scene: Scene, of: Iterable[str], *, theta2: Any = 720, threads: int | None = None) -> xr.Dataset:
    """Compute the coefficients of the links' mass distributions in forces and torques.

    Parameters
    ----------
    scene : Scene
        Scene without friction.
    of : iterable of str
        Names of components of forces, of torques and powers ("F32x", "T12", "Fsx", "Ms").
    theta2 : int or array_like, default 720
        Count of crank angles, or angles [degree].
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        For each quantity its coefficients over (…, theta2, parameter), and `F32x_of_loads` (…, theta2), its part
        without any mass; `value` (…, parameter), the parameters of the scene. Parameters of a link are "crank.m" [kg],
        "crank.mx" and "crank.my" [kg m], mass times the centre of gravity's coordinates from the first pin in the
        link's axes, and "crank.J" [kg m²], moment of inertia about that pin; a slider does not turn and has no J.

    Raises
    ------
    ValueError
        If a quantity is not linear in the masses, the scene has friction or gears with a pressure angle, or the machine
        has no links.

    Notes
    -----
    Equation and source: `linksweep.analysis.balance.regressor`.

    Examples
    --------
    >>> import linksweep as ls
    >>> scene = ls.example("press")
    >>> of_masses = ls.regressor(scene, ["T12"], theta2=36)
    >>> torque = (of_masses.T12 * of_masses.value).sum("parameter") + of_masses.T12_of_loads
    >>> bool(abs(torque - ls.sweep(scene, theta2=36, of=["T12"]).T12).max() < 1e-12)
    True
    """
    names = _checked(scene, of)
    mechanism, quantity = scene.mechanism, scene.table.quantity
    grid = scene.grid(theta2)
    angles = grid.angles  # of the loads' whole cycle
    values = _values(mechanism)
    probes = _with_masses(mechanism, list(values))
    alone = sweep(replace(scene, mechanism=probes, loads=()), angles, of=names)
    massless = sweep(replace(scene, mechanism=_with_masses(mechanism, [])), angles, of=names)
    known = np.stack([np.broadcast_to(row, len(values)) for row in _values(probes).values()], axis=-1)
    inverse = xr.DataArray(np.linalg.inv(known), {"parameter": list(values)}, ("parameter", PROBE))
    table = {"value": joined(values.values(), "parameter", values).transpose(..., "parameter")}
    for name in names:
        spread = alone[name].expand_dims({PROBE: len(values)}) if PROBE not in alone[name].dims else alone[name]
        long_name = f"coefficient of each parameter in: {quantity[name].long_name}"
        column = xr.dot(spread, inverse, dim=PROBE).transpose(..., "parameter")
        table |= {name: column.assign_attrs(units=quantity[name].units, long_name=long_name)}
        table |= {f"{name}_of_loads": massless[name]}
    require_own_names(table)
    table["value"].attrs = {"long_name": "value of each parameter in the scene, in its `unit`"}
    table["value"] = table["value"].assign_coords(unit=("parameter", [UNITS[label.split(".")[-1]] for label in values]))
    attributes = provenance(scene, f"linksweep.regressor(scene, {names})", {})
    return xr.Dataset({**table, "status": massless["status"]}, attrs=attributes)


def _checked(scene: Scene, of: Iterable[str]) -> list[str]:
    require(scene, "bodies")
    names = requested("of", of)
    linear = [name for name, q in scene.table.quantity.items() if q.units in LINEAR_UNITS and not q.squared]
    refuse([problem for name in names for problem in quantity_problems("of", name, linear, scene)])
    kind = type(scene.mechanism).__name__
    reason = scene.mechanism.not_linear
    problem = (
        f"scene is of a {kind} with {reason}: forces are not linear in the masses then; make it 0, or leave it out"
    )
    refuse([problem] if reason else [])
    return names


def _values(mechanism: Mechanism) -> dict[str, Number]:
    """Return the parameters of a mechanism by label; a link that does not turn has no J."""
    masses = mechanism.masses()
    return {
        f"{body.role}.{word}": number
        for body in mechanism.bodies
        for word, number in zip(OF_LINK, masses[body.role].moments(), strict=True)
        if body.turns or word != "J"
    }


def _with_masses(mechanism: Mechanism, labels: list[str]) -> Mechanism:
    """Return the mechanism over a dim of mass distributions, each with one parameter, or of mx and my one besides m
    and J; without labels it has no mass, and its centres of gravity stay where they are."""

    def only(role: str, *words: str) -> Number:
        chosen = np.array([label in [f"{role}.{word}" for word in words] for label in labels], dtype=float)
        return xr.DataArray(chosen, dims=PROBE) if labels else 0.0

    numbers, masses = mechanism.parameters(), {}
    for role, own in mechanism.masses().items():
        place = own.cg_distance, own.cg_angle
        if labels:
            place = float(np.max(numbers[f"{role}_length"])) * only(role, "mx", "my"), 90.0 * only(role, "my")
        masses[role] = MassDistribution(*place, only(role, "m", "mx", "my"), only(role, "J"))
    return mechanism.with_masses(masses)
