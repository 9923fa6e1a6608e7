"""Public names, version, types and data files of the package."""

import ast
import importlib
import re
import tomllib
from fnmatch import fnmatch
from importlib import metadata
from pathlib import Path

import pytest
from mypy import api as mypy

import linksweep as ls
from linksweep.base import version

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "linksweep"


def declared() -> dict:
    """Return the content of pyproject.toml."""
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


@pytest.mark.parametrize("module", [ls, ls.plot])
def test_dir_has_the_public_names_alone(module):
    assert {*dir(module)} - {"__version__"} == {*module.__all__}
    assert all(hasattr(module, name) for name in dir(module))


def test_every_public_name_is_documented_and_none_is_a_folder():
    folders = {path.name for path in PACKAGE.iterdir() if path.is_dir()} - {"plot"}
    assert folders.isdisjoint(ls.__all__)
    assert [name for name in ls.__all__ if not getattr(ls, name).__doc__] == []


def test_a_star_import_takes_the_names_that_type_checkers_know():
    stub = ast.parse((PACKAGE / "__init__.pyi").read_text(encoding="utf-8"))
    (stated,) = (ast.literal_eval(line.value) for line in stub.body if isinstance(line, ast.Assign))
    exec("from linksweep import *", names := {})
    assert stated == sorted(ls.__all__) == sorted(names.keys() - {"__builtins__"})


def test_plot_is_a_module():
    assert importlib.import_module("linksweep.plot") is ls.plot


def test_the_version_is_that_of_the_installed_package(monkeypatch):
    assert ls.__version__ == declared()["project"]["version"]

    def missing(name):
        raise metadata.PackageNotFoundError(name)

    monkeypatch.setattr(metadata, "version", missing)
    assert version.installed_version.__wrapped__() == "0+unknown"


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="module 'linksweep' has no attribute 'swep'"):
        _ = ls.swep


def test_a_wheel_has_every_file_of_the_package():
    """It takes the folder whole, but for what .gitignore leaves out, which is no file of the package."""
    assert declared()["tool"]["hatch"]["build"]["targets"]["wheel"]["packages"] == ["linksweep"]
    ignored = [pattern.rstrip("/") for pattern in (ROOT / ".gitignore").read_text(encoding="utf-8").split()]
    files = [path.relative_to(PACKAGE) for path in PACKAGE.rglob("*") if path.is_file() and path.suffix != ".pyc"]
    assert Path("py.typed") in files
    assert [path for path in files for part in path.parts for pattern in ignored if fnmatch(part, pattern)] == []


def checked(tmp_path: Path, source: str) -> str:
    """Return the report of mypy --strict on a script, passing over the package itself, as where it is installed."""
    (tmp_path / "script.py").write_text(source, encoding="utf-8")
    options = ["--strict", "--follow-imports=silent", f"--cache-dir={ROOT / '.mypy_cache' / 'scripts'}"]
    return mypy.run([*options, str(tmp_path / "script.py")])[0]


@pytest.fixture
def readme(monkeypatch) -> str:
    """The first script of the README: a machine in ten lines."""
    monkeypatch.setenv("MYPYPATH", str(ROOT))
    return re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)[0]


LISTS = """
torque = ls.Load("rocker", torque=lambda theta2: 0.1 * theta2, breaks=[77.7], at=[0.1, 15.0])
spring = ls.TorsionSpring("ground", "rocker", rate=2.0)
again = ls.Scene(press, omega2=30.0, gravity=[0.0, -9.81], loads=[push, torque, spring])
ls.sweep(again, theta2=range(0, 360, 10), of=ls.quantities(again, "force").names)
ls.peaks(again, of="F32", theta2=[0.0, 90.0])
ls.MultiCylinder(ls.example("engine"), [0, 540, 180, 360], positions=[-0.15, -0.05, 0.05, 0.15]).sweep()
names: list[str] = [f"{row.name} [{row.units}]" for row in ls.quantities(again)] + [ls.__version__]
"""


SLIPS = {
    "ls.swep(scene)": "attr-defined",
    "ls.sweep(scene, output=['T12'])": "call-arg",
    "ls.Scene(press, loads=3.0)": "arg-type",
}


def test_scripts_pass_a_strict_type_checker(readme, tmp_path):
    assert checked(tmp_path, readme + LISTS).startswith("Success: no issues found")


@pytest.mark.parametrize(("slip", "error"), SLIPS.items())
def test_a_type_checker_reports_a_slip(slip, error, readme, tmp_path):
    report = checked(tmp_path, readme + slip)
    assert f"[{error}]" in report and "Found 1 error" in report
