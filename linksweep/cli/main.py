"""The command line: demo, sweep, peaks, quantities, study, check, report; `commands` has the rest."""

from __future__ import annotations

import argparse
import io
import os
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import linksweep as ls
from linksweep.analysis.strength.material import STRENGTHS
from linksweep.base.validate import refuse
from linksweep.base.version import installed_version
from linksweep.cli.commands import (
    FILMS,
    PICTURES,
    a_file,
    add_command,
    add_commands,
    add_part,
    add_plot,
    scene_named,
    without_a_screen,
    write_figure,
)
from linksweep.cli.sensitivity import add_sensitivity_commands
from linksweep.files.atomic import target_of
from linksweep.files.netcdf import RESULTS, SCENES, TABLES
from linksweep.scene.examples import names, title
from linksweep.tables.answers import answer_of

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


CLOSED_PIPE = 141
"""Exit status, as a shell tells it, of a program that ended because nobody reads its output."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; 0 when all went well, 2 with a message when the input or a file was at fault."""
    _print_anything()
    try:
        options = _parser().parse_args(arguments)
        code = _run(options)
        if sys.stdout:  # None where it was closed before the start
            sys.stdout.flush()
    except BrokenPipeError:  # who reads the output has had enough of it
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return CLOSED_PIPE
    return code


def _run(options: argparse.Namespace) -> int:
    try:
        for path in filter(None, (getattr(options, "output", None), getattr(options, "plot", None))):
            target_of(path)  # before anything is computed
        with ls.units(getattr(options, "units", None)):
            options.run(options)
    except BrokenPipeError:
        raise
    except (ValueError, OSError, ImportError) as error:
        print(f"linksweep: {error}", file=sys.stderr)
        return 2
    except MemoryError:
        print("linksweep: the memory is full: ask for fewer angles, designs or quantities", file=sys.stderr)
        return 2
    except KeyboardInterrupt as stopped:
        print(f"linksweep: {str(stopped) or 'stopped'}", file=sys.stderr)
        return 130
    return 0


