"""Read a text file; a file that cannot be read is refused with the reason."""

from __future__ import annotations

import os
import stat
from pathlib import Path
from typing import Any

from linksweep.base.validate import closest

LARGEST = 64 * 2**20
"""Bytes that a text file may have."""
KINDS = {
    stat.S_IFDIR: "a folder",
    stat.S_IFIFO: "a pipe",
    stat.S_IFSOCK: "a socket",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
}


def as_path(name: Any) -> Path:
    """Return the path of a file. Raises ValueError for anything but a text or a path, such as a Scene."""
    try:
        return Path(name)
    except TypeError:
        raise ValueError(f"path is a {type(name).__name__}: must be the name of a file") from None


def text_of(path: Path, name: str, ending: str, where: str = "", advice: str = "") -> str:
    """Return the text of a file that messages call `name`. Raises ValueError where it cannot be read.

    The message about a missing file states `where`, a file of that `ending` with a similar name, and the `advice`.
    """
    try:
        if kind := kind_of(path):
            raise ValueError(f"{name}: cannot be read: it is {kind}, no file")
        with open(path, "rb") as file:
            content = file.read(LARGEST + 1)
    except FileNotFoundError:
        alike = closest(path.stem, [file.stem for file in path.parent.glob(f"*{ending}")])
        near = f'; did you mean "{alike}{ending}"?' if alike else ""
        raise ValueError(f"{name}: there is no such file{where}{near}{advice}") from None
    except OSError as error:
        raise ValueError(f"{name}: cannot be read: {error.strerror}") from None
    if len(content) > LARGEST:
        raise ValueError(f"{name}: has more than {LARGEST // 2**20} MB; many designs go into a NetCDF file")
    try:
        return content.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError:
        raise ValueError(f"{name}: is not a text file in UTF-8; save it as one") from None


def kind_of(path: str | os.PathLike[str]) -> str:
    """Return "a folder", "a pipe", … where a path leads to no regular file, else nothing; it must be there."""
    return KINDS.get(stat.S_IFMT(os.stat(path).st_mode), "")
