"""Write Datasets and scenes whole or not at all; read scenes back from scene files and from results."""

from __future__ import annotations

import errno
import os
import shutil
from pathlib import Path
from threading import RLock
from typing import Any

import xarray as xr

from linksweep.base.validate import did_you_mean, quote, refuse
from linksweep.files.atomic import ending_of, whole
from linksweep.files.seal import SAVED, mark_of, seal, sealed
from linksweep.files.spreadsheet import to_excel
from linksweep.files.table import to_csv
from linksweep.results.dataset import design_coordinates, provenance
from linksweep.scene.designs.lazy import in_memory
from linksweep.scene.examples import names
from linksweep.scene.file.reading import parse_scene, read_scene
from linksweep.scene.file.text_file import as_path, kind_of
from linksweep.scene.file.writing import require_writable
from linksweep.scene.parameters import replaced
from linksweep.scene.scene import Scene
from linksweep.scene.storable import label_problem, name_problem

RESULTS, SCENES = (".nc", ".csv", ".xlsx"), (".toml", ".nc")
"""Endings of the files of Datasets, and of scenes."""
TABLES = {".csv": to_csv, ".xlsx": to_excel}
"""Writers of tables, by the ending of their files."""
NO_FILL = {"_FillValue": None}
"""Encoding of a coordinate, which by the CF conventions has no missing values."""
ROOM = 1 << 20
"""Bytes of a NetCDF file besides its numbers."""
NETCDF = RLock()
"""Lock around the NetCDF library: used by two threads at once, it crashes the process."""


def save(ds: xr.Dataset | Scene, path: str | os.PathLike[str]) -> None:
    """Write a Dataset or a scene to a file, whole or not at all.

    The file is written beside its target, flushed to the disk, then renamed.

    Parameters
    ----------
    ds : Dataset or Scene
        Dataset of linksweep, or any that NetCDF can hold; or a scene.
    path : str or PathLike
        File to write; an existing one is replaced only once the new one is complete. Its ending decides the format:
        a Dataset goes to "cycle.nc" (NetCDF), or to "cycle.csv" or "cycle.xlsx" (Excel), tables as of
        `Dataset.linksweep.to_csv` and `.to_excel`; a scene goes to "scene.toml", a text to edit, or to "scene.nc".

    Raises
    ------
    ValueError
        For another ending; for a function of theta2 that no samples can represent, as `Scene.to_toml`; for names
        and labels that NetCDF cannot store unchanged.
    OSError
        When the folder is missing, cannot be written or is full, or `path` is no file; an existing file stays.

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
    refuse([] if isinstance(ds, Scene) else dataset_problems(ds))
    if isinstance(ds, Scene) and ending_of(path, SCENES) == ".toml":
        write_text(ds.to_toml(), path)
    elif isinstance(ds, Scene):
        save_dataset(_as_dataset(ds), path)
    elif (ending := ending_of(path, RESULTS)) in TABLES:
        TABLES[ending](ds, path)
    else:
        save_dataset(ds, path)


def dataset_problems(ds: Any) -> list[str]:
    """Return a problem unless an object is a Dataset."""
    return [] if isinstance(ds, xr.Dataset) else [f"ds is a {type(ds).__name__}: must be a Dataset, or a Scene"]


def save_dataset(ds: xr.Dataset, path: str | os.PathLike[str], manifest: dict[str, Any] | None = None) -> None:
    """Write a Dataset to NetCDF whole or not at all, sealed with a manifest."""
    refuse(_unstorable(ds))
    with whole(path) as temporary, NETCDF:
        try:
            ds.drop_encoding().to_netcdf(temporary, engine="netcdf4", encoding=dict.fromkeys(ds.coords, NO_FILL))
        except (RuntimeError, PermissionError) as error:  # the second where there is no room at all
            if isinstance(error, RuntimeError) and not str(error).startswith("NetCDF"):  # of what the Dataset waits for
                raise
            raise disk_error(temporary, ds.nbytes, error) from None
        seal(temporary, manifest or {}, SAVED)


def disk_error(path: Path, needed: int, error: Exception) -> OSError:
    """Return the error of the system for one of the NetCDF library, which does not tell a full disk from a broken one.

    `needed` is the size of the whole file, at least.
    """
    if shutil.disk_usage(path.parent).free < ROOM + needed - path.stat().st_size:
        return OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    return error if isinstance(error, OSError) else OSError(errno.EIO, f"{os.strerror(errno.EIO)} ({error})")


def write_text(text: str, path: str | os.PathLike[str]) -> None:
    """Write a text file whole or not at all."""
    with whole(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")


def _as_dataset(scene: Scene) -> xr.Dataset:
    """Return a Dataset of a scene alone: its arrays over designs, and everything else as text."""
    require_writable(scene)
    scene = in_memory(scene)
    coordinates = design_coordinates(scene)
    return xr.Dataset(coords=coordinates, attrs=provenance(scene, "linksweep.save(scene)", coordinates))


def _unstorable(ds: xr.Dataset) -> list[str]:
    """Return the problems of a Dataset's names and coordinates that a file cannot hold."""
    names = {name: name_problem(name) for name in (*ds.dims, *ds.variables)}
    problems = [f"ds has {quote(name)}: {problem}; rename it" for name, problem in names.items() if problem]
    labels = {name: label_problem(values.variable) for name, values in ds.coords.items()}
    problems += [f"ds has along {name} {problem}; change its labels" for name, problem in labels.items() if problem]
    return problems


