"""What to draw of each mechanism, and what its joints are called: a table, one row for each kind of mechanism.

The plots know no mechanism. They ask here which links run between which pins, what stands on the ground, where a block
slides, and in whose axes a force can be shown. A new mechanism that is to be drawn is a new row of `DRAWINGS`.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.base.degrees import cos_sin
from linksweep.mechanisms import (
    FourBar,
    InvertedSliderCrank,
    SliderCrank,
    four_bar,
    inverted_slider_crank,
    slider_crank,
)

Points = dict[str, np.ndarray]


class Frame(NamedTuple):
    """Axes of a link: what x runs along, and the angle [degree] of x, a variable of the sweep or a parameter."""

    along: str
    angle: str

    @property
    def across(self) -> str:
        return self.along.split(",")[0]


class Block(NamedTuple):
    """A block that slides: which link it is, and the pin at its centre. Its sides lie in its frame.

    It slides in a guide on the ground, or on a link that turns about a pin: the number of that link, and the pin.
    """

    number: int
    pin: str
    on: tuple[int, str] | None = None


class Guide(NamedTuple):
    """The straight line on the ground that a block slides on: the foot of pin A on it [m], and its direction."""

    foot: np.ndarray
    along: np.ndarray


class Carrier(NamedTuple):
    """The link whose point draws a curve: its name, its number, and the pin that `point` is seen from."""

    role: str
    number: int
    pin: str


COUPLER = Carrier("coupler", 3, "B")


@dataclass(frozen=True)
class Drawing:
    """What the plots have to know of a mechanism.

    `joints` are the pairs of links (i, j) whose force Fij is shown, by the joint's name: a pin, or a word where links
    touch otherwise; `journals` are the links that have the pins' journals; `acts_at` is the pin where the arrow of such
    a force starts. `fixed` gives the pins on the ground [m], `guide` the guide. `drives` names each drive's torque or
    force. `ideal` are parameters to be set aside when only positions are asked for.
    """

    joints: Mapping[str, tuple[int, int]]
    drives: Mapping[str, str]
    journals: Mapping[str, int] = field(default_factory=dict)
    frames: Mapping[int, Frame] = field(default_factory=dict)
    bars: Mapping[int, tuple[str, str]] = field(default_factory=dict)
    moving: tuple[str, ...] = ()
    fixed: Callable[[Any], Points] = lambda mechanism: {"A": np.zeros(2)}
    carrier: Carrier = COUPLER
    block: Block | None = None
    guide: Callable[[Any], Guide] | None = None
    acts_at: Mapping[str, str] = field(default_factory=dict)
    ideal: Mapping[str, float] = field(default_factory=dict)

    @property
    def forces(self) -> dict[str, str]:
        """The force of each joint, such as F12, and the joint's name."""
        return {f"F{i}{j}": name for name, (i, j) in self.joints.items()}

    @property
    def joint_of(self) -> dict[str, str]:
        """The joint of each force and of its reaction."""
        return {f"F{i}{j}": name for name, pair in self.joints.items() for i, j in (pair, pair[::-1])}

    @property
    def angles(self) -> list[str]:
        """Names of the angles of the links' axes."""
        return [frame.angle for frame in self.frames.values()]

    def start_of(self, force: str) -> str:
        """The pin where the arrow of a force starts."""
        joint = self.joint_of[force]
        return self.acts_at.get(joint, joint)

    def link_of(self, force: str, frame: str) -> int:
        """Return the link in whose axes a force Fij is shown; "link" is j, which counts as the journal's in a slide."""
        i, j = int(force[1]), int(force[2])
        journal = self.journals.get(self.joint_of.get(force, ""), j)
        return {"ground": 1, "link": j, "journal": journal, "bearing": i + j - journal}[frame]

    def at_pin(self, force: str) -> bool:
        """Whether a force acts at a pin; pins have a letter for a name."""
        return len(self.joint_of[force]) == 1

    def said(self, force: str) -> str:
        """The joint of a force, in words: "pin C", "guide"."""
        return f"{'pin ' if self.at_pin(force) else ''}{self.joint_of[force]}"


