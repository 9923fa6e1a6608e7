"""MultiCylinder: an engine of several cylinders on one crankshaft, each a slider-crank like the first.

Equations and source: `linksweep.results.cylinders.cylinder_sums`.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Mapping, Sequence, Set
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain, pairwise
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.conversion import to_float64
from linksweep.base.degrees import cos_sin
from linksweep.base.equality import ByContent
from linksweep.base.frozen import normalise
from linksweep.base.public.clear_calls import clear_method
from linksweep.base.validate import Rule, is_array, name_problems, number_problems, quote, refuse
from linksweep.chains.between_links import force_name
from linksweep.engine.quantity import Quantity
from linksweep.engine.threads import limits_threads
from linksweep.mechanisms.capabilities import lack
from linksweep.results.compute import either, requested
from linksweep.results.cylinders.cylinder_sums import (
    QUANTITIES,
    Derived,
    Sum,
    Throw,
    combined,
    main_quantities,
    rules_of,
    sources_of,
)
from linksweep.results.dataset import CYCLE, index_coordinate, origin_attributes
from linksweep.results.sweep import sweep
from linksweep.scene.designs.lazy import in_memory
from linksweep.scene.grid import crank_grid
from linksweep.scene.pairs import changes
from linksweep.scene.scene import Scene

ANGLE, LENGTH = Rule("angle"), Rule("length")
LISTS = {
    "crank_angles": (ANGLE, "cylinder"),
    "bank_angles": (ANGLE, "cylinder"),
    "positions": (LENGTH, "cylinder"),
    "main_positions": (LENGTH, "main bearing"),
}
"""Rule of each list's numbers, and what each number is of."""
NO_MAINS = "places of the main bearings are unknown; give two places or more, main_positions=[...]"
ONE_THROW = 1e-9
"""Distance between cylinders, relative to the largest from z = 0, up to which they are on one throw."""
SHAKING = ("T12", "Fsx", "Fsy", "Fs", "Ms", "Msx", "Msy")


