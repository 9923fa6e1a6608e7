"""Print the variables of a damaged NetCDF file that do not fit their checksums: run by itself, as HDF5 may not survive.

``python unreadable.py study.nc``
"""

from __future__ import annotations

import sys

import netCDF4


def unreadable(path: str) -> list[str]:
    """Names of the variables that cannot be read."""
    found = []
    with netCDF4.Dataset(path) as file:
        for name, variable in file.variables.items():
            try:
                variable[...]
            except (OSError, RuntimeError):
                found.append(name)
    return found


if __name__ == "__main__":
    for name in unreadable(sys.argv[1]):
        print(name)
