"""Compiled kernels are cached safely: never stale, never half written, and not missed if nothing can be cached."""

import errno
import math
import os
import pickle
import stat
import subprocess
import sys
from unittest.mock import Mock

import numpy as np
import pytest
from numba.core.compiler import Compiler

import linksweep as ls
from benchmarks.speed.kernel import way
from linksweep.base import cache
from linksweep.engine import run
from linksweep.engine.kernel import compile as kernels
from linksweep.engine.kernel import numba_code
from linksweep.engine.kernel.instructions import REGISTER as LANES
from linksweep.engine.peaks import laid_out
from linksweep.engine.trace.plan import plan

SOURCE = "import math\n\n\ndef kernel(x):\n    x[0] = math.sqrt(x[0])\n"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty cache, and nothing compiled in this process."""
    monkeypatch.setenv("LINKSWEEP_CACHE_DIR", str(tmp_path / "cache"))
    forget()
    yield tmp_path / "cache"
    forget()


def root_of_two() -> float:
    """Compile a kernel, or fetch it from the cache, and run it."""
    x = np.array([2.0])
    kernels.compiled(SOURCE, kinds=("f8*",))(x)
    return float(x[0])


def forget():
    """As in a new process: compiled kernels are not in memory."""
    kernels.compiled.cache_clear()


def kept(folder):
    """The one kernel that is kept."""
    (path,) = folder.glob("kernel_*")
    return path


KERNELS = """
from hashlib import sha256
import linksweep as ls
from linksweep.engine.kernel.writer import Writer
from linksweep.engine.trace.plan import plan

for scene in map(ls.example, ("engine", "excavator", "klann-leg", "whitworth")):
    sampled, peaks = scene.at(scene.grid(4)), scene.mechanism.peak_quantities(scene.drive)
    source = Writer(plan(sampled.table, peaks, sampled.inputs.forms), ()).source
    print(sha256(source.encode()).hexdigest())
"""


def test_every_process_writes_the_same_kernels():
    """Each orders its sets of names in another way; the excavator's two struts changed places."""
    printed = [
        subprocess.run(
            [sys.executable, "-c", KERNELS],
            env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True,
            text=True,
            check=True,
        ).stdout.split()
        for seed in ("1", "4")
    ]
    assert printed[0] == printed[1] and len(set(printed[0])) == 4


def test_a_second_process_finds_the_compiled_kernel(folder):
    root_of_two()
    written = kept(folder).stat().st_mtime_ns
    forget()
    assert root_of_two() == math.sqrt(2)
    assert kept(folder).stat().st_mtime_ns == written


def test_a_search_takes_code_that_is_kept_from_the_second_design_on(folder, monkeypatch):
    """Else a second process would interpret forty designs, as the first one, before it looked for the code."""
    run_search, lanes = laid_out.LaidOut.run, []

    def noted(designs, search, kinds):
        lanes.append(designs.lanes)
        return run_search(designs, search, kinds)

    def lanes_of(calls):
        laid_out.evaluators_of.cache_clear()  # as in a new process
        lanes.clear()
        for _ in range(calls):
            ls.peaks(ls.example("press"), of="T12")
        return lanes

    monkeypatch.setattr(laid_out.LaidOut, "run", noted)
    assert lanes_of(2) == [1, 1]
    with way("compiled"):
        assert lanes_of(1) == [LANES]
    assert lanes_of(3) == [1, LANES, LANES]
    for path in folder.glob("*sample_*"):
        path.write_bytes(path.read_bytes()[:-1])
    assert lanes_of(2) == [1, 1]


def test_kernels_are_compiled_where_numba_is_told_not_to_compile(folder, monkeypatch):
    """NUMBA_DISABLE_JIT=1 makes a user's own functions plain Python, to be debugged; kernels have no such form."""
    import numba

    monkeypatch.setattr(numba.config, "DISABLE_JIT", 1)
    assert root_of_two() == math.sqrt(2)
    forget()
    assert root_of_two() == math.sqrt(2)  # from the cache
    assert numba.njit(root_of_two) is root_of_two and numba.config.DISABLE_JIT == 1


