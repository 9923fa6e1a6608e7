"""Run fresh Python processes as they start where linksweep is installed: with the .pyc files that installers write."""

from __future__ import annotations

import compileall
import os
import subprocess
import sys
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import linksweep


def python(*arguments: str, folder: Path | None = None, settings: Mapping[str, str] | None = None) -> str:
    """Return the output of a fresh Python, started in a folder, with these environment variables besides."""
    _write_bytecode()
    command, environment = [sys.executable, *arguments], os.environ | (settings or {})
    return subprocess.run(command, cwd=folder, env=environment, check=True, stdout=subprocess.PIPE, text=True).stdout


@cache
def _write_bytecode() -> None:
    """Compile those modules of the package that have no .pyc file, or an old one: some seconds, once."""
    compileall.compile_dir(Path(linksweep.__file__).parent, quiet=2)
