"""Studies that are stopped, killed, or out of disk space: repeating the call gives an identical file."""

import contextlib
import errno
import os
import random
import resource
import signal
import subprocess
import sys
import time
import warnings
from pathlib import Path

import pytest
from studies import assert_same, flipped, many, stop_after, stopped_study

import linksweep as ls
from linksweep.studies import assemble
from linksweep.studies.job import Job


@pytest.fixture
def stopped(tmp_path, monkeypatch):
    return stopped_study(tmp_path, monkeypatch)


# ---------------------------------------------------------------------------------------- stopped and killed


def test_a_stopped_study_continues(stopped, monkeypatch):
    path, whole = stopped
    assert len(os.listdir(f"{path}.partial")) == 4  # three chunks and a manifest
    computed = stop_after(99, monkeypatch)
    ls.study(many(), path, of=["F32"], chunk=6)
    assert [block["speed"].start for block in computed] == [18, 24, 30, 36, 42, 48, 54]
    assert path.read_bytes() == whole
    assert sorted(os.listdir(path.parent)) == ["study.nc", "whole.nc"]


def test_a_finished_study_is_opened_and_not_computed(tmp_path, monkeypatch):
    path = tmp_path / "study.nc"
    first, content = ls.study(many(), path, of=["F32"]).load(), path.read_bytes()
    monkeypatch.setattr(Job, "compute", None)
    assert ls.study(many(), path, of="F32", chunk=7).load().identical(first)
    assert path.read_bytes() == content


KILLED = """
import linksweep as ls
from studies import hang_after, many
hang_after(8)
ls.study(many(), input(), of=["F32"], chunk=1)
"""


def waiting() -> subprocess.Popen:
    """Start a process that waits for the path of the study to compute."""
    tests = Path(__file__).parents[1]
    paths = os.pathsep.join([str(tests / "helpers"), str(tests.parent)])
    environment = {**os.environ, "PYTHONPATH": paths}
    return subprocess.Popen([sys.executable, "-c", KILLED], stdin=subprocess.PIPE, env=environment, text=True)


@pytest.mark.long
def test_a_study_killed_at_random_moments_gives_the_identical_file(tmp_path):
    """Each kill comes some chunks, and a moment, after the last."""
    path, rng = tmp_path / "study.nc", random.Random(7)

    def chunks() -> int:
        return len(list(tmp_path.glob("study.nc.partial/*.npz")))

    processes = [waiting() for _ in range(6)]
    for process, further in zip(processes, (0, 1, 2, 5, 6, 7), strict=True):
        goal = chunks() + further
        process.stdin.write(f"{path}\n")
        process.stdin.flush()
        while chunks() < goal and process.poll() is None:
            time.sleep(0.001)
        time.sleep(rng.uniform(0.0, 0.02))
        process.kill()
        process.communicate()
        assert process.returncode == -signal.SIGKILL
        assert goal <= chunks() < 60
    ls.study(many(), tmp_path / "whole.nc", of=["F32"], chunk=1)
    ls.study(many(), path, of=["F32"], chunk=1)
    assert path.read_bytes() == (tmp_path / "whole.nc").read_bytes()
    assert sorted(os.listdir(tmp_path)) == ["study.nc", "whole.nc"]


STEPS = ("mkdir", "open", "fsync", "replace", "unlink", "rmdir")


def dies_at(step: int, path: Path) -> bool:
    """Run a study of three chunks in a process that dies at a step on files; return whether it died."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the child lacks the other threads, whose steps do not count
        child = os.fork()
    if child:
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 9
    left = [step]

    def counted(function):
        def call(*arguments, **options):
            left[0] -= 1
            if left[0] < 0:
                os._exit(9)  # at once, as kill -9: without cleanup
            return function(*arguments, **options)

        return call

    try:
        for name in STEPS:
            setattr(os, name, counted(getattr(os, name)))
        ls.study(many(), path, of=["F32"], chunk=20)
    finally:
        os._exit(0)


@pytest.mark.long
@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_a_study_killed_at_every_step_on_files_gives_the_identical_file(tmp_path):
    ls.study(many(), tmp_path / "whole.nc", of=["F32"], chunk=20)
    whole = (tmp_path / "whole.nc").read_bytes()
    for step in range(200):
        folder = tmp_path / str(step)
        folder.mkdir()
        died = dies_at(step, folder / "study.nc")
        ls.study(many(), folder / "study.nc", of=["F32"], chunk=20)
        assert (folder / "study.nc").read_bytes() == whole
        assert os.listdir(folder) == ["study.nc"]
        if not died:
            break
    assert 20 < step < 199


def test_a_damaged_chunk_is_computed_again(stopped, monkeypatch):
    path, whole = stopped
    first, second, third = sorted(Path(f"{path}.partial").glob("*.npz"))
    flipped(first, len(first.read_bytes()) // 2, 3)
    second.write_bytes(second.read_bytes()[:-1])
    third.unlink()
    (first.parent / ".left.part").write_bytes(b"half a chunk")
    computed = stop_after(99, monkeypatch)
    ls.study(many(), path, of=["F32"], chunk=6)
    assert len(computed) == 10
    assert path.read_bytes() == whole


def test_other_files_in_the_folder_are_kept(stopped):
    path, whole = stopped
    (path.parent / "study.nc.partial" / "notes.txt").write_text("mine")
    ls.study(many(), path, of=["F32"], chunk=6)
    assert path.read_bytes() == whole
    assert os.listdir(f"{path}.partial") == ["notes.txt"]
    assert ls.study(many(), path, of=["F32"], chunk=6).sizes == {"speed": 60}


def test_a_chunk_damaged_during_assembly_is_computed_again(stopped, monkeypatch):
    path, whole = stopped
    layout_of = assemble.layout_of

    def damaging(chunks, sizes):
        layout = layout_of(chunks, sizes)
        flipped(next(Path(f"{path}.partial").glob("000004*.npz")), 200)
        return layout

    monkeypatch.setattr(assemble, "layout_of", damaging)
    ls.study(many(), path, of=["F32"], chunk=6)
    assert path.read_bytes() == whole


# ------------------------------------------------------------------------------------------ disks that fail


def test_a_missing_folder_is_refused(tmp_path):
    with pytest.raises(FileNotFoundError) as error:
        ls.study(many(), tmp_path / "results" / "study.nc")
    assert str(error.value) == f"{tmp_path}/results/study.nc: there is no folder {tmp_path}/results; make it first"


def test_a_folder_without_write_permission_is_refused(tmp_path, monkeypatch):
    def forbidden(path, *_):
        raise PermissionError(errno.EACCES, "Permission denied", str(path))

    monkeypatch.setattr(os, "mkdir", forbidden)
    with pytest.raises(PermissionError) as error:
        ls.study(many(), tmp_path / "study.nc")
    advice = "mend that and run the same again: finished chunks stay"
    assert str(error.value) == f"[Errno 13] Permission denied; {advice}: '{tmp_path}/study.nc.partial'"


@pytest.mark.skipif(hasattr(os, "geteuid") and os.geteuid() == 0, reason="root may write anywhere")
def test_a_read_only_folder_is_refused(tmp_path):
    tmp_path.chmod(0o555)
    try:
        with pytest.raises(PermissionError):
            ls.study(many(), tmp_path / "study.nc")
        assert os.listdir(tmp_path) == []
    finally:
        tmp_path.chmod(0o755)


@contextlib.contextmanager
def files_at_most(size: int):
    """Limit the size of this process's files, so that writing fails as on a full disk."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


