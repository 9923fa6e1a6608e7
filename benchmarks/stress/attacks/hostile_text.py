"""Cut, flip and stuff scene files and CSV columns with odd and huge values: a scene, or a clean ValueError, soon."""

from __future__ import annotations

import signal
import tempfile
import warnings
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path

import numpy as np

import linksweep as ls
from benchmarks.stress.attacks import Outcome
from linksweep.scene.curves.interpolation import OvershootWarning

TITLE = "scene files and CSV columns damaged, huge or odd: a scene that sweeps, or one clean ValueError, soon"
ROUNDS, SMALL = 5000, 40

SOON = 20
"""Seconds that reading a file and one short sweep may take."""
LONGEST = 500
"""Most characters in a line of a message; there is one line per problem."""
EXAMPLES = [(files("linksweep.scene.examples") / f"{name}.toml").read_text() for name in ("press", "engine", "loop")]
COLUMN = "theta2,P\n" + "".join(f"{angle},{angle % 70}\n" for angle in range(0, 360, 15))
LOAD = '\n[[loads]]\nlink = "coupler"\ninterpolation = "linear"\ntorque = {csv = "a.csv", unit = "N m"}\n'
ODD = (
    "1e308", "-1e308", "1e-320", "nan", "inf", "-0.0", "0", "true", '""', "[]", "{}", "[[[[1]]]]", "1979-05-27",
    "0x" + "f" * 5000, "9" * 4000, '"1e400 cm"', '"' + "9" * 900 + ' cm"', '"1 ' + "m" * 5000 + '"', '"½ in"',
    '"\\u0000"', '"=1+1"', "[" * 3000 + "]" * 3000, '{csv = "/dev/zero"}', '{csv = "../../../../etc/passwd"}',
    '{csv = "."}', '{csv = "a.csv", column = "Q"}', '{dim = "d", values = []}', '{dim = "theta2", values = [1]}',
    '{dim = "d", start = 1, stop = 2, num = 1000000000}', '"""' + "a\n" * 5000 + '"""', '{variable = "ground"}',
)  # fmt: skip
CELLS = (
    "",
    "1e308",
    "-1e308",
    "nan",
    "x" * 2000,
    "1,2",
    '"',
    "\x00",
    "½",
    "1e-320",
    "360",
    "-5",
    "=1+1",
    "1" * 150_000,
)


def cut(text: str, random: np.random.Generator) -> str:
    return text[: random.integers(len(text))]


def flip(text: str, random: np.random.Generator) -> str:
    at = int(random.integers(len(text)))
    return text[:at] + chr(int(random.choice([random.integers(1, 128), random.integers(160, 5000)]))) + text[at + 1 :]


def twice(text: str, random: np.random.Generator) -> str:
    lines = text.split("\n")
    at = int(random.integers(len(lines)))
    return "\n".join([*lines[:at], *lines[at : at + 3] * int(random.integers(2, 300)), *lines[at:]])


def odd_value(text: str, random: np.random.Generator) -> str:
    """Replace the value behind one of the equals signs."""
    lines = text.split("\n")
    at = int(random.choice([k for k, line in enumerate(lines) if "=" in line]))
    return "\n".join([*lines[:at], f"{lines[at].split('=')[0]}= {ODD[random.integers(len(ODD))]}", *lines[at + 1 :]])


def odd_cell(text: str, random: np.random.Generator) -> str:
    """Replace a cell in one of the lines of a CSV file."""
    lines = text.split("\n")
    at, cell = int(random.integers(len(lines))), CELLS[random.integers(len(CELLS))]
    cells = lines[at].split(",")
    cells[int(random.integers(len(cells)))] = cell
    return "\n".join([*lines[:at], ",".join(cells), *lines[at + 1 :]])


SCENES: tuple[Callable[[str, np.random.Generator], str], ...] = (cut, flip, twice, odd_value)
COLUMNS: tuple[Callable[[str, np.random.Generator], str], ...] = (cut, flip, twice, odd_cell)


def attack(random: np.random.Generator, rounds: int) -> Outcome:
    failures = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for _ in range(rounds):
            if random.random() < 0.7:
                spoil, text, column = SCENES[random.integers(4)], EXAMPLES[random.integers(3)], COLUMN
                text = spoil(text, random)
            else:
                spoil, text = COLUMNS[random.integers(4)], EXAMPLES[0] + LOAD
                column = spoil(COLUMN, random)
            (folder / "scene.toml").write_text(text, encoding="utf-8")
            (folder / "a.csv").write_text(column, encoding="utf-8", newline="")
            failures += [f"{spoil.__name__}: {problem}" for problem in _problems(folder / "scene.toml")]
    return Outcome(rounds, failures)


def _problems(path: Path) -> list[str]:
    before = signal.signal(signal.SIGALRM, _too_long)
    signal.alarm(SOON)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            warnings.simplefilter("ignore", OvershootWarning)
            ls.sweep(ls.load_scene(path), 5, threads=1)
    except ValueError as error:
        clean = (
            type(error) is ValueError and max(map(len, str(error).split("\n"))) <= LONGEST and "root:" not in str(error)
        )
        return [] if clean else [f"{type(error).__name__}: {str(error)[:200]}"]
    except Exception as error:
        return [f"{type(error).__name__}: {str(error)[:200]}"]
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)
    return []


def _too_long(*_: object) -> None:
    raise TimeoutError(f"not done after {SOON} s")
