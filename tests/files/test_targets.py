"""Target paths of results: only files are replaced, whatever their names, and killed writers leave no files."""

import contextlib
import fcntl
import os
import re
import socket
import stat
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
import xarray as xr

import linksweep as ls
from linksweep.cli.main import main
from linksweep.cli.running import write_figure
from linksweep.files.atomic import whole

GET = fcntl.F_GETFL
WRITERS = {
    "save": (".nc", lambda path: ls.save(ls.check(ls.example("press")), path)),
    "CSV": (".csv", lambda path: ls.peaks(ls.example("press"), theta2=8).linksweep.to_csv(path)),
    "Excel": (".xlsx", lambda path: ls.peaks(ls.example("press"), theta2=8).linksweep.to_excel(path)),
    "report": (".html", lambda path: ls.report(ls.example("loop"), path)),
    "film": (".gif", lambda path: ls.plot.animate(ls.example("press"), frames=2).save(path)),
    "figure": (".png", lambda path: write_figure(ls.sweep(ls.example("loop"), 8).linksweep.cycle(), path)),
    "study": (".nc", lambda path: ls.study(ls.example("press"), path, of=["T12"])),
}


def pipe(path):
    os.mkfifo(path)


def device(path):
    if os.geteuid():
        pytest.skip("only root makes devices")
    os.mknod(path, 0o600 | stat.S_IFCHR, os.makedev(1, 3))


def bound(path):
    with socket.socket(socket.AF_UNIX) as made:
        made.bind(str(path))


KINDS = {"a folder": Path.mkdir, "a pipe": pipe, "a device": device, "a socket": bound}


@pytest.fixture
def here(monkeypatch):
    """Enter an empty working folder with a short path, since a socket's has at most 108 bytes."""
    with tempfile.TemporaryDirectory() as folder:
        monkeypatch.chdir(folder)
        yield Path(folder)
        monkeypatch.undo()


@pytest.mark.parametrize("linked", [False, True], ids=["itself", "by a link"])
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("writer", WRITERS)
def test_pipes_devices_and_sockets_are_refused_and_kept(here, writer, kind, linked):
    ending, write = WRITERS[writer]
    target = here / f"target{ending}"
    KINDS[kind](target)
    path = here / f"link{ending}" if linked else target
    if linked:
        path.symlink_to(target)
    before, mode = sorted(os.listdir(here)), target.stat().st_mode
    with pytest.raises(OSError, match=f"{path.name}: is {kind}, which no file replaces; choose another name"):
        write(path)
    assert target.stat().st_mode == mode
    assert sorted(os.listdir(here)) == before


def test_the_command_line_refuses_it_before_it_computes(here, monkeypatch, capsys):
    pipe(here / "out.nc")
    monkeypatch.setattr("linksweep.sweep", lambda *_, **__: pytest.fail("computed"))
    (here / "press.toml").write_text((Path(ls.__file__).parent / "scene/examples/press.toml").read_text())
    assert main(["sweep", "press.toml", "-o", "out.nc"]) == 2
    assert capsys.readouterr().err == "linksweep: out.nc: is a pipe, which no file replaces; choose another name\n"


ENGINE = ls.example("engine")


@pytest.mark.parametrize(
    ("write", "allowed"),
    [
        (lambda path: ls.save(ls.check(ENGINE), path), ".nc or .csv or .xlsx"),
        (lambda path: ls.save(ENGINE, path), ".toml or .nc"),
        (lambda path: ls.check(ENGINE).linksweep.to_csv(path), ".csv"),
        (lambda path: ls.study(ENGINE, path), ".nc: a study file is NetCDF; ls.open_study"),
        (lambda path: ls.plot.animate(ENGINE, frames=2).save(path), ".gif or .html"),
        (lambda path: ls.report(ENGINE, path), ".html or .htm: a report is a page"),
    ],
)
@pytest.mark.parametrize("name", ["x.xls", "x", "x.nc4", "x.CSVX", ".nc"])
def test_a_wrong_suffix_is_refused(here, write, allowed, name):
    with pytest.raises(ValueError, match=f"^{re.escape(name)}: its ending must be {re.escape(allowed)}"):
        write(name)
    assert os.listdir(here) == []


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("sweep press.toml -o x.xls", "x.xls: its ending must be .nc or .csv or .xlsx"),
        ("sweep press.toml -o x", "x: its ending must be .nc or .csv or .xlsx"),
        ("peaks press.toml -o x.txt", "x.txt: its ending must be .nc or .csv or .xlsx"),
        ("study press.toml -o x.csv", "x.csv: its ending must be .nc: a study file is NetCDF"),
        ("demo -o x.csv", "x.csv: give a name without ending; x.nc and x.png follow"),
        ("demo -o y/x.nc", "y/x.nc: give a name without ending; x.nc and x.png follow"),
    ],
)
def test_the_command_line_refuses_a_suffix_before_it_computes(here, monkeypatch, capsys, arguments, message):
    ls.save(ls.example("press"), "press.toml")
    for name in {"sweep", "peaks", "example"}:
        monkeypatch.setattr(f"linksweep.{name}", lambda *_, **__: pytest.fail("computed"))
    monkeypatch.setattr("linksweep.studies.study.Job", lambda *_, **__: pytest.fail("computed"))
    with contextlib.suppress(SystemExit):
        assert main(arguments.split()) == 2
    assert message in capsys.readouterr().err
    assert os.listdir(here) == ["press.toml"]


