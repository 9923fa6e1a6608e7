"""A scene with derivatives: those of its quantities to some of its parameters are quantities, too.

The parameters become numbers with slopes, from which motion, machine and loads compute those of all inputs of the
physics; `linksweep.engine.trace.derivatives` takes it from there. The crank angle counts as a parameter, `ANGLE`.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.base.fields import FieldKind, NumberField, below, declared, has_fields
from linksweep.base.frozen import unvalidated, with_sound
from linksweep.base.validate import Number, Rule, quote
from linksweep.chains.gears import geared_rows
from linksweep.engine.quantity import Row, Table
from linksweep.engine.run import Field, Grid, Places, evaluate
from linksweep.engine.trace.derivatives import derivative_of, with_derivatives
from linksweep.engine.trace.plan import plan
from linksweep.mechanisms import Mechanism
from linksweep.mechanisms.strokes import Stroke
from linksweep.scene.curves.derivatives import third_derivative
from linksweep.scene.curves.derivatives import with_derivatives as curve_with_derivatives
from linksweep.scene.curves.over_position import POSITION
from linksweep.scene.derivatives.sloped import Sloped, slopes_of, value_of, where
from linksweep.scene.dimensions import aligned
from linksweep.scene.inputs import Inputs, as_field, form_of
from linksweep.scene.loads.action import Action
from linksweep.scene.pairs import quantities_at
from linksweep.scene.parameters import free, replaced
from linksweep.scene.revolution import LENGTH, OMEGA2, Revolution
from linksweep.scene.scene import Scene
from linksweep.scene.strokes import stroke_of

MOTION = ("omega2", "alpha2")
"""Parameters of the crank's motion, which move no place: machine and loads at an angle do not depend on them."""
ANGLE = "crank angle"
"""The crank angle [rad] as a parameter."""
ROUNDING = 1e-9
"""Difference of two values that are the same position, relative to them."""
OWN = tuple(name for name, *_ in declared(Scene))
"""Fields of a scene."""


class Slope(NamedTuple):
    """Derivative of an input of the physics to a parameter."""

    source: str
    parameter: str
    field: Field

    @property
    def name(self) -> str:
        return derivative_of(self.source, self.parameter)


class Jump(NamedTuple):
    """A crank angle [degree] at which a load jumps or bends, with the load's number; 0 is that of the machine itself.

    It has slopes where a parameter moves it by a closed form, and is an array where a search has located it, a plain
    float where no parameter moves it; NaN, which does not move, in designs that have none.
    """

    load: int
    angle: Any


@dataclass(frozen=True, eq=False, repr=False)
class Differentiated(Scene):
    """A scene in which the quantities `of` have derivatives to the parameters `to`; made by `differentiated`.

    `sampled_slopes` are the slopes of its inputs where these have been evaluated at the angles of a grid.
    """

    of: tuple[str, ...] = ()
    to: tuple[str, ...] = ()
    sampled_slopes: tuple[Slope, ...] = ()

    @cached_property
    def table(self) -> Table:
        """Table of all quantities, and of the derivatives."""
        pairs: dict[str, list[tuple[str, str | float]]] = {parameter: [] for parameter in self.to}
        for slope in self.slopes:
            pairs[slope.parameter].append((slope.source, slope.name))
        turning = _turning(self.mechanism.geared) if ANGLE in pairs else {}
        if turning:
            pairs[ANGLE] += [*((source, row.outputs[0]) for source, row in turning.items()), ("radians2", 1.0)]
        slopes = tuple((parameter, tuple(own)) for parameter, own in pairs.items())
        return with_derivatives(self.plain.table, self.of, slopes, tuple(turning.values()))

    @cached_property
    def inputs(self) -> Inputs:
        """Scene as the engine takes it, with the slopes of its inputs."""
        fields, forms, sizes = self.plain.inputs
        active = {slope.source for slope in self.slopes}
        kept = ((name, fields[name].dims if name in active else form) for name, form in forms)
        own = {slope.name: slope.field for slope in self.slopes}
        return Inputs({**fields, **own}, (*kept, *((name, form_of(field)) for name, field in own.items())), sizes)

    @cached_property
    def slopes(self) -> tuple[Slope, ...]:
        """Slopes of the inputs, of those that change over the revolution at one angle unless they have been sampled."""
        return self.sampled_slopes or tuple(_slopes(self, self.grid(1)))

    @cached_property
    def plain(self) -> Scene:
        """Scene without derivatives."""
        return unvalidated(Scene, **{name: getattr(self, name) for name in OWN})

    @property
    def unloaded(self) -> Scene:
        """Mechanism alone, without derivatives, its crank turning at 1 rad/s."""
        return self.plain.unloaded

    @cached_property
    def moving_jumps(self) -> tuple[Jump, ...]:
        """Crank angles at which forces jump, or bend."""
        sloped = _with_slopes(self)
        mechanism = sloped.mechanism
        jumps = [Jump(0, angle) for angle in (*mechanism.jumps(), *mechanism.seams(self.profile))]
        for k, load in enumerate(sloped.loads, 1):
            along = load.jumps_along(partial(_stroke, mechanism, self.plain))
            jumps += [Jump(k, angle) for angle in (*_jumps_of(load, mechanism), *along)]
        return tuple(jump._replace(angle=_reached(jump.angle)) for jump in jumps)

    @property
    def changing_inputs(self) -> tuple[str, ...]:
        """Names of the inputs that change over the angle."""
        fields = self.plain.at_one_angle.inputs.fields
        return tuple(name for name, field in fields.items() if self.mechanism.index in field.dims)

    def at(self, grid: Grid, places: Places | None = None) -> Scene:
        """Evaluate all that changes over the revolution at the angles of a grid, each for its own design, if stated."""
        sampled = super().at(grid, places)
        return sampled if sampled is self else with_sound(sampled, sampled_slopes=tuple(_slopes(self, grid, places)))