def _print_anything() -> None:
    """Print a question mark for characters that the terminal's encoding lacks, such as ° in ASCII."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="linksweep", description="How hard are my pins loaded, and where is the worst of it?"
    )
    parser.add_argument("--version", action="version", version=f"linksweep {installed_version()}")
    parser.set_defaults(run=lambda options: parser.print_help())
    commands = parser.add_subparsers(metavar="command")
    add = partial(add_command, commands)

    demo = commands.add_parser("demo", help="a built-in scene: peak table, demo.nc, demo.png")
    scenes, without = names(), "name of the files without ending (demo)"
    demo.add_argument("scene", nargs="?", choices=scenes, default="press", help=f"{', '.join(scenes)} (press)")
    demo.add_argument("-o", "--output", type=_stem, dest="stem", metavar="NAME", default=Path("demo"), help=without)
    demo.set_defaults(run=_demo)

    cycle = add("sweep", _sweep, "one revolution to a file, and to a figure")
    _add_angles(cycle, "number of angles (720)", default=720)
    cycle.add_argument("-o", "--output", type=a_file(RESULTS), required=True, help="file to write: .nc, .csv or .xlsx")
    add_plot(cycle)
    _add_of(cycle, "--outputs")

    worst = add("peaks", _peaks, "the worst of each pin force and of the torque")
    _add_angles(worst, "number of angles: the largest of these samples, not the exact peaks")
    _add_of(worst)
    worst.add_argument("-o", "--output", type=a_file(RESULTS), help="file to write: .nc, .csv or .xlsx")

    listed = add("quantities", _quantities, "all quantities of sweep and peaks: names, units, meanings")
    listed.add_argument("words", nargs="*", help="only those with these words in name, unit or meaning, such as force")

    many = add("study", _study, "peaks of many designs to NetCDF; goes on where it was stopped")
    many.add_argument("-o", "--output", type=Path, required=True, help="NetCDF file to write: .nc")
    _add_of(many)
    chunks = "designs computed at a time (50000; 1000 where loads or speeds change with the angle)"
    many.add_argument("--table", type=a_file(tuple(TABLES)), metavar="FILE", help="table of it to write: .csv or .xlsx")
    many.add_argument("--chunk", type=int, metavar="N", help=chunks)

    add("check", _check, "assembly, Grashof class, limits, toggles")

    page = add("report", _report, "a page to print: inputs, checks, peaks, drive, figures")
    page.add_argument("-o", "--output", type=Path, required=True, help="page to write: .html")
    page.add_argument("--title", help="heading of the page (name of the scene file)")
    add_part(page, "crank angles [degree] of a machine that moves over part of a turn")
    page.add_argument("--material", choices=STRENGTHS, help="material of the links, for a table of their strength")
    add_commands(commands)
    add_sensitivity_commands(commands)
    for command in commands.choices.values():
        command.add_argument("--units", metavar="UNITS", help='units to show: SI, US, mm, or as in "in, lbf, rpm"')
    return parser


def _add_angles(parser: argparse.ArgumentParser, text: str, default: int | None = None) -> None:
    parser.add_argument("--theta2", "--theta", dest="angles", type=int, default=default, metavar="N", help=text)


class _Names(argparse.Action):
    """An option that takes names separated by spaces or commas."""

    def __call__(self, parser: Any, namespace: Any, values: Any, option: str | None = None) -> None:
        setattr(namespace, self.dest, [name for names in values for name in names])


def _add_of(parser: argparse.ArgumentParser, *others: str) -> None:
    text = "names of quantities, as in --of F32 T12, after the scene; see linksweep quantities"
    parser.add_argument("--of", *others, type=_names, nargs="+", action=_Names, metavar="NAME", help=text)


def _demo(options: argparse.Namespace) -> None:
    scene = ls.example(options.scene)
    cycle = ls.sweep(scene)
    print(f"{title(options.scene)}\n")
    print(answer_of(ls.peaks(scene)))
    data, picture = (options.stem.with_name(options.stem.name + ending) for ending in (".nc", ".png"))
    ls.save(cycle, data)
    write_figure(_figure(cycle), picture)
    print(f"\nwritten: {data} (open it with xarray.open_dataset), {picture}")


def _sweep(options: argparse.Namespace) -> None:
    scene = scene_named(options.scene)
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
    ds = ls.peaks(scene, of=options.of, **{scene.mechanism.index: options.angles})
    print(answer_of(ds))
    if options.output:
        ls.save(ds, options.output)
        print(f"\nwritten: {options.output}")


def _quantities(options: argparse.Namespace) -> None:
    words = " ".join(options.words)
    table = ls.quantities(scene_named(options.scene), words)
    refuse([] if table else [f'{options.scene}: no quantity has "{words}" in its name, unit or meaning'])
    print(table)


def _study(options: argparse.Namespace) -> None:
    scene = scene_named(options.scene)
    there = options.output.exists()
    with ls.study(scene, options.output, of=options.of, chunk=options.chunk) as ds:
        print(answer_of(ds))
        if options.table:
            ls.save(ds, options.table)
    print(f"\n{'was done already' if there else 'written'}: {options.output}")
    if options.table:
        print(f"written: {options.table}")


def _check(options: argparse.Namespace) -> None:
    scene = scene_named(options.scene)
    print(answer_of(ls.check(scene)))


def _report(options: argparse.Namespace) -> None:
    part = tuple(options.theta2) if options.theta2 else None
    steel = ls.material(options.material) if options.material else None
    heading = options.title or options.scene.stem
    ls.report(scene_named(options.scene), options.output, title=heading, theta2=part, material=steel)
    print(f"written: {options.output}")


def _stem(text: str) -> Path:
    """Return the name of files that differ by their endings."""
    path = Path(text)
    if path.suffix.lower() in (*RESULTS, *SCENES, *PICTURES, *FILMS):
        raise argparse.ArgumentTypeError(
            f"{text}: give a name without ending; {path.stem}.nc and {path.stem}.png follow"
        )
    return path


def _names(text: str) -> list[str]:
    names = [name.strip() for name in text.split(",") if name.strip()]
    if not names:
        raise argparse.ArgumentTypeError("must be names of quantities, such as F32 T12")
    return names


def _figure(cycle: xr.Dataset) -> Figure:
    """Draw the page of a cycle without a screen."""
    without_a_screen()
    return ls.plot.cycle(cycle)
