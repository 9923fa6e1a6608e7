"""Springs and dampers along the line between two points of links, or of a link and the ground."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from linksweep.base.degrees import cos_sin
from linksweep.base.fields import POLAR_POINT, FieldKind, ListField, NumberField, field_problems, of_kind, parameter
from linksweep.base.validate import Number, Rule
from linksweep.chains.rows.bodies import Body, Source, xy
from linksweep.chains.rows.load_forms import Acting, Applied
from linksweep.engine.quantity import Quantity, Row, Total
from linksweep.physics import springs
from linksweep.physics.algebra import planar
from linksweep.scene.loads.action import Action, register
from linksweep.scene.loads.ends import GROUND, Between, link_problems

LENGTH = NumberField(Rule("length"))
End = tuple[str, Number, Number]


class EndField(ListField):
    """A field that holds the end of a spring: a point of the ground, or of a link in its polar coordinates."""

    requirement = '("ground", x, y) in m, or (link, distance in m, angle in degrees)'

    def items(self, value: Any) -> tuple[FieldKind, ...] | None:
        if not (isinstance(value, tuple | list) and len(value) == 3):
            return None
        ground = isinstance(value[0], str) and value[0] == GROUND
        return (FieldKind(), *((LENGTH, LENGTH) if ground else POLAR_POINT.numbers))


@dataclass(frozen=True, eq=False, repr=False)
class _Line(Action):
    """A load along the line between two points."""

    from_: End = of_kind(EndField(example='["ground", 0.3, 0]'))
    to: End = of_kind(EndField(example='["rocker", "10 cm", 15]'))

    damps: ClassVar[bool] = False
    """True where its force grows with the speed."""

    def problems(self, path: str, links: tuple[str, ...]) -> list[str]:
        """Return the problems of the load on a machine of these links."""
        return field_problems(self, path + ".") or link_problems(path, "[1]", self.from_[0], self.to[0], links)

    @property
    def form(self) -> LineForm:
        """Form of its rows."""
        return LineForm(self.from_[0], self.to[0], self.damps)

    def approaches(self, name: str) -> tuple[tuple[str, str], ...]:
        """Return the names of the quantities that locate where its ends come closest."""
        return (approach(name),)

    def ends(self, name: str) -> dict[str, Number]:
        """Return the ends' numbers: in ground axes from A, or in their links' axes from their first pins."""
        return _end_parameters(f"{name}_from", self.from_) | _end_parameters(f"{name}_to", self.to)


@register
@dataclass(frozen=True, eq=False, repr=False)
class Spring(_Line):
    """A linear spring between two points: tension rate·(length − free_length).

    Parameters
    ----------
    from_ : tuple
        One end, on another link than `to`: ("ground", x [m], y [m]) in ground axes from A, or (link, distance [m],
        angle [degree]) in the link's own polar coordinates, from its first pin.
    to : tuple
        The other end [m], [degree], likewise.
    rate : float or DataArray
        Spring rate [N/m].
    free_length : float or DataArray
        Length without force [m]; a longer spring pulls, a shorter one pushes.

    Notes
    -----
    With the spring as first load a scene has `load1_length` [m], `load1_tension` [N] and `load1_power` [W] as
    quantities; the number is that of the load in the scene. The scene checks its values, and raises ValueError. With
    its ends in one point a spring has no direction: its force is 0 there.

    Examples
    --------
    >>> import linksweep as ls
    >>> from dataclasses import replace
    >>> spring = ls.Spring(from_=("ground", 0.3, 0.0), to=("rocker", 0.1, 0.0), rate=2000.0, free_length=0.05)
    >>> worst = ls.peaks(replace(ls.example("press"), loads=[spring]), of=["load1_tension"])
    >>> round(float(worst.load1_tension_max), 1)  # N
    272.4
    """

    rate: Number = parameter("spring_rate", at_least=0.0)
    free_length: Number = parameter("length", at_least=0.0)

    def parameters(self, name: str, machine: Mapping[str, Any]) -> dict[str, Number]:
        """Return the load's numbers under the names that its rows take."""
        return {f"{name}_rate": self.rate, f"{name}_free_length": self.free_length} | self.ends(name)


@register
@dataclass(frozen=True, eq=False, repr=False)
class Damper(_Line):
    """A viscous damper between two points: tension coefficient · rate of its length.

    Parameters
    ----------
    from_ : tuple
        One end, on another link than `to`: ("ground", x [m], y [m]) in ground axes from A, or (link, distance [m],
        angle [degree]) in the link's own polar coordinates, from its first pin.
    to : tuple
        The other end [m], [degree], likewise.
    coefficient : float or DataArray
        Damping coefficient [N s/m].

    Notes
    -----
    With the damper as first load a scene has `load1_length` [m], `load1_tension` [N] and `load1_power` [W] as
    quantities; the number is that of the load in the scene. The scene checks its values, and raises ValueError. With
    its ends in one point its force is 0.

    Examples
    --------
    >>> import linksweep as ls
    >>> from dataclasses import replace
    >>> damper = ls.Damper(from_=("ground", 0.3, 0.0), to=("rocker", 0.1, 0.0), coefficient=150.0)
    >>> worst = ls.peaks(replace(ls.example("press"), loads=[damper]), of=["load1_tension"])
    >>> round(float(worst.load1_tension_max), 1)  # N
    145.1
    """

    coefficient: Number = parameter("damping_coefficient", at_least=0.0)

    damps: ClassVar[bool] = True

    def parameters(self, name: str, machine: Mapping[str, Any]) -> dict[str, Number]:
        """Return the load's numbers under the names that its rows take."""
        return {f"{name}_coefficient": self.coefficient} | self.ends(name)


