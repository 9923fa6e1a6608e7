"""The user's cache folder: results that took long to compute, one file each.

Some of these files are machine code, so no file that others could have written is read: the folder and every file in it
must belong to the user and be writable by nobody else; otherwise nothing is cached. Ownership protects against attack,
the checksum at the head of each file against damage. A file is opened once, and the bytes that were verified are the
ones used.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import stat
import tempfile
import time
from pathlib import Path

DIGEST = hashlib.sha256().digest_size
ORPHAN_AGE = 3600.0
"""Age in seconds beyond which no process still writes a temporary file."""


def cache_folder() -> Path | None:
    """Return LINKSWEEP_CACHE_DIR, or the user's cache folder; None if it can't be made or isn't the user's alone."""
    import platformdirs

    folder = Path(os.environ.get("LINKSWEEP_CACHE_DIR") or platformdirs.user_cache_path("linksweep"))
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        safe = _owned(folder.lstat()) and _only_ours(folder.stat())  # a link, too, must be the user's
    except OSError:
        return None
    return folder if safe and os.access(folder, os.W_OK) else None


def recall(name: str) -> bytes | None:
    """Return the bytes stored under this name; None if there are none, or they are damaged or not the user's alone."""
    folder = cache_folder()
    if folder is None:
        return None
    try:
        with open(folder / name, "rb", opener=_open_ours) as file:
            content = file.read()
    except OSError:
        return None
    digest, stored = content[:DIGEST], content[DIGEST:]
    if hashlib.sha256(stored).digest() == digest:
        return stored
    forget(name)
    return None


def keep(name: str, content: bytes) -> None:
    """Store bytes under a name, whole or not at all; where the folder is full or missing, do nothing."""
    folder = cache_folder()
    if folder is None:
        return
    with contextlib.suppress(OSError):
        _remove_orphans(folder)
        handle, temporary = tempfile.mkstemp(dir=folder, suffix=".tmp")
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(hashlib.sha256(content).digest() + content)
            os.replace(temporary, folder / name)
        except BaseException:
            os.unlink(temporary)
            raise


def forget(name: str) -> None:
    """Remove the bytes stored under this name."""
    if folder := cache_folder():
        with contextlib.suppress(OSError):
            os.unlink(folder / name)


def _remove_orphans(folder: Path) -> None:
    """Remove the temporary files of processes that were killed."""
    for temporary in folder.glob("*.tmp"):
        if time.time() - temporary.lstat().st_mtime > ORPHAN_AGE:
            temporary.unlink()


def _open_ours(path: str, flags: int) -> int:
    """Open a regular file that only the user may write; refuse links, don't wait for pipes."""
    handle = os.open(path, flags | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))
    status = os.fstat(handle)
    if not (stat.S_ISREG(status.st_mode) and _only_ours(status)):
        os.close(handle)
        raise PermissionError(f"{path}: others may write it")
    return handle


def _only_ours(status: os.stat_result) -> bool:
    """Return whether a file or folder is the user's and nobody else may write it; Windows guards users' own folders."""
    return _owned(status) and not (hasattr(os, "geteuid") and status.st_mode & (stat.S_IWGRP | stat.S_IWOTH))


def _owned(status: os.stat_result) -> bool:
    return not hasattr(os, "geteuid") or status.st_uid == os.geteuid()
