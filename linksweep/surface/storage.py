"""Files: Datasets written whole or not at all, and scenes read back from scene files and from results."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from threading import RLock
from typing import Any

import xarray as xr

from linksweep.mechanisms.validate import did_you_mean
from linksweep.scene.file import parse_scene, read_scene
from linksweep.scene.scene import Scene
from linksweep.surface.atomic import whole
from linksweep.surface.seal import SAVED, mark_of, seal, sealed

NETCDF = RLock()
"""The NetCDF library is not made for two threads at once: the process dies."""


def save(ds: xr.Dataset, path: str | os.PathLike) -> None:
    """Write a Dataset to NetCDF whole or not at all: a temporary file beside it, flushed to disk, then renamed.

    Parameters
    ----------
    ds : Dataset of linksweep, or any that NetCDF can hold
    path : the file; one that exists is replaced only once the new one is complete

    Raises
    ------
    OSError
        When the folder is missing, cannot be written or is full, or `path` is no file; what was there before stays.

    Examples
    --------
    >>> import linksweep as ls
    >>> scene = ls.example("press")
    >>> import os, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = os.path.join(folder, "cycle.nc")
    ...     ls.save(ls.sweep(scene), path)
    ...     ls.load_scene(path).omega2
    31.41592653589793
    """
    with whole(path) as temporary, NETCDF:
        ds.drop_encoding().to_netcdf(temporary, engine="netcdf4")
        seal(temporary, {}, SAVED)


def load_scene(path: str | os.PathLike) -> Scene:
    """The scene of a TOML file, or of a NetCDF file that linksweep wrote.

    Parameters
    ----------
    path : "scene.toml" or "cycle.nc"

    Returns
    -------
    Scene that gives equal arrays when swept again at the same angles. Functions of theta2 come back as DataArrays
    over the angles at which they were sampled.

    Raises
    ------
    ValueError
        Naming the file and what is wrong: all errors of a scene file at once; a file that is no NetCDF or holds no
        scene.

    Examples
    --------
    >>> import os, tempfile
    >>> import linksweep as ls
    >>> press = ls.example("press")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     ls.save(ls.sweep(press), os.path.join(folder, "cycle.nc"))
    ...     ls.load_scene(os.path.join(folder, "cycle.nc")) == press
    True
    """
    path = Path(path)
    if path.suffix == ".toml":
        return read_scene(path)
    if not path.exists():
        near = did_you_mean(path.name, [file.name for file in path.parent.glob("*")] if path.parent.is_dir() else [])
        raise ValueError(f"{path}: there is no such file{near}")
    return scene_of(_loaded(path), str(path))


def _loaded(path: Path) -> xr.Dataset:
    """All of a NetCDF file; one without our seal is read where HDF5 can do no harm."""
    if not (mark := mark_of(path)):
        from linksweep.surface.apart import read_apart  # here: it takes what is above

        return read_apart(path)
    sealed(path, mark)  # which refuses a file that is damaged
    with NETCDF, xr.open_dataset(path, engine="netcdf4") as ds:
        return ds.load()


def scene_of(ds: xr.Dataset, name: str = "Dataset") -> Scene:
    """The scene that a Dataset of linksweep came from, or of the branch chosen from it.

    Raises ValueError where the Dataset holds none.
    """
    text = ds.attrs.get("scene")
    if not isinstance(text, str):
        raise ValueError(
            f"{name}: holds no scene; only Datasets made by linksweep do, and only while they keep their attributes"
        )
    arrays = {str(path): ds[path].reset_coords(drop=True) for path in ds.variables}
    scene = parse_scene(text, name, arrays)
    machine: Any = scene.mechanism
    if getattr(machine, "branch", "") == "both" and "branch" in ds.coords and not ds["branch"].dims:
        return replace(scene, mechanism=replace(machine, branch=str(ds["branch"].item())))
    return scene
