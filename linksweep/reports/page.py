"""report(scene, "report.html"): inputs, checks, peaks and figures of one machine on a page to print, in one file.

The template is `page.html`. Inputs, checks, tables and figures are pieces of their own: `scene_tables`, `page_checks`,
`page_tables`, `page_figures`. There is no date in the page, and the figures are drawn with matplotlib's own settings
whatever the user's are, so that equal scenes give equal files, byte for byte.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from importlib.metadata import version
from importlib.resources import files
from string import Template
from typing import Any

import xarray as xr

from linksweep.analysis.strength.material import Material
from linksweep.base.validate import refuse
from linksweep.engine.threads import limits_threads
from linksweep.files.atomic import ending_of
from linksweep.files.netcdf import scene_from, write_text
from linksweep.reports import checks as page_checks
from linksweep.reports import figures as page_figures
from linksweep.reports import scene_tables
from linksweep.reports import tables as page_tables
from linksweep.reports.cylinder_page import parts_of
from linksweep.reports.markup import Markup, joined, safe, section, tag
from linksweep.reports.results_of_page import Range, Results, Steel, results_of
from linksweep.reports.scene_tables import degrees
from linksweep.results.compute import part_of
from linksweep.results.cylinders.multi_cylinder import MultiCylinder
from linksweep.scene.designs.choose import design_labels
from linksweep.scene.file.writing import write_scene
from linksweep.scene.scene import Scene
from linksweep.studies.scene_at import scene_at

ENDINGS = (".html", ".htm")
ADVICE = ": a report is a page, which a browser prints, to PDF as well"
EXACTNESS = "Peaks are exact; the bound says how much higher one could be."
EXPLORER = "linksweep explore scene.toml"
EXPLORE = tag(
    "p", joined("Saved as scene.toml, it can be changed under the mouse: ", tag("code", EXPLORER)), class_="note"
)
SIGNS = "Fᵢⱼ is the force of link i on link j; angles and torques count counter-clockwise, from x."


@limits_threads
def report(
    scene: Scene | xr.Dataset | MultiCylinder,
    path: str | os.PathLike[str],
    *,
    title: str | None = None,
    theta2: tuple[float, float] | None = None,
    material: Material | Mapping[str, Material] | None = None,
    threads: int | None = None,
) -> None:
    """Write a report of one machine: inputs, checks, peaks, drive, geometry, shaking and figures, to print on A4.

    Parameters
    ----------
    scene : Scene, Dataset or MultiCylinder
        Machine of one design; a Dataset of linksweep holds its scene.
    path : str or PathLike
        File to write, "report.html". It needs no other file and no network; an existing one is replaced only once the
        new one is complete.
    title : str, default None
        Heading of the page; None for the kind of mechanism.
    theta2 : pair of float, default None
        First and last crank angle [degree] of a machine that moves over part of a turn, as a tipper does; checks,
        figures and peaks are then of this part.
    material : Material or mapping of str to Material, default None
        Material of the links, or of each by role, for a table of their strength and their moment diagrams; None for no
        such table.
    threads : int, default None
        Largest number of threads; None for all cores.

    Raises
    ------
    ValueError
        For a scene over designs (choose one with `linksweep.scene_at`, or in a Dataset with isel), for another ending
        than .html, and for bad angles.
    OSError
        When the folder is missing or cannot be written.

    Notes
    -----
    Numbers are in the units of `linksweep.units`, or of the scene; where none are chosen, lengths stand in mm, speeds
    of a crank in rpm, and all else as in the results. Every number of the tables stands in full in the `value` of its
    element. Peaks are those of `linksweep.peaks`, with their bounds; checks those of
    `linksweep.check`, and the balance of power and the rounding error of a sweep. The file holds the scene as well.

    Examples
    --------
    >>> import linksweep as ls
    >>> import pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "report.html")
    ...     ls.report(ls.example("loop"), path, title="Rocket car")
    ...     "<h1>Rocket car</h1>" in path.read_text(encoding="utf-8")
    True
    """
    ending_of(path, ENDINGS, ADVICE)
    if isinstance(scene, MultiCylinder):
        refuse([] if theta2 is None else [f"theta2 = {theta2}: must be left out for several cylinders"])
        refuse([] if material is None else ["material: must be left out for several cylinders"])
        write_text(page_of_cylinders(scene.in_memory, title), path)
        return
    one = scene_at(scene) if isinstance(scene, xr.Dataset) else scene_from(scene)
    refuse(_design_problems(one))
    part = part_of("theta2", theta2, one)
    refuse(["material: strength is of the whole cycle; leave out theta2"] if material and part else [])
    text = page(one, title, part, material)
    write_text(text.encode(errors="replace").decode(), path)  # a title may have bytes that are no letters


def page(scene: Scene, title: str | None = None, part: Range | None = None, material: Steel | None = None) -> str:
    """Return the report as HTML."""
    results = results_of(scene, part, material)
    kind = scene_tables.kind_of(scene)
    between = f" from {degrees(part[0])} to {degrees(part[1])}" if part else ""
    parts = {
        "title": title or kind,
        "kind": kind + between,
        "version": version("linksweep"),
        "warnings": page_checks.warnings(results),
        "machine": joined(
            section("Machine", scene_tables.links(scene), scene_tables.loads(scene)),
            section("Strength of the links", page_tables.strength(results)),
        ),
        "left": joined(*_left(results)),
        "right": joined(*_right(results)),
        "figures": page_figures.of_the_cycle(results),
        "more": page_figures.of_bearings_and_shaking(results),
        "signs": SIGNS if results.scene.mechanism.bodies else "",
        "explore": EXPLORE if scene.mechanism.drawing else "",
        "scene": write_scene(scene),
    }
    return _filled(parts)


def page_of_cylinders(machine: MultiCylinder, title: str | None) -> str:
    """Return the report of an engine of several cylinders as HTML."""
    parts = parts_of(machine)
    return _filled({**parts, "title": title or "Engine", "version": version("linksweep")})


def _filled(parts: Mapping[str, Any]) -> str:
    template = Template((files(__package__) / "page.html").read_text(encoding="utf-8"))
    return template.substitute({name: safe(part) for name, part in parts.items()})


def _left(results: Results) -> Iterator[Markup]:
    yield section("Motion" if results.linkage else "Machine", scene_tables.settings(results.scene))
    yield section("Peaks", page_tables.peaks(results), tag("p", EXACTNESS, class_="note"))
    yield section("Geometry", page_tables.geometry(results))


def _right(results: Results) -> Iterator[Markup]:
    yield section("Checks", page_checks.checks(results))
    yield section("Drive", page_tables.drive(results))
    yield section("Motion", page_tables.highlights(results))
    yield section("Shaking, by the inertia of the links", page_tables.shaking(results))


def _design_problems(scene: Scene) -> list[str]:
    labels = design_labels(scene)
    if not labels:
        return []
    sizes = ", ".join(f"{dim} ({len(values)})" for dim, values in labels.items())
    choice = ", ".join(f"{dim!r}: {values[0].item()!r}" for dim, values in labels.items())
    return [
        f"the scene is over several designs, {sizes}, and a report shows one: choose it, "
        f"ls.report(ls.scene_at(scene, {{{choice}}}), ...), or of a Dataset with isel"
    ]
