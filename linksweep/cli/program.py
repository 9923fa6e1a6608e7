"""The program `linksweep`: the command line, in a process of its own."""

from __future__ import annotations

import sys


def run() -> int:
    """Run the command line, and return its exit status."""
    # no command makes an array of dask's, and xarray would import dask for half a second to see whether one is there
    sys.modules.setdefault("dask", None)  # type: ignore[arg-type]
    from linksweep.cli.main import main

    return main()
