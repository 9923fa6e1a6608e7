"""Write the skeleton of a machine as DXF, for CAD, by ezdxf."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from linksweep.plot.sheets.skeleton import Circle, Line, Name, Part, Point
from linksweep.scene.scene import Scene
from linksweep.scene.shown_units import shown_units

UNITS = {"in": 1, "ft": 2, "mm": 4, "cm": 5, "m": 6, "km": 7, "um": 13}
"""Code of each length in a DXF file, its $INSUNITS."""
USUAL = ("mm", 1e-3)
"""Unit where none was chosen, and its size [m]."""
COLORS = (5, 1, 3, 6, 30, 4)
"""Colours of layers, as AutoCAD numbers them."""
MISSING = 'DXF files need ezdxf, which is not installed: pip install "linksweep[cad]"; .svg and .pdf need nothing more'


def write_dxf(parts: Iterable[Part], scene: Scene, path: Path) -> None:
    """Write the parts of a drawing, in the unit of length in which the scene's results are shown.

    Raises ImportError where ezdxf is not installed.
    """
    try:
        import ezdxf
    except ImportError:
        raise ImportError(MISSING) from None
    system = shown_units(scene.units)
    unit, metre = (system.unit("m"), system.size("m")) if system.chosen else USUAL
    document = ezdxf.new("R2010", setup=["linetypes"])
    document.header["$INSUNITS"] = UNITS[unit]
    document.header["$MEASUREMENT"] = 0 if unit in ("in", "ft") else 1
    space = document.modelspace()
    for part in parts:
        if part.layer not in document.layers:
            document.layers.add(part.layer, color=COLORS[len(document.layers) % len(COLORS)])
        _add(space, part, metre)
    document.saveas(path)


def _add(space: Any, part: Part, metre: float) -> None:
    """Add a part to a drawing whose unit has this size [m]."""
    look = {"layer": part.layer} | ({"linetype": "CENTER"} if getattr(part, "dashed", False) else {})
    match part:
        case Line(points=points, closed=closed):
            space.add_lwpolyline((points / metre).tolist(), close=closed, dxfattribs=look)
        case Circle(centre=centre, radius=radius):
            space.add_circle(_place(centre, metre), radius / metre, dxfattribs=look)
        case Point(at=at):
            space.add_point(_place(at, metre), dxfattribs=look)
        case Name(at=at, text=text, height=height):
            space.add_text(text, height=height / metre, dxfattribs=look).set_placement(_place(at, metre))


def _place(at: np.ndarray, metre: float) -> tuple[float, float]:
    x, y = at / metre
    return float(x), float(y)
