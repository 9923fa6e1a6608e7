"""MultiCylinder: an engine of several cylinders on one crankshaft, each a slider-crank like the first.

Cylinder k is the engine's slider-crank turned by its bank angle β about A, its crank ahead by its crank angle φ. In
axes that turn with the cylinder its crank stands at θ2 + φ − β: each cylinder is thus the same cycle at other angles,
its forces turned by β. With z the place along the crankshaft, forces of the cylinders add up to

    Fs = Σ R(β) Fs(θ2 + φ − β)        Ms = Σ Ms(θ2 + φ − β)        T12 = Σ T12(θ2 + φ − β)
    Msx = −Σ z·Fsy,  Msy = Σ z·Fsx    (moments about the axes x and y at z = 0)

Source: C. F. Taylor, The Internal-Combustion Engine in Theory and Practice, volume 2 (engine balance and vibration); R.
L. Norton, Design of Machinery, chapter "Multicylinder Engines".
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from linksweep.mechanisms import SliderCrank
from linksweep.mechanisms.content import ByContent
from linksweep.mechanisms.conversion import to_float64
from linksweep.mechanisms.degrees import cos_sin
from linksweep.mechanisms.validate import Rule, is_array, number_problems, refuse, said
from linksweep.results.record import index_coordinate, origin_attributes
from linksweep.results.sweep import sweep
from linksweep.scene.grid import crank_grid
from linksweep.scene.scene import Scene

ANGLE, LENGTH = Rule("angle"), Rule("length")
SAID = {
    "T12": ("N m", "torque of the drive on the crankshaft, positive counter-clockwise"),
    "Fsx": ("N", "shaking force of all cylinders, component along x"),
    "Fsy": ("N", "shaking force of all cylinders, component along y"),
    "Fs": ("N", "magnitude of the shaking force of all cylinders"),
    "Ms": ("N m", "shaking moment of all cylinders about the crankshaft, positive counter-clockwise"),
    "Msx": ("N m", "moment of the shaking forces about the x axis, -z times Fsy"),
    "Msy": ("N m", "moment of the shaking forces about the y axis, z times Fsx"),
}


@dataclass(frozen=True, eq=False)
class MultiCylinder(ByContent):
    """An engine, pump or compressor of several equal cylinders on one crankshaft.

    Parameters
    ----------
    engine : Scene of a SliderCrank: one cylinder, with the crank's throw, its share of the crankshaft and its loads,
        driven by the crank at a constant omega2
    crank_angles : of each cylinder's crank, ahead of theta2 [degree]; over two turns in a four-stroke engine, where
        they also say where in its cycle each cylinder is: [0, 540, 180, 360]
    bank_angles : of each cylinder, turned from the engine's guide [degree]; none by default
    positions : of each cylinder along the crankshaft [m], z pointing towards the viewer; all 0 by default

    Raises
    ------
    ValueError
        One line for each parameter that is not allowed.

    Notes
    -----
    Loads turn with their cylinder; gravity does not. Equations and source: `linksweep.results.cylinders`.

    Examples
    --------
    An inline four: what is left is the second order, and it goes up and down.

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
    crank_angles: tuple[float, ...]
    bank_angles: tuple[float, ...] = ()
    positions: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        refuse(_engine_problems(self.engine))
        given = {"crank_angles": ANGLE, "bank_angles": ANGLE, "positions": LENGTH}
        for word, rule in given.items():
            refuse(self._take(word, rule))

    def _take(self, word: str, rule: Rule) -> list[str]:
        """Numbers of the cylinders as a tuple, one for each."""
        value: Any = getattr(self, word)
        if is_array(value) or isinstance(value, str) or not isinstance(value, Iterable):
            return [f"{word} = {said(value)}: must be a list of numbers, one for each cylinder"]
        numbers = tuple(to_float64(number, rule.kind) for number in value)
        if word != "crank_angles":
            numbers = numbers or (0.0,) * len(self.crank_angles)
        object.__setattr__(self, word, numbers)
        found = [] if numbers else [f"{word} is empty: give one for each cylinder"]
        if len(numbers) != len(self.crank_angles):
            found.append(
                f"{word} has {len(numbers)} numbers: must have one for each of {len(self.crank_angles)} cylinders"
            )
        return found + [p for k, n in enumerate(numbers, 1) for p in _plain_problems(f"{word}[{k}]", n, rule)]

    def sweep(self, theta2: Any = 720, threads: int | None = None) -> xr.Dataset:
        """Torque, shaking force and moments of all cylinders together over the cycle.

        Parameters
        ----------
        theta2 : count of crank angles, or angles [degree], as `linksweep.sweep` takes them
        threads : at most so many (default: all cores)

        Returns
        -------
        Dataset over (design dims…, theta2): T12 [N m]; Fsx, Fsy, Fs [N]; Ms, Msx, Msy [N m]; status, the worst of all
        cylinders. `linksweep.orders` takes it.

        Raises
        ------
        ValueError
            For angles that are no angles.
        """
        grid = crank_grid(theta2, self.engine.period)
        cylinders = [self._cylinder(k, grid.angles, threads) for k in range(len(self.crank_angles))]
        names = [name for name in SAID if name != "Fs"]
        found = {name: _sum(cylinder[name] for cylinder in cylinders) for name in names}
        found["Fs"] = xr.DataArray(np.hypot(found["Fsx"], found["Fsy"]))
        labelled = {name: found[name].assign_attrs(units=SAID[name][0], long_name=SAID[name][1]) for name in SAID}
        status = cylinders[0]["status"]
        for other in cylinders[1:]:
            status = xr.where(other["status"] > status, other["status"], status)
        labelled["status"] = status.assign_attrs(cylinders[0]["status"].attrs)
        command = f"linksweep.MultiCylinder(...).sweep(theta2={said(theta2)})"
        ds = xr.Dataset(labelled, attrs=origin_attributes(self.engine, command))
        return ds.assign_coords(index_coordinate(self.engine, grid))

    def _cylinder(self, k: int, angles: np.ndarray, threads: int | None) -> xr.Dataset:
        """What cylinder k adds, in ground axes, over the crankshaft's angles."""
        ahead, bank, z = self.crank_angles[k], self.bank_angles[k], self.positions[k]
        cos, sin = cos_sin(bank)
        own = np.mod(angles + (ahead - bank), self.engine.period)
        gx, gy = self.engine.gravity
        seen = replace(self.engine, gravity=(cos * gx + sin * gy, cos * gy - sin * gx))
        cycle = sweep(seen, own, ["T12", "Fsx", "Fsy", "Ms"], threads=threads)
        cycle = cycle.drop_vars([name for name, array in cycle.coords.items() if "theta2" in array.dims])
        x, y = cos * cycle["Fsx"] - sin * cycle["Fsy"], sin * cycle["Fsx"] + cos * cycle["Fsy"]
        return cycle.assign({"Fsx": x, "Fsy": y, "Msx": -z * y, "Msy": z * x})


def _engine_problems(engine: Any) -> list[str]:
    if not isinstance(engine, Scene) or not isinstance(engine.mechanism, SliderCrank):
        return [f"engine is a {type(engine).__name__}: must be a Scene of a SliderCrank"]
    moving = [word for word in ("omega2", "alpha2") if _over_angle(getattr(engine, word))]
    found = [f"engine.{word} = {said(getattr(engine, word))}: must be the same at every crank angle" for word in moving]
    wrong = f'engine.drive = "{engine.drive}": must be "crank", which all cylinders share'
    return found + ([wrong] if engine.drive != "crank" else [])


def _over_angle(value: Any) -> bool:
    return (callable(value) and not is_array(value)) or "theta2" in getattr(value, "dims", ())


def _plain_problems(path: str, number: Any, rule: Rule) -> list[str]:
    array = [f"{path} has dims: must be a number"] if is_array(number) and number.dims else []
    return array or number_problems(path, number, rule)


def _sum(arrays: Iterable[xr.DataArray]) -> xr.DataArray:
    first, *others = arrays
    return sum(others, first)
