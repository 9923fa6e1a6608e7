"""Give a scene the places of section forces, where these are requested of links that are beams."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.frozen import with_sound
from linksweep.base.validate import Number
from linksweep.chains.rows.beams import FORCES, SECTION
from linksweep.chains.rows.load_forms import named
from linksweep.scene.scene import Scene

COUNT = 41
"""Places along a link where none are stated: each 1/40 of the way between its ends."""
BESIDE = 1e-12
"""Share of the length by which a section lies before or beyond a force: a thousand times what rounding moves it."""
_NAME = re.compile(rf"(?:{'|'.join(FORCES)}|stress)(\d+)(?:_.*)?")


def with_sections(scene: Scene, names: Iterable[str] | str | None) -> Scene:
    """Copy a scene with places along its links if quantities at sections are among the names, and it states none."""
    listed = [names] if isinstance(names, str) else [name for name in names or () if isinstance(name, str)]
    if not isinstance(scene, Scene) or scene.section is not None or not any(map(link_of, listed)):
        return scene
    return with_sound(scene, section=places(np.linspace(0.0, 1.0, COUNT))) if scene.mechanism.beams else scene


def places(shares: Any) -> xr.DataArray:
    """Return shares of the way between a link's ends as places over the dim `section`."""
    return xr.DataArray(shares, {SECTION: shares}, SECTION)


def marks(scene: Scene, role: str) -> list[Number]:
    """Return sections on either side of each force on a beam, as shares of its length."""
    numbers, fields = scene.mechanism.beam_numbers(), scene.at_one_angle.inputs.fields
    start, end = (numbers[f"{role}_beam_{name}"] for name in ("start", "end"))
    pins = [0.0 * start, scene.mechanism.parts[role].length, *scene.mechanism.third_pins_along(role)]
    along = [] if len(pins) == 2 else pins
    for name, form in named(tuple(load.form for load in scene.loads)):
        places_of = [at[0] for _, _, at, joined_to in form.applied(name, role) if not joined_to]
        along += [xr.DataArray(fields[s].values, dims=fields[s].dims) if isinstance(s, str) else s for s in places_of]
    shares = [(s - start) / (end - start) for s in along]
    return [np.clip(share + aside, 0.0, 1.0) for share in shares for aside in (-BESIDE, BESIDE)]


@cache
def link_of(name: str) -> int:
    """Return the number of the link of which a name is a section force or a stress; 0 for any other name."""
    match = _NAME.fullmatch(name)
    return int(match[1]) if match else 0


def beam_problem(scene: Scene, name: str) -> str:
    """Return why a link has no such section force; empty for other names."""
    k, roles = link_of(name), scene.mechanism.roles
    if not 2 <= k < 2 + len(roles):
        return ""
    reason = scene.mechanism.beam_problem(roles[k - 2])
    return f"{name}: link {k} ({roles[k - 2]}) is no beam: {reason}" if reason else ""
