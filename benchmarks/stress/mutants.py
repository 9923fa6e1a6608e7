"""Test the tests: slips planted one at a time in a copy of the package, each of which they must catch.

``python -m benchmarks.stress.mutants`` runs all of `mutants.toml`, in some minutes, and prints which test caught which;
``--only WORDS`` runs those whose description contains the words. The exit code is 1 where a mutant survives.

Tests that fail without any mutant are listed first and then excluded: their failures would prove nothing.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
LIST = Path(__file__).with_suffix(".toml")
TAKEN = ("linksweep", "tests", "benchmarks", "pyproject.toml")
"""Files of the project that the tests need."""
ALL_IN_TURN = ("-p", "no:cacheprovider", "-n", "0", "-m", "")
"""Options of pytest: long tests too, and one after the other, so that -x names the first failure."""
FOREVER = 600.0
"""Seconds after which the tests of a mutant, which may never end, count as failed."""
NO_TESTS = 5
"""Exit code of pytest where all tests are deselected: then nothing catches anything."""


@dataclass(frozen=True)
class Mutant:
    """A slip: in this file of the package, `old` becomes `new`; these test files should notice."""

    what: str
    file: str
    old: str
    new: str
    tests: tuple[str, ...]

    def planted(self, text: str) -> str:
        """Return the text of the file with the slip; ValueError where `old` does not occur exactly once.
        -: what it changes stands {count} times in
        +: its `old` occurs {count} times in"""
        if (count := text.count(self.old)) != 1:
            raise ValueError(f'"{self.what}": what it changes stands {count} times in linksweep/{self.file}, not once')
        return text.replace(self.old, self.new)


@dataclass(frozen=True)
class Copy:
    """A copy of the project to spoil; `red` are tests that fail in it unchanged."""

    folder: Path
    red: tuple[str, ...] = ()

    def failures(self, tests: Iterable[str], *options: str, patience: float | None = None) -> list[str]:
        """Return the tests of these files that fail; they may take `patience` seconds, or any time."""
        left_out = [f"--deselect={name}" for name in self.red]
        command = [sys.executable, "-m", "pytest", *ALL_IN_TURN, "--tb=no", "-rfE", *options, *left_out]
        # no .pyc: a source planted and restored within a second would be taken for the same
        surroundings = os.environ | {"LINKSWEEP_CACHE_DIR": str(self.folder / "cache"), "PYTHONDONTWRITEBYTECODE": "1"}
        surroundings.pop("PYTEST_ADDOPTS", None)
        try:
            ran = subprocess.run(
                [*command, *(f"tests/{name}" for name in tests)],
                cwd=self.folder,
                env=surroundings,
                timeout=patience,
                capture_output=True,
                text=True,
            )
        except subprocess.TimeoutExpired:
            return ["(the tests did not end)"]
        named = re.findall(r"^(?:FAILED|ERROR) (.+?)(?: - .*)?$", ran.stdout, re.MULTILINE)
        return named or ([f"(pytest ended with {ran.returncode})"] if ran.returncode not in (0, NO_TESTS) else [])

    @contextmanager
    def planted(self, mutant: Mutant) -> Iterator[None]:
        path = self.folder / "linksweep" / mutant.file
        sound = path.read_text(encoding="utf-8")
        path.write_text(mutant.planted(sound), encoding="utf-8")
        try:
            yield
        finally:
            path.write_text(sound, encoding="utf-8")

    def catcher(self, mutant: Mutant) -> str | None:
        """Return the test that catches a mutant, or None where it survives."""
        with self.planted(mutant):
            return next(iter(self.failures(mutant.tests, "-x", patience=FOREVER)), None)


def mutants(path: Path = LIST) -> list[Mutant]:
    """Return the mutants of the list."""
    listed = tomllib.loads(path.read_text(encoding="utf-8"))["mutants"]
    return [Mutant(**{**words, "tests": tuple(words["tests"])}) for words in listed]


@contextmanager
def copied() -> Iterator[Copy]:
    """Yield a copy of the project in a temporary folder."""
    with tempfile.TemporaryDirectory(prefix="linksweep-mutants-") as folder:
        for name in TAKEN:
            source, target = ROOT / name, Path(folder) / name
            if source.is_dir():
                shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                shutil.copy(source, target)
        yield Copy(Path(folder))


def main(arguments: Sequence[str] | None = None) -> int:
    """Plant the mutants one by one and print the results; return 1 where one survives, or a test fails without any."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.stress.mutants", description="Test the tests: planted slips."
    )
    parser.add_argument("--only", metavar="WORDS", default="", help="mutants whose description has these words")
    only = parser.parse_args(arguments).only
    chosen = [mutant for mutant in mutants() if only in mutant.what]
    with copied() as copy:
        return _run(copy, chosen)


def _run(copy: Copy, chosen: list[Mutant]) -> int:
    red = copy.failures(sorted({test for mutant in chosen for test in mutant.tests}))
    for name in red:
        print(f"fails without a mutant: {name}", flush=True)
    copy, survived = Copy(copy.folder, tuple(red)), 0
    for mutant in chosen:
        caught = copy.catcher(mutant)
        survived += caught is None
        print(f"{'caught' if caught else 'SURVIVED':<8}  {mutant.what}  {caught or ''}".rstrip(), flush=True)
    print(f"{len(chosen) - survived} of {len(chosen)} mutants caught")
    return int(bool(red or survived))


if __name__ == "__main__":
    sys.exit(main())
