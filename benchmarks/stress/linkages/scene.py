"""Make linksweep's scene of random linkages; their arrays have the dim `design`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from typing import Any

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.stress.decimals import Array
from benchmarks.stress.linkages.machine import Linkages


def scene_of(linkages: Linkages) -> ls.Scene:
    x = _labelled(linkages)
    parts = {body.role: (ls.Slider if body.slides else ls.Link)(**x.parts[body.role]) for body in linkages.bodies}
    parts |= {cylinder.role: ls.Cylinder(**x.parts.get(cylinder.role, {})) for cylinder in linkages.cylinders}
    mechanism = ls.Linkage(
        linkages.text,
        ground=x.ground,
        points=x.points,
        guides={name: ls.Guide(**guide) for name, guide in x.guides.items()},
        gears={name: ls.Gears(**gears) for name, gears in x.gears.items()},
        branch=linkages.branch,
        **parts,
    )
    loads = [getattr(ls, type(load).__name__)(**load._asdict()) for load in x.loads]
    return ls.Scene(mechanism, x.omega2, x.alpha2, x.gravity, loads, linkages.drive)


def _labelled(value: Any) -> Any:
    """Return linkages, or any of their numbers, with arrays labelled."""
    if isinstance(value, Linkages):
        return replace(value, **{f.name: _labelled(getattr(value, f.name)) for f in fields(value) if f.name != "pins"})
    if isinstance(value, Mapping):
        return {key: _labelled(one) for key, one in value.items()}
    if isinstance(value, tuple):
        parts = [_labelled(one) for one in value]
        return type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)
    return _array(value) if isinstance(value, np.ndarray) else value


def _array(values: Array) -> xr.DataArray:
    """Return an array over the designs, and over a turn where it has a number for each of some angles."""
    if values.ndim == 1:
        return xr.DataArray(values, dims="design")
    return xr.DataArray(
        values, {"theta2": np.linspace(0.0, 360.0, values.shape[1], endpoint=False)}, ("design", "theta2")
    )
