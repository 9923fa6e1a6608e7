"""Run random commands with random options and bad numbers: exit code 0 or 2, one clean message, never a traceback."""

from __future__ import annotations

import contextlib
import io
import os
import tempfile
import traceback
import warnings
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path

import numpy as np

from benchmarks.stress.attacks import Outcome
from linksweep.cli.main import main
from linksweep.scene.examples import names

TITLE = "the command line with random commands, options, files and bad numbers: exit code 0 or 2, a clean message"
ROUNDS, SMALL = 1000, 12

NUMBERS = (
    "0", "-1", "1", "2", "3", "7", "12", "0.5", "nan", "inf", "-inf", "1e308", "1e-308", "1e400", "1000000000000",
    "9" * 5000, "0x10", "", "½", "8 cm", "1/2 in", "5 kN", "m" * 3000, "--", "\udcff",
)  # fmt: skip
WORDS = ("F32", "T12", "F12,F32", "theta4", "Fsx", "status", "nothing", "", "F32 ", "normal_force", "\udcff", "=1+1")
SCENES = (
    *(f"{name}.toml" for name in names()),
    "missing.toml",
    "folder",
    "empty.toml",
    "cycle.nc",
    "b\udcff.toml",
    ".",
)
OUTPUTS = (
    "out.nc", "out.csv", "out.html", "out.gif", "out.png", "out.svg", "folder", "pipe", "missing/out.nc", "",
    "b\udcff.nc", "n" * 252 + ".nc", "n" * 300,
)  # fmt: skip
FIGURE = ("--plot", "out.png", OUTPUTS)
OPTIONS: dict[str, tuple[tuple[str, str, Sequence[str]], ...]] = {
    "sweep": (("-o", "out.nc", OUTPUTS), ("--theta2", "12", NUMBERS), ("--of", "F32", WORDS), FIGURE),
    "peaks": (("-o", "out.nc", OUTPUTS), ("--theta2", "12", NUMBERS), ("--of", "T12", WORDS)),
    "study": (("-o", "study.nc", OUTPUTS), ("--of", "T12", WORDS), ("--chunk", "5", NUMBERS)),
    "check": (),
    "report": (("-o", "out.html", OUTPUTS), ("--title", "Press", WORDS)),
    "animate": (("-o", "out.gif", OUTPUTS), ("--frames", "2", NUMBERS)),
    "bearings": (
        ("--diameter", "0.02", NUMBERS),
        ("--length", "3 cm", NUMBERS),
        ("--capacity", "5 kN", NUMBERS),
        FIGURE,
    ),
    "breakdown": (("", "F32", WORDS), FIGURE),
    "balance": (("--radius", "6 cm", NUMBERS), ("--fraction", "0.5", NUMBERS)),
    "orders": (("-n", "3", NUMBERS), ("", "Fsx", WORDS)),
    "flywheel": (("--fluctuation", "0.02", NUMBERS),),
    "nothing": (),
}
"""Options of each command: the flag, a good value, and others."""
NEEDED = ("-o", "--radius", "--theta2", "")
COMMANDS = [*OPTIONS]


def attack(random: np.random.Generator, rounds: int) -> Outcome:
    failures, before = [], Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            _furnish()
            for _ in range(rounds):
                words = _words(random)
                failures += [f"linksweep {' '.join(words)[:200]!a}: {problem}" for problem in _problems(words)]
        finally:
            os.chdir(before)
    return Outcome(rounds, failures)


def _furnish() -> None:
    """Create the files that the commands read."""
    for name in names():
        text = (files("linksweep.scene.examples") / f"{name}.toml").read_text(encoding="utf-8")
        for path in (f"{name}.toml", "b\udcff.toml"):
            Path(path).write_text(text, encoding="utf-8")
    Path("empty.toml").touch()
    Path("folder").mkdir()
    os.mkfifo("pipe")
    with contextlib.redirect_stdout(io.StringIO()):
        main(["sweep", "press.toml", "-o", "cycle.nc", "--theta2", "12"])


def _words(random: np.random.Generator) -> list[str]:
    command = COMMANDS[random.integers(len(COMMANDS))]
    words = [command, _one_of(SCENES, random) if random.random() < 0.4 else "press.toml"]
    for option, good, others in OPTIONS[command]:
        if option in NEEDED or random.random() < 0.5:
            words += [*[option] * bool(option), _one_of(others, random) if random.random() < 0.4 else good]
    return words


def _one_of(values: Sequence[str], random: np.random.Generator) -> str:
    return values[random.integers(len(values))]


def _problems(words: list[str]) -> list[str]:
    out, errors = io.StringIO(), io.StringIO()
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors), warnings.catch_warnings():
            warnings.simplefilter("error")
            code = main(words)
    except SystemExit as ended:  # argparse
        code = ended.code
    except BaseException as error:
        return [f"{type(error).__name__}: {error} {traceback.extract_tb(error.__traceback__)[-1]}"]
    message = errors.getvalue()
    clean = "Traceback" not in message and max(map(len, message.split("\n"))) < 10_000 and bool(message) == bool(code)
    return [] if code in (0, 2) and clean else [f"exit code {code}, {message[:300]!a}"]
