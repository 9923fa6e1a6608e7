"""Commands that print what parameters and tolerances do to results: sensitivities, tolerance."""

from __future__ import annotations

import argparse
from typing import Any

import linksweep as ls
from linksweep.base.validate import refuse
from linksweep.cli.commands import add_command, add_plot, one_design, show
from linksweep.tables.answers import answer_of


def add_sensitivity_commands(commands: Any) -> None:
    """Add the two words to those of the command line."""
    which = add_command(commands, "sensitivities", _sensitivities, "derivatives of results to the scene's parameters")
    names = "results, such as F32_peak T12_rms swing"
    which.add_argument("--of", nargs="+", metavar="NAME", help=f"{names} (peaks of all pins and the drive)")
    which.add_argument("--to", nargs="+", metavar="PATH", help="parameters, such as coupler.length (all)")

    made = add_command(commands, "tolerance", _tolerance, "what tolerances of parameters do to results")
    made.add_argument("--of", nargs="+", metavar="NAME", required=True, help=names)
    text = 'a parameter with its lower and upper limit, as crank.length "0 um" "21 um", or a class, as ground js9'
    made.add_argument("--tol", nargs="+", action="append", required=True, metavar=("PATH", "LIMIT"), help=text)
    made.add_argument("-n", type=int, default=1024, help="designs drawn for exact results beside (1024)")
    add_plot(made)


def _sensitivities(options: argparse.Namespace) -> None:
    print(answer_of(ls.sensitivities(one_design(options.scene), options.of, to=options.to)))


def _tolerance(options: argparse.Namespace) -> None:
    wrong = [" ".join(words) for words in options.tol if len(words) not in (2, 3)]
    refuse([f"--tol {text}: must be a parameter with two limits, or with one class, as ground js9" for text in wrong])
    tolerances = {path: _limits(limits) for path, *limits in options.tol}
    ds = ls.tolerance(one_design(options.scene), tolerances, of=options.of, n=options.n)
    print(answer_of(ds))
    show(options, lambda: ls.plot.tornado(ds))


def _limits(words: list[str]) -> str | ls.Tolerance:
    """Return a class by its name, or limits as numbers or with units."""
    return words[0] if len(words) == 1 else ls.Tolerance(*(_number(word) for word in words))


def _number(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text