@dataclass(frozen=True, eq=False, repr=False)
class MultiCylinder(ByContent):
    """An engine, pump or compressor of several equal cylinders on one crankshaft.

    Parameters
    ----------
    engine : Scene
        Scene of a SliderCrank: one cylinder, with the crank's throw, its part of the crankshaft and its loads, driven
        by the crank at a constant omega2.
    crank_angles : sequence of float
        Angle of each cylinder's crank, ahead of theta2 [degree]; over two turns in a four-stroke engine, where it also
        states where in its cycle the cylinder is: [0, 540, 180, 360].
    bank_angles : sequence of float, default ()
        Angle of each cylinder, turned from the engine's guide [degree]; () for 0.
    positions : sequence of float, default ()
        Position of each cylinder along the crankshaft [m], z pointing towards the viewer; () for 0.
    main_positions : sequence of float, default ()
        Positions of the main bearings along the crankshaft [m], in order, with every cylinder between two of them; ()
        for halfway between neighbouring places of cylinders, and as far outside the first and the last. Places that
        differ by rounding are one.

    Raises
    ------
    ValueError
        One line for each parameter that is not allowed.

    Notes
    -----
    Loads turn with their cylinder; gravity does not. An engine whose crank does not turn fully has sums at those angles
    of a sweep where all cylinders are ok; their peaks and means are NaN, as no cycle is whole. Equations and source:
    `linksweep.results.cylinders.cylinder_sums`.

    Examples
    --------
    An inline four leaves the second order, which goes up and down.

    >>> import linksweep as ls
    >>> four = ls.MultiCylinder(ls.example("engine"), [0, 540, 180, 360], positions=[-0.15, -0.05, 0.05, 0.15])
    >>> ls.orders(four.sweep(), "Fsy", n=4).Fsy_amplitude.round(3).sel(order=[1, 2, 3]).values.tolist()
    [0.0, 3276.256, 0.0]

    A 90° V-twin on one throw, with a counterweight for the rotating and half of the reciprocating mass: no first order.

    >>> engine = ls.example("engine")
    >>> throw = ls.with_counterweights(engine, ls.counterweights(engine, radius=0.05, fraction=0.5))
    >>> twin = ls.MultiCylinder(throw, crank_angles=[0, 0], bank_angles=[45, -45])
    >>> ls.orders(twin.sweep(), ["Fsx", "Fsy"], n=2).sel(order=1).Fsx_amplitude.round(6).item()
    0.0
    """

    engine: Scene
    crank_angles: Sequence[float]
    bank_angles: Sequence[float] = ()
    positions: Sequence[float] = ()
    main_positions: Sequence[float] = ()

    def __post_init__(self) -> None:
        lists = {word: _numbers_in(getattr(self, word), rule) for word, (rule, _) in LISTS.items()}
        count = len(lists["crank_angles"] or ())
        lists |= {word: (0.0,) * count for word in ("bank_angles", "positions") if lists[word] == ()}
        problems = {word: self._list_problems(word, numbers, count) for word, numbers in lists.items()}
        normalise(self, **{word: numbers for word, numbers in lists.items() if numbers is not None})
        places = [] if problems["positions"] or problems["main_positions"] else self._main_problems()
        refuse([*_engine_problems(self.engine), *chain(*problems.values()), *places])

    def _list_problems(self, word: str, numbers: tuple[Any, ...] | None, count: int) -> list[str]:
        """Return the problems of numbers for each of `count` cylinders, or of mains, which may be any number."""
        rule, owner = LISTS[word]
        if numbers is None:
            wrong = f"{word} = {quote(getattr(self, word))}"
            return [f"{wrong}: must be a list of numbers, one for each {owner}, in their order"]
        if word == "crank_angles" and not numbers:
            return [f"{word} is empty: give one for each {owner}"]
        miscounted = owner == "cylinder" and count and len(numbers) != count
        counts = [f"{word} has {len(numbers)} numbers: must have one for each of {count} cylinders"]
        each = [p for k, n in enumerate(numbers, 1) for p in _plain_problems(f"{word}[{k}]", n, rule)]
        return [*(counts if miscounted else ()), *each]

    def _main_problems(self) -> list[str]:
        """Return the problems of the places of the main bearings."""
        places = self.main_positions
        if not places:
            return []
        if len(places) < 2 or not np.all(np.diff(places) > 0.0):
            wrong = f"main_positions = {quote(list(places))}"
            return [f"{wrong}: must be two places or more, in order along the crankshaft"]
        return [
            f"positions[{k}] = {z:g} m: must lie between the first and the last main bearing, at {places[0]:g} m and "
            f"{places[-1]:g} m"
            for k, z in enumerate(self.positions, 1)
            if not places[0] <= z <= places[-1]
        ]

    @cached_property
    def quantity(self) -> Mapping[str, Quantity]:
        """All quantities of the whole engine, by name."""
        return {quantity.name: quantity for quantity in (*QUANTITIES, *main_quantities(len(self.mains)))}

    @cached_property
    def rules(self) -> Mapping[str, Sum | Derived]:
        """Return the sum over cylinders, or function of sums, for each quantity."""
        return rules_of(len(self.mains))

    @property
    def in_memory(self) -> MultiCylinder:
        """Return a copy whose lazy numbers are computed."""
        return replace(self, engine=in_memory(self.engine))

    @property
    def pin_forces(self) -> tuple[str, ...]:
        """Magnitudes of the pin forces of one cylinder, which do not depend on its bank angle."""
        return tuple(force_name(i, j) for a, b in self.engine.mechanism.pins.values() for i, j in ((a, b), (b, a)))

    @property
    def period(self) -> float:
        """Crank angle of the whole cycle [degree]."""
        return self.engine.period

    @cached_property
    def mains(self) -> tuple[float, ...]:
        """Places of the main bearings along the crankshaft [m], in order; () if neither they nor throws have places."""
        return tuple(self.main_positions) or _halfway(sorted({*self.throw_positions}))

    @cached_property
    def throw_positions(self) -> tuple[float, ...]:
        """Position of each cylinder's throw along the crankshaft [m]: places that differ by rounding are one."""
        throws, least = list[float](), ONE_THROW * max(map(abs, self.positions))
        for z in sorted(self.positions):
            throws += [z] if not throws or z - throws[-1] > least else []
        return tuple(throws[bisect_right(throws, z) - 1] for z in self.positions)

    @cached_property
    def throws(self) -> tuple[Throw, ...]:
        """Place of each cylinder in the engine."""
        standing = zip(self.crank_angles, self.bank_angles, self.positions, strict=True)
        return tuple(Throw(ahead - bank, cos_sin(bank), z, _shares(z, self.mains)) for ahead, bank, z in standing)

    @cached_property
    def cylinders(self) -> tuple[Scene, ...]:
        """Scene of each cylinder, in axes that turn with it: they differ in the direction of gravity alone."""
        gx, gy = self.engine.gravity
        banks = [throw.bank for throw in self.throws]
        turned = {
            (cos, sin): replace(self.engine, gravity=(cos * gx + sin * gy, cos * gy - sin * gx)) for cos, sin in banks
        }
        return tuple(turned[bank] for bank in banks)

    @clear_method
    @limits_threads
    def sweep(
        self,
        theta2: Any = 720,
        *,
        of: str | Iterable[str] | None = None,
        outputs: str | Iterable[str] | None = None,
        threads: int | None = None,
    ) -> xr.Dataset:
        """Compute torque, shaking force and moments of all cylinders together over the cycle.

        Parameters
        ----------
        theta2 : int or array_like, default 720
            Count of crank angles, or the angles themselves [degree], as in `linksweep.sweep`.
        of : str or iterable of str, default None
            Names of quantities. None for T12, the shaking force and its moments; others are `power`, `reduced_torque`,
            `reduced_inertia`, `F_main1`, `F_main1x` … and the like.
        outputs : str or iterable of str, default None
            Another name of `of`.
        threads : int, default None
            Largest number of threads; None for all cores. Results do not depend on it.

        Returns
        -------
        Dataset
            Over (design dims…, theta2): T12 [N m]; Fsx, Fsy, Fs [N]; Ms, Msx, Msy [N m]; status, the worst of all
            cylinders. `linksweep.orders` takes it.

        Raises
        ------
        ValueError
            If an angle is no finite number, or a name is unknown.
        """
        word, quantities = either(of=of, outputs=outputs)
        names = list(SHAKING) if quantities is None else requested(word, quantities)
        refuse([p for name in names for p in quantity_problems(self, word, name, "status")])
        grid = crank_grid(theta2, self.period)
        needed = dict.fromkeys((*names, "status"))
        sources = sources_of(needed, self.rules)
        cycles = [
            _bare(sweep(scene, np.mod(grid.angles + throw.ahead, self.period), of=sources))
            for scene, throw in zip(self.cylinders, self.throws, strict=True)
        ]
        sums = combined(needed, self.rules, self.throws, cycles)
        status = sums.pop("status").assign_attrs(cycles[0]["status"].attrs)
        labelled = {
            name: values.where(status == 0).assign_attrs(self._attributes(name)) for name, values in sums.items()
        }
        command = f"linksweep.MultiCylinder(...).sweep(theta2={quote(theta2)})"
        ds = xr.Dataset(labelled | {"status": status}, attrs=attributes_of(self, command))
        return ds.assign_coords(index_coordinate(self.engine, grid))

    def _attributes(self, name: str) -> dict[str, Any]:
        """Return unit, description and cycle of a quantity: loads over several turns enter some quantities alone."""
        quantity, scene = self.quantity[name], self.engine
        cycle = scene.period if changes(scene, sources_of((name,), self.rules)) else scene.period_of_motion
        return {"units": quantity.units, "long_name": quantity.long_name, CYCLE: cycle}


