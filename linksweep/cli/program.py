"""The program `linksweep`: the command line, in a process of its own."""

from __future__ import annotations

import atexit
import gc
import os
import sys
from typing import NoReturn

ALLOCATIONS = 500_000
"""Objects made until garbage is looked for: more than a short command makes, of which each search took a thirtieth of
the time. The garbage in them takes some 10 MB."""


def start() -> NoReturn:
    """Run the command line, and end the process at once: Python would first take a thousand imported modules apart,
    for a sixth of the time of `linksweep demo`."""
    code = run()
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        if stream:  # None where it was closed before the start
            stream.flush()
    os._exit(code)


def run() -> int:
    """Run the command line, and return its exit status."""
    gc.set_threshold(ALLOCATIONS)
    # no command makes an array of dask's, and xarray would import dask for half a second to see whether one is there
    sys.modules.setdefault("dask", None)  # type: ignore[arg-type]
    from linksweep.cli.main import main

    return main()
