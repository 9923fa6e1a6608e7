"""Open a finished study lazily; a variable whose checksum fails raises."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from xarray.backends import BackendArray
from xarray.backends.common import AbstractDataStore
from xarray.core import indexing

from linksweep.files.netcdf import NETCDF
from linksweep.files.seal import sealed
from linksweep.scene.file.text_file import as_path


def open_study(path: str | os.PathLike[str]) -> xr.Dataset:
    """Open a finished study; each variable is read on first use.

    The file is not kept open. Its checksum is verified once, on opening; damage that happens later is reported for each
    variable.

    Parameters
    ----------
    path : str or PathLike
        File that `linksweep.study` finished.

    Returns
    -------
    Dataset
        Dataset over the design dims, equal to that of `linksweep.peaks`.

    Raises
    ------
    ValueError
        Naming the file, and the variable where it is known: for a file that is missing, damaged, cut off, or no
        study.

    Examples
    --------
    >>> import os, tempfile
    >>> import linksweep as ls
    >>> scene = ls.sample(ls.example("press"), {"coupler.length": ("20 cm", "24 cm")}, n=8)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = ls.study(scene, os.path.join(folder, "study.nc"), of=["F32"])
    ...     again = ls.open_study(os.path.join(folder, "study.nc")).load()
    >>> dict(again.sizes), float(again.F32_peak.min()) > 0.0
    ({'design': 8}, True)
    """
    path = as_path(path)
    if not path.is_file():
        raise ValueError(f"{path}: there is no such file; linksweep.study makes it")
    sealed(path)
    return xr.open_dataset(_Store(path))


@contextlib.contextmanager
def _opened(path: Path) -> Iterator[Any]:
    import netCDF4  # here: only reading studies needs it

    with NETCDF, netCDF4.Dataset(path) as file:
        yield file


class _Store(AbstractDataStore):
    """A NetCDF file as an xarray data store, opened anew for each reading."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def get_variables(self) -> dict[str, xr.Variable]:
        with _opened(self.path) as file:
            return {name: self._variable(name, stored) for name, stored in file.variables.items()}

    def _variable(self, name: str, stored: Any) -> xr.Variable:
        lazy = indexing.LazilyIndexedArray(_Checked(self.path, name, stored))
        return xr.Variable(stored.dimensions, lazy, {key: stored.getncattr(key) for key in stored.ncattrs()})

    def get_attrs(self) -> dict[str, Any]:
        with _opened(self.path) as file:
            return {key: file.getncattr(key) for key in file.ncattrs()}


class _Checked(BackendArray):
    """A variable of a file, read lazily; where its checksum fails, the error names it."""

    def __init__(self, path: Path, name: str, stored: Any) -> None:
        self.path, self.name, self.shape = path, name, stored.shape
        self.dtype = np.dtype(object) if stored.dtype is str else stored.dtype

    def __getitem__(self, key: indexing.ExplicitIndexer) -> Any:
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.OUTER, self._read)

    def _read(self, key: tuple[Any, ...]) -> Any:
        try:
            with _opened(self.path) as file:
                file.set_auto_mask(False)
                return np.asarray(file[self.name][key], dtype=self.dtype)
        except (OSError, RuntimeError) as error:
            reason = f"its checksum does not match, or the file is not there any more ({error})"
            advice = "study again, or read other variables"
            raise ValueError(f"{self.path}: {self.name} cannot be read: {reason}; {advice}") from error