def differentiated(scene: Scene, of: tuple[str, ...], to: tuple[str, ...]) -> Differentiated:
    """Return a scene in which these quantities have derivatives to these parameters.

    A number becomes an array without dims, so that a machine takes its general form: one with an offset, at an angle.
    """
    own = {path: scene.numbers[path][0] for path in to if path != ANGLE}
    single = {path: xr.DataArray(0.0 if value is None else value) for path, value in own.items() if _single(value)}
    general = replaced(scene, single) if single else scene
    return Differentiated(**{name: getattr(general, name) for name in OWN}, of=of, to=to)


def number_problem(scene: Scene, path: str) -> str:
    """Return why a parameter has no derivative; "" where it has one."""
    value, _ = free(scene)[path]
    index = scene.mechanism.index
    if path == "alpha2" and scene.alpha2 is None:
        return f"{path} = None: follows from omega2; give it a number" if scene.changes_speed else ""
    if value is None:
        return f"{path} = None: is no number; give it one"
    if not isinstance(value, float) and (not hasattr(value, "dims") or {index, POSITION} & {*value.dims}):
        return f"{path} = {quote(value)}: changes over the cycle; derivatives are to numbers that do not"
    if "friction" in path.rpartition(".")[2] and np.any(np.asarray(value) == 0.0):
        return f"{path} = 0: friction begins to act there, so that it has no derivative; give it a small value"
    return ""


def _single(value: Any) -> bool:
    return value is None or isinstance(value, float)


def _jumps_of(load: Action, mechanism: Mechanism) -> list[Any]:
    """Return the crank angles [degree] at which a load over them jumps: at its breaks none of numbers alone does."""
    numbers = getattr(load, "changing", ())
    still = numbers and all(isinstance(number, Sloped | float | None) for number in numbers)
    return [angle for angle in load.jumps(mechanism) if not (still and isinstance(angle, float))]


def _reached(angle: Any) -> Any:
    """Return a crank angle without slopes where it is NaN."""
    return where(np.isnan(angle), np.nan, angle) if isinstance(angle, Sloped) else angle


def _stroke(mechanism: Mechanism, plain: Scene, name: str) -> Stroke:
    """Return the stroke of a position of a mechanism with slopes; one that a search has located has none."""
    closed = plain.mechanism.strokes[name].crank_angles
    return mechanism.strokes[name] if closed else stroke_of(plain, name)


def _turning(geared: tuple[tuple[str, Any], ...]) -> Mapping[str, Row]:
    """Return the rows of the slopes to the crank angle, by the cosine or sine that each is of."""
    turned = {("cos2", "sin2"): 1.0} | {geared_rows(role)[:2]: float(ratio) for role, ratio in geared}
    return {
        source: Row(operator.mul, (derivative_of(source, ANGLE),), (other, factor))
        for (cos, sin), ratio in turned.items()
        for source, other, factor in ((cos, sin, -ratio), (sin, cos, ratio))
    }


