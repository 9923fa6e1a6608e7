"""Motion of a machine made of a crank and dyads, from the crank on.

A dyad closes between pins and guides that have their places, and places the other pins of its links.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping

from linksweep.chains import cylinders, gears, lines, slides
from linksweep.chains.dyads import rrp, rrr
from linksweep.chains.dyads.names import (
    RATES,
    Names,
    Vector,
    direction_of,
    frame_of,
    full,
    full_of_point,
    of_force,
    of_link,
    of_pin,
    sliding_of,
)
from linksweep.chains.dyads.rrr import Rows
from linksweep.chains.rows.bodies import CRANK, Body, Source, crank_pin_rows, xy
from linksweep.chains.shape import ORIGIN, Arm, Arms, Frame, Shape
from linksweep.chains.topology import GROUND, RPR, RRP, RRR, Side, Step
from linksweep.engine.quantity import Quantity, Row
from linksweep.physics import crank_driven
from linksweep.physics.algebra import planar
from linksweep.physics.closures import pins


class Motion:
    """Rows of all steps of a machine of some shape."""

    def __init__(self, shape: Shape):
        self.shape, self.topology, self.plain = shape, shape.topology, shape.plain
        self.rows: Rows = []
        self.bodies: dict[str, Body] = {}
        self.frames: dict[str, Frame] = {}
        self.arms = Arms(self)
        self.names: dict[str, Names] = {}
        self.certain: dict[str, Source] = {}
        self._work: dict[str, list[str]] = defaultdict(list)
        self.sides: dict[str, tuple[Side, Side]] = {}
        self.sliding: dict[str, tuple[str, str, str]] = {}
        self.quantities: list[Quantity] = []
        self._crank()
        for step in self.topology.steps:
            getattr(self, f"_place_{type(step).__name__}")(step)
        for role in self.topology.cylinders:
            cylinders.place_cylinder(self, role)

    _place_RPP = slides.place_RPP
    _place_PRP = slides.place_PRP
    _place_RPR = lines.place_RPR
    _place_Gear = gears.place_Gear

    # ------------------------------------------------------------------------------------------------ names

    @property
    def work(self) -> tuple[str, ...]:
        """Terms of the virtual work of all that acts on the links, without friction, link by link."""
        return tuple(term for role in self.topology.roles for term in self._work[role])

    def number(self, role: str) -> int:
        return self.topology.number(role)

    def row(self, function: Callable, outputs: tuple[str, ...], *inputs: Source) -> None:
        self.rows.append(Row(function, outputs, inputs))

    def is_origin(self, pin: str) -> bool:
        return pin == self.topology.ground[0]

    def fixed(self, pin: str) -> bool:
        return self.topology.support.get(pin) == GROUND

    def pin(self, letter: str, pin: str) -> dict[str, Source]:
        return of_pin(letter, pin, self.fixed(pin), self.is_origin(pin))

    def place(self, pin: str) -> Vector:
        """Return the names of a pin's position."""
        return ORIGIN if self.is_origin(pin) else full(pin)

    def motion(self, pin: str, stem: str, ending: str = "") -> tuple[Source, Source]:
        """Return the names of a vector of a pin's motion, such as u or v; zeros for a fixed pin."""
        return (0.0, 0.0) if self.fixed(pin) else (f"{stem}{pin}x{ending}", f"{stem}{pin}y{ending}")

    def ratio(self, role: str) -> Source:
        return {GROUND: 0.0, self.topology.crank: 1.0}.get(role) or self.bodies[role].ratio

    def own(self, role: str, pin: str) -> Vector:
        """Return a pin's position in its link's own axes, with low words."""
        first, second, *_ = self.topology.links[role]
        if pin == first:
            return ORIGIN
        return (f"{role}_length", 0.0, 0.0, 0.0) if pin == second else full_of_point(pin)

    def arm(self, role: str, pin: str) -> tuple[Source, Source]:
        """Return the vector from a link's first pin to another; a slider has one pin only."""
        first, second, *_ = self.topology.links.get(role, (pin, ""))
        if pin == first:
            return (0.0, 0.0)
        return xy(f"r{self.number(role)}" if pin == second else f"r{self.number(role)}_{pin}")

    # ------------------------------------------------------------------------------------------------ motion

    def _crank(self) -> None:
        role = self.topology.crank
        pivot, pin = self.topology.links[role][:2]
        self.rows += Names("", {"crank_length": f"{role}_length"}, of_pin("B", pin)).placed(crank_pin_rows())
        words, low_words = (f"{role}_length", "cos2", "cos2_lo", "sin2", "sin2_lo"), (f"{pin}x_lo", f"{pin}y_lo")
        self.row(pins.crank_pin_low_words, low_words, *words)
        if not self.plain:
            self.certain |= dict.fromkeys(low_words, f"{role}_length")
        self.bodies[role] = Body(CRANK.number, role, steady=True, ratio=1.0)
        self.frames[role] = Frame(pivot, ("cos2", "sin2", "cos2_lo", "sin2_lo"), (1.0, 0.0, 0.0, 0.0))
        self.arms.add(pivot, pin, full(pin))
        self._carry(role, {pivot, pin})
        self._work[role].append("N2")

    def turn(self, side: Side, line: Vector, ratio: float) -> None:
        """Add rows of a link that turns at a steady ratio to the crank, by the direction of its line of pins."""
        self.link(side.role, Frame(side.pin, line, (1.0, 0.0, 0.0, 0.0)), {side.pin}, (ratio, 0.0))

    def link(self, role: str, frame: Frame, placed: set[str], turning: tuple[Source, Source] | None = None) -> None:
        """Add rows of a link that a dyad has placed: its rotation, its other pins, its work; and its body."""
        k, first = self.number(role), self.topology.links[role][0]
        ratio, slope = turning or (f"ratio{k}", f"slope{k}")
        self.frames[role] = frame
        self.row(planar.product, (f"omega{k}",), "omega2", ratio)
        self.row(crank_driven.angular_acceleration, (f"alpha{k}",), "omega2", "alpha2", ratio, slope)
        self.row(planar.direction, (f"theta{k}",), *xy(f"r{k}"))
        self._body(role, first, ratio, slope)
        self._carry(role, placed)

    def _body(self, role: str, pin: str, ratio: Source, slope: Source) -> None:
        """Add a body whose first pin is this, and the rows of its work."""
        k = self.number(role)
        u, u_slope = self.motion(pin, "u"), self.motion(pin, "u", "_slope")
        v, a = self.motion(pin, "v"), self.motion(pin, "a")
        self.bodies[role] = Body(
            k, role, v, a, False, (self.place(pin)[0], self.place(pin)[1]), ratio, slope, u, u_slope
        )
        if not self.fixed(pin):
            self.row(planar.dot, (f"pin_work{k}",), f"Q{k}x", f"Q{k}y", *u)
            self._work[role].append(f"pin_work{k}")
        if ratio != 0.0:
            self.row(planar.product, (f"turn_work{k}",), ratio, f"N{k}")
            self._work[role].append(f"turn_work{k}")

    def _carry(self, role: str, placed: set[str]) -> None:
        """Add rows of all pins of a placed link: their vectors from its first pin, and the places of its other pins."""
        k, frame = self.number(role), self.frames[role]
        first, second, *third = self.topology.links[role]
        carried = [pin for pin in (first, second, *third) if pin not in placed and self.topology.support[pin] == role]
        for pin in carried:
            self._carried(role, pin, frame)
        for pin in third:
            if pin not in carried or frame.pin != first:
                own, length = self.own(role, pin), f"{role}_length"
                self.row(planar.to_ground_axes, xy(f"r{k}_{pin}"), *own[:2], length, *xy(f"r{k}"))

    def _carried(self, role: str, pin: str, frame: Frame) -> None:
        """Add rows of a pin that its link carries."""
        k, start = self.number(role), frame.pin
        first, second, *_ = self.topology.links[role]
        own, quotient = full(f"own{k}_{pin}"), full(f"quotient{k}_{pin}")
        arm = full(f"r{k}_{pin}" if start == first and pin != second else f"r{k}_{start}_{pin}")
        self.row(pins.between, own, *self.own(role, pin), *self.own(role, start))
        self.row(pins.quotient, quotient, *own, *frame.own)
        self.row(pins.turned_with_low_words, arm, *quotient, *frame.vector)
        self.arms.add(start, pin, arm)
        self.row(pins.joined, full(pin), *self.place(start), *arm)
        if not self.plain:
            self.certain |= dict.fromkeys(full(pin)[2:], f"{role}_length")
        u, u_slope = self.motion(start, "u"), self.motion(start, "u", "_slope")
        ratio, slope = self.bodies[role].ratio, self.bodies[role].slope
        self.row(planar.point_velocity, xy(f"u{pin}"), *u, ratio, *arm[:2])
        self.row(planar.point_acceleration, (f"u{pin}x_slope", f"u{pin}y_slope"), *u_slope, ratio, slope, *arm[:2])
        self.rates(pin)

    def rates(self, pin: str) -> None:
        """Add rows of a pin's velocity and acceleration."""
        for axis in "xy":
            u = f"u{pin}{axis}"
            self.row(planar.product, (f"v{pin}{axis}",), "omega2", u)
            self.row(crank_driven.angular_acceleration, (f"a{pin}{axis}",), "omega2", "alpha2", u, f"{u}_slope")

    def _arm(self, side: Side, pin: str) -> Arm:
        """Return a dyad's link from its known pin to the pin that it places, and add rows that make its axes of it."""
        if side.role in self.topology.struts:
            return Arm(f"r_{side.role}", f"{side.role}_length", 0.0)
        role, k = side.role, self.number(side.role)
        first, second, *_ = self.topology.links[role]
        if (side.pin, pin) == (first, second):
            return Arm(f"r{k}", f"{role}_length", 0.0)
        if (pin, side.pin) == (first, second):
            for axis in "xy":
                self.row(planar.opposite, (f"r{k}{axis}",), f"s{k}{axis}")
            return Arm(f"s{k}", f"{role}_length", 0.0)
        own = full(f"own_arm{k}")
        self.row(pins.between, own, *self.own(role, pin), *self.own(role, side.pin))
        self.row(pins.distance, (f"{role}_arm", f"{role}_arm_lo"), *own)
        self.row(pins.quotient, full(f"line{k}"), *self.own(role, second), *own)
        self.row(pins.turned, xy(f"r{k}"), *xy(f"line{k}"), *xy(f"s{k}"))
        self.certain |= {f"{role}_arm": f"{role}_length"} | dict.fromkeys(xy(f"line{k}"), 1.0)
        return Arm(f"s{k}", f"{role}_arm", f"{role}_arm_lo")

    def _frame(self, side: Side, pin: str, arm: Arm) -> Frame:
        """Return how a dyad places its link: from its known pin to the pin where the dyad closes."""
        own = full(f"own_frame{self.number(side.role)}")
        self.row(pins.between, own, *self.own(side.role, pin), *self.own(side.role, side.pin))
        return Frame(side.pin, full(arm.stem), own)

    def close(
        self,
        step: Step,
        rows: Rows,
        certain: Mapping[str, Source],
        certain_beyond: Mapping[str, Source],
        *listed: Mapping[str, Source],
    ) -> None:
        """Add the rows of a dyad under their names in this machine."""
        crank = {"crank_length": f"{self.topology.crank}_length"}
        self.names[step.name] = names = self.names_of(step, crank, *listed)
        if rates := {names[name] for row in rows for name in row.outputs if name in RATES}:
            self.rows = [row for row in self.rows if rates.isdisjoint(row.outputs)]
        self.rows += names.placed(rows)
        for numbers in [certain] if self.plain else [certain, certain_beyond]:
            self.certain |= {str(names[name]): names.of(unit) for name, unit in numbers.items()}

    def names_of(self, step: Step, *listed: Mapping[str, Source]) -> Names:
        """Return the names of a dyad's rows: after a space its own, which no name of a pin or a part can equal."""
        if self.plain:
            return Names("", *listed)
        return Names(f" {step.name}", {"transmission_angle": f"transmission_angle_{step.name}"}, *listed)

    def measure(self, step: Step, words: str) -> None:
        """Add the quantity of a dyad's transmission angle."""
        self.quantities.append(Quantity(str(self.names[step.name]["transmission_angle"]), "degree", words))

    def slides_of(self, step: Step, role: str, inner: tuple[str, str, str], line: str, start: str) -> None:
        """Add the quantities of a part's motion along a line."""
        position, velocity, acceleration = (str(self.names[step.name][name]) for name in inner)
        self.sliding[role] = position, velocity, acceleration
        self.quantities += [
            Quantity(position, "m", f"position of the {role} along the {line}, from {start}"),
            Quantity(velocity, "m/s", f"velocity of the {role} along the {line}"),
            Quantity(acceleration, "m/s^2", f"acceleration of the {role} along the {line}"),
        ]

    def slides_on(self, step: Step, role: str, name: str, guide: str) -> None:
        """Add the quantities of a slider's motion along its guide; `name` is its own in its dyad."""
        inner = (f"x_{name}", f"v_{name}", f"a_{name}")
        self.slides_of(step, role, inner, "guide", f"the foot of {self._origin(guide)} on it")

    def _side_link(self, side: Side, pin: str, arm: Arm) -> None:
        """Add rows of a link from a known pin to the pin that its dyad finds; a strut is no body."""
        if side.role not in self.topology.struts:
            self.link(side.role, self._frame(side, pin, arm), {side.pin, pin})

    def _side(self, digit: int, word: str, side: Side, arm: Arm) -> dict[str, Source]:
        """Return the names of a dyad's link, of all that acts on it, and of its moment about the known pin."""
        if side.role in self.topology.struts:
            letter = "D" if digit == 4 else "B"
            strut = cylinders.side_of_strut(self, digit, letter, word, side)
            return {**of_link(digit, f"_{side.role}"), **strut}
        k = self.number(side.role)
        lengths = {f"{word}_length": arm.length, f"{word}_length_lo": arm.length_lo}
        vector = dict(zip(full(f"r{digit}"), full(arm.stem), strict=True))
        return of_link(digit, k) | lengths | vector | self.load(digit, k, f"L{k}_{side.pin}")

    def load(self, digit: int, number: int, moment: str) -> dict[str, Source]:
        return {f"Q{digit}x": f"acting{number}x", f"Q{digit}y": f"acting{number}y", f"N{digit}": moment}

    def on_crank_and_ground(self, step: Step) -> bool:
        """Return whether a dyad joins the crank's pin to the ground by links that are lines of pins.

        Such a dyad closes by the crank's angle, which leaves it more digits near a toggle, where the pivots' distance
        is a float.
        """
        links, crank_pin = self.topology.links, self.topology.links[self.topology.crank][1]
        if isinstance(step, RRR):
            known = {step.first.pin, step.second.pin}
            lines = all(
                side.role in links and {side.pin, step.pin} == {*links[side.role][:2]}
                for side in (step.first, step.second)
            )
            return lines and crank_pin in known and all(pin == crank_pin or self._off_origin(pin) for pin in known)
        if isinstance(step, RRP):
            line = step.link.role in links and {step.link.pin, step.pin} == {*links[step.link.role][:2]}
            exact = self.topology.hosts[step.guide] == GROUND and step.guide not in self.shape.between
            return line and step.link.pin == crank_pin and exact
        if isinstance(step, RPR):
            own_line = step.guide not in self.shape.inclined and step.link.pin == links[step.link.role][0]
            return own_line and step.pin == crank_pin and self._off_origin(step.link.pin)
        return False

    def _off_origin(self, pin: str) -> bool:
        return self.fixed(pin) and not self.is_origin(pin) and pin not in self.shape.between

    def _place_RRR(self, step: RRR) -> None:
        first, second, X = step.first, step.second, step.pin
        special = self.on_crank_and_ground(step)
        swapped = special and self.fixed(first.pin)
        coupler, rocker = (second, first) if swapped else (first, second)
        self.sides[step.name] = coupler, rocker
        arms = [self._arm(side, X) for side in (coupler, rocker)]
        self.rates(X)
        for side, arm in zip((coupler, rocker), arms, strict=True):
            self._side_link(side, X, arm)
        rows = rrr.on_crank_and_ground(step.name in self.shape.turned, step.name in self.shape.goes_through)
        self.close(
            step,
            rows if special else rrr.between_pins(),
            rrr.CERTAIN_ON_CRANK if special else rrr.CERTAIN,
            rrr.CERTAIN_BEYOND,
            self._swapped(step) if swapped else {},
            {} if self.plain else frame_of("ground", rocker.pin),
            self.pin("B", coupler.pin) | self.pin("D", rocker.pin) | of_pin("C", X),
            self._side(3, "coupler", coupler, arms[0]) | self._side(4, "rocker", rocker, arms[1]),
            of_force("F43", f"push_{rocker.role}_{X}"),
            of_force("F32", f"push_{coupler.role}_{coupler.pin}"),
            of_force("F14", f"hold_{rocker.role}"),
        )
        names = self.names[step.name]
        self.arms.apart(tuple(str(names[own]) for own in full("apart_BD")), coupler.pin, rocker.pin)
        for side, arm in zip((rocker, coupler), arms[::-1], strict=True):
            self.arms.add(side.pin, X, full(arm.stem))
        self.measure(step, f"acute angle between {first.role} and {second.role}")

    def _swapped(self, step: Step) -> dict[str, Source]:
        """Return the name of the branch's sign seen from the crank where the link on the ground is named first."""
        self.row(planar.opposite, (f"branch_sign_from_crank {step.name}",), f"branch_sign {step.name}")
        return {"branch_sign": f"branch_sign_from_crank {step.name}"}

    def _place_RRP(self, step: RRP) -> None:
        rod, X, slider, k = step.link, step.pin, step.slider, self.number(step.slider)
        special, host = self.on_crank_and_ground(step), self.topology.hosts[step.guide]
        arm, guide = self._arm(rod, X), self.guide(step.guide)
        self.rates(X)
        self._side_link(rod, X, arm)
        self.slider(slider, X, guide, host)
        self.close(
            step,
            rrp.on_crank_and_ground(step.name in self.shape.turned) if special else rrp.between_pin_and_guide(),
            rrp.CERTAIN_ON_CRANK if special else rrp.CERTAIN,
            rrp.CERTAIN_BEYOND,
            self.on_guide(step.guide, guide),
            self.pin("B", rod.pin) | of_pin("C", X),
            self._side(3, "rod", rod, arm) | of_link(4, k) | self.load(4, k, f"L{k}"),
            sliding_of("slider", slider),
            of_force("F43", f"push_{slider}_{X}"),
            of_force("F32", f"push_{rod.role}_{rod.pin}"),
            of_force("F14", f"hold_{slider}"),
        )
        self.measure(step, f"acute angle between the {rod.role} and the guide's normal")
        self.slides_on(step, slider, "slider", step.guide)

    def slider(self, role: str, pin: str, guide: Mapping[str, Source], host: str) -> None:
        """Add rows of a link that turns with its host: its axes along the guide and its rotation; and its body."""
        k, turning = self.number(role), self.turning(host)
        for axis, part in zip("xy", ("guide_cos", "guide_sin"), strict=True):
            self.row(planar.identity, (f"r{k}{axis}",), guide[part])
        for word in ("omega", "alpha"):
            self.row(planar.identity, (f"{word}{k}",), 0.0 if host == GROUND else f"{word}{self.number(host)}")
        self._body(role, pin, *turning)

    def turning(self, role: str) -> tuple[Source, Source]:
        """Return the names of a link's rotation per rate of the crank, and of its derivative."""
        return (0.0, 0.0) if role == GROUND else (self.bodies[role].ratio, self.bodies[role].slope)

    def on_guide(self, guide: str, names: Mapping[str, Source], letter: str = "O") -> dict[str, Source]:
        """Return the names of a guide, of its rotation, and of the origin of its axes: the first pin of its link, or
        the crank's pivot."""
        host = self.topology.hosts[guide]
        ratio, slope = self.turning(host)
        return {**names, "guide_ratio": ratio, "guide_slope": slope, **self.pin(letter, self._origin(guide))}

    def _origin(self, guide: str) -> str:
        host = self.topology.hosts[guide]
        return self.topology.ground[0] if host == GROUND else self.topology.links[host][0]

    def guide(self, guide: str) -> dict[str, Source]:
        """Return the names of a guide's direction, offset and friction, and add rows that turn it with its link."""
        host, own = self.topology.hosts[guide], direction_of(guide)
        words = ("guide_cos", "guide_sin", "guide_cos_lo", "guide_sin_lo")
        numbers: dict[str, Source] = {name: f"{guide}_{name}" for name in ("offset", "offset_lo", "friction")}
        if host == GROUND:
            return {word: word for word in words} if self.plain else numbers | dict(zip(words, own, strict=True))
        frame, turned = self.frames[host], full(f"direction_{guide}_")
        self.row(pins.quotient, full(f"quotient_{guide}_"), *own, *frame.own)
        self.row(pins.turned_with_low_words, turned, *full(f"quotient_{guide}_"), *frame.vector)
        self.certain |= dict.fromkeys(turned, 1.0)
        return numbers | dict(zip(words, turned, strict=True))
