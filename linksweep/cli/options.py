"""Declare commands, each under the task that it is for, and the options that several of them share.

Nothing slow is imported before a command runs: `linksweep --help` and the completion of a shell are then immediate.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Collection, Iterable, Iterator
from importlib import import_module
from pathlib import Path
from typing import Any, NoReturn

PICTURES = (".png", ".pdf", ".svg")
FILMS = (".gif", ".html")
SHEETS = (".svg", ".pdf", ".dxf")


class Commands:
    """The commands of a program, by task."""

    def __init__(self, program: argparse.ArgumentParser) -> None:
        self._parsers = program.add_subparsers(metavar="command", parser_class=Command)
        self.by_name: dict[str, argparse.ArgumentParser] = {}
        self.by_task: dict[str, dict[str, str]] = {}

    def add(
        self, name: str, run: Callable[[argparse.Namespace], None], text: str, *, task: str, scene: bool = True
    ) -> argparse.ArgumentParser:
        """Add a command under the heading of a task; return its parser, which takes a scene unless told otherwise."""
        self.by_task.setdefault(task, {})[name] = text
        parser = self.by_name[name] = self._parsers.add_parser(name, help=text, description=text)
        parser.set_defaults(run=run, parser=parser)
        if scene:
            parser.add_argument("scene", type=Path, help="scene file (.toml), result (.nc), or an example's name")
        parser.add_argument("--units", metavar="UNITS", help='units to show: SI, US, mm, or as in "in, lbf, rpm"')
        return parser


class Command(argparse.ArgumentParser):
    """The parser of one command."""

    def error(self, message: str) -> NoReturn:
        """Exit with a message, and with advice where the scene was taken for one of several names."""
        advice = "; it stands before options that take several names, such as --of"
        super().error(message + (advice if message.endswith("required: scene") else ""))


class Words(Collection[str]):
    """Words that an option may take: those of a table, whose module is imported when they are needed."""

    def __init__(self, module: str, table: str) -> None:
        self._module, self._table = module, table

    def _words(self) -> list[str]:
        table = getattr(import_module(self._module), self._table)
        return list(table() if callable(table) else table)

    def __iter__(self) -> Iterator[str]:
        return iter(self._words())

    def __len__(self) -> int:
        return len(self._words())

    def __contains__(self, word: object) -> bool:
        return word in self._words()


STRENGTHS = Words("linksweep.analysis.strength.material", "STRENGTHS")
KINDS = Words("linksweep.analysis.pins.bearing", "EXPONENTS")
FRAMES = Words("linksweep.analysis.pins.bearings", "FRAMES")
EXAMPLES = Words("linksweep.scene.examples", "names")
RESULTS = Words("linksweep.files.netcdf", "RESULTS")
TABLES = Words("linksweep.files.netcdf", "TABLES")
SCENES = Words("linksweep.files.netcdf", "SCENES")


def add_plot(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--plot", type=a_file(PICTURES), help="figure to write: .png, .pdf or .svg")


def add_angles(parser: argparse.ArgumentParser, text: str, default: int | None = None) -> None:
    parser.add_argument("--theta2", "--theta", dest="angles", type=int, default=default, metavar="N", help=text)


def add_capacity(parser: argparse.ArgumentParser) -> None:
    """Add the options of the rolling bearings in all pins."""
    rating = 'dynamic load rating of all bearings, such as "5 kN"'
    parser.add_argument("--capacity", type=a_number("force"), help=rating)
    kinds = "of rolling bearings: %(choices)s (ball)"
    parser.add_argument("--kind", choices=KINDS, default="ball", metavar="KIND", help=kinds)


def add_part(parser: argparse.ArgumentParser, text: str) -> None:
    parser.add_argument("--theta2", nargs=2, type=float, metavar=("FIRST", "LAST"), help=text)


def add_names(parser: argparse.ArgumentParser, *option: str, text: str, metavar: str = "NAME", **more: Any) -> None:
    """Add an option, or an argument, that takes several names, with spaces or commas between them."""
    count = "+" if option[0].startswith("-") else "*"
    parser.add_argument(*option, nargs=count, type=_names, action=_Names, metavar=metavar, help=text, **more)


def add_of(parser: argparse.ArgumentParser, *others: str) -> None:
    text = "names of quantities, as in --of F32 T12 or --of F32,T12, after the scene; linksweep quantities lists them"
    add_names(parser, "--of", *others, text=text)


class _Names(argparse.Action):
    """Joins the names of arguments that each have one or several."""

    def __call__(self, parser: Any, namespace: Any, values: Any, option: str | None = None) -> None:
        several = values if values is not self.default else []
        setattr(namespace, self.dest, [name for names in several for name in names] or self.default)


def _names(text: str) -> list[str]:
    names = [name.strip() for name in text.split(",") if name.strip()]
    if not names:
        raise argparse.ArgumentTypeError("must be names, such as F32 T12")
    return names


def a_file(endings: Iterable[str]) -> Callable[[str], Path]:
    """Return a function that reads an argument as a file with one of these endings."""

    def read(text: str) -> Path:
        from linksweep.files.atomic import ending_of

        try:
            ending_of(text, tuple(endings))
        except ValueError as error:
            raise argparse.ArgumentTypeError(str(error)) from None
        return Path(text)

    return read


def a_number(kind: str) -> Callable[[str], float]:
    """Return a function that reads an argument as a number with a unit, or in SI units."""

    def read(text: str) -> float:
        from linksweep.base.units import quantity

        try:
            return float(text)
        except ValueError:
            pass
        try:
            return quantity(text, kind)
        except ValueError as error:
            raise argparse.ArgumentTypeError(str(error)) from None

    return read


def number_or_text(text: str) -> float | str:
    """Return an argument as a number if it is one, else as it is, with a unit for the library to read."""
    try:
        return float(text)
    except ValueError:
        return text
