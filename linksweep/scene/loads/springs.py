"""Springs and dampers between two links, or between a link and the ground."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from linksweep.base.degrees import cos_sin
from linksweep.base.validate import (
    Number,
    Rule,
    choice_problems,
    field_problems,
    number_problems,
    parameter,
    quote,
)
from linksweep.mechanisms import Mechanism
from linksweep.mechanisms.rows.spring_forms import (
    GROUND,
    DamperForm,
    SpringForm,
    TorsionDamperForm,
    TorsionSpringForm,
    approach,
)
from linksweep.scene.loads.action import Action
from linksweep.scene.loads.load import AT

POINT = (Rule("length"), Rule("length"))
End = tuple[str, Number, Number]


@dataclass(frozen=True, eq=False)
class _Line(Action):
    """What acts along the line between two points."""

    from_: End
    to: End

    def problems(self, path: str, links: tuple[str, ...]) -> list[str]:
        ends = {f"{path}.from_": self.from_, f"{path}.to": self.to}
        found = [problem for at, end in ends.items() for problem in _end_problems(at, end, links)]
        same = [] if found else _same_link(f"{path}.to[1]", self.from_[0], self.to[0])
        return found + same + field_problems(self, path + ".")

    def approaches(self, name: str) -> tuple[tuple[str, str], ...]:
        return (approach(name),)

    def ends(self, name: str) -> dict[str, Number]:
        """Its ends' numbers: in ground axes from A, or in their links' axes from their first pins."""
        return _end(f"{name}_from", self.from_) | _end(f"{name}_to", self.to)


@dataclass(frozen=True, eq=False)
class Spring(_Line):
    """A linear spring between two points: tension rate·(length − free_length).

    Parameters
    ----------
    from_, to : its ends, each on another link: ("ground", x [m], y [m]) in ground axes from A, or
        (link, distance [m], angle [degree]) in the link's own polar coordinates, from its first pin
    rate : [N/m]
    free_length : its length without force [m]; a longer one pulls, a shorter one pushes

    Numbers may be DataArrays of design dims. The scene that takes the spring as its k-th load checks it, and can then
    be asked for loadk_length, loadk_tension and loadk_power. What is wrong with it is a ValueError of that scene. With
    its ends in one point a spring has no direction: its force is 0 there.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.Spring(from_=("ground", 0.3, 0.0), to=("rocker", 0.1, 0.0), rate=2000.0, free_length=0.05).rate
    2000.0
    """

    rate: Number = parameter("spring_rate", at_least=0.0)
    free_length: Number = parameter("length", at_least=0.0)

    @property
    def form(self) -> SpringForm:
        return SpringForm(self.from_[0], self.to[0])

    def parameters(self, name: str, machine: Mapping[str, Any]) -> dict[str, Number]:
        return {f"{name}_rate": self.rate, f"{name}_free_length": self.free_length} | self.ends(name)


@dataclass(frozen=True, eq=False)
class Damper(_Line):
    """A viscous damper between two points: tension coefficient · rate of its length.

    Parameters
    ----------
    from_, to : its ends, as those of a Spring
    coefficient : [N s/m]

    Numbers may be DataArrays of design dims. The scene that takes the damper as its k-th load can be asked for
    loadk_length, loadk_tension and loadk_power. With its ends in one point its force is 0. What is wrong with it is a
    ValueError of that scene.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.Damper(from_=("ground", 0.3, 0.0), to=("rocker", 0.1, 0.0), coefficient=150.0).coefficient
    150.0
    """

    coefficient: Number = parameter("damping_coefficient", at_least=0.0)

    @property
    def form(self) -> DamperForm:
        return DamperForm(self.from_[0], self.to[0])

    def parameters(self, name: str, machine: Mapping[str, Any]) -> dict[str, Number]:
        return {f"{name}_coefficient": self.coefficient} | self.ends(name)


@dataclass(frozen=True, eq=False)
class _Turning(Action):
    """What acts between the lines of pins of two links; of the ground, the line is x."""

    from_: str
    to: str

    def problems(self, path: str, links: tuple[str, ...]) -> list[str]:
        found = choice_problems(f"{path}.from_", self.from_, (GROUND, *links))
        found += choice_problems(f"{path}.to", self.to, (GROUND, *links))
        return (
            found + ([] if found else _same_link(f"{path}.to", self.from_, self.to)) + field_problems(self, path + ".")
        )


@dataclass(frozen=True, eq=False)
class TorsionSpring(_Turning):
    """A torsion spring between two links: it turns `to` back, and `from_` on, by rate·twist.

    Parameters
    ----------
    from_, to : two links by name; one may be "ground"
    rate : [N m/rad]
    free_angle : angle from the line of pins of `from_` (of the ground: from x) to that of `to`, counter-clockwise,
        at which it exerts no torque [degree]

    The twist is the angle between the links less the free angle, folded to (-180, 180]: it follows from the position
    alone, and no turns are counted. Where a link turns so far that the twist passes 180, the torque jumps; `peaks`
    looks at both sides of the jump of a spring between crank and ground, of others only at the samples.

    Numbers may be DataArrays of design dims. The scene that takes the spring as its k-th load can be asked for
    loadk_twist [degree], loadk_to_torque and loadk_power. What is wrong with it is a ValueError of that scene.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.TorsionSpring(from_="ground", to="rocker", rate=5.0, free_angle=90.0).to
    'rocker'
    """

    rate: Number = parameter("torsional_rate", at_least=0.0)
    free_angle: Number = parameter("angle", 0.0)

    @property
    def form(self) -> TorsionSpringForm:
        return TorsionSpringForm(self.from_, self.to)

    def parameters(self, name: str, machine: Mapping[str, Any]) -> dict[str, Number]:
        cos, sin = cos_sin(self.free_angle)
        return {f"{name}_rate": self.rate, f"{name}_free_cos": cos, f"{name}_free_sin": sin}

    def jumps(self, mechanism: Mechanism) -> tuple[Number, ...]:
        """Crank angle [degree] at which the twist of a spring between crank and ground passes 180."""
        turned = {(GROUND, "crank"): 1.0, ("crank", GROUND): -1.0}.get((self.from_, self.to))
        return () if turned is None else (180.0 + turned * self.free_angle,)


@dataclass(frozen=True, eq=False)
class TorsionDamper(_Turning):
    """A viscous damper between two links that turn against each other: torque coefficient · rate of their angle.

    Parameters
    ----------
    from_, to : two links by name; one may be "ground"
    coefficient : [N m s/rad], DataArray of design dims allowed

    The scene that takes it as its k-th load can be asked for loadk_to_torque and loadk_power. What is wrong with it is
    a ValueError of that scene.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.TorsionDamper(from_="crank", to="coupler", coefficient=0.2).coefficient
    0.2
    """

    coefficient: Number = parameter("torsional_damping", at_least=0.0)

    @property
    def form(self) -> TorsionDamperForm:
        return TorsionDamperForm(self.from_, self.to)

    def parameters(self, name: str, machine: Mapping[str, Any]) -> dict[str, Number]:
        """Its number under the name that the physics wires by."""
        return {f"{name}_coefficient": self.coefficient}


def _end(name: str, end: End) -> dict[str, Number]:
    if end[0] == GROUND:
        return {f"{name}_x": end[1], f"{name}_y": end[2]}
    cos, sin = cos_sin(end[2])
    return {f"{name}_at_x": end[1] * cos, f"{name}_at_y": end[1] * sin}


def _end_problems(path: str, end: Any, links: tuple[str, ...]) -> list[str]:
    if not (isinstance(end, tuple | list) and len(end) == 3):
        wanted = '("ground", x, y) in m, or (link, distance in m, angle in degrees)'
        return [f"{path} = {quote(end)}: must be {wanted}"]
    rules = POINT if isinstance(end[0], str) and end[0] == GROUND else AT
    problems = choice_problems(f"{path}[1]", end[0], (GROUND, *links))
    return problems + [p for k in (0, 1) for p in number_problems(f"{path}[{k + 2}]", end[k + 1], rules[k])]


def _same_link(path: str, first: str, second: str) -> list[str]:
    return [f"{path} = {second!r}: must be another link than that of from_"] if first == second else []
