"""Notebooks find in the package what they need; the documentation's build executes them and looks at their outputs."""

import os
import subprocess
import sys


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
