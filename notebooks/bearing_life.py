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
# # How long will the bearings last?
#
# A bearing in a catalogue runs at one speed under one load. A bearing in a linkage is loaded differently at every angle, and some
# of them do not even turn, but swing to and fro. What is "the" load of such a bearing, and how many hours does it live? The
# answer takes three things that a cycle has in it: the force, the *relative* rotation of the two links that the pin joins, and
# the one as a function of the other.

# %%
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import xarray as xr

import linksweep as ls

bar = {"width": 0.02, "thickness": 0.02, "density": 7850.0}  # steel [m, kg/m³]
machine = ls.FourBar(ls.Bar(0.06, **bar), ls.Bar(0.22, **bar), ls.Bar(0.16, **bar), ground=0.22)
rpm = 2 * np.pi / 60


def resistance(theta2):
    """Of the work on the rocker [N m]: 600 while it swings one way, 80 on the way back, with a soft change."""
    return -340.0 - 260.0 * np.tanh(6.0 * np.sin(np.radians(theta2 + 20.0)))


tray = ls.Load("coupler", force=(0.0, -1500.0), at=(0.12, 30.0))  # N
conveyor = ls.Scene(machine, omega2=240 * rpm, gravity=(0.0, -9.81), loads=[ls.Load("rocker", torque=resistance), tray])
cycle = ls.sweep(conveyor)
figure = cycle.linksweep.bearings()

# %% [markdown]
# These are load diagrams in the axes of the ground. A shaft that turns sees its load from another side. For the pin at B, in the
# axes of the two links that it joins:

# %%
fig, panels = plt.subplots(1, 2, figsize=(10, 4.8), layout="constrained")
for ax, frame, link in zip(panels, ("journal", "bearing"), ("crank (journal)", "coupler (bearing)"), strict=True):
    cycle.linksweep.bearing("F32", frame=frame, ax=ax)
    ax.set_title(f"B in the axes of the {link}")

# %% [markdown]
# ## Force over rotation
#
# `bearings` gives for each pin the force, the relative rotation ψ, and what follows. At A and B the crank turns full circles in
# its neighbours. At C and D, where the rocker swings, the pin turns some way and back again. Fatigue counts each degree that
# rolls by, whatever its direction:

# %%
pins = {"A": "12", "B": "32", "C": "43", "D": "14"}
loads = ls.bearings(conveyor, {pin: ls.Bearing(capacity=14_000.0) for pin in pins})
turned = loads.rotation_share.cumsum("theta2") * loads.rotation  # degrees since θ2 = 0, to and fro added up
fig, (left, right) = plt.subplots(1, 2, figsize=(10, 3.8), sharey=True, layout="constrained")
for pin in pins:
    left.plot(loads.theta2, loads.F.sel(pin=pin), label=f"pin {pin}")
    right.plot(turned.sel(pin=pin), loads.F.sel(pin=pin), label=f"pin {pin}: {float(loads.rotation.sel(pin=pin)):.0f}°")
left.set(xlabel="crank angle θ₂ [°]", ylabel="force [N]", title="over the crank angle", xlim=(0, 360), ylim=(0, None))
right.set(xlabel="turned in its bearing [°]", title="over the rotation of the pin", xlim=(0, 360))
for ax in (left, right):
    ax.legend(fontsize="small")
    ax.grid(alpha=0.3)

# %% [markdown]
# ## One load for all
#
# Each small turn Δψ under a load F uses up a part of the bearing's life, in proportion to F³ for balls, to F^(10/3) for rollers
# (Palmgren and Miner). The constant load that does the same damage is therefore
#
# ```text
# P = (Σ F^p·|Δψ| / Σ |Δψ|)^(1/p)        p = 3 for balls, 10/3 for rollers
# L10 = (C/P)^p                          in million revolutions,
# ```
#
# with the bearing's capacity C from the catalogue. For pin C, step by step, as a sum over half degrees (`ls.bearings` integrates,
# so that its answer does not depend on steps):

# %%
pin_c = ls.sweep(conveyor, of=["F43", "omega3", "omega4"])
turns = abs(pin_c.omega3 - pin_c.omega4) / conveyor.omega2 * 0.5  # degrees of the pin in each half degree of the crank
P = float(((pin_c.F43**3 * turns).sum() / turns.sum()) ** (1 / 3))
L10 = (14_000 / P) ** 3  # million revolutions
hours = L10 * 1e6 / (float(turns.sum()) / 360) / 240 / 60
print(f"P = {P:.1f} N, L10 = {L10:.0f} million revolutions of the pin = {hours:,.0f} h")
print(f"ls.bearings: {float(loads.equivalent_load.sel(pin='C')):.1f} N, {float(loads.L10h.sel(pin='C')):,.0f} h")

# %%
table = loads[["rotation", "equivalent_load", "L10", "L10h"]].to_dataframe()
table.insert(1, "largest load", loads.F.max("theta2"))
table.insert(2, "mean over θ2", loads.F.mean("theta2"))
table.round(1)

# %% [markdown]
# C and D bear more than A and B, and live more than twice as long: they turn a quarter as far.
#
# Three loads to choose from, and they differ. The largest is too careful: it acts for a moment. The mean is too bold: a cube
# weighs what is large. And even the right mean is wrong if it is taken over the *crank* angle. Pin B turns fastest in the coupler
# just where it is loaded most, pin C where it is loaded least:

