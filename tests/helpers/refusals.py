"""Provide a sound scene to spoil, and read the lines of a refusal."""

import re
from dataclasses import replace

import pytest
import xarray as xr

import linksweep as ls

LINK = ls.Link(0.22, 0.68, 2.8e-3)
BAR = ls.Bar(0.08, 0.02, 0.02, 7750.0)
DISK = ls.Disk(0.18, 0.05, 0.02, 7750.0)
FOUR_BAR = ls.FourBar(crank=BAR, coupler=LINK, rocker=DISK, ground=0.2)
LOAD = ls.Load("coupler", force=(0.0, -80.0), at=(0.1, 15.0), torque=2.0)
LOOP = ls.Scene(ls.LoopTrack(radius=30.0, mass=700.0), speed=100.0, thrust=10_000.0)
SCENE = ls.Scene(FOUR_BAR, omega2=30.0, loads=[ls.Load("rocker", torque=1.0), LOAD])
TURNED = "; for a point on the other side turn its angle by 180 degrees"
ADVICE = "must|give|make|write|name |leave|hold|less|begin|once|did you mean|shorten|there are"
ADVICE += "|every angle|declare|accepted: "

PYTHON = r"\bls\.\w+|\blinksweep\.[a-z]+|\w*DataArray|\w*Dataset\w*|\bisel\b|\w+\((?!s\))|\b[a-z]\w*=\S+"


def python_words(text: str) -> list[str]:
    """Return what only Python understands: calls, keywords, and names of its libraries."""
    return re.findall(PYTHON, text)


def coupler(**changes) -> ls.Scene:
    return replace(SCENE, mechanism=replace(FOUR_BAR, coupler=replace(LINK, **changes)))


def crank(**changes) -> ls.Scene:
    return replace(SCENE, mechanism=replace(FOUR_BAR, crank=replace(BAR, **changes)))


def rocker(**changes) -> ls.Scene:
    return replace(SCENE, mechanism=replace(FOUR_BAR, rocker=replace(DISK, **changes)))


def four_bar(**changes) -> ls.Scene:
    return replace(SCENE, mechanism=replace(FOUR_BAR, **changes))


def loop(**changes) -> ls.Scene:
    return replace(LOOP, **changes)


def track(**changes) -> ls.Scene:
    return replace(LOOP, mechanism=replace(LOOP.mechanism, **changes))


def scene(**changes) -> ls.Scene:
    return replace(SCENE, **changes)


def load(**changes) -> ls.Scene:
    """Return the scene with its second load changed."""
    return replace(SCENE, loads=[SCENE.loads[0], replace(LOAD, **changes)])


def refusal(call, *arguments, **options) -> list[str]:
    """Return the lines of a ValueError, and check the form that all messages have."""
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        call(*arguments, **options)
    lines = str(refused.value).split("\n")
    for line in lines:
        assert re.match(r"[a-z]\w*(\[\d\])?(\.\w+(\[\d\])?)*( = |: | has | is | holds | depends )", line), line
        assert " at 0x" not in line
        assert len(line) < 250 or "must be one of " in line  # lists of names are long
        assert line == line.strip()
        assert re.search(ADVICE, line), line
    return lines


def array(*values, dims="design", **coords) -> xr.DataArray:
    return xr.DataArray(list(values), coords or None, dims)
