"""The folder of an unfinished study: a manifest, and a file for each finished chunk.

A chunk is numpy's npz, made in memory and named by its number and the SHA-256 of its bytes. It is written under another
name, flushed to the disk, then renamed: after kill -9 or a power cut it is there whole or not at all. A file whose
bytes do not match its name is deleted and computed again.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import re
import shutil
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import xarray as xr

from linksweep.base.validate import quote, refuse
from linksweep.files.atomic import SUFFIX, locked, whole
from linksweep.files.packed import packed, unpacked

MANIFEST = "manifest.json"
PART = SUFFIX  # ending of files that are being written
ASSEMBLED = "assembled" + PART
CHUNK = re.compile(r"(\d+)-([0-9a-f]{64})\.npz")


class Partial:
    """The folder of an unfinished study; `kept` has the files of finished chunks by number."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.assembled = folder / ASSEMBLED
        """Path at which the finished study is assembled."""
        self.kept: dict[int, Path] = {}
        for path in folder.iterdir():
            if named := CHUNK.fullmatch(path.name):
                self.kept[int(named[1])] = path
            elif path.name.endswith(PART):
                _remove(path)  # it was being written when the study was killed

    def keep(self, number: int, ds: xr.Dataset) -> None:
        data = packed(ds)
        path = self._path(number, data)
        with whole(path) as temporary:
            temporary.write_bytes(data)
        self.kept[number] = path

    def holds(self, number: int) -> bool:
        """Return whether a chunk is stored and undamaged."""
        return self._bytes(number) is not None

    def load(self, number: int) -> xr.Dataset | None:
        """Return a stored chunk; None where there is none, or it is damaged."""
        data = self._bytes(number)
        return None if data is None else unpacked(data)

    def _bytes(self, number: int) -> bytes | None:
        if number not in self.kept:
            return None
        path = self.kept[number]
        data = path.read_bytes() if path.exists() else b""
        if path == self._path(number, data):
            return data
        del self.kept[number]
        path.unlink(missing_ok=True)
        return None

    def _path(self, number: int, data: bytes) -> Path:
        return self.folder / f"{number:06d}-{hashlib.sha256(data).hexdigest()}.npz"

    def remove(self) -> None:
        """Remove the folder; its manifest last, so that what is left after a kill still says what it is."""
        for path in [*self.kept.values(), self.assembled, self.folder / MANIFEST]:
            path.unlink(missing_ok=True)
        with contextlib.suppress(OSError):  # files of others stay
            self.folder.rmdir()


def _remove(path: Path) -> None:
    """Remove a file, or a folder with all its content."""
    if path.is_dir():
        shutil.rmtree(path)
    else:
        path.unlink()


@contextlib.contextmanager
def partial(folder: Path, manifest: Mapping[str, Any]) -> Iterator[Partial]:
    """Create or reopen the folder of a study, locked for this process alone.

    Raises ValueError where the folder belongs to another study, or another process works on it.
    """
    manifest_file = folder / MANIFEST
    folder.mkdir(exist_ok=True)
    with locked(folder.resolve(), wait=False) as alone:
        if alone is False:
            raise ValueError(f"{folder}: another process is at work on this study; wait for it, or stop it")
        if manifest_file.exists():
            refuse(_other(manifest_file, manifest))
        elif any(not path.name.endswith(PART) for path in folder.iterdir()):
            raise ValueError(f"{folder}: is no folder of a study: it has no {MANIFEST}; move it away")
        else:
            with whole(manifest_file) as temporary:
                temporary.write_text(json.dumps(manifest, indent=1), encoding="utf-8")
        yield Partial(folder)


def _other(manifest_file: Path, manifest: Mapping[str, Any]) -> list[str]:
    """Return why a folder belongs to another study."""
    try:
        old = json.loads(manifest_file.read_bytes())
        different = [word for word in manifest if old[word] != manifest[word]]
    except (ValueError, LookupError, TypeError):
        problem = "is damaged: it does not say of which study this folder is; delete the folder and study again"
        return [f"{manifest_file}: {problem}"]
    advice = "go on with that, move the folder away, or choose another name"
    return [
        f"{manifest_file.parent}: was begun with another {word}{differing(old[word], manifest[word])}; {advice}"
        for word in different[:1]
    ]


def differing(old: Any, new: Any) -> str:
    """Return both values that differ, in brackets; nothing for digests, and where they differ beyond what is shown."""
    digest = len(str(new)) == 64
    return "" if digest or quote(old) == quote(new) else f" ({quote(old)}, not {quote(new)})"