def _slopes(scene: Differentiated, grid: Grid, places: Places | None = None) -> Iterator[Slope]:
    """Yield the slopes of the inputs at the angles of a grid; `places`: as of `Scene.at`."""
    revolution = SlopedRevolution(_with_slopes(scene), grid, scene, places=places)
    values = revolution.moving.motion if {*scene.to} <= {*MOTION} else _all_inputs(revolution.sampled())
    for name, value in values.items():
        for parameter, slope in slopes_of(value).items():
            yield Slope(name, parameter, as_field(value_of(slope)))


def _all_inputs(sampled: Scene) -> dict[str, Any]:
    """Return the numbers of motion, machine and loads of a scene at some angles, by name."""
    values = sampled.motion | sampled.mechanism.parameters()
    if "section" in values:
        values |= sampled.mechanism.beam_numbers()
    for k, load in enumerate(sampled.loads, 1):
        values |= load.parameters(f"load{k}", values)
    return values


# ------------------------------------------------------------------------------------------ numbers with slopes


def _with_slopes(scene: Differentiated) -> Scene:
    """Return the scene, its parameters with slopes; those that change over the angle stay as they are."""
    index = scene.mechanism.index

    def converted(path: str, value: Any) -> Any:
        if path in scene.to:
            return Sloped(value_of(value), {path: 1.0})
        constant = path in scene.arrays and index not in scene.arrays[path].dims
        return Sloped(value_of(value), {}) if constant else value

    return _converted(scene.plain, "", converted)


def _converted(owner: Any, prefix: str, convert: Callable[[str, Any], Any]) -> Any:
    """Return a copy of a dataclass with its numbers converted, skipping validation."""
    parts = ((name, kind, getattr(owner, name)) for name, kind, _ in declared(owner))
    return with_sound(
        owner, **{name: _converted_value(part, prefix + name, kind, convert) for name, kind, part in parts}
    )


def _converted_value(value: Any, path: str, kind: FieldKind, convert: Callable[[str, Any], Any]) -> Any:
    if has_fields(value):
        return _converted(value, below(path, kind), convert)
    if isinstance(value, tuple | list):
        kinds = kind.items(value) or (kind,) * len(value)
        items = enumerate(zip(value, kinds, strict=True), 1)
        return tuple(_converted_value(item, f"{path}[{k}]", each, convert) for k, (item, each) in items)
    return convert(path, value) if isinstance(kind, NumberField) else value


