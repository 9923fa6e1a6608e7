"""A scene: a mechanism, how it is driven, and what acts on it; and the same scene as numbers for the engine."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cached_property, partial
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.equality import ByContent, content
from linksweep.base.frozen import normalise, with_sound
from linksweep.base.validate import (
    UNITS,
    Number,
    Rule,
    choice_problems,
    field_problems,
    is_array,
    is_lazy,
    pair_problems,
    parameter,
    quote,
    refuse,
)
from linksweep.engine.quantity import Table
from linksweep.engine.run import Grid, evaluate
from linksweep.engine.trace.plan import plan
from linksweep.mechanisms import MECHANISMS, Mechanism
from linksweep.scene.checked_number import said_unit_problems
from linksweep.scene.curves.acceleration import acceleration, acceleration_problems
from linksweep.scene.curves.interpolation import CUBIC
from linksweep.scene.curves.over_angle import (
    Curves,
    at_angles,
    overshoot_of,
    period_of,
    period_of_function,
    turning_problems,
)
from linksweep.scene.curves.quick import Quick, quick_angles
from linksweep.scene.dimensions import dimension_problems
from linksweep.scene.grid import NAMES as GRID_ROWS
from linksweep.scene.grid import crank_grid
from linksweep.scene.inputs import Inputs, as_field, form_of, over_designs
from linksweep.scene.loads.action import Action, Revolution
from linksweep.scene.parameters import bare, numbers

ACCELERATION = Rule("acceleration")
MOTION = ("omega2", "alpha2", "drive", "loads", "speed", "thrust", "profile")
"""Words of a scene of which each mechanism takes its own."""


@dataclass(frozen=True, eq=False)
class Scene(ByContent):
    """What happens to a mechanism: its drive, gravity and loads.

    Parameters
    ----------
    mechanism : FourBar, SliderCrank, InvertedSliderCrank or LoopTrack
    omega2 : angular velocity of the crank [rad/s], positive counter-clockwise
    alpha2 : its angular acceleration [rad/s²]. Left out, it is ω2·dω2/dθ2, which is 0 where omega2 is the same at every
        angle; of a spline by that spline, of a function by differences, to 1e-9 of the largest. Where it is given it
        is taken, and `linksweep.check` tells how far it is from that
    gravity : (gx, gy) [m/s²]; none by default, (0, -9.81) for a mechanism that stands upright
    loads : any number of Load, GasPressure, Spring, Damper, TorsionSpring and TorsionDamper
    drive : the link whose ground torque is the unknown: "crank" (T12), "coupler" (T13) or "rocker" (T14);
        or the "cylinder" of an inverted slider-crank (cylinder_force); "crank" by default
    speed : of the car in a loop [m/s]: at every position, or with profile="energy" at the bottom
    thrust : of the car along the track [N]; none by default
    profile : "constant" (by default), or "energy", which follows work and energy round the loop

    A crank takes omega2, alpha2, drive and loads; a loop takes speed, thrust and profile; both take gravity.

    Any number may be an xarray.DataArray with named dims; omega2, alpha2, forces and torques may also depend on
    theta2, as a DataArray or a function of theta2 [degree], which must come round after one turn of the crank or some.
    One that takes two, as in a four-stroke engine, makes the whole cycle two turns long: theta2 then runs to 720. The
    values of a DataArray are in the parameter's own unit; one that says another in attrs["units"] is refused, not
    converted. Quantities of pint, and arrays of them, are converted; numbers of any dtype become float64. Where one is
    dask's, results are lazy too, chunk by chunk of the designs, and its values are judged when they are computed.
    Labels are numbers, truth values, texts or times, and names of dims such as NetCDF takes: what no file would give
    back as it is, is refused.

    Raises
    ------
    ValueError
        One line for each parameter that is not allowed, by its path.

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

    mechanism: Mechanism
    omega2: Number = parameter("angular_velocity", None, over_angle=True)
    alpha2: Number = parameter("angular_acceleration", None, over_angle=True)
    gravity: Sequence[Number] = (0.0, 0.0)
    loads: Sequence[Action] = ()
    drive: str = ""
    speed: Number = parameter("velocity", None, at_least=0.0)
    thrust: Number = parameter("force", None)
    profile: str = ""

    def __post_init__(self) -> None:
        super().__post_init__()
        normalise(self, **{word: _own_label(word, getattr(self, word)) for word in MOTION})
        sound = isinstance(self.mechanism, Mechanism)
        found = [] if sound else [f"mechanism = {quote(self.mechanism)}: must be a {' or '.join(MECHANISMS)}"]
        found += field_problems(self)
        found += pair_problems("gravity", self.gravity, (ACCELERATION, ACCELERATION), "(gx, gy) in m/s^2")
        found += self._take_motion() if sound else []
        found += self._take_loads()
        refuse(found)
        refuse([problem for path, load in self._loads() for problem in load.misfits(path, self.mechanism)])
        # omega2 may be asked for as it was given; the loop's speed over theta is not the speed that was given
        results = self.table.quantity.keys() - (self.motion.keys() & self.arrays.keys())
        refuse(said_unit_problems(self) + self._interpolation_problems())
        turn = self.mechanism.period
        refuse([p for path, function in self.functions.items() for p in turning_problems(path, function, turn)])
        refuse(self._index_problems() + dimension_problems(self.arrays, self.mechanism.index, results))

    def _take_motion(self) -> list[str]:
        """What the mechanism takes of the words for its motion; those left out get their defaults."""
        kind, given = type(self.mechanism), [word for word in MOTION if not _left_out(getattr(self, word))]
        own = ", ".join((*kind.motion, "gravity"))
        found = [
            f"{word} = {quote(getattr(self, word))}: is no word of {kind.__name__}; give its own: {own}"
            for word in given
            if word not in kind.motion
        ]
        if kind.motion[0] not in given:
            found.append(f"{kind.motion[0]}: missing; give {kind.__name__} {_rule(kind.motion[0]).number}")
        normalise(self, **{word: default for word, default in kind.defaults.items() if word not in given})
        for word, allowed in kind.choices().items():
            found += choice_problems(word, getattr(self, word), allowed)
        return found

    def _index_problems(self) -> list[str]:
        """Return a line for each parameter over the index of a machine that is not the crank's angle."""
        index = self.mechanism.index
        over = [path for path, array in self.arrays.items() if index in array.dims and index != "theta2"]
        return [f"{path} depends on {index}: it must be the same at every {self.mechanism.spot}" for path in over]

    def _interpolation_problems(self) -> list[str]:
        """Arrays that say how they go on between angles, and are none of a load over the angles."""
        index = self.mechanism.index
        arrays = [(path, array) for path, array in self.arrays.items() if "interpolation" in array.attrs]
        others = [path for path, array in arrays if index not in array.dims or not path.startswith("loads")]
        return [f"{path}.interpolation: is for loads over {index}; leave it out" for path in others]

    def _of_mechanism(self, words: str) -> tuple[str, ...]:
        """The mechanism's drives or links; of an unsound one, those of any."""
        kinds = (type(self.mechanism),) if isinstance(self.mechanism, Mechanism) else tuple(MECHANISMS.values())
        return tuple(dict.fromkeys(word for kind in kinds for word in getattr(kind, words)))

    def _take_loads(self) -> list[str]:
        """Any collection of loads as a tuple; a single load counts as one."""
        loads = (self.loads,) if isinstance(self.loads, Action) else self.loads
        if isinstance(loads, str | Mapping | np.ndarray) or is_array(loads) or not isinstance(loads, Iterable):
            return [f"loads = {quote(loads)}: must be a Load, or a list of them"]
        normalise(self, loads=tuple(loads))
        found: list[str] = []
        links = self._of_mechanism("links")  # a mechanism without any takes no loads, as has been said
        for path, load in self._loads() if links else ():
            sound = isinstance(load, Action)
            found += load.problems(path, links) if sound else [f"{path} = {quote(load)}: must be a Load"]
        return found

    def _loads(self) -> list[tuple[str, Action]]:
        return [(f"loads[{k}]", load) for k, load in enumerate(self.loads, 1)]

    @cached_property
    def table(self) -> Table:
        """All that can be computed of this scene."""
        return self.mechanism.table(self.drive, tuple(load.form for load in self.loads))

    @cached_property
    def arrays(self) -> dict[str, xr.DataArray]:
        """The scene's DataArrays, over designs or angles, by the path of the parameter that each is."""
        return {path: value for path, value in self._numbers.items() if isinstance(value, xr.DataArray)}

    @property
    def _numbers(self) -> dict[str, Any]:
        """The scene's numbers by path, but for tables and functions of a position."""
        curves = {id(number) for load in self.loads for number in load.over_positions}
        return {path: value for path, value, _ in numbers(self) if id(value) not in curves}

    @cached_property
    def parameters(self) -> dict[str, xr.Variable]:
        """The same as variables that say their unit, without what the user's arrays carry besides."""
        units = {path: UNITS.get(kind, "") for path, _, kind in numbers(self)}
        return {
            path: xr.Variable(array.dims, array.data, {"units": units[path], "long_name": f"parameter {path}"})
            for path, array in self.arrays.items()
        }

    @cached_property
    def functions(self) -> dict[str, Any]:
        """The scene's functions of theta2 by path."""
        return {path: value for path, value in self._numbers.items() if callable(value) and not hasattr(value, "dims")}

    @cached_property
    def period(self) -> float:
        """Of the whole cycle [degree]: the turns of the crank after which all loads, omega2 and alpha2 come round."""
        turn = self.mechanism.period
        periods = [period_of(array, turn) for array in self.arrays.values() if "theta2" in array.dims]
        periods += [period_of_function(function, turn) for function in self.functions.values()]
        periods += [load.period for load in self.loads if load.period]
        return turn * math.lcm(*(round(period / turn) for period in periods))

    def jumps(self) -> tuple[Number, ...]:
        """Crank angles [degree] at which forces jump: friction where a slider turns round, pressure at dead centres,
        a torsion spring at 180."""
        with np.errstate(invalid="ignore"):  # designs that do not turn fully may have none: NaN
            of_loads = (angle for load in self.loads for angle in load.jumps(self.mechanism))
            every = (*self.mechanism.jumps(), *of_loads)
        return tuple({content(angle): angle for angle in every}.values())  # friction and gas share dead centres

    @cached_property
    def quick(self) -> Quick:
        """Crank angles at which functions of theta2 and arrays over it are quick."""
        return quick_angles(self)

    def approaches(self) -> tuple[tuple[str, str], ...]:
        """Return the names of pairs of quantities that tell where loads turn over quickly, and how narrow that is."""
        return tuple(pair for k, load in enumerate(self.loads, 1) for pair in load.approaches(f"load{k}"))

    def to_toml(self) -> str:
        """Return the text of a scene file, from which `linksweep.load_scene` makes an equal scene.

        Returns
        -------
        TOML with the words of the constructors and the numbers in SI units, to the bit. Functions of theta2 stand
        there as samples, which a spline joins to within 1e-9 of their largest value.

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
        from linksweep.scene.file.toml import toml_of  # here: it takes scenes

        return toml_of(self)

    @cached_property
    def at_one_angle(self) -> Scene:
        """The scene at one angle, for what does not depend on it; the scene itself where nothing changes with it."""
        return self.at(crank_grid(1, self.period, self.mechanism.index))

    @cached_property
    def steady(self) -> bool:
        """Whether nothing that it is given changes over the revolution."""
        over_angle = any(self.mechanism.index in array.dims for array in self.arrays.values())
        return self.at_one_angle is self and not over_angle

    def at(self, grid: Grid) -> Scene:
        """The same scene with all that changes over the revolution given as DataArrays over the grid's angles."""
        omega2 = self._sampled("omega2", grid)
        revolution = Revolution(self.mechanism, grid, omega2, self._curves, partial(self._kinematics, grid))
        loads = tuple(load.sampled(path, revolution) for path, load in self._loads())
        return with_sound(self, omega2=omega2, alpha2=self._acceleration(grid), loads=loads)

    def _acceleration(self, grid: Grid) -> Number | None:
        """Return alpha2 at the grid's angles; None where it was left out and omega2 is the same at every angle."""
        if self.alpha2 is not None or not self.changes_speed:
            return self._sampled("alpha2", grid)
        derived = self.derived_acceleration(grid)
        refuse(acceleration_problems(derived))
        return derived

    @property
    def changes_speed(self) -> bool:
        """Whether omega2 is a function of theta2, or an array over it."""
        return "omega2" in self.functions or self.mechanism.index in getattr(self.omega2, "dims", ())

    def derived_acceleration(self, grid: Grid) -> xr.DataArray:
        """Return ω2·dω2/dθ2 [rad/s²] at the grid's angles, of an omega2 that changes with theta2."""
        return acceleration("omega2", self.omega2, _rule("omega2"), grid, self.mechanism.period, self._curves)

    def _sampled(self, word: str, grid: Grid) -> Number:
        return at_angles(word, getattr(self, word), _rule(word), grid, self.mechanism.period, curves=self._curves)

    @cached_property
    def _curves(self) -> Curves:
        return {}

    def _kinematics(self, grid: Grid, *names: str) -> list[xr.DataArray]:
        """Quantities that angles and lengths alone decide, at the grid's angles."""
        unloaded = self._unloaded
        request = plan(unloaded.table, names, unloaded.inputs.forms)
        found = evaluate(request, unloaded.inputs.fields, grid, unloaded.inputs.sizes)
        fields = [found[name] for name in names]
        return [xr.DataArray(field.values, {grid.dim: grid.angles}, field.dims) for field in fields]

    @cached_property
    def _unloaded(self) -> Scene:
        """The mechanism alone, its crank turning."""
        return with_sound(self, omega2=1.0, alpha2=0.0, gravity=(0.0, 0.0), loads=())

    def overshoots(self) -> dict[str, float]:
        """By path, how far each spline through an array over theta2 leaves its range, relative to that range."""
        kinds = {path: getattr(load, "interpolation", None) for path, load in self._loads()}
        splines = {
            path: array
            for path, array in self.arrays.items()
            if self.mechanism.index in array.coords and kinds.get(path.rpartition(".")[0]) in (None, CUBIC)
        }
        overshoots = {path: overshoot_of(array, self.mechanism.period) for path, array in splines.items()}
        return {path: overshoot for path, overshoot in overshoots.items() if overshoot is not None}

    @cached_property
    def bare(self) -> Scene:
        """The same scene without labels, which have been compared, but for its loads."""
        parts = ("mechanism", "omega2", "alpha2", "gravity", "speed", "thrust")
        return with_sound(self, **{part: bare(getattr(self, part)) for part in parts})

    @cached_property
    def inputs(self) -> Inputs:
        """The scene as the engine takes it; what changes over the revolution must have been brought `at` a grid."""
        named = self.bare._named_values()
        fields = {name: as_field(value) for name, value in named.items()}
        grid_rows = tuple((name, (self.mechanism.index,)) for name in GRID_ROWS)
        forms = (*((name, form_of(field)) for name, field in fields.items()), *grid_rows)
        sizes = {dim: n for f in fields.values() for dim, n in zip(f.dims, f.values.shape, strict=True)}
        sizes.pop(self.mechanism.index, None)
        return Inputs(fields, forms, sizes)

    @cached_property
    def labels(self) -> dict[str, xr.Variable]:
        """Coordinates of the design dims that have some."""
        found = {dim: xr.Variable(dim, names) for dim, names in self.mechanism.coordinates().items()}
        for array in self.arrays.values():
            found |= {str(dim): _plain(array[dim].variable) for dim in array.dims if dim in array.coords}
        found.pop(self.mechanism.index, None)
        return found

    @cached_property
    def motion(self) -> dict[str, Any]:
        """The numbers of its motion under the names that the physics wires by."""
        given = {word: getattr(self, word) for word in MOTION}
        gravity = {"gravity_x": self.gravity[0], "gravity_y": self.gravity[1]}
        return self.mechanism.motion_parameters(given) | gravity

    def _named_values(self) -> dict[str, Any]:
        named = {**self.motion, **self.mechanism.parameters()}
        named |= over_designs(self.mechanism.driven(self.motion))
        for k, load in enumerate(self.loads, 1):
            named |= load.parameters(f"load{k}", named)
        return named


def _own_label(word: str, value: Any) -> Any:
    """Return an array over a dim of its own name with its values as labels: in a file it is this dim's coordinate."""
    own = isinstance(value, xr.DataArray) and value.dims == (word,) and word not in value.coords
    return value.assign_coords({word: value.values}) if own and not is_lazy(value) else value


def _left_out(word: Any) -> bool:
    return word is None or (isinstance(word, str | tuple | list) and not word)


def _rule(word: str) -> Rule:
    return next(item.metadata["rule"] for item in fields(Scene) if item.name == word)


def _plain(variable: xr.Variable) -> xr.Variable:
    """A coordinate with those of its attributes that every file format takes, and no memory of a file it came from."""
    kept = {k: v for k, v in variable.attrs.items() if isinstance(v, str | int | float) and not isinstance(v, bool)}
    values = variable.values
    texts = np.array([str(label) for label in values], object) if values.dtype == object else values
    return xr.Variable(variable.dims, texts, kept)
