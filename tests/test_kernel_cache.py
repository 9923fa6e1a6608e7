"""Compiled kernels are kept safely: never stale, never half written, and not missed where nothing can be kept."""

import stat
import sys

import pytest

import linksweep as ls
from linksweep.engine import compile as kernels
from linksweep.engine import run
from linksweep.engine.plan import plan


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty cache, nothing compiled in this process, and every request compiled."""
    monkeypatch.setenv("LINKSWEEP_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setattr(run, "COMPILE_AFTER", 0)
    kernels.compiled.cache_clear()
    yield tmp_path / "cache"
    kernels.compiled.cache_clear()


def swept():
    return ls.sweep(ls.example("press"), theta2=8, outputs=["T12"])


def forget():
    """As in a new process: compiled kernels and their modules are not in memory."""
    kernels.compiled.cache_clear()
    kernels._compiled_functions.cache_clear()
    for name in [name for name in sys.modules if name.startswith("kernel_")]:
        del sys.modules[name]


def test_a_second_process_finds_the_compiled_kernel(folder):
    first = swept()
    compiled = {path: path.stat().st_mtime_ns for path in folder.rglob("*.nbc")}
    assert compiled
    forget()
    assert swept().equals(first)
    assert {path: path.stat().st_mtime_ns for path in folder.rglob("*.nbc")} == compiled


def test_a_damaged_source_is_written_again(folder):
    first = swept()
    (source,) = folder.glob("kernel_*.py")
    whole = source.read_text()
    source.write_text(whole[: len(whole) // 2])
    forget()
    assert swept().equals(first)
    assert source.read_text() == whole


def test_the_name_covers_all_that_enters_the_kernel(folder, monkeypatch):
    scene = ls.example("press")
    kernel = run.runner(plan(scene.table, ("T12",), scene.inputs.forms), (), 1024).fused.source
    kernels.compiled(kernel, "")
    kernels.compiled(kernel.replace("sqrt(", "1.0 * sqrt("), "")
    kernels.compiled(kernel, "import math\n\n\ndef unused():\n    return 1.0\n")
    monkeypatch.setattr(kernels, "SETTINGS", 'error_model="numpy", nogil=True, boundscheck=False')
    kernels.compiled.cache_clear()
    kernels.compiled(kernel, "")
    assert len(list(folder.glob("kernel_*.py"))) == 5  # four kernels, and the functions that the third one is given


@pytest.mark.parametrize("blocked", ["a file stands in the way", "a folder that cannot be written"])
def test_without_a_folder_to_write_to_it_compiles_all_the_same(folder, monkeypatch, blocked):
    expected = swept()
    forget()
    elsewhere = folder.parent / "blocked"
    if blocked.startswith("a file"):
        elsewhere.write_text("not a folder")
    else:
        elsewhere.mkdir()
        elsewhere.chmod(stat.S_IRUSR | stat.S_IXUSR)
        monkeypatch.setattr(kernels.os, "access", lambda *_: False)  # root may write anywhere
    monkeypatch.setenv("LINKSWEEP_CACHE_DIR", str(elsewhere))
    assert kernels.cache_folder() is None
    assert swept().equals(expected)
