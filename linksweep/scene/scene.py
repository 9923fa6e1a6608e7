"""A scene: a mechanism, its motion, gravity and loads."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.checked_number import unit_attribute_problems
from linksweep.base.equality import ByContent, content
from linksweep.base.fields import (
    PairField,
    PartField,
    PartsField,
    field_problems,
    field_rules,
    left_out,
    numbers,
    of_kind,
    parameter,
    unstated,
)
from linksweep.base.frozen import bare, cached_copy, cached_property, field_values, normalise, with_sound
from linksweep.base.public.clear_calls import clear_method
from linksweep.base.validate import UNITS, Number, Rule, choice_problems, quote, refuse
from linksweep.engine.quantity import Table
from linksweep.engine.run import Grid, Places
from linksweep.mechanisms import MECHANISMS, Mechanism
from linksweep.scene.curves.over_angle import ArrayCurve, period_of, period_of_function, turning_problems
from linksweep.scene.curves.quick import Quick, quick_angles
from linksweep.scene.dimensions import dimension_problems, index_problems, interpolation_problems, length_problems
from linksweep.scene.grid import crank_grid
from linksweep.scene.inputs import Inputs, engine_inputs
from linksweep.scene.loads.action import LOADS, Action
from linksweep.scene.loads.kinds import Load
from linksweep.scene.revolution import Revolution
from linksweep.scene.shown_units import UNITS_FIELD
from linksweep.scene.storable import own_label, storable_coordinate
from linksweep.scene.strokes import stroke_of

GRAVITY = PairField(Rule("acceleration"), Rule("acceleration"), "(gx, gy) in m/s^2")
MECHANISM = PartField(MECHANISMS.values(), Mechanism, inline=True)
ACTIONS = PartsField(PartField(LOADS.values(), Action, default=Load))
MOTION = ("omega2", "alpha2", "drive", "loads", "section", "speed", "thrust", "profile")
"""Parameters of a scene of which each mechanism takes its own."""


@dataclass(frozen=True, eq=False, repr=False)
class Scene(ByContent):
    """A mechanism with its motion, gravity and loads.

    Parameters
    ----------
    mechanism : Mechanism
        FourBar, SliderCrank, InvertedSliderCrank, Linkage or LoopTrack.
    omega2 : float, DataArray or function, default None
        Angular velocity of the crank [rad/s], positive counter-clockwise. Required where there is a crank.
    alpha2 : float, DataArray or function, default None
        Angular acceleration of the crank [rad/s²]; None for ω2·dω2/dθ2, which is 0 for a constant omega2.
    gravity : pair of float or DataArray, default (0.0, 0.0)
        Components along x and y [m/s²]; (0, -9.81) for a mechanism that stands upright.
    loads : list of loads, default ()
        Any number of Load, GasPressure, Spring, Damper, TorsionSpring and TorsionDamper.
    drive : str, default ""
        Driven part: "crank" (unknown T12; taken where none is stated), "coupler" (T13), "rocker" (T14), or the
        "cylinder" of an inverted slider-crank (cylinder_force). Of a linkage, the name of its crank, of another link on
        a ground pin (T16 for link 6), or of a cylinder without a length of its own (force_c1).
    speed : float or DataArray, default None
        Speed of the car in a loop [m/s]: at every position, or with profile="energy" at the bottom. Required there.
    thrust : float or DataArray, default None
        Thrust of the car along the track [N]; None for no thrust.
    profile : str, default ""
        Speed round the loop: "constant" (taken where none is stated), or "energy", by work and energy.
    section : float or DataArray, default None
        Place of section forces between the ends of a link, 0 to 1 [1]; None for 41 places where they are requested.
    units : str, default ""
        Units in which results are shown, such as "in, lbf, rpm", "US" or "mm"; "" for SI: see `linksweep.units`.

    Raises
    ------
    ValueError
        One line for each parameter that is not allowed, by its path.

    Notes
    -----
    A crank takes omega2, alpha2, drive, loads and section; a loop takes speed, thrust and profile; both take gravity.

    Any number may be an xarray.DataArray with named dims; omega2, alpha2, forces and torques may also depend on
    theta2, as a DataArray or a function of theta2 [degree], which must repeat after one turn of the crank or some. One
    that takes two, as in a four-stroke engine, makes the whole cycle two turns long, as gears of the ratio 1/2 do:
    theta2 then runs to 720. The values of a DataArray are in the parameter's own unit; one that states another in
    attrs["units"] is refused, not converted. Quantities of pint, and arrays of them, are converted; numbers of any
    dtype become float64. Where one is dask's, results are lazy too, chunk by chunk of the designs, and its values are
    checked when they are computed. Labels are numbers, truth values, texts or times, and names of dims are those that
    NetCDF allows: what a file would not return as it was written is refused.

    The derivative of an omega2 that is an array is that of its spline; of a function it is computed by differences, to
    1e-9 of the largest. An alpha2 beside it is used as it is, and `linksweep.check` states how far the two differ.

    Examples
    --------
    >>> import linksweep as ls
    >>> bar = dict(width=0.02, thickness=0.02, density=7750)
    >>> press = ls.FourBar(crank=ls.Bar(length=0.08, **bar), coupler=ls.Bar(length=0.22, **bar),
    ...                    rocker=ls.Bar(length=0.18, **bar), ground=0.20)
    >>> scene = ls.Scene(press, omega2=30.0, gravity=(0.0, -9.81), loads=[ls.Load("rocker", torque=-12.0)])
    >>> scene.drive
    'crank'
    """

    mechanism: Mechanism = of_kind(MECHANISM)
    omega2: Number = parameter("angular_velocity", None, over_angle=True)
    alpha2: Number = parameter("angular_acceleration", None, over_angle=True)
    gravity: Sequence[Number] = of_kind(GRAVITY, (0.0, 0.0))
    loads: Sequence[Action] = of_kind(ACTIONS, ())
    drive: str = ""
    speed: Number = parameter("velocity", None, at_least=0.0)
    thrust: Number = parameter("force", None)
    profile: str = ""
    section: Number = parameter("dimensionless", None, at_least=0.0, at_most=1.0)
    units: str = of_kind(UNITS_FIELD, "")

    def __post_init__(self) -> None:
        super().__post_init__()
        normalise(self, **self._normalised())
        refuse(self._problems())
        refuse([problem for path, load in self._loads() for problem in load.misfits(path, self.mechanism)])
        machine, arrays = self.mechanism, self.arrays
        units = unit_attribute_problems((path, *number) for path, number in self._not_plain.items())
        refuse(units + interpolation_problems(arrays, machine.index))
        refuse([p for path, curve in self.functions.items() for p in turning_problems(path, curve, machine.period)])
        # omega2 is a result by that name, too; the speed of a loop's results is another than the parameter
        taken = {*self.table.quantity.keys() - (self.motion.keys() & arrays.keys()), *machine.both_branches}
        refuse(index_problems(arrays, machine) + dimension_problems(arrays, machine.index, taken))

    def _defaults(self) -> dict[str, Any]:
        return super()._defaults() | dict(self.mechanism.defaults)

    def _normalised(self) -> dict[str, Any]:
        """Return the fields with arrays labelled, and the mechanism's defaults."""
        values = {name: own_label(name, value) for name, value in field_values(self).items()}
        if not isinstance(self.mechanism, Mechanism):
            return values
        machine, loads = self.mechanism, values["loads"]
        if isinstance(loads, tuple):
            values["loads"] = tuple(load.for_machine(machine) if isinstance(load, Action) else load for load in loads)
        return values | {name: default for name, default in machine.defaults.items() if unstated(values[name])}

    def _problems(self) -> list[str]:
        """Return the problems of each parameter by itself."""
        motion_problems = self._motion_problems() if isinstance(self.mechanism, Mechanism) else []
        return field_problems(self) + motion_problems + self._load_problems()

    def _motion_problems(self) -> list[str]:
        """Return the problems of the parameters for motion: those that the mechanism does not take, or requires."""
        machine, values = self.mechanism, {name: getattr(self, name) for name in MOTION}
        kind, own, required = type(machine).__name__, ", ".join((*machine.motion, "gravity")), machine.motion[0]
        problems = [
            f"{name} = {quote(value)}: is no parameter of {kind}; give its own: {own}"
            for name, value in values.items()
            if name not in machine.motion and not left_out(value)
        ]
        if left_out(values[required]):
            problems.append(f"{required}: missing; give {kind} {field_rules(Scene)[required].number}")
        problems += (misfits := length_problems(self.numbers, machine.index))
        choices = () if misfits else machine.choices().items()
        return problems + [p for name, allowed in choices for p in choice_problems(name, values[name], allowed)]

    def _load_problems(self) -> list[str]:
        links: tuple[str, ...] = getattr(self.mechanism, "roles", ())
        loads = self._loads() if isinstance(self.loads, tuple) else []
        actions = [(path, load) for path, load in loads if isinstance(load, Action)]
        return [p for path, load in actions for p in load.problems(path, links)] if links else []  # else none are taken

    def _loads(self) -> list[tuple[str, Action]]:
        return [(f"loads[{k}]", load) for k, load in enumerate(self.loads, 1)]

    @cached_property
    def table(self) -> Table:
        """Table of all quantities that can be computed of this scene."""
        return self.mechanism.table(self.drive, tuple(load.form for load in self.loads))

    @cached_property
    def numbers(self) -> dict[str, tuple[Any, str]]:
        """Value and kind of each number of the scene, by path."""
        return {path: (value, kind) for path, value, kind in numbers(self)}

    @cached_property
    def arrays(self) -> dict[str, xr.DataArray]:
        """DataArrays of the scene, over designs or angles, by the path of the parameter."""
        return {path: value for path, value in self._varying.items() if isinstance(value, xr.DataArray)}

    @cached_property
    def _varying(self) -> dict[str, Any]:
        """Arrays and functions of the scene by path, but for tables and functions of a position."""
        curves = {id(number) for load in self.loads for number in load.over_positions}
        return {path: value for path, (value, _) in self._not_plain.items() if id(value) not in curves}

    @cached_property
    def _not_plain(self) -> dict[str, tuple[Any, str]]:
        """The `numbers` that are not one float each."""
        return {path: number for path, number in self.numbers.items() if not isinstance(number[0], (float, type(None)))}

    @cached_property
    def parameters(self) -> dict[str, xr.Variable]:
        """Arrays of the scene as variables that state their unit, without the user's other attributes."""
        units = {path: UNITS[self.numbers[path][1]] for path in self.arrays}
        return {
            path: xr.Variable(array.dims, array.data, {"units": units[path], "long_name": f"parameter {path}"})
            for path, array in self.arrays.items()
        }

    @cached_property
    def functions(self) -> dict[str, Any]:
        """Functions of theta2 by the path of the parameter."""
        return {path: value for path, value in self._varying.items() if callable(value)}

    @cached_property
    def motion(self) -> dict[str, Any]:
        """Numbers of motion and gravity under the names that the physics takes."""
        values = {name: getattr(self, name) for name in MOTION}
        gravity = {"gravity_x": self.gravity[0], "gravity_y": self.gravity[1]}
        return self.mechanism.motion_parameters(values) | gravity

    @cached_property
    def period(self) -> float:
        """Whole cycle [degree]: the turns of the crank after which motion, loads, omega2 and alpha2 all repeat."""
        turn = self.mechanism.period
        periods = [period_of(array, turn) for array in self.arrays.values() if "theta2" in array.dims]
        periods += [period_of_function(function, turn) for function in self.functions.values()]
        periods += [load.period for load in self.loads if load.period]
        return turn * math.lcm(self.mechanism.turns, *(round(period / turn) for period in periods))

    @cached_property
    def period_of_motion(self) -> float:
        """Cycle of the machine without its loads [degree], after which all positions repeat."""
        return self.unloaded.period

    @cached_property
    def quick(self) -> Quick:
        """Crank angles at which functions of theta2, and arrays over it, change quickly."""
        return quick_angles(self)

    @cached_property
    def curves(self) -> Mapping[str, ArrayCurve]:
        """Periodic curves through the arrays over theta2, by path; each is computed when it is first needed."""
        kinds = {path: getattr(load, "interpolation", None) for path, load in self._loads()}
        return {
            path: ArrayCurve(path, array, self.mechanism.period, kinds.get(path.rpartition(".")[0]))
            for path, array in self.arrays.items()
            if "theta2" in array.coords
        }

    @cached_property
    def labels(self) -> dict[str, xr.Variable]:
        """Coordinates of the design dims that have labels."""
        labels = {dim: xr.Variable(dim, names) for dim, names in self.mechanism.coordinates().items()}
        for array in self.arrays.values():
            labels |= {str(dim): storable_coordinate(array[dim].variable) for dim in array.dims if dim in array.coords}
        labels.pop(self.mechanism.index, None)
        return labels

    @cached_property
    def steady(self) -> bool:
        """True where no parameter changes over the revolution."""
        over_angle = any(self.mechanism.index in array.dims for array in self.arrays.values())
        plain = not self._not_plain and not self.loads
        return plain or (not (over_angle or self.functions) and Revolution(self, self.grid(1)).sampled() is self)

    @property
    def changes_speed(self) -> bool:
        """True where omega2 is a function of theta2, or an array over it."""
        return "omega2" in self.functions or self.mechanism.index in getattr(self.omega2, "dims", ())

    @property
    @cached_copy
    def at_one_angle(self) -> Scene:
        """Scene at one angle, for results that do not depend on it; the scene itself where nothing changes with it."""
        return self.at(self.grid(1))

    @cached_property
    def unloaded(self) -> Scene:
        """Mechanism alone, its crank turning at 1 rad/s."""
        return with_sound(self, omega2=1.0, alpha2=0.0, gravity=(0.0, 0.0), loads=())

    @property
    @cached_copy
    def bare(self) -> Scene:
        """Scene whose arrays have no labels, but for those of its loads."""
        parts = field_values(self).items() if self.arrays else ()
        others = {name: bare(value) for name, value in parts if name not in ("loads", "mechanism")}
        return with_sound(self, mechanism=self.mechanism.bare, **others)

    @cached_property
    def inputs(self) -> Inputs:
        """Scene as the engine takes it; what changes over the revolution must be `at` the angles of a grid."""
        return engine_inputs(self.bare)

    def grid(self, angles: Any) -> Grid:
        """Make the grid of a sweep.

        Parameters
        ----------
        angles : int or array of float
            Count N of crank angles, arange(N)·period/N, or the angles themselves [degree].

        Returns
        -------
        Grid
            Angles with the cosines and sines from which the kernels start.

        Raises
        ------
        ValueError
            For a count below 1, and for what is no list of finite angles.
        """
        return crank_grid(angles, self.period, self.mechanism.index, self.mechanism.geared)

    def at(self, grid: Grid, places: Places | None = None) -> Scene:
        """Evaluate all that changes over the revolution at the angles of a grid.

        Parameters
        ----------
        grid : Grid
            Angles of a sweep.
        places : mapping of str to array of int, default None
            Index along each design dim [1] of the one design that arrays are evaluated for at each angle; None: all.

        Returns
        -------
        Scene
            Scene with DataArrays over these angles; the scene itself where nothing changes with them.

        Raises
        ------
        ValueError
            For a function that fails or returns no finite numbers, and an array that has no values at these angles.
        """
        return self if self.steady else Revolution(self, grid, places=places).sampled()

    def jumps(self) -> tuple[Number, ...]:
        """List the crank angles at which forces jump.

        Returns
        -------
        tuple of float or DataArray
            Angles [degree] of friction at reversals, of pressure at dead centres, of torsion springs at 180; or NaN.
        """
        return self._jumps

    @cached_property
    def _jumps(self) -> tuple[Number, ...]:
        with np.errstate(invalid="ignore"):  # designs that do not turn fully
            of_loads = (angle for load in self.loads for angle in load.jumps(self.mechanism))
            along_strokes = (angle for load in self.loads for angle in load.jumps_along(partial(stroke_of, self)))
            every = (*self.mechanism.jumps(), *of_loads, *along_strokes)
        return tuple({content(angle): angle for angle in every}.values())  # friction and gas share dead centres

    def approaches(self) -> tuple[tuple[str, str], ...]:
        """List the quantities that locate where the direction of a spring or damper turns over quickly.

        Returns
        -------
        tuple of pairs of str
            Names: of a quantity that rises through 0 there, and of the width in terms of the crank angle.
        """
        return tuple(pair for k, load in enumerate(self.loads, 1) for pair in load.approaches(f"load{k}"))

    @clear_method
    def to_toml(self) -> str:
        """Write the text of a scene file, from which `linksweep.load_scene` makes an equal scene.

        Returns
        -------
        str
            TOML with numbers in SI units, to the bit; functions of theta2 as samples that a spline joins to 1e-9.

        Raises
        ------
        ValueError
            For a function of theta2 that jumps, or changes too quickly for samples to stand for it.

        Examples
        --------
        >>> import linksweep as ls
        >>> print(ls.example("loop").to_toml().split("[mechanism]")[1])
        <BLANKLINE>
        type = "LoopTrack"
        radius = 30.0
        mass = 700.0
        <BLANKLINE>
        """
        from linksweep.scene.file.writing import toml_of  # here: it takes scenes

        return toml_of(self)
