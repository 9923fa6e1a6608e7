"""Print the variables of a damaged NetCDF file whose checksums do not match: run by itself, as HDF5 may crash.

``python unreadable.py study.nc``
"""

from __future__ import annotations

import sys

import netCDF4


def unreadable(path: str) -> list[str]:
    """Return the names of the variables that cannot be read."""
    names = []
    with netCDF4.Dataset(path) as file:
        for name, variable in file.variables.items():
            try:
                variable[...]
            except (OSError, RuntimeError):
                names.append(name)
    return names


if __name__ == "__main__":
    for name in unreadable(sys.argv[1]):
        print(name)