def load_scene(path: str | os.PathLike[str]) -> Scene:
    """Return the scene of a TOML file, or of a NetCDF file that linksweep wrote.

    Parameters
    ----------
    path : str or PathLike
        File to read: "scene.toml" or "cycle.nc".

    Returns
    -------
    Scene
        Scene that gives equal arrays when swept again. Functions of theta2 come back as DataArrays whose spline is
        within 1e-9 of their largest value, and equal at every half degree; a function that jumps, or changes too
        quickly for that, is not in the file.

    Raises
    ------
    ValueError
        Naming the file and the problem: all errors of a scene file at once; a file that is no NetCDF, is cut off,
        or holds no scene.

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
    path = as_path(path)
    if path.suffix.lower() == ".toml":
        return read_scene(path)
    if not path.exists():
        files = [file.name for file in path.parent.glob("*")] if path.parent.is_dir() else []
        near = did_you_mean(path.name, [*files, *names()])
        there = f'; of the example write ls.example("{path}")' if str(path) in names() else near
        raise ValueError(f"{path}: there is no such file{there}")
    if kind := kind_of(path):
        raise ValueError(f"{path}: cannot be read: it is {kind}, no file")
    return scene_of(loaded(path), str(path))


def loaded(path: Path) -> xr.Dataset:
    """Return the whole of a NetCDF file; one without linksweep's seal is read in a separate process."""
    if not (mark := mark_of(path)):
        from linksweep.files.isolated import read_isolated  # here: it also runs as a program, which imports this module

        return read_isolated(path)
    sealed(path, mark)  # raises for a damaged file
    with NETCDF, xr.open_dataset(path, engine="netcdf4") as ds:
        return ds.load()


def scene_from(scene: Scene | xr.Dataset, whole: bool = True) -> Scene:
    """Return a scene itself, or the one that a Dataset came from, as by `scene_of`; ValueError names the parameter."""
    if isinstance(scene, Scene):
        return scene
    wrong = f"scene is a {type(scene).__name__}: must be a Scene, as from ls.load_scene, or a Dataset of linksweep"
    refuse([] if isinstance(scene, xr.Dataset) else [wrong])
    return scene_of(scene, whole=whole)


def scene_of(ds: xr.Dataset, name: str = "Dataset", whole: bool = True) -> Scene:
    """Return the scene that a Dataset of linksweep came from, with the branch that was selected, if any.

    A function that jumps is refused unless the scene need not be `whole`: then a cycle's own samples represent it.

    Raises ValueError where the Dataset holds no scene.
    """
    refuse(dataset_problems(ds))
    text = ds.attrs.get("scene")
    if not isinstance(text, str):
        raise ValueError(
            f"{name}: holds no scene; only Datasets made by linksweep do, and only while they keep their attributes; "
            "those of a MultiCylinder hold none"
        )
    arrays = {str(path): ds[path].reset_coords(drop=True) for path in ds.variables}
    scene = parse_scene(text, name, arrays, whole)
    branches = scene.mechanism.both_branches.items()
    selected = {dim: path for dim, path in branches if dim in ds.coords and not ds[dim].dims}
    return replaced(scene, {path: str(ds[dim].item()) for dim, path in selected.items()})
