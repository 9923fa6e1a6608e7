"""Write files whole or not at all, and replace nothing but regular files.

A new file is written in a temporary folder beside its target, flushed to the disk, then renamed; the name of that
folder is short, whatever the target's. The writer holds a lock on the folder, which the system releases when the
process ends, however it ends: a process that can lock such a folder knows that it was left behind, and removes it.
"""

from __future__ import annotations

import contextlib
import io
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import IO, Any

from linksweep.base.validate import refuse
from linksweep.scene.file.text_file import as_path, kind_of

PREFIX, SUFFIX = ".linksweep-", ".part"
"""First and last characters of the names of temporary folders."""


@contextlib.contextmanager
def whole(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Yield a temporary file to write to, which replaces `path` on success; otherwise `path` is left unchanged.

    Raises OSError where `path` is no file, or its folder is missing or cannot be written.
    """
    target = target_of(path)
    remove_abandoned(target.parent)
    with _named(path), _folder_beside(target) as folder:
        temporary = folder / "new"
        temporary.touch()
        yield temporary
        with open(temporary, "rb+") as file:  # Windows flushes only files open for writing
            os.fsync(file.fileno())
        with contextlib.suppress(FileNotFoundError):
            shutil.copymode(target, temporary)
        _replace(temporary, target)
    sync_folder(target.parent)


def write_from_memory(path: Path, write: Callable[[IO[bytes]], Any]) -> None:
    """Write a file by way of memory: on a full disk `write`, of another package, would not raise an OSError."""
    memory = io.BytesIO()
    write(memory)
    path.write_bytes(memory.getbuffer())


def ending_of(path: str | os.PathLike[str], endings: tuple[str, ...], advice: str = "") -> str:
    """Return the ending of a file's name in lower case, which decides the format.

    Raises ValueError, with `advice`, for an ending that is not among `endings`.
    """
    ending = as_path(path).suffix.lower()
    refuse([] if ending in endings else [f"{path}: its ending must be {' or '.join(endings)}{advice}"])
    return ending


def target_of(path: str | os.PathLike[str]) -> Path:
    """Return the file that a path leads to, existing or possible: a link remains, its target is replaced.

    Raises OSError for a folder, a device, a pipe, a socket, or a path in a folder that does not exist.
    """
    target = Path(os.path.realpath(path) if os.path.islink(path) else path)
    try:
        kind = kind_of(target)
    except FileNotFoundError:
        kind = ""
    except NotADirectoryError:
        raise NotADirectoryError(f"{path}: {target.parent} is no folder; choose another") from None
    if kind:
        raise FileExistsError(f"{path}: is {kind}, which no file replaces; choose another name")
    if not target.parent.is_dir():
        raise FileNotFoundError(f"{path}: there is no folder {target.parent}; make it first")
    return target


def remove_abandoned(folder: Path) -> None:
    """Remove from a folder the temporary files of processes that were killed."""
    with contextlib.suppress(OSError):
        for abandoned in folder.glob(f"{PREFIX}*{SUFFIX}"):
            with contextlib.suppress(OSError), locked(abandoned, wait=False) as has_lock:
                if has_lock:
                    shutil.rmtree(abandoned)


def sync_folder(folder: Path) -> None:
    """Flush a rename in a folder to the disk; not every system lets a folder be opened."""
    with contextlib.suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


@contextlib.contextmanager
def _folder_beside(target: Path) -> Iterator[Path]:
    """Make a temporary folder beside a file, locked where the system has locks, and remove it in the end."""
    while True:
        folder = Path(tempfile.mkdtemp(SUFFIX, PREFIX, target.parent))
        try:
            with locked(folder, wait=True):
                if folder.exists():  # else another process removed it before it was locked
                    yield folder
                    return
        finally:
            shutil.rmtree(folder, ignore_errors=True)


@contextlib.contextmanager
def locked(folder: Path, wait: bool) -> Iterator[bool | None]:
    """Lock a folder until the end, or until the process ends, however it does.

    Yields False where another process has the lock, None where the folder or the system has no such locks.
    """
    with contextlib.ExitStack() as stack:
        try:
            import fcntl

            handle = os.open(folder, os.O_RDONLY | os.O_NOFOLLOW)
            stack.callback(os.close, handle)
            fcntl.flock(handle, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
            has_lock: bool | None = True
        except (ImportError, OSError) as error:
            has_lock = False if isinstance(error, BlockingIOError) else None
        yield has_lock


def _replace(temporary: Path, target: Path) -> None:
    """Rename a whole file to its target, which on Windows nobody may have open."""
    try:
        os.replace(temporary, target)
    except PermissionError as error:
        if not target.exists():
            raise
        advice = f"{error.strerror}; where it is open, here or in another program, close it, then run the same again"
        raise PermissionError(error.errno, advice, str(target)) from None


@contextlib.contextmanager
def _named(path: str | os.PathLike[str]) -> Iterator[None]:
    """Name the target, not the temporary file, in an error of the system; the write that fails names no file."""
    try:
        yield
    except OSError as error:
        if error.errno is None or not (error.filename is None or PREFIX in str(error.filename)):
            raise
        raise OSError(error.errno, error.strerror, str(path)) from None