def direction(angle: Any) -> np.ndarray:
    """The unit vector at an angle [degree], exact at the multiples of 90."""
    return np.array([float(part) for part in cos_sin(angle)])


def _ground_pins(mechanism: FourBar | InvertedSliderCrank) -> Points:
    return {"A": np.zeros(2), "D": float(mechanism.ground) * direction(mechanism.ground_angle)}


def _slider_guide(mechanism: SliderCrank) -> Guide:
    along = direction(mechanism.slide_angle)
    return Guide(float(mechanism.offset) * np.array([-along[1], along[0]]), along)


FOUR_BAR = Drawing(
    joints=four_bar.PINS,
    drives=FourBar.drives,
    journals=FourBar.journals,
    frames={2: Frame("crank, A→B", "theta2"), 3: Frame("coupler, B→C", "theta3"), 4: Frame("rocker, D→C", "theta4")},
    bars={2: ("A", "B"), 3: ("B", "C"), 4: ("D", "C")},
    moving=("B", "C"),
    fixed=_ground_pins,
)
SLIDER_CRANK = Drawing(
    joints=slider_crank.PINS,
    drives=SliderCrank.drives,
    journals=SliderCrank.journals,
    frames={2: Frame("crank, A→B", "theta2"), 3: Frame("rod, B→C", "theta3"), 4: Frame("guide", "slide_angle")},
    bars={2: ("A", "B"), 3: ("B", "C")},
    moving=("B", "C"),
    carrier=Carrier("rod", 3, "B"),
    block=Block(4, "C"),
    guide=_slider_guide,
    acts_at={"guide": "C"},
    ideal={"friction": 0.0},
)
INVERTED_SLIDER_CRANK = Drawing(
    joints={pin if len(pin) == 1 else "slide": pair for pin, pair in inverted_slider_crank.PINS.items()},
    drives=InvertedSliderCrank.drives,
    journals=InvertedSliderCrank.journals,
    frames={2: Frame("crank, A→B", "theta2"), 3: Frame("rocker", "theta4"), 4: Frame("rocker", "theta4")},
    bars={2: ("A", "B")},
    moving=("B",),
    fixed=_ground_pins,
    carrier=Carrier("rocker", 4, "D"),
    block=Block(3, "B", on=(4, "D")),
    acts_at={"slide": "B"},
    ideal={"friction": 0.0},
)
DRAWINGS: dict[type, Drawing] = {
    FourBar: FOUR_BAR,
    SliderCrank: SLIDER_CRANK,
    InvertedSliderCrank: INVERTED_SLIDER_CRANK,
}

LOST = Drawing(
    joints={"A": (1, 2), "B": (3, 2), "C": (4, 3), "ground": (1, 4)},
    drives={**FourBar.drives, **InvertedSliderCrank.drives},
)
"""Of a Dataset that has lost its scene: nobody knows how its link 4 is held."""


def drawing_of(mechanism: Any) -> Drawing:
    """What to draw of this mechanism. Raises ValueError for one that nobody has drawn yet."""
    return _by_name(type(mechanism).__name__)


def drawing_of_results(ds: xr.Dataset) -> Drawing:
    """The same for the mechanism that a Dataset was computed of; `LOST` where it has lost its scene."""
    kind = _words(ds).get("mechanism", {}).get("type")
    return LOST if kind is None else _by_name(kind)


def drive_of_results(ds: xr.Dataset) -> str | None:
    """The driven link of the scene that a Dataset was computed of."""
    return _words(ds).get("drive")


def _by_name(kind: str) -> Drawing:
    known = {cls.__name__: drawing for cls, drawing in DRAWINGS.items()}
    if kind not in known:
        raise ValueError(f"a {kind} cannot be drawn: there are plots of {', '.join(known)}")
    return known[kind]


def _words(ds: xr.Dataset) -> dict[str, Any]:
    """The scene of a Dataset as its text has it: enough for names, whatever became of its arrays."""
    text = ds.attrs.get("scene")
    return _parsed(text) if isinstance(text, str) else {}


@lru_cache(maxsize=16)
def _parsed(text: str) -> dict[str, Any]:
    return tomllib.loads(text)
