"""A drawing of PMKS+ in SI units: joints, bodies and forces."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

Point = tuple[float, float]


@dataclass(frozen=True)
class Joint:
    """A pin, or a pin that slides on a guide on the ground or in a slot of a body.

    Parameters
    ----------
    name : str
        Its letter in the drawing.
    at : tuple of float
        Place [m].
    grounded, driven, slides : bool
        It is on the ground; it has the input; it slides.
    welded, sealed : bool
        Of a sliding joint: its body does not turn against the guide; it is the piston of a cylinder.
    angle : float
        Direction of its guide on the ground [degree].
    carrier, slot : str, tuple of str
        Body that has the slot, and the two joints on it that give the slot's direction; empty on the ground.
    speed : float
        Of the input: turning counter-clockwise [rad/s], or along the guide [m/s].
    mass : float
        Mass of the block [kg].
    """

    name: str
    at: Point
    grounded: bool
    driven: bool
    slides: bool
    welded: bool
    sealed: bool
    angle: float
    carrier: str
    slot: tuple[str, str]
    speed: float
    mass: float


@dataclass(frozen=True)
class Body:
    """A link, or several welded together: names of its joints, mass [kg], moment of inertia about its centre of
    gravity [kg m²], and the place of that [m]. `parts` are the links welded."""

    name: str
    title: str
    joints: tuple[str, ...]
    mass: float
    inertia: float
    cg: Point
    parts: tuple[str, ...]


@dataclass(frozen=True)
class Force:
    """A force [N] at a point of a body [m], in the drawing's position; `follows` where it turns with the body."""

    name: str
    body: str
    at: Point
    force: Point
    follows: bool


@dataclass(frozen=True)
class Drawing:
    """Joints, bodies and forces, gravity [m/s²], and sentences on what of the document is left out."""

    joints: Mapping[str, Joint]
    bodies: Mapping[str, Body]
    forces: tuple[Force, ...]
    gravity: float
    left_out: tuple[str, ...]