DAMAGE = {
    "cut": lambda whole: whole[: len(whole) // 2],
    "empty": lambda whole: b"",
    "a bit flipped": lambda whole: whole[:999] + bytes([whole[999] ^ 4]) + whole[1000:],
    "garbage": lambda whole: b"\xff" * len(whole),
    "another numba's": lambda whole: cache.hashlib.sha256(pickle.dumps((1, 2))).digest() + pickle.dumps((1, 2)),
}


@pytest.mark.parametrize("damage", DAMAGE)
def test_a_damaged_kernel_is_compiled_and_kept_again(folder, damage):
    root_of_two()
    whole = kept(folder).read_bytes()
    kept(folder).write_bytes(DAMAGE[damage](whole))
    forget()
    assert root_of_two() == math.sqrt(2)
    again = kept(folder).read_bytes()
    assert cache.hashlib.sha256(again[cache.DIGEST :]).digest() == again[: cache.DIGEST]
    assert again != DAMAGE[damage](whole)


def test_a_full_disk_keeps_nothing_and_leaves_nothing(folder, monkeypatch):
    root_of_two()
    kept(folder).unlink()
    forget()

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(cache.os, "replace", full)
    assert root_of_two() == math.sqrt(2)
    assert list(folder.iterdir()) == []


def test_temporary_files_of_killed_runs_are_swept(folder):
    folder.mkdir(mode=0o700)
    for name, age in (("old.tmp", 2 * cache.ORPHAN_AGE), ("new.tmp", 0.0)):
        (folder / name).write_bytes(b"")
        then = cache.time.time() - age
        os.utime(folder / name, (then, then))
    root_of_two()
    assert [path.name for path in folder.glob("*.tmp")] == ["new.tmp"]


# ------------------------------------------------------------------------------------------ what others put there


posix = pytest.mark.skipif(not hasattr(os, "geteuid"), reason="Windows guards the user's folders itself")


class Trap:
    """A pickle that leaves a mark where it is run."""

    def __init__(self, mark):
        self.mark = mark

    def __reduce__(self):
        return os.mkdir, (str(self.mark),)


def plant(folder, mark):
    """Put a trap, its checksum right, in place of the kept kernel."""
    content = pickle.dumps(Trap(mark))
    path = kept(folder)
    path.write_bytes(cache.hashlib.sha256(content).digest() + content)
    return path


@posix
def test_a_cache_that_only_the_user_may_write_is_trusted(folder, tmp_path):
    """The trap works: tests below that find no mark do so because it was not read."""
    root_of_two()
    plant(folder, tmp_path / "mark")
    forget()
    root_of_two()
    assert (tmp_path / "mark").exists()


@posix
@pytest.mark.parametrize("who", ["the folder", "the kernel"])
@pytest.mark.parametrize("mode", [stat.S_IWGRP, stat.S_IWOTH])
def test_a_cache_that_others_may_write_is_not_read(folder, tmp_path, who, mode):
    root_of_two()
    path = plant(folder, tmp_path / "mark")
    written = folder if who == "the folder" else path
    written.chmod(written.stat().st_mode | mode)
    forget()
    assert root_of_two() == math.sqrt(2)
    assert not (tmp_path / "mark").exists()


@posix
@pytest.mark.parametrize("who", ["the folder", "the kernel", "a link to the folder"])
def test_a_cache_that_another_user_owns_is_not_read(folder, tmp_path, monkeypatch, who):
    root_of_two()
    path = plant(folder, tmp_path / "mark")
    others = {"the folder": folder, "the kernel": path, "a link to the folder": tmp_path / "link"}[who]
    if not others.exists():
        others.symlink_to(folder)
        monkeypatch.setenv("LINKSWEEP_CACHE_DIR", str(others))
    inode, owned = others.lstat().st_ino, cache._owned
    monkeypatch.setattr(cache, "_owned", lambda status: status.st_ino != inode and owned(status))
    forget()
    assert root_of_two() == math.sqrt(2)
    assert not (tmp_path / "mark").exists()


@posix
def test_a_kernel_that_is_a_link_is_not_read(folder, tmp_path):
    root_of_two()
    path = plant(folder, tmp_path / "mark")
    path.rename(tmp_path / "elsewhere")
    path.symlink_to(tmp_path / "elsewhere")
    forget()
    assert root_of_two() == math.sqrt(2)
    assert not (tmp_path / "mark").exists()
    assert not path.is_symlink()  # the kernel that was compiled stands there now


@posix
@pytest.mark.parametrize("umask", [0o000, 0o022])
def test_a_new_folder_is_the_users_alone(folder, umask):
    before = os.umask(umask)
    try:
        root_of_two()
    finally:
        os.umask(before)
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert stat.S_IMODE(kept(folder).stat().st_mode) == 0o600


# ------------------------------------------------------------------------------------------------------- its name


def test_the_name_covers_all_that_enters_the_kernel(folder, monkeypatch):
    scene = ls.example("press")
    kernel = run.runner(plan(scene.table, ("T12",), scene.inputs.forms), ()).fused.source
    kernels.compiled(kernel, "")
    kernels.compiled(kernel.replace("sqrt(", "1.0 * sqrt("), "")
    kernels.compiled(kernel, "import math\n\n\ndef unused():\n    return 1.0\n")
    monkeypatch.setattr(kernels, "SETTINGS", kernels.SETTINGS | {"boundscheck": False})
    kernels.compiled.cache_clear()
    kernels.compiled(kernel, "")
    assert len(list(folder.glob("kernel_*"))) == 4


@pytest.mark.parametrize("blocked", ["a file stands in the way", "a folder that cannot be written"])
def test_without_a_folder_to_write_to_it_compiles_all_the_same(folder, monkeypatch, blocked):
    elsewhere = folder.parent / "blocked"
    if blocked.startswith("a file"):
        elsewhere.write_text("not a folder")
    else:
        elsewhere.mkdir()
        elsewhere.chmod(stat.S_IRUSR | stat.S_IXUSR)
        monkeypatch.setattr(cache.os, "access", lambda *_: False)  # root may write anywhere
    monkeypatch.setenv("LINKSWEEP_CACHE_DIR", str(elsewhere))
    assert cache.cache_folder() is None
    assert root_of_two() == math.sqrt(2)


# ------------------------------------------------------------------------------------------------- numba's part


def test_kernels_that_are_optimised_once_have_the_bits_of_numbas_own_compiler(folder, monkeypatch):
    monkeypatch.setattr(run, "COMPILE_AFTER", -1)
    scene = ls.example("engine")
    once = ls.sweep(scene, 100)
    assert isinstance(kernels.compiled(SOURCE, kinds=("f8*",)).owner._library, numba_code.OptimisedOnce)
    for path in folder.glob("kernel_*"):
        path.unlink()
    forget()
    own = Mock(side_effect=Compiler)
    monkeypatch.setattr(numba_code, "KernelCompiler", own)
    assert ls.sweep(scene, 100).identical(once)
    assert own.called
