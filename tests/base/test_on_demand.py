"""Public names are imported at their first use, and Datasets have the accessor whichever package is imported first."""

import subprocess
import sys
from importlib.util import find_spec

import pytest

from linksweep.base.public.on_demand import when_imported

USE = "xarray.Dataset(attrs={'scene': ''}).linksweep.to_csv"
ORDERS = {
    "linksweep first": f"import linksweep, xarray; {USE}",
    "xarray first": f"import xarray, linksweep; {USE}",
    "a part of xarray first": f"import linksweep; from xarray.core import dataset; import xarray; {USE}",
    "looked for, not imported": f"import linksweep, importlib.util as u; u.find_spec('xarray'); import xarray; {USE}",
    "imported by linksweep": f"import linksweep; linksweep.Scene; import xarray; {USE}",
    "without xarray": "import sys, linksweep; linksweep.Bar(1, 1, 1, 1); assert 'xarray' not in sys.modules",
}


@pytest.mark.parametrize("code", ORDERS.values(), ids=ORDERS)
def test_datasets_have_the_accessor_whichever_package_is_imported_first(code):
    subprocess.run([sys.executable, "-W", "error", "-c", code], check=True)


@pytest.fixture
def module(tmp_path, monkeypatch) -> str:
    """The name of a module that can be imported, which states its loader."""
    (tmp_path / "imported_later.py").write_text("LOADER = type(__loader__).__name__\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "imported_later", raising=False)
    return "imported_later"


def test_an_action_is_called_once_after_the_import_and_leaves_nothing_behind(module):
    finders, seen = [*sys.meta_path], []
    when_imported(module)(lambda imported: seen.append(imported.LOADER))
    assert find_spec(module).origin.endswith("imported_later.py") and seen == []
    imported = __import__(module)
    assert seen == ["SourceFileLoader"] and sys.meta_path == finders
    assert type(imported.__spec__.loader) is type(imported.__loader__) is type(pytest.__loader__)
    when_imported(module)(seen.append)
    assert seen == ["SourceFileLoader", imported]


def test_a_module_that_fails_may_be_imported_again(module, tmp_path):
    seen = []
    when_imported(module)(seen.append)
    (tmp_path / "imported_later.py").write_text("raise RuntimeError")
    with pytest.raises(RuntimeError):
        __import__(module)
    (tmp_path / "imported_later.py").write_text("LOADER = 'another, longer text'")
    assert seen == []
    assert [__import__(module)] == seen


def test_a_module_that_does_not_exist_is_not_found():
    finders = [*sys.meta_path]
    when_imported("there_is_no_such_module")(pytest.fail)
    with pytest.raises(ModuleNotFoundError):
        __import__("there_is_no_such_module")
    sys.meta_path[:] = finders