@pytest.mark.parametrize("command", ["sweep", "peaks"])
def test_csv_is_the_table_of_the_netcdf_file(here, command):
    ls.save(ls.example("press"), "press.toml")
    for name in ("x.nc", "x.CSV"):
        assert main([command, "press.toml", "-o", name]) == 0
    with xr.open_dataset("x.nc") as ds:
        ds.linksweep.to_csv("again.csv")
    text = Path("x.CSV").read_text()
    assert text == Path("again.csv").read_text()
    first, *rows = text.splitlines()
    assert "status" in first.split(",")
    assert len(rows) == {"sweep": 720, "peaks": 1}[command]


@pytest.mark.parametrize("length", [*range(241, 256)])
def test_every_valid_file_name(here, length):
    for name in ("a" * (length - 3) + ".nc", "é" * ((length - 3) // 2) + "a" * ((length - 3) % 2) + ".nc"):
        with whole(name) as temporary:
            temporary.write_text("text")
        assert os.listdir(here) == [name]
        os.unlink(name)


def test_a_study_may_have_the_longest_name(here):
    name = "a" * 252 + ".nc"
    ls.study(ls.example("press"), name, of=["T12"])
    assert os.listdir(here) == [name]


def test_a_replaced_file_keeps_its_permissions(here):
    Path("private.nc").touch(0o600)
    ls.save(ls.check(ls.example("press")), "private.nc")
    assert stat.S_IMODE(os.stat("private.nc").st_mode) == 0o600


def test_a_link_to_a_missing_file(here):
    Path("link.nc").symlink_to("new.nc")
    ls.save(ls.check(ls.example("press")), "link.nc")
    assert Path("link.nc").is_symlink()
    assert Path("new.nc").stat().st_size > 0


def test_flushed_files_are_open_for_writing(here, monkeypatch):
    """Windows flushes only files that are open for writing."""
    opened = []
    monkeypatch.setattr(
        os, "fsync", lambda handle: opened.append((os.fstat(handle), fcntl.fcntl(handle, fcntl.F_GETFL)))
    )
    with whole("a.nc") as temporary:
        temporary.write_text("text")
    modes = [flags & os.O_ACCMODE for status, flags in opened if stat.S_ISREG(status.st_mode)]
    assert modes == [os.O_RDWR]


def test_a_file_that_is_open_on_windows_is_kept_and_named(here, monkeypatch):
    """There a file that a program has open cannot be replaced."""
    Path("open.csv").write_text("old")

    def in_use(source, target):
        raise PermissionError(13, "Permission denied", str(source), None, str(target))

    monkeypatch.setattr(os, "replace", in_use)
    with pytest.raises(PermissionError) as refused:
        ls.save(ls.peaks(ls.example("press"), theta2=8), "open.csv")
    advice = "where it is open, here or in another program, close it, then run the same again"
    assert str(refused.value) == f"[Errno 13] Permission denied; {advice}: 'open.csv'"
    assert Path("open.csv").read_text() == "old" and os.listdir(here) == ["open.csv"]


# --------------------------------------------------------------------------------------------- killed while writing


KILLED = """
import os, signal, sys
from linksweep.files.atomic import whole
with whole(sys.argv[1]) as temporary:
    temporary.write_text("half")
    os.kill(os.getpid(), signal.SIGKILL)
"""


def test_the_next_writer_removes_the_files_of_a_killed_one(here):
    assert subprocess.run([sys.executable, "-c", KILLED, "a.nc"], check=False).returncode == -9
    (left,) = os.listdir(here)
    assert left != "a.nc"
    with whole("b.nc") as temporary:
        temporary.write_text("text")
    assert os.listdir(here) == ["b.nc"]


def test_the_files_of_a_running_writer_are_kept(here):
    going = "import sys\nfrom linksweep.files.atomic import whole\n" + (
        "with whole('slow.nc') as temporary:\n    print(flush=True)\n    temporary.write_text(sys.stdin.read())\n"
    )
    command = [sys.executable, "-c", going]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        process.stdout.readline()
        with whole("quick.nc") as temporary:
            temporary.write_text("text")
        process.communicate("all of it")
    assert Path("slow.nc").read_text() == "all of it"
    assert sorted(os.listdir(here)) == ["quick.nc", "slow.nc"]


@pytest.mark.parametrize(
    "call",
    [
        ls.load_scene,
        ls.open_study,
        lambda scene: ls.save(scene, scene),
        lambda scene: ls.report("page.html", scene),
        lambda scene: ls.save_drawing("press.svg", scene),
    ],
)
def test_what_is_no_path_is_refused_by_its_kind(call):
    with pytest.raises(ValueError, match=r"^path is a Scene: must be the name of a file$"):
        call(ls.example("press"))