def quantity_problems(machine: MultiCylinder, path: str, name: Any, *others: str) -> list[str]:
    """Return a problem unless a name is a quantity of an engine, or one of the others; of mains, why there are none."""
    if not machine.mains and str(name).startswith("F_main"):
        return [f"{path} = {quote(name)}: {NO_MAINS}"]
    return name_problems(path, name, [*machine.quantity, *others])


def attributes_of(machine: MultiCylinder, command: str) -> dict[str, Any]:
    """Return the attributes of a Dataset of all cylinders that a command makes."""
    return origin_attributes(machine.engine, command) | {"title": f"linksweep: {type(machine).__name__}"}


def _bare(cycle: xr.Dataset) -> xr.Dataset:
    """Return a cylinder's cycle without its own angles, which differ from the engine's."""
    return cycle.drop_vars([name for name, array in cycle.coords.items() if "theta2" in array.dims])


def _halfway(throws: list[float]) -> tuple[float, ...]:
    """Return places halfway between throws, and as far outside; () for one throw."""
    if len(throws) < 2:
        return ()
    between = [0.5 * (a + b) for a, b in pairwise(throws)]
    return (2.0 * throws[0] - between[0], *between, 2.0 * throws[-1] - between[-1])


def _shares(z: float, mains: tuple[float, ...]) -> tuple[float, ...]:
    """Return the part that each main carries of a force at z, by the lever rule in the bay that z lies in."""
    weights = np.zeros(len(mains))
    if len(mains):
        right = min(max(int(np.searchsorted(mains, z)), 1), len(mains) - 1)
        bay = mains[right] - mains[right - 1]
        weights[right - 1], weights[right] = (mains[right] - z) / bay, (z - mains[right - 1]) / bay
    return tuple(map(float, weights))


def one_cylinder(machine: Scene | MultiCylinder) -> Scene:
    """Return the scene of one cylinder of an engine, or a scene itself."""
    return machine.engine if isinstance(machine, MultiCylinder) else machine


def _engine_problems(engine: Any) -> list[str]:
    if not isinstance(engine, Scene):
        return [f"engine is a {type(engine).__name__}: must be a Scene"]
    if missing := lack(engine.mechanism, "engine_cylinder"):
        return [f"engine is of {missing}"]
    over_angle = {*engine.functions, *(path for path, array in engine.arrays.items() if "theta2" in array.dims)}
    moving = [word for word in ("omega2", "alpha2") if word in over_angle]
    problems = [
        f"engine.{word} = {quote(getattr(engine, word))}: must be the same at every crank angle" for word in moving
    ]
    wrong = f'engine.drive = "{engine.drive}": must be "crank", which all cylinders share'
    return problems + ([wrong] if engine.drive != "crank" else [])


def _numbers_in(value: Any, rule: Rule) -> tuple[Any, ...] | None:
    """Return the numbers of a list; None of what is none, as a text or a set, whose members have no order."""
    others = is_array(value) or isinstance(value, str | bytes | bytearray | Set | Mapping)
    if others or getattr(value, "ndim", 1) == 0 or not isinstance(value, Iterable):
        return None
    return tuple(to_float64(number, rule.kind) for number in value)


def _plain_problems(path: str, number: Any, rule: Rule) -> list[str]:
    """Return the problems of a number that is the same for all designs."""
    several = (is_array(number) and number.dims) or isinstance(number, np.ndarray | list | tuple)
    if several or number is None:
        return [f"{path} = {quote(number)}: must be {rule.number}, the same for all designs"]
    return number_problems(path, number, rule)
