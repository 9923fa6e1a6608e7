"""The seal of a file that linksweep wrote: a manifest and a checksum of the whole file, after the end of its HDF5 data.

HDF5's own checksums (fletcher32) cover only the numbers of variables with dims: no labels, no single numbers; and a bit
flipped in the structure can send the HDF5 library into an endless loop. So the file is read once before HDF5 sees it,
and refused where its SHA-256 does not match. HDF5, and every program that reads NetCDF through it, ignores bytes after
its end. The seal, from the end backwards: a mark, the SHA-256 of all bytes before it, the length of the manifest, the
manifest as JSON. The mark distinguishes a finished study from a file that was saved.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import struct
import subprocess
import sys
from pathlib import Path
from typing import IO, Any

STUDY, SAVED = b"\nlinksweep study\n", b"\nlinksweep saved\n"
FOOTER = struct.Struct(f"<Q32s{len(STUDY)}s")
READ = 1 << 22  # bytes at a time
SEARCH = 60.0  # seconds that the search for damaged variables may take: HDF5 may hang on a damaged file


def seal(path: Path, manifest: dict[str, Any], mark: bytes = STUDY) -> None:
    """Append the seal to a file and flush it to the disk."""
    text = json.dumps(manifest).encode()
    head = text + struct.pack("<Q", len(text))
    with open(path, "rb+") as file:
        digest = _digest(file, os.path.getsize(path))
        digest.update(head)
        file.seek(0, os.SEEK_END)
        file.write(head + digest.digest() + mark)
        file.flush()
        os.fsync(file.fileno())


def mark_of(path: Path) -> bytes:
    """Return the mark at the end of a file; empty where there is none."""
    with contextlib.suppress(OSError), open(path, "rb") as file:
        file.seek(-len(STUDY), os.SEEK_END)
        mark = file.read()
        return mark if mark in (STUDY, SAVED) else b""
    return b""


def sealed(path: Path, mark: bytes = STUDY) -> dict[str, Any]:
    """Return the manifest of a sealed file after verifying its checksum; ValueError where that does not match."""
    with open(path, "rb") as file:
        size = file.seek(0, os.SEEK_END)
        file.seek(max(0, size - FOOTER.size))
        end = file.read(FOOTER.size)
        if not end.endswith(mark) or len(end) < FOOTER.size:
            raise ValueError(
                f"{path}: is no study that linksweep finished: cut off, changed since, or another file; move it away, "
                f"or choose another name"
            )
        length, expected, _ = FOOTER.unpack(end)
        file.seek(0)
        if _digest(file, size - FOOTER.size + 8).digest() != expected:
            advice = f"{_where(path)}; move it away and study again" if mark == STUDY else "; make it again"
            raise ValueError(f"{path}: is damaged: its checksum does not match{advice}")
        file.seek(size - FOOTER.size - length)
        manifest: dict[str, Any] = json.loads(file.read(length))
        return manifest


def _digest(file: IO[bytes], size: int) -> Any:
    """Return the SHA-256 of the first bytes of a file."""
    digest = hashlib.sha256()
    while size > 0 and (part := file.read(min(READ, size))):
        digest.update(part)
        size -= len(part)
    return digest


def _where(path: Path) -> str:
    """Return which variables of a damaged file cannot be read; another process searches, as HDF5 may hang or crash."""
    search = [sys.executable, "-P", str(Path(__file__).with_name("unreadable.py")), str(path)]
    try:
        output = subprocess.run(search, capture_output=True, text=True, timeout=SEARCH, check=True).stdout
        names = output.split("\n")[:-1]
    except (OSError, subprocess.SubprocessError):
        return ""
    return f", {', '.join(names)} cannot be read" if names else ", outside the numbers of its variables"
