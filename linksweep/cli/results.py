"""Commands for motion and forces over a revolution: demo, peaks, check, sweep, quantities."""

from __future__ import annotations

import argparse
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import linksweep as ls
from linksweep.cli.options import (
    EXAMPLES,
    FILMS,
    PICTURES,
    RESULTS,
    SCENES,
    Commands,
    a_file,
    add_angles,
    add_of,
    add_plot,
)
from linksweep.cli.running import one_design, print_answer, scene_named, without_a_screen, write_figure

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


def add_result_commands(commands: Commands) -> None:
    """Add these commands to those of the command line."""
    add = partial(commands.add, task="Motion and forces")
    demo = add("demo", _demo, "a built-in scene: peak table, demo.nc, demo.png", scene=False)
    demo.add_argument("scene", nargs="?", choices=EXAMPLES, default="press", metavar="NAME", help="%(choices)s (press)")
    without = "name of the files without ending (demo)"
    demo.add_argument("-o", "--output", type=_stem, dest="stem", metavar="NAME", default=Path("demo"), help=without)

    worst = add("peaks", _peaks, "the worst of each pin force and of the torque")
    add_angles(worst, "number of angles: the largest of these samples, not the exact peaks")
    part = "first and last angle [degree] of a part of the cycle: the exact peaks of that part, ends included"
    worst.add_argument("--between", nargs=2, type=float, metavar=("FIRST", "LAST"), help=part)
    add_of(worst)
    worst.add_argument("-o", "--output", type=a_file(RESULTS), help="file to write: .nc, .csv or .xlsx")

    add("check", _check, "assembly, Grashof class, limits, toggles")

    cycle = add("sweep", _sweep, "one revolution to a file, and to a figure")
    add_angles(cycle, "number of angles (720)", default=720)
    cycle.add_argument("-o", "--output", type=a_file(RESULTS), required=True, help="file to write: .nc, .csv or .xlsx")
    add_plot(cycle)
    add_of(cycle, "--outputs")

    listed = add("quantities", _quantities, "all quantities of sweep and peaks: names, units, meanings")
    listed.add_argument("words", nargs="*", help="only those with these words in name, unit or meaning, such as force")


def _demo(options: argparse.Namespace) -> None:
    from linksweep.scene.examples import title

    scene = ls.example(options.scene)
    cycle = ls.sweep(scene)
    print(f"{title(options.scene)}\n")
    print_answer(ls.peaks(scene))
    data, picture = (options.stem.with_name(options.stem.name + ending) for ending in (".nc", ".png"))
    ls.save(cycle, data)
    write_figure(_figure(cycle), picture)
    print(f"\nwritten: {data} (open it with xarray.open_dataset), {picture}")


def _sweep(options: argparse.Namespace) -> None:
    scene = (one_design if options.plot else scene_named)(options.scene)
    cycle = ls.sweep(scene, options.angles, of=options.of)
    figure = None
    if options.plot:  # with all pin forces, whichever quantities the file has
        figure = _figure(cycle if options.of is None else ls.sweep(scene, options.angles))
    ls.save(cycle, options.output)
    print(f"written: {options.output}")
    if figure is not None:
        write_figure(figure, options.plot)
        print(f"written: {options.plot}")


def _peaks(options: argparse.Namespace) -> None:
    scene = scene_named(options.scene)
    ds = ls.peaks(scene, of=options.of, between=options.between, **{scene.mechanism.index: options.angles})
    print_answer(ds)
    if options.output:
        ls.save(ds, options.output)
        print(f"\nwritten: {options.output}")


def _quantities(options: argparse.Namespace) -> None:
    words = " ".join(options.words)
    table = ls.quantities(scene_named(options.scene), words)
    if not table:
        raise ValueError(f'{options.scene}: no quantity has "{words}" in its name, unit or meaning')
    print(table)


def _check(options: argparse.Namespace) -> None:
    print_answer(ls.check(scene_named(options.scene)))


def _stem(text: str) -> Path:
    """Return the name of files that differ by their endings."""
    path = Path(text)
    if path.suffix.lower() in (*RESULTS, *SCENES, *PICTURES, *FILMS):
        raise argparse.ArgumentTypeError(
            f"{text}: give a name without ending; {path.stem}.nc and {path.stem}.png follow"
        )
    return path


def _figure(cycle: xr.Dataset) -> Figure:
    """Draw the page of a cycle without a screen."""
    without_a_screen()
    return ls.plot.cycle(cycle)
