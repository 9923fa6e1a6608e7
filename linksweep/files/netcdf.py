"""Files: Datasets written whole or not at all, and scenes read back from scene files and from results."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from threading import RLock
from typing import Any

import xarray as xr

from linksweep.base.validate import did_you_mean, quote, refuse
from linksweep.files.atomic import ending_of, whole
from linksweep.files.seal import SAVED, mark_of, seal, sealed
from linksweep.files.table import to_csv
from linksweep.results.dataset import design_coordinates, provenance
from linksweep.scene.designs.lazy import in_memory
from linksweep.scene.file.text_file import kind_of
from linksweep.scene.file.toml import parse_scene, read_scene, require_writable
from linksweep.scene.scene import Scene
from linksweep.scene.storable import label_problem, name_problem

RESULTS, SCENES = (".nc", ".csv"), (".toml", ".nc")
"""Endings of the files of Datasets and of scenes."""
NETCDF = RLock()
"""The NetCDF library is not made for two threads at once: the process dies."""


def save(ds: xr.Dataset | Scene, path: str | os.PathLike[str]) -> None:
    """Write a Dataset or a scene whole or not at all: a temporary file beside it, flushed to disk, then renamed.

    Parameters
    ----------
    ds : Dataset of linksweep, or any that NetCDF can hold; or a Scene
    path : the file; one that exists is replaced only once the new one is complete. Its ending says what is written: a
        Dataset goes to "cycle.nc", NetCDF, or to "cycle.csv", a table as of `Dataset.linksweep.to_csv`, without its
        scene; a scene to "scene.toml", a text to be edited, or to "scene.nc"

    Raises
    ------
    ValueError
        For another ending, and a function of theta2 that no samples stand for, as `Scene.to_toml`; for names and labels
        that NetCDF cannot give back as they are.
    OSError
        When the folder is missing, cannot be written or is full, or `path` is no file; what was there before stays.

    Examples
    --------
    >>> import linksweep as ls
    >>> scene = ls.example("press")
    >>> import os, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     for name in ("press.toml", "press.nc"):
    ...         ls.save(scene, os.path.join(folder, name))
    ...         assert ls.load_scene(os.path.join(folder, name)) == scene
    """
    if isinstance(ds, Scene):
        if ending_of(path, SCENES) == ".toml":
            return write_text(ds.to_toml(), path)
        ds = _as_dataset(ds)
    elif ending_of(path, RESULTS) == ".csv":
        return to_csv(ds, path)
    refuse(_unstorable(ds))
    with whole(path) as temporary, NETCDF:
        ds.drop_encoding().to_netcdf(temporary, engine="netcdf4")
        seal(temporary, {}, SAVED)


def write_text(text: str, path: str | os.PathLike[str]) -> None:
    """Write a text file whole or not at all."""
    with whole(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")


def _as_dataset(scene: Scene) -> xr.Dataset:
    """Return a Dataset of a scene alone: its arrays over designs, and all else as text."""
    require_writable(scene)
    scene = in_memory(scene)
    coordinates = design_coordinates(scene)
    return xr.Dataset(coords=coordinates, attrs=provenance(scene, "linksweep.save(scene)", coordinates))


def _unstorable(ds: xr.Dataset) -> list[str]:
    """Return the names and the coordinates of a Dataset that a file cannot hold."""
    names = {name: name_problem(name) for name in (*ds.dims, *ds.variables)}
    found = [f"ds has {quote(name)}: {problem}; rename it" for name, problem in names.items() if problem]
    labels = {name: label_problem(values.variable) for name, values in ds.coords.items()}
    return found + [f"ds has along {name} {problem}; change its labels" for name, problem in labels.items() if problem]


def load_scene(path: str | os.PathLike[str]) -> Scene:
    """The scene of a TOML file, or of a NetCDF file that linksweep wrote.

    Parameters
    ----------
    path : "scene.toml" or "cycle.nc"

    Returns
    -------
    Scene that gives equal arrays when swept again. Functions of theta2 come back as DataArrays whose spline is within
    1e-9 of their largest value, and equal at every half degree; one that jumps, or changes too quickly for that, is not
    in the file.

    Raises
    ------
    ValueError
        Naming the file and what is wrong: all errors of a scene file at once; a file that is no NetCDF or holds no
        scene, or not the whole of it.

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
    if path.suffix.lower() == ".toml":
        return read_scene(path)
    if not path.exists():
        near = did_you_mean(path.name, [file.name for file in path.parent.glob("*")] if path.parent.is_dir() else [])
        raise ValueError(f"{path}: there is no such file{near}")
    if kind := kind_of(path):
        raise ValueError(f"{path}: cannot be read: it is {kind}, no file")
    return scene_of(_loaded(path), str(path))


def _loaded(path: Path) -> xr.Dataset:
    """All of a NetCDF file; one without our seal is read where HDF5 can do no harm."""
    if not (mark := mark_of(path)):
        from linksweep.files.apart import read_apart  # here: it also runs as a program, which imports this

        return read_apart(path)
    sealed(path, mark)  # which refuses a file that is damaged
    with NETCDF, xr.open_dataset(path, engine="netcdf4") as ds:
        return ds.load()


def scene_of(ds: xr.Dataset, name: str = "Dataset", whole: bool = True) -> Scene:
    """The scene that a Dataset of linksweep came from, or of the branch chosen from it.

    A function that jumps is refused; unless it need not be the `whole` scene: then a cycle's own samples stand for it.

    Raises ValueError where the Dataset holds none.
    """
    text = ds.attrs.get("scene")
    if not isinstance(text, str):
        raise ValueError(
            f"{name}: holds no scene; only Datasets made by linksweep do, and only while they keep their attributes"
        )
    arrays = {str(path): ds[path].reset_coords(drop=True) for path in ds.variables}
    scene = parse_scene(text, name, arrays, whole)
    machine: Any = scene.mechanism
    if getattr(machine, "branch", "") == "both" and "branch" in ds.coords and not ds["branch"].dims:
        return replace(scene, mechanism=replace(machine, branch=str(ds["branch"].item())))
    return scene
