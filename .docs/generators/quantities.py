"""The page of all quantities: for each machine, the names that `sweep` and `peaks` can compute."""

from pathlib import Path

import linksweep as ls
from generators.page import Page
from linksweep.results.quantities import HEADER

MACHINES = {
    "Four-bar": ("press", 'the four-bar of `ls.example("press")`'),
    "Slider-crank": ("engine", 'the engine of `ls.example("engine")`'),
    "Inverted slider-crank": ("quick-return", 'the shaper of `ls.example("quick-return")`'),
    "Car in a loop": ("loop", '`ls.example("loop")`'),
    "Linkage": ("knuckle-press", '`ls.example("knuckle-press")`; other linkages have other links and pins'),
}
"""Headings, with the example whose quantities stand below."""

INTRODUCTION = """\
Every name that `of=` takes, in `ls.sweep`, `ls.peaks` and `ls.study`. `ls.quantities(scene)` lists those of your own
machine, and `ls.quantities(scene, "force")` searches the list.

`ls.peaks` adds an ending to each name. A magnitude such as `F32` has `F32_peak` and, in degrees, `F32_peak_at`. A
quantity with a sign such as `T12` has `T12_max` and `T12_min`, each with its `_at`, and `T12_peak`, the largest
magnitude. Request `T12_mean`, `T12_rms` (over time), `F32_bound` or `F32_samples` by that name.

Units are in UDUNITS spelling; `1` is a number without a unit. The column "dims" states on what the quantity depends
in this example; "default" marks those that a sweep computes when you ask for nothing in particular.
"""


def write(folder: Path) -> None:
    """Write quantities.md."""
    page = Page()
    page.heading("Quantities", INTRODUCTION, level=1)
    for heading, (name, words) in MACHINES.items():
        table = ls.quantities(ls.example(name))
        page.heading(heading, f"{len(table)} quantities of {words}.")
        page.table(HEADER, ([f"`{row.cells[0]}`", *row.cells[1:]] for row in table))
    page.write(folder / "quantities.md")