@dataclass(frozen=True, eq=False)
class SlopedRevolution(Revolution):
    """A scene of numbers with slopes and the angles of a grid; `original` is the scene with plain numbers."""

    original: Differentiated

    @property
    def moving(self) -> Scene:
        """Scene with its motion alone evaluated at the angles, with slopes."""
        return with_sound(self.scene, omega2=self.omega2, alpha2=self.alpha2)

    @property
    def angles(self) -> Any:
        """Angles of the grid [degree], with their slope to the crank angle."""
        return self._turned(xr.Variable(self.grid.dim, self.grid.angles), np.degrees(1.0))

    @cached_property
    def alpha2(self) -> Number:
        """Angular acceleration of the crank; where it follows from omega2, dα/dθ = (dω/dθ)² + ω d²ω/dθ²."""
        if self.scene.alpha2 is not None or not self.original.changes_speed:
            return super().alpha2
        omega, slope, curvature = self._over_angle("omega2", self.original.omega2, OMEGA2)
        return self._turned(omega * slope, slope * slope + omega * curvature)

    @property
    def turning(self) -> Number:
        """1 for a crank that turns counter-clockwise, -1 for clockwise."""
        return Sloped(value_of(1.0 - 2.0 * (value_of(self.omega2) < 0.0)), {})

    def sample(self, path: str, value: Any, rule: Rule) -> Any:
        """Return the parameter at a path, evaluated at the angles if it changes with them."""
        if value is None or isinstance(value, Sloped | float):
            return value
        if ANGLE not in self.original.to:
            plain = Revolution(self.original.plain, self.grid, places=self.places)
            return Sloped(value_of(plain.sample(path, value, rule)), {})
        return self._turned(*self._over_angle(path, value, rule)[:2])

    def sample_length(self, path: str, length: Any) -> tuple[Number, Number, Number]:
        """Return a length that changes with theta2 at the angles, and its derivatives [m/rad, m/rad²]."""
        value, slope, curvature = self._over_angle(path, length, LENGTH)
        if ANGLE not in self.original.to:
            return value, slope, curvature
        curve, turn = self.original.curves.get(path), self.mechanism.period
        third = third_derivative(path, length, LENGTH, self.grid, turn, curve, self.places)
        return self._turned(value, slope), self._turned(slope, curvature), self._turned(curvature, value_of(third))

    def stroke(self, name: str, stroke_of: Callable[[Scene, str], Stroke]) -> Stroke:
        """Return the stroke of a position by its name, its constants with slopes."""
        stroke = _stroke(self.mechanism, self.original.plain, name)
        return replace(stroke, start=self._end(stroke)) if stroke.from_end else stroke

    def kinematics(self, *names: str) -> list[Any]:
        """Return quantities over the angles, of those that angles and lengths alone decide, with slopes."""
        own = self._alone(names)
        alone = own.at(self.grid)
        derivatives = {name: {p: derivative_of(name, p) for p in own.to} for name in names}
        every = (*names, *(derivative for own in derivatives.values() for derivative in own.values()))
        inputs = alone.inputs
        results = evaluate(plan(alone.table, every, inputs.forms), inputs.fields, self.grid, inputs.sizes)
        number = {name: value_of(xr.Variable(*field)) for name, field in results.items()}
        return [Sloped(number[name], {p: number[own] for p, own in derivatives[name].items()}) for name in names]

    def _alone(self, names: tuple[str, ...]) -> Differentiated:
        """Return the mechanism alone with derivatives of quantities to its own parameters, and to the angle."""
        alone = self.original.unloaded
        own = {f"loads[{k}]" for k in range(1, len(self.scene.loads) + 1)} | {"omega2", "alpha2", "gravity"}
        to = tuple(p for p in self.original.to if p.partition(".")[0] not in own and not p.startswith("gravity"))
        return Differentiated(**{name: getattr(alone, name) for name in OWN}, of=names, to=to)

    def _end(self, stroke: Stroke) -> Sloped:
        """Return the largest value of a stroke's quantity, with its slopes at the crank angle where it turns round; NaN
        where it is largest at an end of the motion, where slopes are infinite."""
        alone = self._alone((stroke.quantity,))
        sizes = alone.at_one_angle.inputs.sizes
        designs, dims = np.arange(math.prod(sizes.values())), tuple(sizes)
        shape = tuple(sizes.values())

        def of_designs(number: Any) -> np.ndarray:
            return np.broadcast_to(aligned(as_field(number), dims), shape).ravel()

        angles = [np.zeros(len(designs)), *(np.nan_to_num(of_designs(angle)) for angle in stroke.turning)]
        heights = np.stack([quantities_at(alone, (stroke.quantity,), designs, row)[0] for row in angles])
        largest = of_designs(stroke.start)
        away = np.nan_to_num(np.abs(heights - largest), nan=np.inf)
        nearest = np.argmin(away, axis=0)
        angle, turns = np.stack(angles)[nearest, designs], away[nearest, designs] <= ROUNDING * np.abs(largest)
        slopes = (own for own in alone.to if own != ANGLE)
        numbers = {p: quantities_at(alone, (derivative_of(stroke.quantity, p),), designs, angle)[0] for p in slopes}
        known = {p: np.where(turns | (own == 0.0), own, np.nan).reshape(shape) for p, own in numbers.items()}
        return Sloped(value_of(stroke.start), {p: value_of(xr.Variable(dims, own)) for p, own in known.items()})

    def _over_angle(self, path: str, value: Any, rule: Rule) -> tuple[Any, Any, Any]:
        """Return a function of theta2, or an array over it, at the angles, and two derivatives [1/rad, 1/rad²]."""
        curve, turn = self.original.curves.get(path), self.mechanism.period
        own = curve_with_derivatives(path, value, rule, self.grid, turn, curve, self.places)
        value, slope, curvature = map(value_of, own)
        return value, slope, curvature

    def _turned(self, value: Any, slope: Any) -> Sloped:
        """Return a number with its slope to the crank angle, where that is a parameter."""
        return Sloped(value, {ANGLE: slope} if ANGLE in self.original.to else {})