def _end_parameters(name: str, end: End) -> dict[str, Number]:
    if end[0] == GROUND:
        return {f"{name}_x": end[1], f"{name}_y": end[2]}
    cos, sin = cos_sin(end[2])
    return {f"{name}_at_x": end[1] * cos, f"{name}_at_y": end[1] * sin}


@dataclass(frozen=True)
class LineForm(Between):
    """The rows of a force along the line between two points."""

    def rows(self, name: str, bodies: dict[str, Body]) -> list[Row | Total]:
        unit, pull, line, speed = xy(f"{name}_u"), xy(f"{name}_from_F"), xy(f"{name}_d"), xy(f"{name}_dv")
        rows = [row for end, link in self.ends(name) for row in _end_rows(end, bodies[link])]
        return [
            *rows,
            Row(planar.difference, line, (*xy(f"{name}_to_"), *xy(f"{name}_from_"))),
            Row(planar.square, (f"{name}_length_squared",), line),
            Row(planar.root, (f"{name}_length",), (f"{name}_length_squared",)),
            Row(springs.line_direction, unit, (*line, f"{name}_length")),
            Row(planar.difference, speed, self._of_ends(name, "v")),
            Row(planar.dot, (f"{name}_lengthening",), (*unit, *speed)),
            self._tension(name),
            Row(planar.along, pull, (f"{name}_tension", *unit)),
            *(Row(planar.opposite, (f"{name}_to_F{axis}",), (f"{name}_from_F{axis}",)) for axis in "xy"),
            Row(springs.resisting_power, (f"{name}_power",), (f"{name}_tension", f"{name}_lengthening")),
            *self._approach(name, line),
        ]

    def _approach(self, name: str, line: tuple[str, str]) -> list[Row | Total]:
        """Return the rows that tell where its ends come closest as the crank turns, and how narrow that is."""
        ratio, (slope, width) = xy(f"{name}_du"), approach(name)
        return [
            Row(planar.difference, ratio, self._of_ends(name, "u")),
            Row(planar.dot, (slope,), (*line, *ratio)),
            Row(springs.turning_width, (width,), (f"{name}_length", *ratio)),
        ]

    def _of_ends(self, name: str, vector: str) -> tuple[Source, ...]:
        """Return the names of a vector at both ends, that of `to` first; 0 on the ground."""
        links = {"to": self.to, "from": self.from_}.items()
        to, from_ = ((0.0, 0.0) if link == GROUND else xy(f"{name}_{end}_{vector}") for end, link in links)
        return (*to, *from_)

    def _tension(self, name: str) -> Row:
        if self.damps:
            return Row(planar.product, (f"{name}_tension",), (f"{name}_coefficient", f"{name}_lengthening"))
        inputs = (f"{name}_rate", f"{name}_free_length", f"{name}_length")
        return Row(springs.spring_tension, (f"{name}_tension",), inputs)

    def on(self, name: str, link: str) -> Acting:
        ends = [end for end, role in self.ends(name) if role == link]
        return Acting(tuple(f"{end}_F" for end in ends), tuple(f"{end}_moment" for end in ends))

    def applied(self, name: str, link: str) -> tuple[Applied, ...]:
        ends = [end for end, role in self.ends(name) if role == link]
        return tuple(Applied(f"{end}_F", at=(f"{end}_at_x", f"{end}_at_y")) for end in ends)

    def quantities(self, name: str) -> list[Quantity]:
        return [
            Quantity(f"{name}_length", "m", f"distance between the ends of {self.title(name)}"),
            Quantity(f"{name}_tension", "N", f"tension of {self.title(name)}, negative where it pushes its ends apart"),
            Quantity(f"{name}_power", "W", f"power of {self.title(name)}, positive when it feeds the mechanism"),
        ]


def approach(name: str) -> tuple[str, str]:
    """Return the names of l·dl/dθ2, which rises through 0 where the ends come closest, and of the width there."""
    return f"{name}_approach", f"{name}_width"


def _end_rows(end: str, body: Body) -> list[Row | Total]:
    """Return the rows of an end on a moving link: its position and velocity, moment and power of the force on it."""
    arm, force, velocity = xy(f"{end}_r"), xy(f"{end}_F"), xy(f"{end}_v")
    return [
        Row(planar.to_ground_axes, arm, (*xy(f"{end}_at_"), *body.axes)),
        Row(planar.vector_sum, xy(f"{end}_"), (*body.pin_position, *arm)),
        Row(planar.point_velocity, velocity, (*body.pin_velocity, f"omega{body.number}", *arm)),
        Row(planar.point_velocity, xy(f"{end}_u"), (*body.pin_ratio, body.ratio, *arm)),
        Row(planar.cross, (f"{end}_moment",), (*arm, *force)),
        Row(planar.dot, (f"{end}_power",), (*force, *velocity)),
    ]
