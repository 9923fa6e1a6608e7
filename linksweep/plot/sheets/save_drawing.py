"""save_drawing(scene, "press.dxf"): a machine in a position as SVG, PDF or DXF, by the ending of the file."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any

import xarray as xr

from linksweep.base.checked_number import one_number, one_pair
from linksweep.base.fields import POLAR_POINT
from linksweep.base.validate import Rule, choice_problems, flag_problems, listed, quote, refuse
from linksweep.files.atomic import ending_of, whole
from linksweep.files.netcdf import scene_from
from linksweep.plot.kit.drawings import drawing_of
from linksweep.plot.machine import crank_angle
from linksweep.plot.sheets.skeleton import Curve, skeleton
from linksweep.scene.scene import Scene

ENDINGS = (".dxf", ".pdf", ".svg")


def save_drawing(
    scene: Scene | xr.Dataset,
    path: str | os.PathLike[str],
    *,
    theta2: float = 45.0,
    curves: Iterable[tuple[str, float, float]] | None = None,
    machine: bool = True,
    scale: float | str | None = None,
) -> None:
    """Write the drawing of a machine in a position, and the curves of points of its links: SVG, PDF, or DXF for CAD.

    Parameters
    ----------
    scene : Scene or Dataset
        Scene of one design, or a Dataset from `linksweep.sweep` that holds it.
    path : str or PathLike
        File to write, whole or not at all: "press.svg", "press.pdf", "press.dxf".
    theta2 : float or str, default 45.0
        Crank angle [degree], or a text such as "30 deg".
    curves : iterable of tuple, default None
        Points whose curves are drawn, each (link, distance from its first pin [m], angle from its line of pins
        [degree]); None for the one that `linksweep.plot.mechanism` draws.
    machine : bool, default True
        True for machine and curves; False for the curves alone.
    scale : float or str, default None
        Length on paper per length of the machine [1] of SVG and PDF, such as "1:2" or 0.5; None for a figure with
        axes. DXF is always in full size.

    Raises
    ------
    ValueError
        For another ending, for what `linksweep.plot.mechanism` refuses, for a `machine` that is no truth value, and
        for a scale whose page is too large.
    ImportError
        For DXF where ezdxf is not installed: ``pip install "linksweep[cad]"``.
    OSError
        When the folder is missing, cannot be written or is full.

    Notes
    -----
    DXF has the skeleton of the machine: on a layer of its own each link, as lines from pin to pin, and each curve, as a
    polyline; on further layers pins, centres of gravity, guides, pitch circles, centre lines and names. Circles of pins
    and blocks are signs: the scene does not hold their sizes. The origin is the crank's ground pin, the unit that of
    `linksweep.units` or of the scene, else mm; the file states it ($INSUNITS).

    Examples
    --------
    >>> import linksweep as ls
    >>> import pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "press.svg")
    ...     ls.save_drawing(ls.example("press"), path, theta2="30 deg", scale="1:2")
    ...     "</svg>" in path.read_text(encoding="utf-8")
    True
    """
    ending = ending_of(path, ENDINGS)
    refuse(flag_problems("machine", machine))
    one = scene_from(scene, whole=False)
    angle = crank_angle(theta2)
    drawing_of(one.mechanism)  # refuses a machine without one, before its curves
    points = None if curves is None else _points(one, curves)
    size = None if scale is None else scale_of(scale)
    refuse([f"scale = {quote(scale)}: a DXF file is in full size; leave it out"] if size and ending == ".dxf" else [])
    refuse(["machine = False: curves must name at least one point"] if not (machine or points) else [])
    if ending == ".dxf":
        from linksweep.plot.sheets.dxf import write_dxf  # here: it needs ezdxf

        parts = skeleton(one, angle, points, machine)
        with whole(path) as temporary:
            write_dxf(parts, one, temporary)
    else:
        from linksweep.plot.sheets.page import page, write_page  # here: it imports matplotlib

        figure = page(one, angle, points, machine, size)
        with whole(path) as temporary:
            write_page(figure, temporary, ending[1:])


def _points(scene: Scene, curves: Any) -> list[Curve]:
    """Return the points of curves, checked."""
    roles = {body.role: body.number for body in scene.mechanism.bodies}
    every = [curves] if isinstance(curves, tuple) and curves and isinstance(curves[0], str) else listed(curves)
    points = []
    for k, item in enumerate(every, 1):
        path = f"curves[{k}]"
        sound = isinstance(item, tuple | list) and len(item) == 3
        refuse([] if sound else [f"{path} = {quote(item)}: must be (link, distance [m], angle [degree])"])
        link, *at = item
        refuse(choice_problems(f"{path}[1]", link, roles))
        points.append(Curve(link, roles[link], one_pair(path, tuple(at), POLAR_POINT)))
    return points


def scale_of(scale: Any) -> float:
    """Return the length on paper per length of a machine, of a number or a text such as "1:2"."""
    size = scale
    if isinstance(scale, str):
        paper, colon, of_machine = scale.partition(":")
        try:
            size = float(paper) / (float(of_machine) if colon else 1.0)
        except (ValueError, ZeroDivisionError):
            raise ValueError(f'scale = "{scale}": must be a scale such as 1:2, or a number such as 0.5') from None
    return one_number("scale", size, Rule("dimensionless", above=0.0))
