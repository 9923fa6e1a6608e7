# ---
# jupyter:
#   jupytext:
#     formats: ipynb,py:percent
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # A gallery of machines
#
# Each of these is an example of the package, `ls.example("watt-1")`: a text of links and pins, lengths, masses and loads as in a
# real machine, in a file of some twenty lines that may be copied and changed. Here each stands at one angle of its crank; the blue
# line is the path of a point.

# %%
import math

import matplotlib.pyplot as plt

import linksweep as ls

machines = {  # crank angle [°] of the picture, and what else to draw
    "watt-1": (60, {"link": "strut", "point": (0.250, 0.0)}),
    "watt-2": (60, {"link": "output", "point": (0.038, 0.0)}),
    "stephenson-1": (60, {}),
    "stephenson-3": (60, {"link": "coupler", "point": (0.1658, -20.9)}),
    "knuckle-press": (300, {"link": "rod", "point": (0.490, 0.0)}),
    "drag-link-press": (220, {"link": "driven", "point": (0.120, 95.0)}),
    "geared-five-bar": (200, {"link": "left", "point": (0.260, 0.0)}),
    "crank-shaper": (40, {"link": "arm", "point": (0.600, 0.0)}),
    "whitworth": (60, {"link": "arm", "point": (0.090, 0.0)}),
    "scotch-yoke": (40, {"link": "crank", "point": (0.0, 0.0)}),
    "pump-jack": (40, {"link": "beam", "point": (3.2766, 0.0)}),
    "jansen-leg": (60, {}),
    "klann-leg": (100, {}),
    "wipers": (40, {}),
    "scissor-lift": (120, {}),
    "excavator": (12, {}),
}


def show(name, ax):
    """Draw an example into axes without ticks, under its name."""
    theta2, options = machines[name]
    ls.plot.mechanism(ls.example(name), theta2, ax=ax, **options)
    ax.set(xlabel="", ylabel="", xticklabels=[], yticklabels=[])
    ax.set_title("")
    ax.set_title(name, loc="left")
    if name == "excavator":  # its boom moves on an arc, not all the way round
        ax.set_aspect("equal", adjustable="box")
        ax.set(xlim=(-0.5, 8.5), ylim=(-4.5, 4.5))


columns = 4
rows = math.ceil(len(machines) / columns)
fig, panels = plt.subplots(rows, columns, figsize=(4 * columns, 4 * rows), layout="constrained")
for ax in panels.flat[len(machines) :]:
    ax.set_axis_off()
for name, ax in zip(machines, panels.flat, strict=False):
    show(name, ax)
# %% [markdown]
# What they are, in the words of their files:

# %%
for name in machines:
    print(f"{name:16} {ls.example(name).mechanism.links}")
