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
# # A load that was measured
#
# The push of the tool is rarely a formula. It is a column of numbers from a load cell, a curve from a data sheet, or a
# sentence such as "over the last 12 mm". All three belong into the scene as they are.

# %%
import tempfile
import warnings
from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

import linksweep as ls

press = ls.example("press")

# %% [markdown]
# ## A column of a CSV file
#
# The first column is the crank angle in degrees, over one turn or several; the first line names the columns. Rows need not
# be evenly spaced, and may close the cycle by repeating the first. Here is a file as a data logger writes it, in lbf:

# %%
folder = Path(tempfile.mkdtemp())
angles = [0, 30, 60, 80, 90, 100, 120, 140, 160, 170, 180, 210, 240, 270, 300, 330]
push = [0, 0, 20, 105, 225, 310, 370, 400, 380, 260, 60, 0, 0, 0, 0, 0]  # lbf
rows = "\n".join(f"{angle},{force}" for angle, force in zip(angles, push, strict=True))
(folder / "push.csv").write_text(f"theta2,F\n{rows}\n")

ls.save(replace(press, loads=()), folder / "press.toml")  # the example without its loads, as a file
with (folder / "press.toml").open("a") as file:
    file.write("""
[[loads]]
link = "coupler"
force = [0, {csv = "push.csv", unit = "lbf"}]
at = ["10 cm", "15 deg"]
interpolation = "pchip"
""")
upwards = ls.load_scene(folder / "press.toml")
cycle = ls.sweep(upwards)
ax = cycle.linksweep.forces()

# %% [markdown]
# The file's numbers are positive, so this load pushes up. To turn it over, change the sign in the file, or do it in Python,
# where a load over the angle is a DataArray with the dim `theta2`:

# %%
measured = xr.DataArray(-4.4482216152605 * np.array(push), {"theta2": angles}, "theta2")  # N, downwards


def pushing(interpolation):
    """The press with the measured push, and a curve through its points."""
    return replace(
        press, loads=[ls.Load("coupler", force=(0.0, measured), at=(0.10, 15.0), interpolation=interpolation)]
    )


# %% [markdown]
# ## Between the rows
#
# What happens between two rows is for you to say. A spline is smooth, but rings: it swings beyond its points where the
# load sets in and ends, and linksweep warns of it. "pchip" is smooth and stays within them, "linear" connects them, "step"
# holds each up to the next.

# %%
fig, ax = plt.subplots(figsize=(9, 3.6), layout="constrained")
for interpolation in ("periodic cubic", "pchip", "linear", "step"):
    scene = pushing(interpolation)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        over = ls.sweep(scene, of=["F43"])
        peak = ls.peaks(scene, of=["F43"])
    print(f"{interpolation:15} F43 {float(peak.F43_peak):6.1f} N at {float(peak.F43_peak_at):5.1f}°", end="")
    print("   (warns that it rings)" if caught else "")
    ax.plot(over.theta2, over.F43, label=interpolation)
ax.set(xlabel="crank angle θ₂ [°]", ylabel="F43 [N]", xlim=(30, 200))
ax.legend()
ax.grid(alpha=0.3)

# %% [markdown]
# ## A function of the angle
#
# In degrees, like all angles. A function that takes them for radians does not repeat after a turn, and is refused.

# %%
smooth = ls.Load("rocker", torque=lambda theta2: -6.0 * (1.0 - np.cos(np.radians(theta2))))
ls.peaks(replace(press, loads=[smooth]), of=["T12"]).linksweep

# %%
try:
    replace(press, loads=[ls.Load("rocker", torque=np.sin)])
except ValueError as error:
    print(error)

# %% [markdown]
# ## A load over the stroke
#
# A punch pushes over the last 12 mm before its outer dead centre, and only while it closes. Said over the crank angle, that
# would be another load for each geometry; over the stroke it is the same for all. Here with the guide more and more aside:

# %%
aside = np.linspace(0.0, 0.04, 9)  # m
offset = xr.DataArray(aside, {"offset": aside}, "offset")
crank, rod = ls.Bar(0.05, 0.03, 0.02, 7850), ls.Bar(0.20, 0.03, 0.02, 7850)
punch = ls.SliderCrank(crank, rod, slider_mass=2.0, offset=offset)
push_at = xr.DataArray([-20e3, 0.0], {"position": [0.0, 0.012]}, "position")  # N from each distance on, to the next
over_stroke = ls.Load("slider", force=push_at, over="slider.to_end", while_="closing", interpolation="step")
punching = ls.peaks(ls.Scene(punch, omega2=10.0, loads=[over_stroke]), of=["T12", "T12_mean"])

fig, ax = plt.subplots(figsize=(7, 3.4), layout="constrained")
ax.plot(1e3 * aside, punching.T12_max, marker="o", label="largest torque")
ax.plot(1e3 * aside, punching.T12_mean, marker="o", label="mean torque")
ax.set(xlabel="offset of the guide [mm]", ylabel="T12 [N m]", ylim=(0, None))
ax.legend()
ax.grid(alpha=0.3)

# %% [markdown]
# The mean torque does not change: it is the work of the stroke, 20 kN times 12 mm, over a turn.

# %%
assert np.allclose(punching.T12_mean, 20e3 * 0.012 / (2 * np.pi), rtol=1e-9)
