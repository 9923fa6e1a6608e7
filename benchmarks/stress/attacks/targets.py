"""Write results to targets that are no files, by links, under the longest names: only files are replaced."""

from __future__ import annotations

import os
import socket
import stat
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

import linksweep as ls
from benchmarks.stress.attacks import Outcome
from linksweep.files.atomic import whole

TITLE = "results written over folders, pipes, devices, sockets, links and long names: only files are replaced"
ROUNDS, SMALL = 2000, 60

LONGEST = 255
PEAKS = ls.peaks(ls.example("press"), ["T12"], theta2=8)


def text(path: Path) -> None:
    with whole(path) as temporary:
        temporary.write_text("text")


def pipe(path: Path) -> None:
    os.mkfifo(path)


def bound(path: Path) -> None:
    with socket.socket(socket.AF_UNIX) as made:
        made.bind(str(path))


def device(path: Path) -> None:
    os.mknod(path, 0o600 | stat.S_IFCHR, os.makedev(1, 3))


WRITERS: tuple[tuple[str, Callable[[Path], object]], ...] = (
    ("", text),
    (".nc", lambda path: ls.save(PEAKS, path)),
    (".csv", PEAKS.linksweep.to_csv),
)
"""Writers, each with the ending of the names that it takes."""
FILES: tuple[Callable[[Path], None], ...] = (Path.touch, lambda path: None)
OTHERS: tuple[Callable[[Path], None], ...] = (Path.mkdir, pipe, bound, *((device,) if os.geteuid() == 0 else ()))


def attack(random: np.random.Generator, rounds: int) -> Outcome:
    failures = []
    for _ in range(rounds):
        with tempfile.TemporaryDirectory() as folder:
            failures += _problems(Path(folder), random)
    return Outcome(rounds, failures)


def _problems(folder: Path, random: np.random.Generator) -> list[str]:
    made = (*FILES, *OTHERS)[random.integers(len(FILES + OTHERS))]
    ending, writer = WRITERS[random.integers(len(WRITERS))]
    length = int(random.integers(1 + len(ending), 60 if made is bound else LONGEST + 1))  # a socket's path is short
    target = folder / ("n" * (length - len(ending)) + ending)
    made(target)
    links = int(random.integers(3))
    path = _linked(folder, target, links, ending)
    before = _kinds(folder)
    try:
        writer(path)
        refused = False
    except OSError as error:
        refused = "which no file replaces" in str(error)
    after = _kinds(folder)
    expected = before if made in OTHERS else before | {target.name: stat.S_IFREG}
    name = getattr(made, "__name__", "nothing")
    problems = [f"{name}, {length} letters, {links} links: {after} for {expected}"] * (after != expected)
    return problems + [f"{name}: refused is {refused}"] * (refused != (made in OTHERS))


def _linked(folder: Path, target: Path, links: int, ending: str) -> Path:
    """Return a link to a link … to the target."""
    for number in range(links):
        link = folder / f"link{number}{ending}"
        link.symlink_to(target)
        target = link
    return target


def _kinds(folder: Path) -> dict[str, int]:
    return {path.name: stat.S_IFMT(path.lstat().st_mode) for path in folder.iterdir()}
