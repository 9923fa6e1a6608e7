"""Names and labels that a NetCDF file holds, and that xarray reads as it wrote them.

Source for names: `NC_check_name` of netCDF-C, which also converts them to normal form C of Unicode.
"""

from __future__ import annotations

import re
import unicodedata
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.validate import is_lazy, quote

NAME = re.compile(r"(\w|[^\x00-\x7f])([^\x00-\x1f/\x7f]*[^\x00-\x20/\x7f])?", re.ASCII)
LONGEST = 255
"""Largest length of a name in bytes."""
TEXTS = (str, np.str_)
LARGEST = 2**63 - 1
"""Largest integer of TOML."""
UNITS_OF_TIME = ("ns", "us")
"""Units of times: in NetCDF, and in the text of a scene."""
LONGEST_SPAN = np.timedelta64(2**63 // 1000, "us")
"""Longest span of times: xarray counts them from the first one, in nanoseconds, and errs where int64 cannot hold it."""


def name_problem(name: Any) -> str:
    """Return why a file cannot hold a dimension or a variable of this name; nothing where it can."""
    if type(name) not in TEXTS or not NAME.fullmatch(name):
        begins = 'begins with a letter, a digit or "_", without "/", control characters and a space at its end'
        return f"its name must be a text that {begins}"
    if not (_is_sound(name) and unicodedata.is_normalized("NFC", name)):
        return "its name must be Unicode in normal form C"
    return f"its name must have at most {LONGEST} bytes" if len(name.encode()) > LONGEST else ""


def label_problem(variable: Any) -> str:
    """Return which label of a coordinate a file cannot hold, and why; nothing where it can hold all of them."""
    dtype = variable.dtype
    plain = isinstance(dtype, np.dtype)
    if plain and dtype.kind == "u" and (variable.values > LARGEST).any():
        return f"the label {variable.values.max()}: must be at most {LARGEST}, or a text"
    if plain and (dtype.kind in "iub" or (dtype.kind == "f" and dtype.itemsize in (4, 8))):
        return ""
    if plain and dtype.kind == "M":
        return _time_problem(variable.values)
    if dtype.kind in "OU":
        return _text_problem(variable.values.ravel().tolist())
    allowed = "float64, float32, integers of numpy, truth values, texts, or times without a zone"
    return f"labels of dtype {dtype}: must be {allowed}"


def storable_coordinate(variable: xr.Variable) -> xr.Variable:
    """Return a coordinate with those of its attributes that every file format allows, and without its encoding."""
    attributes = {name: value for name, value in variable.attrs.items() if type(value) is not bool}
    attributes = {name: value for name, value in attributes.items() if isinstance(value, str | int | float)}
    values = variable.values
    texts = np.array([str(label) for label in values], object) if values.dtype == object else values
    return xr.Variable(variable.dims, texts, attributes)


def _text_problem(labels: list[Any]) -> str:
    """Return why a file cannot hold labels that are texts or mixed; nothing where it can."""
    others = [label for label in labels if type(label) not in TEXTS]
    if others:
        return f"the label {quote(others[0])}: must be a text, or all an array of numbers, truth values or times"
    if _is_sound("".join(labels)):
        return ""
    broken = next(label for label in labels if not _is_sound(label))
    return f"the label {quote(broken)}: must be Unicode without NUL"


def _time_problem(times: np.ndarray) -> str:
    """Return which time a file cannot hold; nothing where it can hold all of them."""
    lost = np.array([not all(_holds(unit, time) for unit in UNITS_OF_TIME) for time in times.reshape(-1)], dtype=bool)
    words = "must be a time in whole microseconds between the years 1678 and 2262, or a text"
    if lost.any():
        return f"the label {times.reshape(-1)[lost][0]}: {words}"
    if times.size and np.ptp(times.astype("M8[us]")) > LONGEST_SPAN:
        return f"the label {times.max()}: must be at most 292 years after {times.min()}, or a text"
    return ""


def _holds(unit: str, time: np.datetime64) -> bool:
    """Return whether a unit of time holds a time exactly."""
    try:
        return bool(time.astype(f"M8[{unit}]").astype(time.dtype) == time)  # not so of NaT
    except OverflowError:  # numpy 2.5 raises where others return another time
        return False


def _is_sound(text: str) -> bool:
    """Return whether a text can be written as UTF-8, and read to its end."""
    try:
        return b"\0" not in text.encode()
    except UnicodeEncodeError:
        return False


def own_label(name: str, value: Any) -> Any:
    """Return an array over a dim of its own name with its values as labels: in a file it is this dim's coordinate."""
    own = isinstance(value, xr.DataArray) and value.dims == (name,) and name not in value.coords
    return value.assign_coords({name: value.values}) if own and not is_lazy(value) else value
