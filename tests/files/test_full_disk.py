"""Writers on a disk that is full, or fills up: an error of the system that names the file, and no litter."""

import contextlib
import errno
import os
import subprocess
import sys
from pathlib import Path

import pytest
import xarray as xr
from test_targets import WRITERS

import linksweep as ls

FULL = {
    **{name: writer for name, writer in WRITERS.items() if name != "study"},  # which keeps its finished chunks
    "CSV": (".csv", lambda path: ls.sweep(ls.example("press")).linksweep.to_csv(path)),
    "cycle": (".nc", lambda path: ls.save(ls.sweep(ls.example("press")), path)),
    "drawing": (".pdf", lambda path: ls.save_drawing(ls.example("press"), path)),
}
PAGE = 4096


@pytest.fixture
def disk(tmp_path):
    """Return a disk of 64 kB."""
    if not (hasattr(os, "geteuid") and os.geteuid() == 0):
        pytest.skip("only root can make a small disk")
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", tmp_path], capture_output=True).returncode:
        pytest.skip("no disk can be made here")
    yield tmp_path
    subprocess.run(["umount", "--lazy", tmp_path], check=True)  # the NetCDF library leaves its file open


def fill(disk, room):
    """Fill a disk but for so many bytes."""
    with open(disk / "fill", "wb", buffering=0) as file, contextlib.suppress(OSError):
        while True:
            file.write(bytes(PAGE))
    os.truncate(disk / "fill", (disk / "fill").stat().st_size - room)


@pytest.mark.parametrize("room", [0, PAGE])
@pytest.mark.parametrize("writer", FULL)
def test_a_full_disk_is_an_error_of_the_system(disk, writer, room):
    ending, write = FULL[writer]
    path = disk / f"new{ending}"
    path.write_bytes(b"old")
    fill(disk, room)
    with pytest.raises(OSError, match="No space left on device") as error:
        write(path)
    assert error.value.errno == errno.ENOSPC
    assert error.value.filename.startswith(str(path))
    assert path.read_bytes() == b"old"
    assert sorted(os.listdir(disk)) == ["fill", path.name]


def test_an_error_of_numbers_still_to_be_computed_is_none_of_the_disk(tmp_path):
    def fail(values):
        raise RuntimeError("computed")

    ds = ls.check(ls.example("press")).astype(float).chunk()
    with pytest.raises(RuntimeError, match="computed"):
        ls.save(xr.apply_ufunc(fail, ds, dask="parallelized", output_dtypes=[float]), tmp_path / "new.nc")


def test_nothing_is_printed_about_an_excel_file_that_finds_no_room(disk):
    fill(disk, room=0)
    words = "press", "-o", str(disk / "new.xlsx")
    run = subprocess.run([sys.executable, "-m", "linksweep", "peaks", *words], capture_output=True, text=True)
    assert (run.returncode, run.stderr) == (2, f"linksweep: [Errno 28] No space left on device: '{Path(words[2])}'\n")
