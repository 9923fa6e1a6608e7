"""Every notebook runs from top to bottom and has figures in its output."""

import os
import subprocess
import sys
from pathlib import Path

import jupytext
import nbclient
import pytest

NOTEBOOKS = sorted((Path(__file__).parents[2] / "notebooks").glob("*.py"))


@pytest.mark.long
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
@pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::ResourceWarning", "ignore::FutureWarning")
def test_notebook_runs(path, monkeypatch):
    monkeypatch.setenv("MPLBACKEND", "module://matplotlib_inline.backend_inline")
    notebook = jupytext.read(path)
    nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3").execute()
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    assert any("image/png" in output.get("data", {}) for output in outputs)


def test_notebooks_exist():
    assert NOTEBOOKS


def test_a_report_made_first_leaves_the_display_of_figures_on(tmp_path):
    """A notebook's backend turns the display on with the first figure, which must not be the report's."""
    (tmp_path / "wakes.py").write_text(
        "import matplotlib\nfrom matplotlib.backends.backend_agg import *\nmatplotlib.interactive(True)\n"
    )
    code = """
import linksweep as ls, matplotlib
ls.sweep(ls.example("press"), theta2=8).linksweep.cycle()
assert matplotlib.get_backend() == "module://wakes"
assert matplotlib.is_interactive()
"""
    there = os.environ | {"MPLBACKEND": "module://wakes", "PYTHONPATH": str(tmp_path)}
    subprocess.run([sys.executable, "-c", code], env=there, check=True)
