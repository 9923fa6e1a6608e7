"""Assemble the file of a study from its chunks, with one at a time in memory.

Numbers are stored in tiles with a checksum each (fletcher32). A variable has the union of its dims in all chunks; one
that does not depend on the dims split into chunks is written once.
"""

from __future__ import annotations

import errno
import hashlib
import os
import shutil
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from math import prod
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from xarray.conventions import encode_cf_variable

from linksweep.files.netcdf import NETCDF, NO_FILL, ROOM, disk_error
from linksweep.results.dataset import design_coordinates, provenance
from linksweep.scene.designs.selection import Block
from linksweep.scene.scene import Scene

Chunks = Callable[[], Iterator[tuple[Block, xr.Dataset]]]

TILE = 1 << 16  # numbers under one checksum: half a megabyte


@dataclass
class Layout:
    """The layout of a whole study: sizes of its dims, the dims of each variable, and an empty variable `like` each."""

    sizes: dict[str, int]
    dims: dict[str, tuple[str, ...]] = field(default_factory=dict)
    like: dict[str, xr.Variable] = field(default_factory=dict)
    attributes: dict[str, Any] = field(default_factory=dict)

    def sizes_of(self, name: str) -> dict[str, int]:
        return {dim: self.sizes[dim] for dim in self.dims[name]}


def assemble(path: Path, scene: Scene, sizes: Mapping[str, int], chunks: Chunks, command: str) -> None:
    """Write the file of a study; chunks() iterates over all of them, block and Dataset, each time it is called.

    Raises OSError where the disk is full or fails.
    """
    coordinates = design_coordinates(scene)
    layout = layout_of(chunks(), sizes)
    layout.attributes = provenance(scene, command, coordinates)
    layout.sizes |= {str(dim): n for values in coordinates.values() for dim, n in values.sizes.items()}
    numbers = (like.dtype.itemsize * prod(layout.sizes_of(name).values()) for name, like in layout.like.items())
    needed = sum(numbers)
    if shutil.disk_usage(path.parent).free < ROOM + needed:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    try:
        _write(path, layout, coordinates, chunks)
    except RuntimeError as error:  # the NetCDF library raises no other for a disk that fails
        raise disk_error(path, needed, error) from None


def layout_of(chunks: Iterable[tuple[Block, xr.Dataset]], sizes: Mapping[str, int]) -> Layout:
    """Return the layout of the whole study from all of its chunks."""
    layout = Layout({})
    seen: dict[tuple, bytes] = {}
    for block, ds in chunks:
        layout.sizes |= {str(dim): n for dim, n in ds.sizes.items()}
        for name, variable in ds.variables.items():
            dims = merged(layout.dims.get(str(name), ()), tuple(map(str, variable.dims)))
            place = (name, *(block[dim].start for dim in block if dim in variable.dims))
            digest = hashlib.sha256(np.ascontiguousarray(variable.values).tobytes()).digest()
            if seen.setdefault(place, digest) != digest:  # it differs between chunks, so it depends on their dims
                dims = merged(dims, tuple(block))
            layout.dims[str(name)] = dims
            layout.like.setdefault(str(name), variable[(slice(0, 0),) * variable.ndim] if variable.ndim else variable)
    layout.sizes |= sizes
    return layout


def merged(one: tuple[str, ...], other: tuple[str, ...]) -> tuple[str, ...]:
    """Return all dims of both, in an order that keeps the order of each."""
    dims = list(one)
    for k, dim in enumerate(other):
        if dim not in dims:
            following = [dims.index(later) for later in other[k + 1 :] if later in dims]
            dims.insert(min(following, default=len(dims)), dim)
    return tuple(dims)


def _write(path: Path, layout: Layout, coordinates: Mapping[str, xr.Variable], chunks: Chunks) -> None:
    import netCDF4  # here: only writing studies needs it

    with NETCDF:
        file = netCDF4.Dataset(path, "w")
        try:
            _define_all(file, layout, coordinates)
            for block, ds in chunks():
                for name, variable in ds.variables.items():
                    _fill(file, layout, str(name), variable, block)
        finally:
            file.close()


def _define_all(file: Any, layout: Layout, coordinates: Mapping[str, xr.Variable]) -> None:
    beside = {name: {*values.dims} for name, values in coordinates.items() if name not in layout.sizes}
    for name, dims in layout.dims.items():
        named = " ".join(path for path, over in beside.items() if over <= {*dims})
        _define(file, name, layout.like[name], layout.sizes_of(name), {"coordinates": named} if named else {})
    for name, values in coordinates.items():
        plain = xr.Variable(values.dims, values.data, values.attrs, NO_FILL)
        encoded = encode_cf_variable(plain, name=name)
        _define(file, name, plain, values.sizes, {})[...] = encoded.values
    alone = [path for path, over in beside.items() if not any(over <= {*dims} for dims in layout.dims.values())]
    file.setncatts(layout.attributes | ({"coordinates": " ".join(alone)} if alone else {}))


def _define(file: Any, name: str, like: xr.Variable, sizes: Mapping[Any, int], more: Mapping[str, str]) -> Any:
    """Return a new, empty variable of the file, with the attributes that xarray writes for one like it, and more."""
    encoded = encode_cf_variable(like, name=name)
    attributes = {**encoded.attrs, **more}
    for dim, n in sizes.items():
        if dim not in file.dimensions:
            file.createDimension(dim, n)
    number = encoded.dtype.kind in "iuf"
    stored = file.createVariable(
        name,
        encoded.dtype.newbyteorder("=") if number else str,
        tuple(sizes),
        fletcher32=number and bool(sizes),
        chunksizes=tile(sizes.values()) or None,
        fill_value=attributes.pop("_FillValue", None),
    )
    stored.setncatts(attributes)
    return stored


def tile(shape: Iterable[int]) -> tuple[int, ...]:
    """Return the shape of the tiles of an array, row by row.

    Examples
    --------
    >>> tile((1000, 10, 3)), tile((10, 1000000))
    ((1000, 10, 3), (1, 65536))
    """
    room, sides = TILE, []
    for n in reversed(tuple(shape)):
        sides.append(min(n, max(1, room)))
        room //= sides[-1]
    return tuple(reversed(sides))


def _fill(file: Any, layout: Layout, name: str, variable: xr.Variable, block: Block) -> None:
    """Write a chunk's numbers to their place, unless another chunk has written the same ones."""
    dims = layout.dims[name]
    if any(part.start for dim, part in block.items() if dim not in dims):
        return
    place = {dim: block.get(dim, slice(0, layout.sizes[dim])) for dim in dims}
    spread = variable.set_dims({dim: part.stop - part.start for dim, part in place.items()}).transpose(*dims)
    file[name][tuple(place.values())] = spread.values
