"""Datasets of numbers as bytes, for chunks of a study and for transfer between processes."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr


def packed(ds: xr.Dataset) -> bytes:
    """Return a Dataset of numbers as bytes: numpy's npz, with dims and attributes as JSON."""
    about = {name: [values.dims, _plain(values.attrs)] for name, values in ds.variables.items()}
    text = json.dumps([_plain(ds.attrs), about])
    file = io.BytesIO()
    np.savez(file, *(values.values for values in ds.variables.values()), about=np.frombuffer(text.encode(), np.uint8))
    return file.getvalue()


def unpacked(data: bytes) -> xr.Dataset:
    """Return the Dataset stored in bytes by `packed`."""
    with np.load(io.BytesIO(data), allow_pickle=False) as file:
        attributes, about = json.loads(file["about"].tobytes())
        variables = {
            name: xr.Variable(dims, file[f"arr_{k}"], _restored(own))
            for k, (name, (dims, own)) in enumerate(about.items())
        }
    return xr.Dataset(variables, attrs=_restored(attributes))


def _plain(attributes: Mapping[Any, Any]) -> dict[str, Any]:
    """Return attributes for JSON; arrays, such as flag_values, with their type."""
    return {
        name: [value.dtype.str, value.tolist()] if isinstance(value, np.ndarray | np.generic) else value
        for name, value in attributes.items()
    }


def _restored(attributes: Mapping[str, Any]) -> dict[str, Any]:
    return {
        name: np.array(value[1], dtype=value[0]) if isinstance(value, list) else value
        for name, value in attributes.items()
    }