# %%
over_crank = (loads.F**3).mean("theta2") ** (1 / 3)
for pin in pins:
    ratio = float(over_crank.sel(pin=pin) / loads.equivalent_load.sel(pin=pin))
    print(f"pin {pin}: P is off by {100 * (ratio - 1):+5.1f} %, the life by {100 * (ratio**-3 - 1):+5.1f} %")

# %% [markdown]
# The load spectrum is the same thing as a histogram: how much of its rotation the pin makes under which load. Beside it, who does
# the damage.

# %%
spectrum = ls.load_spectrum(loads, classes=12)
damage = spectrum.share * spectrum.class_load**3
damage = damage / damage.sum("load_class")
fig, panels = plt.subplots(1, 2, figsize=(10, 3.6), layout="constrained")
for ax, pin in zip(panels, ("A", "C"), strict=True):
    load, width = spectrum.class_load.sel(pin=pin), float(spectrum.class_load.sel(pin=pin)[0]) * 0.8
    ax.bar(load - width / 2, 100 * spectrum.share.sel(pin=pin), width, label="of the rotation")
    ax.bar(load + width / 2, 100 * damage.sel(pin=pin), width, label="of the damage")
    ax.axvline(float(loads.equivalent_load.sel(pin=pin)), color="k", linestyle="--", linewidth=1, label="P")
    ax.set(xlabel=f"load of pin {pin} [N]", ylabel="share [%]")
    ax.legend(fontsize="small")

# %% [markdown]
# ## Is it right? Two published examples
#
# A pump whose bearings feel F = F̄ + A·sin θ is an example in Shigley's *Mechanical Engineering Design* (chapter "Rolling-Contact
# Bearings"): the factor P/F̄ for ball bearings is tabulated for A/F̄. A massless mechanism with that force on its main bearing,
# and nothing else, is such a pump:

# %%
light = [ls.Link(length, 0.0, 0.0) for length in (0.1, 0.3, 0.25)]
shaft = ls.FourBar(*light, ground=0.2)
ratio = xr.DataArray(np.arange(0, 1.01, 0.2), dims="ratio")


def at_the_main_bearing(force, rpm_of_shaft=480.0, **bearing):
    loaded = ls.Scene(shaft, omega2=rpm_of_shaft * rpm, loads=[ls.Load("crank", force=(force, 0.0))])
    return ls.bearings(loaded, {"A": ls.Bearing(**bearing)}).sel(pin="A")


theta2 = xr.DataArray(np.arange(0, 360, 0.5), {"theta2": np.arange(0, 360, 0.5)}, "theta2")
pump = at_the_main_bearing(1000.0 * (1.0 + ratio * np.sin(np.radians(theta2))))
printed = np.array([1.0, 1.02, 1.07, 1.15, 1.25, 1.36])
pd.DataFrame({"A/F̄": ratio, "printed": printed, "computed": pump.equivalent_load / 1000}).round(4).T

# %% [markdown]
# And hours: a straight roller bearing that carries 1.4 × 1650 lbf = 10.279 kN for 50 000 h at 480 rpm needs a capacity of 91.1 kN
# (problem 11-3 in the 8th edition, from its solution manual). Which is to say that one of 91.1 kN lives for 50 000 h:

# %%
roller = at_the_main_bearing(10_279.0, capacity=91_100.0, kind="roller")
print(f"L10 = {float(roller.L10):.0f} million revolutions (1440 printed), L10h = {float(roller.L10h):,.0f} h")

# %% [markdown]
# ## Choosing
#
# The customer wants 20 000 h. Which capacity does each pin need, at which speed? Faster means more revolutions an hour, and more
# load.

# %%
speeds = np.linspace(60, 900, 57)
faster = replace(conveyor, omega2=xr.DataArray(speeds * rpm, {"rpm": speeds}, "rpm"))
per_load = ls.bearings(faster, {pin: ls.Bearing(capacity=1.0) for pin in pins}, theta2=360).L10h
needed = (20_000 / per_load) ** (1 / 3)  # N: the life grows with the cube of the capacity
fig, ax = plt.subplots(figsize=(8, 4), layout="constrained")
for pin in pins:
    ax.plot(speeds, needed.sel(pin=pin) / 1e3, label=f"pin {pin}")
for capacity in (14.0, 25.5, 35.1):
    ax.axhline(capacity, color="0.6", linewidth=1, linestyle=":")
    ax.text(890, capacity + 0.4, f"a bearing of {capacity} kN", ha="right", color="0.4")
ax.set(xlabel="speed [rpm]", ylabel="capacity for 20 000 h [kN]", xlim=(60, 900), ylim=(0, 42))
ax.legend(loc="upper left")
ax.grid(alpha=0.3)

# %% [markdown]
# One caution. The sum over |Δψ| takes every degree of a swing for as good as a degree of a revolution. That is the simplest of
# several rules for swinging bearings (O. Menck and M. Stammler compare them in *Wind Energy Science* 9 (2024) 777); where a swing
# is so small that the rollers do not reach each other's tracks, lubrication decides and not fatigue.

# %%
assert abs(hours / float(loads.L10h.sel(pin="C")) - 1) < 1e-4  # half degrees miss where the pin turns round
assert abs(pump.equivalent_load / 1000 - printed).max() < 0.005
assert abs(float(roller.L10h) / 50_000 - 1) < 0.002
