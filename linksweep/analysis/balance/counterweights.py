"""Counterweights: which ones balance a machine in closed form, and a scene whose links carry them.

Equations and sources: `linksweep.mechanisms.balance`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.checked_number import checked_number, unit_attribute_problems
from linksweep.base.equality import ByContent
from linksweep.base.fields import POLAR_POINT, field_problems, numbers, of_kind, parameter
from linksweep.base.validate import Number, Rule, choice_problems, listed, quote, refuse
from linksweep.mechanisms.balance import MassDistribution
from linksweep.results.compute import require
from linksweep.scene.dimensions import argument_problems
from linksweep.scene.scene import Scene

RADIUS = Rule("length", above=0.0)


@dataclass(frozen=True, eq=False, repr=False)
class Counterweight(ByContent):
    """A mass fixed to a link.

    Numbers may be DataArrays of design dims.

    Parameters
    ----------
    link : str
        Link that carries the mass.
    mass : float or DataArray
        Mass [kg].
    at : pair of floats or DataArrays, default (0.0, 0.0)
        Place of the mass in the link's own polar coordinates: distance from its first pin [m], angle from its line of
        pins [degree].
    inertia : float or DataArray, default 0.0
        Moment of inertia about the mass's own centre of gravity [kg m²].

    Raises
    ------
    ValueError
        If a parameter is out of bounds; one line for each.

    Examples
    --------
    >>> import linksweep as ls
    >>> weight = ls.Counterweight("crank", mass=0.4, at=(0.05, 180.0))
    >>> balanced = ls.with_counterweights(ls.example("press"), [weight])
    >>> round(balanced.mechanism.crank.mass, 3)  # kg, of which the bar has 0.248
    0.648
    """

    link: str
    mass: Number = parameter("mass", at_least=0.0)
    at: Sequence[Number] = of_kind(POLAR_POINT, (0.0, 0.0))
    inertia: Number = parameter("inertia", 0.0, at_least=0.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        named = f'link = {quote(self.link)}: must be a name, such as "crank"'
        refuse(([] if isinstance(self.link, str) else [named]) + field_problems(self))
        refuse(unit_attribute_problems(numbers(self)))


def with_counterweights(scene: Scene, counterweights: Iterable[Counterweight]) -> Scene:
    """Return a scene whose links carry counterweights.

    Parameters
    ----------
    scene : Scene
        Scene without them.
    counterweights : list of Counterweight
        Counterweights, any number on each link.

    Returns
    -------
    Scene
        Scene in which each such link is a Link of the mass, centre of gravity and inertia of both together.

    Raises
    ------
    ValueError
        If a link cannot carry one, a load would move with the link's centre of gravity (origin="cg"), or arrays over
        one dim differ in length or labels.

    Examples
    --------
    >>> import linksweep as ls
    >>> scene = ls.with_counterweights(ls.example("press"), [ls.Counterweight("crank", 0.248, at=(0.04, 180.0))])
    >>> scene.mechanism.crank.mass, round(scene.mechanism.crank.cg_distance, 15)
    (0.496, 0.0)
    """
    require(scene, "bodies")
    weights = listed(counterweights)
    strange = [weight for weight in weights if not isinstance(weight, Counterweight)]
    refuse([f"counterweights = {quote(weight)}: must be a Counterweight" for weight in strange])
    masses = scene.mechanism.masses()
    carriers = {role: masses[role] for role in scene.mechanism.parts if role in masses}  # a cylinder has no mass
    refuse([p for weight in weights for p in choice_problems("counterweights.link", weight.link, carriers)])
    refuse(argument_problems(scene.arrays, counterweights=weights))
    loaded = {weight.link for weight in weights}
    moving = [k for k, load in enumerate(scene.loads, 1) if load.on_centre_of in loaded]
    why = "would move with the counterweight; give its place from the pin"
    refuse([f'loads[{k}].origin = "cg": {why}' for k in moving])
    links = {role: _carrying(carriers[role], [w for w in weights if w.link == role]) for role in loaded}
    return replace(scene, mechanism=scene.mechanism.with_masses(links))


def _carrying(link: MassDistribution, weights: list[Counterweight]) -> MassDistribution:
    """Return the mass distribution of a link with its weights.

    Masses, first moments and moments of inertia about its pin add up.
    """
    placed = (MassDistribution(weight.at[0], weight.at[1], weight.mass, weight.inertia) for weight in weights)
    parts = [part.moments() for part in (link, *placed)]
    mass, x, y, about_pin = (xr.DataArray(sum(numbers[1:], numbers[0])) for numbers in zip(*parts, strict=True))
    distance = np.hypot(x, y) / mass.where(mass > 0.0, 1.0)
    inertia = (about_pin - mass * distance * distance).clip(min=0.0)
    numbers = (distance, np.degrees(np.arctan2(y, x)), mass, inertia)
    return MassDistribution(*map(_plain, numbers))


def _plain(number: Any) -> Number:
    """Return a float, or a DataArray without attributes where there are dims."""
    number = xr.DataArray(number)
    return number.drop_attrs() if number.dims else float(number)


def counterweights(scene: Scene, *, radius: Any, fraction: Number | None = None) -> list[Counterweight]:
    """Compute the counterweights that cancel a machine's shaking force, or a fraction of its first order.

    Parameters
    ----------
    scene : Scene
        Scene of a machine whose condition of balance is known in closed form.
    radius : float, DataArray or mapping
        Distance of the counterweights from their pins [m]: one number, or one for each link, {"crank": 0.05, "rocker":
        0.06}.
    fraction : float or DataArray, default None
        Fraction of the first order that the crank's counterweight takes [1], of a machine that counterweights balance
        in part, as a slider-crank; None is a half. 0 balances the turning masses alone, 1 moves the first order
        across the guide.

    Returns
    -------
    list of Counterweight
        One on the crank and, of machines with a rocker, one on the rocker. With them a four-bar and an inverted
        slider-crank shake no more, at any speed; a slider-crank shakes along the guide with 1 − fraction, across it
        with fraction of the first order, and with all of the higher orders. An offset adds a first order along the
        guide that no fraction changes: a quarter turn away, about offset/rod as large.

    Raises
    ------
    ValueError
        If the machine has no such condition, a fraction stands beside complete balance, a radius is out of bounds, or
        arrays over one dim differ in length or labels.

    Notes
    -----
    Conditions and source: `linksweep.mechanisms.balance` (Berkof and Lowen). The shaking moment remains, and commonly
    grows, as do pin forces and torque; `linksweep.best_counterweights` finds compromises.

    Examples
    --------
    >>> import linksweep as ls
    >>> scene = ls.example("press")
    >>> balanced = ls.with_counterweights(scene, ls.counterweights(scene, radius=0.06))
    >>> before, after = (float(ls.sweep(s, of=["Fs"]).Fs.max()) for s in (scene, balanced))
    >>> after < 1e-10 * before
    True
    """
    require(scene, "bodies", "balancing_moments")
    mechanism, kind = scene.mechanism, type(scene.mechanism).__name__
    wholly = f"fraction = {quote(fraction)}: must be left out, a {kind} is balanced wholly"
    refuse([wholly] if fraction is not None and not mechanism.balances_partly else [])
    share = checked_number("fraction", 0.5 if fraction is None else fraction, Rule("dimensionless"))
    refuse(argument_problems(scene.arrays, radius=radius, fraction=share))
    lacking = mechanism.balancing_moments(share)
    radii = by_link("radius", radius, list(lacking))
    return [_weight(link, moment, radii[link]) for link, moment in lacking.items()]


def by_link(
    word: str,
    values: Any,
    links: list[str],
    rule: Rule = RADIUS,
    checked: Callable[[str, Any, Rule], Number] = checked_number,
) -> dict[str, Number]:
    """Return a number for each link: one for all, or by name."""
    if not isinstance(values, Mapping):
        return dict.fromkeys(links, checked(word, values, rule))
    by_link = dict(values)
    refuse([p for link in by_link for p in choice_problems(word, link, links)])
    refuse([f"{word}.{link}: missing; give it {rule.number}" for link in links if link not in by_link])
    return {link: checked(f"{word}.{link}", number, rule) for link, number in by_link.items()}


def _weight(link: str, moment: Any, radius: Number) -> Counterweight:
    angle = np.degrees(np.arctan2(moment.imag, moment.real))
    return Counterweight(link, _plain(abs(moment) / radius), at=(radius, _plain(angle)))
