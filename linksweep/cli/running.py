"""Load scenes by name, print tables and write figures, for all commands."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import linksweep as ls
from linksweep.cli.options import PICTURES

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


def scene_named(path: Path) -> ls.Scene:
    """Return the scene of a file; where there is no file of this name, the example of this name."""
    from linksweep.scene.examples import names

    return ls.example(str(path)) if str(path) in names() and not path.exists() else ls.load_scene(path)


def one_design(path: Path) -> ls.Scene:
    """Return the scene of a file, of one design."""
    from linksweep.scene.designs.choose import design_labels

    scene = scene_named(path)
    several = ", ".join(f"{dim} ({len(labels)})" for dim, labels in design_labels(scene).items())
    if several:
        advice = "this takes one, linksweep peaks and linksweep study take many"
        raise ValueError(f"{path}: has several designs, over {several}; {advice}")
    return scene


def print_answer(ds: xr.Dataset, end: str = "\n") -> None:
    """Print the tables of a result."""
    from linksweep.tables.answers import answer_of

    print(answer_of(ds), end=end)


def show(options: argparse.Namespace, draw: Callable[[], Any]) -> None:
    """Write the figure of a plot to the file that the option --plot names, if any, without a screen."""
    if options.plot is None:
        return
    without_a_screen()
    drawn = draw()
    write_figure(drawn if hasattr(drawn, "savefig") else drawn.figure, options.plot)
    print(f"\nwritten: {options.plot}")


def without_a_screen() -> None:
    """Draw to files alone, in the first font of matplotlib's list: it looks for all of them at each text."""
    import matplotlib as mpl

    _without_documentation()
    mpl.use("Agg")
    if mpl.rcParams["font.sans-serif"][0] == "DejaVu Sans":  # it comes with matplotlib
        mpl.rcParams["font.sans-serif"] = ["DejaVu Sans"]


def _without_documentation() -> None:
    """Keep matplotlib from writing, while it is imported, into the docstrings of all its artists which properties they
    have: it takes a tenth of the time of `linksweep demo`."""
    from matplotlib import artist

    artist.kwdoc = lambda artist: ""
    artist.Artist._update_set_signature_and_docstring = classmethod(lambda kind: None)  # type: ignore[attr-defined]


def write_figure(figure: Figure, path: Path) -> None:
    """Write a figure to a file, whole or not at all, and close it."""
    from matplotlib import pyplot

    from linksweep.files.atomic import ending_of, whole, write_from_memory

    try:
        with whole(path) as temporary:
            if ending_of(path, PICTURES) == ".png":
                _write_png(figure, temporary)
            else:
                write_from_memory(temporary, partial(figure.savefig, format=ending_of(path, PICTURES)[1:], dpi=150))
    finally:
        pyplot.close(figure)


def _write_png(figure: Figure, path: Path) -> None:
    """Write a figure as `Figure.savefig` does, which draws it twice, the first time for a layout that any drawing
    makes, and compresses it for twice the time into 0.96 of the bytes."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    figure.set_dpi(150)
    FigureCanvasAgg(figure).print_png(path, pil_kwargs={"compress_level": 3})
