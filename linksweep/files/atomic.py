"""Files written whole or not at all, and nothing replaced but regular files.

A new file is made in a folder of its own beside its target, flushed to the disk, then renamed; the name of that folder
is short, whatever the target's. Its writer holds a lock on it, which the system lifts when the process ends, however
it ends: who can lock such a folder knows that it was left behind, and removes it.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

from linksweep.base.validate import refuse
from linksweep.scene.file.text_file import kind_of

PREFIX, SUFFIX = ".linksweep-", ".part"
"""How the names of folders begin and end in which files are being written."""


@contextlib.contextmanager
def whole(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Yield a temporary file to write to, which becomes `path` when all went well; else `path` is left as it was.

    Raises OSError for a path that is no file, or lies in a folder that is missing or cannot be written.
    """
    target = target_of(path)
    sweep(target.parent)
    with _named(path), _folder_beside(target) as folder:
        temporary = folder / "new"
        temporary.touch()
        yield temporary
        with open(temporary, "rb+") as file:  # Windows flushes only what may be written
            os.fsync(file.fileno())
        with contextlib.suppress(FileNotFoundError):
            shutil.copymode(target, temporary)
        os.replace(temporary, target)
    sync_folder(target.parent)


def ending_of(path: str | os.PathLike[str], endings: tuple[str, ...], advice: str = "") -> str:
    """Return the ending of a file's name, in lower case, which says what is written.

    Raises ValueError, with some advice, for another than these.
    """
    ending = Path(path).suffix.lower()
    refuse([] if ending in endings else [f"{path}: its ending must be {' or '.join(endings)}{advice}"])
    return ending


def target_of(path: str | os.PathLike[str]) -> Path:
    """Return the file that a path leads to, which is there or can be made: a link stays one, its target is replaced.

    Raises OSError where it is a folder, a device, a pipe, a socket, or in a folder that is not there.
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


def sweep(folder: Path) -> None:
    """Remove from a folder the files that killed processes were writing there."""
    with contextlib.suppress(OSError):
        for left in folder.glob(f"{PREFIX}*{SUFFIX}"):
            with contextlib.suppress(OSError), _locked(left, wait=False) as alone:
                if alone:
                    shutil.rmtree(left)


def sync_folder(folder: Path) -> None:
    """Make a rename in a folder last; not every system lets a folder be opened."""
    with contextlib.suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


@contextlib.contextmanager
def _folder_beside(target: Path) -> Iterator[Path]:
    """Make a folder beside a file for as long as it is written, locked where the system has locks."""
    while True:
        folder = Path(tempfile.mkdtemp(SUFFIX, PREFIX, target.parent))
        try:
            with _locked(folder, wait=True):
                if folder.exists():  # else another process swept it before it was locked
                    yield folder
                    return
        finally:
            shutil.rmtree(folder, ignore_errors=True)


@contextlib.contextmanager
def _locked(folder: Path, wait: bool) -> Iterator[bool]:
    """Lock a folder; yield False where another process has it, or the system has no such locks."""
    try:
        import fcntl
    except ImportError:
        yield False
        return
    with contextlib.ExitStack() as stack:
        try:
            handle = os.open(folder, os.O_RDONLY | os.O_NOFOLLOW)
            stack.callback(os.close, handle)
            fcntl.flock(handle, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
        except OSError:
            yield False
        else:
            yield True


@contextlib.contextmanager
def _named(path: str | os.PathLike[str]) -> Iterator[None]:
    """Name the file, and not the temporary one, in what the system says."""
    try:
        yield
    except OSError as error:
        if PREFIX not in str(error.filename):
            raise
        raise OSError(error.errno, error.strerror, str(path)) from None
