"""Commands for many designs, and for what parameters and tolerances do to one: study, sensitivities, tolerance."""

from __future__ import annotations

import argparse
from functools import partial
from pathlib import Path

import linksweep as ls
from linksweep.cli.options import TABLES, Commands, a_file, add_capacity, add_names, add_of, add_plot, number_or_text
from linksweep.cli.running import one_design, print_answer, scene_named, show


def add_design_commands(commands: Commands) -> None:
    """Add these commands to those of the command line."""
    add = partial(commands.add, task="Designs")
    many = add("study", _study, "peaks of many designs to NetCDF; goes on where it was stopped")
    many.add_argument("-o", "--output", type=Path, required=True, help="NetCDF file to write: .nc")
    add_of(many)
    many.add_argument("--table", type=a_file(TABLES), metavar="FILE", help="table of it to write: .csv or .xlsx")
    chunks = "designs computed at a time (50000; 1000 where loads or speeds change with the angle)"
    many.add_argument("--chunk", type=int, metavar="N", help=chunks)

    which = add("sensitivities", _sensitivities, "derivatives of results to the scene's parameters")
    names = "results, such as F32_peak T12_rms swing time_ratio L10_B"
    add_names(which, "--of", text=f"{names} (peaks of all pins and the drive)")
    add_names(which, "--to", metavar="PATH", text="parameters, such as coupler.length (all)")
    add_capacity(which)

    made = add("tolerance", _tolerance, "what tolerances of parameters do to results")
    add_names(made, "--of", required=True, text=names)
    text = 'a parameter with its lower and upper limit, as crank.length "0 um" "21 um", or a class, as ground js9'
    made.add_argument(
        "--tol", nargs="+", action="append", required=True, dest="tolerances", metavar=("PATH", "LIMIT"), help=text
    )
    add_capacity(made)
    made.add_argument("-n", type=int, default=1024, help="designs drawn for exact results beside (1024)")
    add_plot(made)


def _study(options: argparse.Namespace) -> None:
    scene = scene_named(options.scene)
    there = options.output.exists()
    with ls.study(scene, options.output, of=options.of, chunk=options.chunk) as ds:
        print_answer(ds)
        if options.table:
            ls.save(ds, options.table)
    print(f"\n{'was done already' if there else 'written'}: {options.output}")
    if options.table:
        print(f"written: {options.table}")


def _sensitivities(options: argparse.Namespace) -> None:
    scene = one_design(options.scene)
    print_answer(ls.sensitivities(scene, options.of, to=options.to, pins=_rolling_bearings(scene, options)))


def _tolerance(options: argparse.Namespace) -> None:
    from linksweep.plot.tolerances import tornados

    for words in options.tolerances:
        if len(words) not in (2, 3):
            form = "must be a parameter with two limits, or with one class, as ground js9"
            raise ValueError(f"--tol {' '.join(words)}: {form}")
    tolerances = {path: _limits(limits) for path, *limits in options.tolerances}
    scene = one_design(options.scene)
    ds = ls.tolerance(scene, tolerances, of=options.of, n=options.n, pins=_rolling_bearings(scene, options))
    print_answer(ds)
    show(options, lambda: tornados(ds))


def _rolling_bearings(scene: ls.Scene, options: argparse.Namespace) -> dict[str, ls.Bearing]:
    """Return the bearings of a machine, in every pin the same."""
    bearing = ls.Bearing(capacity=options.capacity, kind=options.kind)
    return dict.fromkeys(getattr(scene.mechanism, "pins", ()), bearing)


def _limits(words: list[str]) -> str | ls.Tolerance:
    """Return a class by its name, or limits as numbers or with units."""
    return words[0] if len(words) == 1 else ls.Tolerance(*(number_or_text(word) for word in words))
