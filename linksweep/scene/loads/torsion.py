"""Torsion springs and dampers between two links, or between a link and the ground."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from linksweep.base.degrees import cos_sin
from linksweep.base.fields import field_problems, parameter, word
from linksweep.base.validate import Number
from linksweep.chains.rows.bodies import Body
from linksweep.chains.rows.load_forms import Acting, Applied
from linksweep.engine.quantity import Quantity, Row, Total
from linksweep.mechanisms import Mechanism
from linksweep.physics import springs
from linksweep.physics.algebra import planar
from linksweep.physics.algebra.arithmetic import degrees
from linksweep.scene.loads.action import Action, register
from linksweep.scene.loads.ends import GROUND, Between, Pair, link_problems


@dataclass(frozen=True, eq=False, repr=False)
class _Turning(Action):
    """A torque between the lines of pins of two links; the line of the ground is x."""

    from_: str = word('"ground"')
    to: str = word('"rocker"')

    damps: ClassVar[bool] = False
    """True where its torque grows with the speed."""

    @property
    def form(self) -> TurningForm:
        """Form of its rows."""
        return TurningForm(self.from_, self.to, self.damps)

    def problems(self, path: str, links: tuple[str, ...]) -> list[str]:
        """Return the problems of the load on a machine of these links."""
        return link_problems(path, "", self.from_, self.to, links) + field_problems(self, path + ".")


@register
@dataclass(frozen=True, eq=False, repr=False)
class TorsionSpring(_Turning):
    """A torsion spring between two links: it turns `to` back, and `from_` on, by rate·twist.

    Parameters
    ----------
    from_ : str
        One link, or "ground".
    to : str
        The other link, or "ground".
    rate : float or DataArray
        Torsional rate [N m/rad].
    free_angle : float or DataArray, default 0.0
        Angle [degree] without torque, counter-clockwise from the line of pins of `from_` (of the ground: from x) to
        that of `to`.

    Notes
    -----
    The twist is the angle between the links less the free angle, folded to (-180, 180]: it follows from the position
    alone, and no turns are counted. Where a link turns so far that the twist passes 180, the torque jumps; `peaks`
    looks at both sides of the jump of a spring between crank and ground, at other springs only at the samples.

    With the spring as first load a scene has `load1_twist` [degree], `load1_to_torque` [N m] and `load1_power` [W] as
    quantities; the number is that of the load in the scene. The scene checks its values, and raises ValueError.

    Examples
    --------
    >>> import linksweep as ls
    >>> from dataclasses import replace
    >>> spring = ls.TorsionSpring(from_="ground", to="rocker", rate=5.0, free_angle=90.0)
    >>> worst = ls.peaks(replace(ls.example("press"), loads=[spring]), of=["load1_twist"])
    >>> round(float(worst.load1_twist_max), 1)  # degrees
    47.2
    """

    rate: Number = parameter("torsional_rate", at_least=0.0)
    free_angle: Number = parameter("angle", 0.0)

    def parameters(self, name: str, machine: Mapping[str, Any]) -> dict[str, Number]:
        """Return the load's numbers under the names that its rows take."""
        cos, sin = cos_sin(self.free_angle)
        return {f"{name}_rate": self.rate, f"{name}_free_cos": cos, f"{name}_free_sin": sin}

    def jumps(self, mechanism: Mechanism) -> tuple[Number, ...]:
        """Return the crank angle [degree] at which the twist of a spring between crank and ground passes 180."""
        crank = mechanism.roles[0]
        turned = {(GROUND, crank): 1.0, (crank, GROUND): -1.0}.get((self.from_, self.to))
        return () if turned is None else (180.0 + turned * self.free_angle,)