@pytest.mark.parametrize(("size", "kept"), [(800, 0), (12_000, 10)])
def test_a_full_disk_keeps_the_chunks(stopped, size, kept):
    path, whole = stopped
    with files_at_most(size), pytest.raises(OSError, match=r"finished chunks stay: '.*study\.nc\.partial'"):
        ls.study(many(), path, of=["F32"], chunk=6)
    assert len(list(path.parent.glob("study.nc.partial/*.npz"))) == max(kept, 3)
    assert not path.exists()
    ls.study(many(), path, of=["F32"], chunk=6)
    assert path.read_bytes() == whole


def test_a_disk_without_room_for_the_file_is_refused_before_writing(stopped, monkeypatch):
    path, whole = stopped
    with monkeypatch.context() as patch:
        usage = assemble.shutil.disk_usage(path.parent)
        patch.setattr(assemble.shutil, "disk_usage", lambda folder: usage._replace(free=5000))
        with pytest.raises(OSError, match="No space left on device; mend that and run the same again") as error:
            ls.study(many(), path, of=["F32"], chunk=6)
    assert error.value.errno == errno.ENOSPC
    ls.study(many(), path, of=["F32"], chunk=6)
    assert path.read_bytes() == whole


@pytest.mark.skipif(not (hasattr(os, "geteuid") and os.geteuid() == 0), reason="only root can make a small disk")
@pytest.mark.long
def test_a_full_disk(tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", str(disk)], capture_output=True).returncode:
        pytest.skip("no disk can be made here")
    try:
        with pytest.raises(OSError, match="No space left on device") as error:
            ls.study(many(), disk / "study.nc", chunk=6)
        assert error.value.errno == errno.ENOSPC
        assert [path.name for path in disk.iterdir()] == ["study.nc.partial"]
        subprocess.run(["mount", "-o", "remount,size=4m", str(disk)], check=True)
        assert_same(ls.study(many(), disk / "study.nc", chunk=6).load(), ls.peaks(many()))
    finally:
        subprocess.run(["umount", str(disk)], check=True)


def test_a_link_stays_a_link(tmp_path):
    (tmp_path / "there").mkdir()
    (tmp_path / "study.nc").symlink_to(tmp_path / "there" / "study.nc")
    ls.study(many(), tmp_path / "study.nc", of=["F32"])
    assert (tmp_path / "study.nc").is_symlink()
    assert os.listdir(tmp_path / "there") == ["study.nc"]


def test_the_file_appears_whole_and_flushed(tmp_path, monkeypatch):
    path, done = tmp_path / "study.nc", []
    replace, fsync = os.replace, os.fsync

    def renamed(source, target):
        if Path(target) == path:
            done.append(("replace", os.stat(source).st_ino, ls.open_study(source).sizes["speed"]))
        replace(source, target)

    monkeypatch.setattr(os, "replace", renamed)
    monkeypatch.setattr(os, "fsync", lambda handle: done.append(("fsync", os.fstat(handle).st_ino)) or fsync(handle))
    ls.study(many(), path, of=["F32"], chunk=20)
    kind, node, designs = next(step for step in done if step[0] == "replace")
    assert (kind, designs, path.stat().st_ino) == ("replace", 60, node)
    before = done[: done.index((kind, node, designs))]
    assert ("fsync", node) in before
    assert done[-1][0] == "fsync"  # the folder, so that the name is on disk too
