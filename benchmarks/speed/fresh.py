"""Run fresh Python processes as they start where linksweep is installed: with the .pyc files that installers write."""

from __future__ import annotations

import compileall
import subprocess
import sys
from functools import cache
from pathlib import Path

import linksweep


def python(*arguments: str, folder: Path | None = None) -> str:
    """Return the output of a fresh Python, started in a folder."""
    _write_bytecode()
    command = [sys.executable, *arguments]
    return subprocess.run(command, cwd=folder, check=True, stdout=subprocess.PIPE, text=True).stdout


@cache
def _write_bytecode() -> None:
    """Compile those modules of the package that have no .pyc file, or an old one: some seconds, once."""
    compileall.compile_dir(Path(linksweep.__file__).parent, quiet=2)
