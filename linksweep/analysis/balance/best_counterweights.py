"""Counterweights that serve a weighted mix of aims best, by bounded least squares.

Each link may carry masses at a radius, in DIRECTIONS directions round its first pin. Forces are linear in these masses
(see `linksweep.analysis.balance.regressor`), so that the sum of squares of relative sizes

    Σ weight · (size after / size before)²

is a convex function of masses ≥ 0. An RMS or a ripple is a 2-norm, and this is bounded linear least squares. A peak is
the norm of a high power, reached by reweighting the samples while the power rises (iteratively reweighted least
squares).

Source: C. L. Lawson and R. J. Hanson, Solving Least Squares Problems (bounds); R. Fletcher, J. A. Grant and M. D.
Hebden, The Calculation of Linear Best Lp Approximations, Computer Journal 14 (1971) (damped reweighting).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.analysis.balance.compare import sizes_named
from linksweep.analysis.balance.counterweights import RADIUS, Counterweight, by_link
from linksweep.analysis.balance.regressor import OF_LINK, regressor
from linksweep.base.checked_number import one_number
from linksweep.base.validate import Rule, count_problems, name_problems, quote, refuse
from linksweep.engine.threads import limits_threads
from linksweep.results.compute import by_name, require
from linksweep.results.sweep import sweep
from linksweep.scene.designs.selection import design_sizes
from linksweep.scene.scene import Scene

Array = np.ndarray
DIRECTIONS = 24
POWERS = (2.0, 4.0, 8.0, 16.0, 32.0, 64.0)
"""Powers of the norms on the way to a peak; the last is within a hundredth of the largest of 720 samples."""
STEPS = 10
TRIED = (1.0, 0.5, 0.25, 0.1, 0.05, 0.02)
"""Fractions of the way to the solution of the weighted squares that each step tries."""
LIGHTER, HEAVIER = 1e-7, 1e4
"""Relative weights of rows that keep masses light, and of rows that hold a link at its limit of mass."""
WEIGHT = Rule("dimensionless", above=0.0)
MOST = Rule("mass", above=0.0)


class Aim(NamedTuple):
    """A size to be made small: its samples (component, angle) are `base + change @ added`.

    `added` are m, mx, my and J that the counterweights add to each link; each sample is a `share` of the cycle's time.
    """

    word: str
    weight: float
    base: Array
    change: Array
    share: Array

    def samples(self, added: Array) -> Array:
        return self.base + self.change @ added

    def size(self, added: Array) -> float:
        """Return the largest magnitude, or the root mean square."""
        squares = (self.samples(added) ** 2).sum(axis=0)
        return float(np.sqrt(squares.max() if self.word == "peak" else (squares * self.share).sum()))


@limits_threads
def best_counterweights(
    scene: Scene,
    minimize: Mapping[str, float],
    *,
    radius: Any,
    most: Any = None,
    theta2: int = 720,
    threads: int | None = None,
) -> list[Counterweight]:
    """Compute counterweights that make a weighted mix of forces, torques and shaking small.

    Parameters
    ----------
    scene : Scene
        Scene of one design, without friction.
    minimize : mapping of str to float
        Weights of the sizes that are to be small [1], {"F32_peak": 1.0, "T12_ripple": 0.5, "Fs_rms": 1.0, "Ms_peak":
        0.2}: of a quantity its `_peak` (largest magnitude), `_rms` over time, or `_ripple` (root mean square about its
        mean).
    radius : float or mapping
        Distance of the counterweights from the first pins of their links [m]: one number for all links whose first pin
        is on the ground, or one for each link that may have one, {"crank": 0.05}.
    most : float or mapping, default None
        Largest mass [kg], of all of these links or of each; None for no limit.
    theta2 : int, default 720
        Count of crank angles over the cycle.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    list of Counterweight
        One for each link. Masses in several directions are merged into one body: mass, centre of gravity (at most
        `radius` from the pin) and moment of inertia.

    Raises
    ------
    ValueError
        If the scene has several designs or friction, a name is unknown, theta2 is no count, or a weight, radius or
        mass is out of bounds.

    Notes
    -----
    Minimized is the sum of weight·(size after / size before)². Equations and sources:
    `linksweep.analysis.balance.best_counterweights`.

    Examples
    --------
    >>> import linksweep as ls
    >>> scene = ls.example("press")
    >>> weights = ls.best_counterweights(scene, {"Fs_rms": 1.0, "T12_ripple": 1.0}, radius=0.06, theta2=180)
    >>> table = ls.compare(scene, ls.with_counterweights(scene, weights), of=["Fs_rms"], theta2=180)
    >>> table.Fs_rms.round(2).values.tolist()  # N, before and after
    [81.54, 6.14]
    """
    require(scene, "bodies")
    if designs := [*design_sizes(scene), *scene.mechanism.both_branches]:
        refuse([f"scene has designs over {', '.join(designs)}: give one, as ls.scene_at(scene, ...)"])
    refuse(count_problems("theta2", theta2))
    sizes = _weights(scene, minimize)
    carriers = scene.mechanism.parts
    grounded = [body.role for body in scene.mechanism.bodies if body.on_ground and body.role in carriers]
    links = list(radius) if isinstance(radius, Mapping) else grounded
    refuse([] if links else [f"radius: is empty; name one or more of {', '.join(carriers)}"])
    radii = by_link("radius", radius, links, RADIUS, one_number)
    refuse([p for link in radii for p in name_problems("radius", link, carriers)])
    bounds = dict.fromkeys(radii, np.inf) if most is None else by_link("most", most, list(radii), MOST, one_number)
    spokes = {link: _spokes(r) for link, r in radii.items()}
    aims = _aims(scene, sizes, list(spokes), theta2)
    masses = _best(aims, list(spokes.values()), np.array([bounds[link] for link in spokes]))
    parts = masses.reshape(len(spokes), DIRECTIONS)
    return [_as_one(link, part, spokes[link]) for link, part in zip(spokes, parts, strict=True)]


def _weights(scene: Scene, minimize: Any) -> dict[tuple[str, str], float]:
    """Return the weights by quantity and kind of size."""
    form = 'must be weights by name, as {"F32_peak": 1.0, "T12_ripple": 0.5}'
    refuse([f"minimize = {quote(minimize)}: {form}"] if not isinstance(minimize, Mapping) or not minimize else [])
    minimize = by_name("minimize", minimize, scene)
    sizes = sizes_named("minimize", scene, minimize)
    weights = [one_number(f"minimize.{name}", weight, WEIGHT) for name, weight in minimize.items()]
    return dict(zip(sizes, weights, strict=True))


def _spokes(radius: float) -> Array:
    """Return m, mx, my and J of a mass of 1 kg in each direction."""
    angles = np.arange(DIRECTIONS) * (2.0 * np.pi / DIRECTIONS)
    ones = np.ones(DIRECTIONS)
    return np.stack([ones, radius * np.cos(angles), radius * np.sin(angles), radius * radius * ones])


def _aims(scene: Scene, sizes: Mapping[tuple[str, str], float], links: list[str], theta2: int) -> list[Aim]:
    components = {name: scene.table.quantity[name].components for name, _ in sizes}
    names = [name for pair in components.values() for name in pair]
    coefficients = regressor(scene, names, theta2=theta2)
    cycle = sweep(scene, theta2, of=names)
    labels = [f"{link}.{word}" for link in links for word in OF_LINK]
    ok = np.broadcast_to(cycle["status"].values == 0, cycle.sizes["theta2"])
    share = _over_angles(1.0 / abs(cycle.get("omega2", xr.DataArray(1.0))), cycle)[ok]
    share = share / share.sum()
    aims = []
    for (name, word), weight in sizes.items():
        base = np.stack([_over_angles(cycle[part], cycle)[ok] for part in components[name]])
        of_added = [coefficients[part].sel(parameter=labels) for part in components[name]]
        change = np.stack([_over_angles(rows, cycle)[ok] for rows in of_added])
        if word == "ripple":
            base = base - (base * share).sum(axis=1, keepdims=True)
            change = change - (change * share[:, None]).sum(axis=1, keepdims=True)
        aims.append(Aim(word, weight, base, change, share))
    return aims


def _over_angles(array: xr.DataArray, cycle: xr.Dataset) -> Array:
    return array.broadcast_like(cycle["theta2"]).transpose("theta2", ...).values


def _best(aims: list[Aim], spokes: list[Array], limits: Array) -> Array:
    """Return the tried masses with the least sum of squares; the first try is none at all."""
    from scipy.linalg import block_diag

    adds = block_diag(*spokes)
    nothing = np.zeros(len(adds))
    scales = [np.sqrt(aim.weight) / (aim.size(nothing) or 1.0) for aim in aims]

    def total(masses: Array, power: float = 0.0) -> float:
        return sum((scale * _norm(aim, adds @ masses, power)) ** 2 for scale, aim in zip(scales, aims, strict=True))

    best = masses = np.zeros(adds.shape[1])
    for power in POWERS if any(aim.word == "peak" for aim in aims) else POWERS[:1]:
        for _ in range(STEPS if power > 2.0 else 1):
            weighted = [_weighted(aim, adds @ masses, scale, power) for scale, aim in zip(scales, aims, strict=True)]
            towards = _bounded(np.concatenate(weighted), adds, limits) - masses
            tries = [masses + step * towards for step in TRIED]
            masses = min([masses, *tries], key=lambda tried: total(tried, power))
            best = min(best, masses, key=total)
    return best


def _norm(aim: Aim, added: Array, power: float) -> float:
    """Return the size of an aim; of a peak, for a power above 0, the mean of that power."""
    if aim.word != "peak" or power == 0.0:
        return aim.size(added)
    magnitude = np.sqrt((aim.samples(added) ** 2).sum(axis=0))
    largest = float(magnitude.max()) or 1.0
    return largest * float(((magnitude / largest) ** power * aim.share).sum() ** (1.0 / power))


def _weighted(aim: Aim, added: Array, scale: float, power: float) -> Array:
    """Return rows (change | −base) whose sum of squares has the gradient of the norm's square."""
    magnitude = np.sqrt((aim.samples(added) ** 2).sum(axis=0))
    weights = scale * np.sqrt(aim.share)
    norm = _norm(aim, added, power)
    if aim.word == "peak" and norm > 0.0:
        weights = weights * (magnitude / norm) ** (0.5 * power - 1.0)
    rows = np.concatenate([aim.change, -aim.base[..., None]], axis=-1) * weights[:, None]
    return rows.reshape(-1, rows.shape[-1])


