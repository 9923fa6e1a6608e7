"""Read NetCDF files without linksweep's seal in a separate process: HDF5 may crash or hang on a damaged one.

``python -m linksweep.files.isolated cycle.nc`` writes the file's variables to its standard output, in the form of
`linksweep.files.packed`.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import xarray as xr

from linksweep.files.packed import packed, unpacked

LONGEST, SLOWEST = 60.0, 1e6
"""Seconds that reading a file may take once the process has imported what it needs, and bytes that it then reads in
each further second."""
READY = b"ready\n"
"""First output of the process: from here on it reads the file, however long its imports took on a busy machine."""
HDF5 = b"\x89HDF\r\n\x1a\n"
END = {0: 40, 1: 44, 2: 28, 3: 28}
"""Position of the file's length within an HDF5 file, by the version of the superblock."""


def read_isolated(path: Path) -> xr.Dataset:
    """Return all variables of a NetCDF file, as coordinates; ValueError that names the file where it cannot be read."""
    longest = LONGEST
    try:
        if not (reason := _cut_off(path)):
            command = [sys.executable, "-P", "-m", __name__, os.fspath(path)]
            longest += os.path.getsize(path) / SLOWEST
            process, output, errors = _run(command, longest)
            if not process.returncode:
                ds = unpacked(output)
                return ds.set_coords([*ds.data_vars])
            crashed = process.returncode < 0  # by a signal
            reason = "damaged: the NetCDF library crashes on it" if crashed else errors.decode().strip()
    except subprocess.TimeoutExpired:
        reason = f"damaged: the NetCDF library has not returned after {longest:.3g} s"
    except OSError as error:
        reason = str(error.strerror)
    raise ValueError(f"{path}: cannot be read as NetCDF ({reason}); a scene file ends in .toml")


def _run(command: list[str], longest: float) -> tuple[subprocess.Popen[bytes], bytes, bytes]:
    """Run the process; return it with its output and its errors. TimeoutExpired counts from when it is ready."""
    # unbuffered: else the first line's reader may take more of the output, which communicate() would not see
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, bufsize=0) as process:
        try:
            if process.stdout:
                process.stdout.readline()  # READY, or nothing where it ended before
            return process, *process.communicate(timeout=longest)
        except BaseException:
            process.kill()
            raise


def _cut_off(path: Path) -> str:
    """Return the problem of a file that is shorter than the length in its own header; empty where it is not."""
    with open(path, "rb") as file:
        head, size = file.read(64), file.seek(0, os.SEEK_END)
    if not head.startswith(HDF5) or len(head) < 64 or head[8] not in END:
        return ""
    end = int.from_bytes(head[END[head[8]] :][:8], "little")
    return f"cut off: {size} of {end} bytes" if size < end else ""


def _main(path: str) -> None:
    import netCDF4  # noqa: F401  # here, before it is ready: its import may take long

    sys.stdout.buffer.write(READY)
    sys.stdout.buffer.flush()
    try:
        with xr.open_dataset(path, engine="netcdf4") as ds:
            whole = ds.load()
            texts = {name: values.astype(str) for name, values in whole.variables.items() if values.dtype.kind == "O"}
            sys.stdout.buffer.write(packed(whole.assign(texts)))
    except Exception as error:  # a damaged file may raise anything
        sys.exit(" ".join(str(getattr(error, "strerror", None) or error).split()))


if __name__ == "__main__":
    _main(sys.argv[1])
