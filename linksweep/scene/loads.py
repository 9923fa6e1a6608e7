"""Loads: a force at a point of a link, a torque on a link, or both."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from linksweep.mechanisms.actions import LoadForm
from linksweep.mechanisms.conversion import PAIRS, as_pair
from linksweep.mechanisms.degrees import cos_sin
from linksweep.mechanisms.validate import Number, Rule, choice_problems, pair_problems, parameter, problems
from linksweep.scene.action import Revolution, with_values
from linksweep.scene.changing_load import ChangingLoad

FORCE = Rule("force", over_angle=True)
TORQUE = Rule("torque", over_angle=True)
FORCE_PAIR = "(Fx, Fy) in N, each a number, a DataArray or a function of theta2"
AT = (Rule("length", at_least=0.0, polar=True), Rule("angle"))


@dataclass(frozen=True, eq=False)
class Load(ChangingLoad):
    """A force at a point of a link, a torque on it, or both, besides weight and inertia.

    Parameters
    ----------
    link : the link it acts on, by name ("crank", "coupler", "rocker")
    force : (Fx, Fy) [N], or None for no force; on a slider also one number, along the guide (frame "link")
    at : the point, in the link's own polar coordinates: (distance [m], angle from the line of pins [degree])
    frame : axes of the force: "ground", or "link" (x along the line of pins)
    torque : [N m], positive counter-clockwise, or None for no torque
    origin : what `at` is measured from: the link's first "pin", or its "cg" (centre of gravity)
    breaks : angles theta2 [degree] at which the force or torque jumps, or is narrower than 0.02 degrees, in a list:
        exact peaks look at both sides of each, and closely between them
    interpolation : of DataArrays over theta2, at angles that they do not hold: "periodic cubic" (spline, by default),
        "pchip" (monotone between neighbours, does not ring), "linear", or "step" (each value holds from its angle up
        to the next)

    Forces and torques may be numbers, DataArrays (design dims and theta2) or functions of theta2 [degree]; the
    point may be DataArrays of design dims. A DataArray over theta2 is reproduced exactly at angles that it holds. Its
    period is 360 degrees, or 720 where its angles span more (four-stroke engines): then theta2 of the whole scene runs
    to 720, and what has a period of 360 repeats. Values are checked by the scene that takes the load: ValueError there.

    A spline through a load with steps rings. Where one leaves its data's range by more than 1 % of it, it warns
    (`OvershootWarning`) when it is first used, and `linksweep.check` tells by how much.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.Load("coupler", force=(0.0, -80.0), at=(0.10, 15.0)).frame
    'ground'
    """

    link: str
    force: tuple[Number, Number] | None = None
    at: tuple[Number, Number] = (0.0, 0.0)
    frame: str = "ground"
    torque: Number | None = parameter("torque", None, over_angle=True)
    origin: str = "pin"
    breaks: tuple[float, ...] = ()
    interpolation: str | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "force", as_pair(self.force, PAIRS["force"]))
        on_slider = isinstance(self.link, str) and self.link == "slider"  # an array compares element by element
        if on_slider and self.force is not None and not isinstance(self.force, tuple | list | str):
            object.__setattr__(self, "force", (self.force, 0.0))
            object.__setattr__(self, "frame", "link")
        super().__post_init__()

    @property
    def changing(self) -> tuple[Any, ...]:
        components = self.force if isinstance(self.force, tuple | list) else ()
        return (*components, self.torque)

    @property
    def form(self) -> LoadForm:
        return LoadForm(self.link, self.force is not None, self.torque is not None, self.frame == "link")

    def problems(self, path: str, links: tuple[str, ...]) -> list[str]:
        found = choice_problems(f"{path}.link", self.link, links)
        found += choice_problems(f"{path}.frame", self.frame, ("ground", "link"))
        found += choice_problems(f"{path}.origin", self.origin, ("pin", "cg"))
        found += self.changing_problems(path)
        if self.force is None and self.torque is None:
            found.append(f"{path} has neither force nor torque: give force=(Fx, Fy), torque=..., or both")
        if self.force is not None:
            found += pair_problems(f"{path}.force", self.force, (FORCE, FORCE), FORCE_PAIR)
        return (
            found
            + problems(self, path + ".")
            + pair_problems(f"{path}.at", self.at, AT, "(distance in m, angle in degrees)")
        )

    def sampled(self, path: str, revolution: Revolution) -> Load:
        force = self.force and tuple(
            revolution.sample(f"{path}.force[{k}]", component, FORCE, self.interpolation)
            for k, component in enumerate(self.force, 1)
        )
        torque = revolution.sample(f"{path}.torque", self.torque, TORQUE, self.interpolation)
        return with_values(self, force=force, torque=torque)

    def parameters(self, load: str, machine: Mapping[str, Any]) -> dict[str, Number]:
        """The load's numbers under the names that the physics wires by; `machine` has its link's centre of gravity."""
        named: dict[str, Any] = {}
        if self.force is not None:
            component = f"{load}_force_" if self.frame == "link" else f"{load}_F"
            named |= {component + "x": self.force[0], component + "y": self.force[1]}
            cos, sin = cos_sin(self.at[1])
            cg = machine[f"{self.link}_cg_x"], machine[f"{self.link}_cg_y"]
            from_x, from_y = cg if self.origin == "cg" else (0.0, 0.0)
            named |= {f"{load}_at_x": from_x + self.at[0] * cos, f"{load}_at_y": from_y + self.at[0] * sin}
        if self.torque is not None:
            named[f"{load}_torque"] = self.torque
        return named