def _bounded(rows: Array, adds: Array, limits: Array) -> Array:
    """Return masses ≥ 0 of least squares, of each link together within its limit; of equally good ones the lightest."""
    triangle = np.linalg.qr(rows).R  # the same sum of squares in a few rows
    of_masses = np.column_stack([triangle[:, :-1] @ adds, triangle[:, -1]])
    size, count = np.linalg.norm(of_masses[:, :-1]), adds.shape[1]
    light = np.append(np.full(count, LIGHTER * size), 0.0)[None]
    masses = _not_negative(np.concatenate([of_masses, light]))
    over = _totals(masses) > limits
    if over.any():  # convex: the best masses within the limits reach those that the free ones exceed
        full = np.repeat(np.eye(len(over))[over], DIRECTIONS, axis=1) * (HEAVIER * size)
        at = HEAVIER * size * limits[over]
        masses = _not_negative(np.concatenate([of_masses, light, np.column_stack([full, at])]))
    shrink = np.minimum(1.0, limits / np.maximum(_totals(masses), 1e-300))
    return masses * np.repeat(shrink, DIRECTIONS)


def _not_negative(rows: Array) -> Array:
    from scipy.optimize import nnls

    return nnls(rows[:, :-1], rows[:, -1], maxiter=100 * rows.shape[1])[0]


def _totals(masses: Array) -> Array:
    return masses.reshape(-1, DIRECTIONS).sum(axis=1)


def _as_one(link: str, masses: Array, spokes: Array) -> Counterweight:
    """Return masses in several directions as one body."""
    mass, x, y, about_pin = spokes @ masses
    distance = float(np.hypot(x, y) / mass) if mass > 0.0 else 0.0
    inertia = max(0.0, float(about_pin - mass * distance * distance))
    return Counterweight(link, float(mass), (distance, float(np.degrees(np.arctan2(y, x)))), inertia)
