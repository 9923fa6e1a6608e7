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
# # A machine of your own
#
# A feeder on the shop floor: a crank-rocker that pushes cartons off a belt. You have a tape measure, the weight of its
# parts, and two questions: does pin C need a larger bush, and may the feeder run twice as fast? Everything below is what
# you would do with a machine of yours, from the measured lengths to the page for the file.
#
# ## The scene file
#
# A scene is a machine and what happens to it. As a file it takes numbers with the units that you measured in. Bars have
# their mass from their size; the coupler, an odd casting, was weighed and balanced on an edge. `units` states in which
# units tables, plots and the report shall show their numbers; results themselves are always in SI.

# %%
import tempfile
from pathlib import Path

import numpy as np

import linksweep as ls

folder = Path(tempfile.mkdtemp())
(folder / "feeder.toml").write_text("""
units = "in, lbf, rpm"
omega2 = "60 rpm"
gravity = [0, "-9.81 m/s^2"]

[mechanism]
type = "FourBar"
ground = "16 in"
crank = {type = "Bar", length = "4 in", width = "1.5 in", thickness = "0.5 in", density = "0.283 lb/in^3"}
coupler = {length = "15 in", mass = "6.2 lb", inertia = "130 lb in^2", cg_distance = "6.5 in", cg_angle = "8 deg"}
rocker = {type = "Bar", length = "10 in", width = "1.5 in", thickness = "0.5 in", density = "0.283 lb/in^3"}

[[loads]]
link = "rocker"
force = ["-45 lbf", 0]
at = ["10 in", 0]
""")
feeder = ls.load_scene(folder / "feeder.toml")

# %% [markdown]
# A wrong file is refused with all of its errors at once, each with its line and with what to write instead:

# %%
wrong = (folder / "feeder.toml").read_text().replace('"4 in"', '"4 inch"').replace("cg_angle", "cg_angel")
(folder / "wrong.toml").write_text(wrong)
try:
    ls.load_scene(folder / "wrong.toml")
except ValueError as error:
    print(str(error).replace(str(folder), "…"))

# %% [markdown]
# ## Look at it, before any number
#
# Is this the machine that stands on the floor, and not its mirror image? (If it were, `branch = "crossed"` would turn it
# over.) The letters are its pins, the numbers its links, and the arrows the forces in its pins.

# %%
ax = ls.plot.mechanism(feeder, theta2=60.0, forces=True)

# %% [markdown]
# ## Does it go round, and how far does it swing?

# %%
print(ls.check(feeder).linksweep)
print(ls.geometry(feeder).linksweep)

# %% [markdown]
# ## How hard are the pins loaded?
#
# `peaks` returns the worst of each pin force and of the torque of the drive, over the whole revolution, and the crank angle
# where it is.

# %%
worst = ls.peaks(feeder)
worst.linksweep

# %% [markdown]
# ## Why is pin C loaded?
#
# `breakdown` separates a force into the shares of its causes. They add up to it at every angle.

# %%
ax = ls.plot.breakdown(ls.breakdown(feeder, "F43"))

# %% [markdown]
# Mostly by the push. So a bush for C follows from the push, and a lighter coupler would change little.
#
# ## Twice as fast?
#
# Inertia grows with the square of the speed. `speed_limit` finds the speed at which a peak reaches a bound. Say the bush in
# C may bear 60 lbf:

# %%
bound = 60 * 4.4482216152605  # N
limit = float(ls.speed_limit(feeder, "F43", below=bound).omega2_limit)
print(f"pin C stays below 60 lbf up to {limit * 30 / np.pi:.0f} rpm; twice the speed is 120 rpm")

# %% [markdown]
# ## The page for the file
#
# Inputs, checks, peaks, drive and figures on two sides of paper, in one file that needs no other. `ls.save` keeps the
# revolution, with the scene in it.

# %%
ls.report(feeder, folder / "feeder.html", title="Carton feeder")
ls.save(ls.sweep(feeder), folder / "feeder.nc")
for path in sorted(folder.glob("feeder.*")):
    print(f"{path.name}: {path.stat().st_size / 1e3:.0f} kB")

# %%
assert ls.load_scene(folder / "feeder.nc") == feeder
assert worst.status == 0