@register
@dataclass(frozen=True, eq=False, repr=False)
class TorsionDamper(_Turning):
    """A viscous damper between two links that turn against each other: torque coefficient · rate of their angle.

    Parameters
    ----------
    from_ : str
        One link, or "ground".
    to : str
        The other link, or "ground".
    coefficient : float or DataArray
        Damping coefficient [N m s/rad].

    Notes
    -----
    With the damper as first load a scene has `load1_to_torque` [N m] and `load1_power` [W] as quantities; the number is
    that of the load in the scene. The scene checks its values, and raises ValueError.

    Examples
    --------
    >>> import linksweep as ls
    >>> from dataclasses import replace
    >>> damper = ls.TorsionDamper(from_="crank", to="coupler", coefficient=0.2)
    >>> worst = ls.peaks(replace(ls.example("press"), loads=[damper]), of=["load1_to_torque"])
    >>> round(float(worst.load1_to_torque_peak), 2)  # N m
    10.47
    """

    coefficient: Number = parameter("torsional_damping", at_least=0.0)

    damps: ClassVar[bool] = True

    def parameters(self, name: str, machine: Mapping[str, Any]) -> dict[str, Number]:
        """Return the load's number under the name that its rows take."""
        return {f"{name}_coefficient": self.coefficient}


@dataclass(frozen=True)
class TurningForm(Between):
    """The rows of a torque between two links, against the angle or the rate by which one turns from the other."""

    def rows(self, name: str, bodies: dict[str, Body]) -> list[Row | Total]:
        first, second = bodies.get(self.from_), bodies.get(self.to)
        rates = [f"omega{body.number}" if body else 0.0 for body in (second, first)]
        ends = [(end, f"omega{bodies[link].number}") for end, link in self.ends(name)]
        powers = [Row(planar.product, (f"{end}_power",), (f"{end}_torque", rate)) for end, rate in ends]
        return [
            Row(springs.turning_rate, (f"{name}_turning",), tuple(rates)),
            *self._resistance(name, first, second),
            Row(planar.identity, (f"{name}_from_torque",), (f"{name}_resistance",)),
            Row(planar.opposite, (f"{name}_to_torque",), (f"{name}_resistance",)),
            *powers,
            Row(springs.resisting_power, (f"{name}_power",), (f"{name}_resistance", f"{name}_turning")),
        ]

    def _resistance(self, name: str, first: Body | None, second: Body | None) -> list[Row]:
        """Return the rows of the resisting torque."""
        if self.damps:
            return [Row(planar.product, (f"{name}_resistance",), (f"{name}_coefficient", f"{name}_turning"))]
        free = (f"{name}_free_cos", f"{name}_free_sin")
        return [
            Row(springs.twist, (f"{name}_twist_rad",), (*_line(first), *_line(second), *free)),
            Row(degrees, (f"{name}_twist",), (f"{name}_twist_rad",)),
            Row(planar.product, (f"{name}_resistance",), (f"{name}_rate", f"{name}_twist_rad")),
        ]

    def on(self, name: str, link: str) -> Acting:
        return Acting(moments=tuple(f"{end}_torque" for end, role in self.ends(name) if role == link))

    def applied(self, name: str, link: str) -> tuple[Applied, ...]:
        ends = [(end, role) for end, role in self.ends(name) if role == link]
        other = self.to if link == self.from_ else self.from_
        return tuple(Applied(torque=f"{end}_torque", joined_to=other) for end, _ in ends)

    def quantities(self, name: str) -> list[Quantity]:
        wound = f"angle by which {self.title(name)} is wound from its free angle, in (-180, 180]"
        twist = [] if self.damps else [Quantity(f"{name}_twist", "degree", wound)]
        return [
            *twist,
            Quantity(f"{name}_to_torque", "N m", f"torque of {self.title(name)} on the {self.to}"),
            Quantity(f"{name}_power", "W", f"power of {self.title(name)}, positive when it feeds the mechanism"),
        ]


def _line(body: Body | None) -> Pair:
    """Return the direction of a link's line of pins; x for the ground."""
    return (1.0, 0.0) if body is None else (f"r{body.number}x", f"r{body.number}y")
