"""Loads: a force at a point of a link, a torque on a link, or both."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from linksweep.base.degrees import cos_sin
from linksweep.base.fields import (
    ANYTHING,
    POLAR_POINT,
    PairField,
    RowField,
    choice,
    field_problems,
    of_kind,
    parameter,
    word,
)
from linksweep.base.frozen import normalise, with_sound
from linksweep.base.units import unit_problems
from linksweep.base.validate import Number, Rule, choice_problems, quote
from linksweep.chains.rows.bodies import Body
from linksweep.chains.rows.load_forms import Acting, Applied, Form
from linksweep.engine.quantity import Row, Total
from linksweep.mechanisms import Mechanism
from linksweep.mechanisms.strokes import Stroke, kind_of_position
from linksweep.physics.algebra import planar
from linksweep.scene.curves.over_position import KINDS as POSITION_KINDS
from linksweep.scene.curves.over_position import POSITION, at_positions, corners, is_function, is_table, table_problems
from linksweep.scene.loads.action import register
from linksweep.scene.loads.changing_load import BREAKS, ChangingLoad
from linksweep.scene.revolution import Revolution
from linksweep.scene.strokes import stroke_of

FORCE = Rule("force", over_angle=True)
TORQUE = Rule("torque", over_angle=True)
COMPONENTS = PairField(FORCE, FORCE, "(Fx, Fy) in N, each a number, a DataArray or a function of theta2", or_first=True)
AT_ANGLES: dict[str, Any] = {"over": None, "while_": None, "breaks": (), "interpolation": None}
"""Fields of a load over a position once it is sampled at crank angles."""


@register
@dataclass(frozen=True, eq=False, repr=False)
class Load(ChangingLoad):
    """A force at a point of a link, a torque on it, or both, besides weight and inertia.

    Parameters
    ----------
    link : str
        The link that it acts on: "crank", "coupler", "rocker", "rod", "slider" or "block"; of a `Linkage` its name.
    force : pair of float, DataArray or function, default None
        (Fx, Fy) [N]; None for no force. On a slider also one number, along its guide (frame "link").
    at : pair of float or DataArray, default (0.0, 0.0)
        Point of action of force and torque in the link's own polar coordinates: distance [m], angle from its line of
        pins [degree]. That of a torque matters for section forces alone.
    frame : str, default "ground"
        Axes of the force: "ground", or "link" (x along the link's line of pins).
    torque : float, DataArray or function, default None
        Torque [N m], positive counter-clockwise; None for no torque.
    origin : str, default "pin"
        Origin of `at`: the link's first "pin", or its centre of gravity, "cg".
    breaks : list of float, default ()
        Angles theta2 [degree] at which force or torque jumps, or is narrower than 0.02 degrees: exact peaks look at
        both sides of each, and closely between them. Positions [m] or [degree] of a load over a position.
    interpolation : str, default None
        Curve through DataArrays over theta2, between their angles: "periodic cubic" (a spline; for None), "pchip"
        (monotone between neighbours, does not ring), "linear", or "step" (each value holds up to the next angle).
    over : str, default None
        Position that force and torque follow in place of the crank angle: of a `SliderCrank` "slider.position"
        (`x_slider`, along the guide from the foot of A on it) or "slider.to_end" (distance to the outer dead centre,
        where crank and rod are stretched) [m]; of a `FourBar` "rocker.angle" (`theta4`) [degree]; of an
        `InvertedSliderCrank` "block.position" (`slide`) [m]. Of a `Linkage`, by the name of the part, "ram.position"
        and "ram.to_end" (distance to the farthest position along the guide) of a slider on the ground, "block.position"
        of one on a link (`x_block`), "rocker.angle" of a link on a ground pin, "c1.length" of a cylinder.
    while_ : str, default None
        Direction of motion in which it acts: of a slider "closing" (towards its outer dead centre, or along its guide)
        or "opening"; of a block (away from the rocker's pivot, or along its line) and of a cylinder "extending" or
        "retracting"; of a rocker "counter-clockwise" or "clockwise". None for both.

    Warns
    -----
    OvershootWarning
        Where a spline leaves its data's range by more than 1 % of it, when it is first used; one through steps rings.

    Notes
    -----
    The scene that takes the load checks its values, and raises ValueError. DataArrays have design dims; those of force
    and torque may have theta2, too, and their values come back to the bit at angles that they hold. Their period is
    one turn, or as many turns as their angles span (two in a four-stroke engine): then theta2 of the whole scene spans
    as many.

    Over a position, force and torque are numbers, DataArrays over the dim "position" alone [m] or [degree], or
    functions of it. A DataArray is interpolated "linear" (by default), "pchip" or "step"; beyond its ends its end
    values hold. Each design has its own crank angles for it: exact peaks look at both sides of those where an array
    bends or jumps, and where the link reverses. Of a linkage these are found between samples each quarter of a degree.

    Sensitivities take the slope of a function as the limit of its differences (C. J. F. Ridders' extrapolation): where
    the function is smooth, their derivatives err by less than 4e-13.

    Examples
    --------
    >>> import linksweep as ls
    >>> from dataclasses import replace
    >>> push = ls.Load("coupler", force=(0.0, -80.0), at=(0.10, 15.0))
    >>> scene = replace(ls.example("press"), loads=[push])
    >>> round(float(ls.peaks(scene, of=["F43"]).F43_peak), 1)  # N
    169.9

    A press pushes over the last 12 mm before its outer dead centre, whatever its offset.

    >>> import xarray as xr
    >>> push = xr.DataArray([-50e3, 0.0], {"position": [0.0, 0.012]}, "position")
    >>> press = ls.Load("slider", force=push, over="slider.to_end", while_="closing", interpolation="step")
    """

    link: str = word('"coupler"')
    force: Sequence[Number] | Number | None = of_kind(COMPONENTS, None)
    at: Sequence[Number] = of_kind(POLAR_POINT, (0.0, 0.0))
    frame: str = choice("ground", "link")
    torque: Number | None = parameter("torque", None, over_angle=True)
    origin: str = choice("pin", "cg")
    breaks: Sequence[float] = of_kind(ANYTHING, ())  # angles or positions: `over` says which
    interpolation: str | None = None
    over: str | None = None
    while_: str | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        normalise(self, breaks=self._breaks_kind.converted(self.breaks))

    @property
    def _breaks_kind(self) -> RowField:
        return BREAKS if self.over is None else RowField(Rule(kind_of_position(str(self.over))))

    @property
    def changing(self) -> tuple[Any, ...]:
        """The numbers that may change over the revolution."""
        components = self.force if isinstance(self.force, tuple | list) else ()
        return (*components, self.torque)

    @property
    def over_positions(self) -> tuple[Any, ...]:
        """Tables and functions of a position."""
        curves = () if self.over is None else self.changing
        return tuple(number for number in curves if is_table(number) or is_function(number))

    @property
    def form(self) -> LoadForm:
        """Form of its rows."""
        return LoadForm(self.link, self.force is not None, self.torque is not None, self.frame == "link")

    def problems(self, path: str, links: tuple[str, ...]) -> list[str]:
        """Return the problems of the load on a machine of these links."""
        problems = choice_problems(f"{path}.link", self.link, links)
        problems += self.interpolation_problems(path) + self._position_problems(path)
        problems += self._breaks_kind.problems(f"{path}.breaks", self.breaks)
        if self.force is None and self.torque is None:
            problems.append(f"{path} has neither force nor torque: give force=(Fx, Fy), torque=..., or both")
        return problems + field_problems(self, path + ".")

    @property
    def on_centre_of(self) -> str:
        """The link with whose centre of gravity its place moves; "" for none."""
        return self.link if self.origin == "cg" else ""

    def for_machine(self, mechanism: Mechanism) -> Load:
        """Return the load on this mechanism: one number on a slider is a force along its guide."""
        on_slider = isinstance(self.link, str) and self.link in mechanism.sliders  # an array compares each element
        alone = on_slider and COMPONENTS.may_be_first(self.force)
        return replace(self, force=(self.force, 0.0), frame="link") if alone else self

    def misfits(self, path: str, mechanism: Mechanism) -> list[str]:
        """Return why this mechanism cannot take the load, which is valid in itself."""
        if self.over is None:
            return []
        if both := [*mechanism.both_branches.values()]:
            advice = f'give {both[0]}="open" or "crossed"'
            return [f"{path}.over = {quote(self.over)}: is a position of one branch; {advice}"]
        if not mechanism.strokes:
            kind = type(mechanism).__name__
            return [f"{path}.over = {quote(self.over)}: a {kind} has no positions to follow; give the load over theta2"]
        problems = choice_problems(f"{path}.over", self.over, mechanism.strokes)
        if problems:
            return problems
        stroke = mechanism.strokes[self.over]
        for at, number in self._changing_at(path):
            unit = number[POSITION].attrs.get("units") if is_table(number) else None
            problems += unit_problems(f"{at}.{POSITION}", unit, stroke.kind)
        return problems + ([] if self.while_ is None else choice_problems(f"{path}.while_", self.while_, stroke.words))

    def _position_problems(self, path: str) -> list[str]:
        if self.over is None:
            advice = 'give the position that it means, as in over="slider.position"'
            return [] if self.while_ is None else [f"{path}.while_ = {quote(self.while_)}: {advice}"]
        known = self.interpolation is None or self.interpolation in POSITION_KINDS
        periodic = [] if known else choice_problems(f"{path}.interpolation", self.interpolation, POSITION_KINDS)
        return periodic + [p for at, number in self._changing_at(path) for p in table_problems(at, number)]

    def _changing_at(self, path: str) -> list[tuple[str, Any]]:
        """Return the numbers that may change over the revolution, with their paths."""
        forces = [(f"{path}.force[{k}]", force) for k, force in enumerate(self.changing[:-1], 1)]
        return [*forces, (f"{path}.torque", self.torque)]

    def jumps(self, mechanism: Mechanism) -> tuple[Number, ...]:
        """Return the crank angles [degree] at which a force or torque over these jumps, kinks or is narrow."""
        return super().jumps(mechanism) if self.over is None else ()

    def jumps_along(self, stroke_of: Callable[[str], Stroke]) -> tuple[Number, ...]:
        """Return the crank angles [degree] at which a force or torque over a position jumps, kinks or is narrow."""
        if self.over is None:
            return ()
        stroke = stroke_of(self.over)
        places = {*self.breaks, *(place for number in self.changing for place in corners(number, self.interpolation))}
        reached = (angle for place in sorted(places) for angle in stroke.reached(place))
        return (*reached, *(stroke.turning if self.while_ else ()))

    def sampled(self, path: str, revolution: Revolution) -> Load:
        """Return the load with all that changes over the revolution at its angles."""
        following = self.over is not None
        if not following and {*map(type, self.changing)} <= {float, type(None)}:
            return self
        sample = partial(self._followed, *self._positions(revolution)) if following else revolution.sample
        rules = (FORCE, FORCE, TORQUE) if self.force else (TORQUE,)
        *force, torque = (
            sample(at, number, rule) for (at, number), rule in zip(self._changing_at(path), rules, strict=True)
        )
        values = {"force": self.force and tuple(force), "torque": torque}
        return with_sound(self, **values) if self.over is None else with_sound(self, **values, **AT_ANGLES)

    def _positions(self, revolution: Revolution) -> tuple[str, Any, Number]:
        """Return the kind of the positions, the positions over the angles, and 1 where the load acts, 0 elsewhere."""
        stroke = revolution.stroke(str(self.over), stroke_of)
        quantity, slope = revolution.kinematics(stroke.quantity, stroke.slope)
        positions = stroke.start + stroke.sense * quantity
        if self.while_ is None:
            return stroke.kind, positions, 1.0
        forward = slope * (revolution.turning * stroke.forward)
        acting = forward > 0.0 if self.while_ == stroke.words[0] else forward < 0.0
        return stroke.kind, positions, 1.0 * acting

    def _followed(self, kind: str, positions: Any, acts: Number, path: str, number: Any, rule: Rule) -> Any:
        """Return a force or torque over the angles; one that is 0 at every position stays a number."""
        if number is None or (isinstance(number, float) and number == 0.0):
            return number
        followed: Any = at_positions(path, number, rule, positions, kind, self.interpolation) * acts
        # where it cannot be assembled there is no position; a plain number acts at every angle
        return followed.fillna(0.0) if hasattr(followed, "fillna") else followed

    def parameters(self, load: str, machine: Mapping[str, Any]) -> dict[str, Number]:
        """Return the load's numbers under the names that its rows take; `machine` has its link's centre of gravity."""
        named: dict[str, Any] = {}
        if self.force is not None:
            component = f"{load}_force_" if self.frame == "link" else f"{load}_F"
            named |= {component + "x": self.force[0], component + "y": self.force[1]}
        if self.torque is not None:
            named[f"{load}_torque"] = self.torque
        cos, sin = cos_sin(self.at[1])
        cg = machine[f"{self.link}_cg_x"], machine[f"{self.link}_cg_y"]
        from_x, from_y = cg if self.origin == "cg" else (0.0, 0.0)
        return named | {f"{load}_at_x": from_x + self.at[0] * cos, f"{load}_at_y": from_y + self.at[0] * sin}


@dataclass(frozen=True)
class LoadForm(Form):
    """The rows of a force at a point of a link, a torque on it, or both."""

    link: str
    force: bool
    torque: bool
    link_axes: bool
    full_turns: bool = False

    @property
    def place(self) -> str:
        return self.link

    def rows(self, name: str, bodies: dict[str, Body]) -> list[Row | Total]:
        body = bodies[self.link]
        power = Row(planar.product, (f"{name}_torque_power",), (f"{name}_torque", f"omega{body.number}"))
        return [power, *(self._force_rows(name, body) if self.force else [])]

    def on(self, name: str, link: str) -> Acting:
        if link != self.link:
            return Acting()
        moments = self._of_force(f"{name}_moment") + self._of_torque(f"{name}_torque")
        return Acting(self._of_force(f"{name}_F"), moments)

    def applied(self, name: str, link: str) -> tuple[Applied, ...]:
        if link != self.link:
            return ()
        at = f"{name}_at_x", f"{name}_at_y"
        return (Applied(f"{name}_F" if self.force else "", f"{name}_torque" if self.torque else "", at),)

    def powers(self, name: str) -> tuple[str, ...]:
        return self._of_force(f"{name}_force_power") + self._of_torque(f"{name}_torque_power")

    def _of_force(self, name: str) -> tuple[str, ...]:
        return (name,) if self.force else ()

    def _of_torque(self, name: str) -> tuple[str, ...]:
        return (name,) if self.torque else ()

    def _force_rows(self, name: str, body: Body) -> list[Row | Total]:
        point, force = (f"{name}_rx", f"{name}_ry"), (f"{name}_Fx", f"{name}_Fy")
        velocity = (f"{name}_vx", f"{name}_vy")
        rows: list[Row | Total] = [
            Row(planar.to_ground_axes, point, (f"{name}_at_x", f"{name}_at_y", *body.axes)),
            Row(planar.cross, (f"{name}_moment",), (*point, *force)),
            Row(planar.point_velocity, velocity, (*body.pin_velocity, f"omega{body.number}", *point)),
            Row(planar.dot, (f"{name}_force_power",), (*force, *velocity)),
        ]
        if self.link_axes:
            rows.append(Row(planar.to_ground_axes, force, (f"{name}_force_x", f"{name}_force_y", *body.axes)))
        return rows
