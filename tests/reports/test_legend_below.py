"""The legend below a report's figure lies within it, whatever the names of the links."""

from dataclasses import replace

import pytest
from matplotlib import style
from matplotlib.figure import Figure

import linksweep as ls
from linksweep.reports.figures import LOOK, SIZE, legend_below

STEEL = {"width": 0.02, "thickness": 0.02, "density": 7750.0}


@pytest.mark.parametrize(
    ("name", "columns"), [("coupler", 3), ("my_long_link_name", 2), ("the_very_long_name_of_a_coupler_link", 1)]
)
def test_a_legend_of_long_names_lies_within_the_figure(name, columns):
    bars = {"crank": ls.Bar(0.08, **STEEL), name: ls.Bar(0.22, **STEEL), "rocker": ls.Bar(0.18, **STEEL)}
    machine = ls.Linkage(f"crank A-B, {name} B-C, rocker D-C", ground={"A": (0.0, 0.0), "D": (0.2, 0.0)}, **bars)
    push = ls.Load(name, force=(0.0, -355.0), at=(0.1, 15.0))
    scene = replace(ls.example("press"), mechanism=machine, loads=[push, ls.Load("rocker", torque=-12.0)])
    with style.context(LOOK):
        figure = Figure(figsize=SIZE, layout="constrained")
        legend_below(ls.plot.breakdown(ls.breakdown(scene, "F32", theta2=36), ax=figure.add_subplot()))
        figure.draw_without_rendering()
    (legend,) = figure.legends
    entries = [*legend.get_texts(), *legend.get_patches(), *legend.get_lines()]
    ends = [(box.x0, box.x1) for box in (entry.get_window_extent() for entry in entries)]
    assert min(start for start, _ in ends) >= 0.0 and max(end for _, end in ends) <= figure.bbox.width
    assert f"{name} inertia" in [text.get_text() for text in legend.get_texts()]
    assert len({round(start) for start, _ in ends[: len(legend.get_texts())]}) == columns
