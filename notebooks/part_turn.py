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
# # A machine that moves over part of a turn
#
# A tipper raises its body by 50° and lets it down again. Nothing turns fully: the body is the "crank", since its angle
# counts the motion, and a hydraulic cylinder drives it. How hard must the cylinder push, what do the hinges bear, and
# how large must the cylinder be?
#
# ## The machine
#
# The body is hinged to the frame at A. The cylinder's barrel is hinged to the frame at D, and the end of its rod to the
# body at B. For linksweep this is an inverted slider-crank: the barrel is the rocker, and the rod's end the block that
# slides along it.

# %%
import tempfile
from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

import linksweep as ls

body = ls.Link(1.8, mass=4000.0, inertia=3000.0, cg_distance=2.2, cg_angle=10.0)
barrel = ls.Link(1.5, mass=90.0, inertia=15.0, cg_distance=0.5)
machine = ls.InvertedSliderCrank(body, barrel, ground=1.6, ground_angle=-25.0, block_mass=40.0)
tipper = ls.Scene(machine, omega2=0.05, gravity=(0.0, -9.81), drive="cylinder")
arc = np.linspace(0.0, 50.0, 101)  # degrees

fig, panels = plt.subplots(1, 2, figsize=(11, 4.4), sharey=True, layout="constrained")
for ax, theta2 in zip(panels, (0.0, 50.0), strict=True):
    ls.plot.mechanism(tipper, theta2, ax=ax, forces=True)

# %% [markdown]
# ## The arc
#
# `theta2` takes a list of angles in place of a count. The cylinder's force is positive where it pushes.

# %%
lift = ls.sweep(tipper, arc, of=["cylinder_force", "slide", "F12", "F43", "F14"])
fig, (left, right) = plt.subplots(1, 2, figsize=(11, 3.6), layout="constrained")
left.plot(arc, lift.cylinder_force / 1e3, label="cylinder")
left.plot(arc, lift.F12 / 1e3, "--", label="hinge A")
left.set(xlabel="angle of the body θ₂ [°]", ylabel="force [kN]")
left.legend()
right.plot(arc, lift.slide)
right.set(xlabel="angle of the body θ₂ [°]", ylabel="distance of B from D [m]")
for ax in (left, right):
    ax.grid(alpha=0.3)

# %% [markdown]
# The cylinder's force is largest at the start: there the load is farthest out from the hinge, and it comes nearer as the
# body rises. The cylinder's stroke and its bore:

# %%
stroke = float(lift.slide.max() - lift.slide.min())
largest = float(lift.cylinder_force.max())
bore = np.sqrt(4 * largest / (np.pi * 160e5))  # m, at 160 bar
print(f"stroke {1e3 * stroke:.0f} mm, {largest / 1e3:.1f} kN: a bore of {1e3 * bore:.0f} mm at 160 bar")

# %% [markdown]
# ## Where should the cylinder stand?
#
# A study: the direction in which D lies from A, over the same arc.

# %%
angle = np.linspace(-45.0, -10.0, 36)
moved = replace(machine, ground_angle=xr.DataArray(angle, {"place": angle}, "place"))
forces = ls.sweep(replace(tipper, mechanism=moved), arc, of=["cylinder_force", "F12"])
fig, ax = plt.subplots(figsize=(8, 3.6), layout="constrained")
ax.plot(angle, forces.cylinder_force.max("theta2") / 1e3, label="cylinder")
ax.plot(angle, forces.F12.max("theta2") / 1e3, "--", label="hinge A")
ax.set(xlabel="direction of D from A [°]", ylabel="largest force over the arc [kN]", ylim=(0, None))
ax.legend()
ax.grid(alpha=0.3)

# %% [markdown]
# From −45° to −20° it hardly matters; above, both forces grow fast.
#
# ## The hinges
#
# Bushes that turn by 50° and back. `bearings` takes the angles, too, and assumes that the machine returns as it came:

# %%
bush = ls.Bearing(diameter=0.06, length=0.08, friction=0.1)
loads = ls.bearings(tipper, {"A": bush, "B": bush, "D": bush}, theta2=arc)
for pin in ("A", "B", "D"):
    pressure = float(loads.pressure.sel(pin=pin).max()) / 1e6
    print(f"pin {pin}: {float(loads.F.sel(pin=pin).max()) / 1e3:5.1f} kN, {pressure:4.1f} MPa, ", end="")
    print(f"turns {float(loads.rotation.sel(pin=pin)):4.1f}°")

# %% [markdown]
# ## The page for the file

# %%
page = Path(tempfile.mkdtemp()) / "tipper.html"
ls.report(tipper, page, title="Tipper", theta2=(0, 50))
print(f"{page.name}: {page.stat().st_size / 1e3:.0f} kB")

# %%
slowly = ls.sweep(replace(tipper, omega2=1e-6), [0.0], of=["cylinder_force"])
assert abs(float(slowly.cylinder_force[0]) / largest - 1) < 0.01  # it is weight that counts, not inertia
assert loads.rotation.sel(pin="A") == 50.0
