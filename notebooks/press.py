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
# # How hard are the pins of this press loaded?
#
# A small press: a crank-rocker of steel bars that stands upright, its crank driven at 300 rpm, its coupler pushing against
# 80 lbf. Before we choose bearings we want to know, over a whole revolution, the force in each pin and the torque that
# the drive must give, and where the worst of it is.

# %%
import tempfile
from pathlib import Path

import numpy as np
import xarray as xr

import linksweep as ls

bar = {"width": 0.02, "thickness": 0.02, "density": 7750.0}  # 2 × 2 cm steel [m, kg/m³]

press = ls.FourBar(
    crank=ls.Bar(length=0.08, **bar),
    coupler=ls.Bar(length=0.22, **bar),
    rocker=ls.Bar(length=0.18, **bar),
    ground=0.20,
)
scene = ls.Scene(
    press,
    omega2=2 * np.pi * 300 / 60,  # rad/s
    gravity=(0.0, -9.81),
    loads=[
        ls.Load("coupler", force=(0.0, -355.86), at=(0.10, 15.0)),  # N, at 10 cm from B, 15° off the line B–C
        ls.Load("rocker", torque=-12.0),  # N m
    ],
)

# %% [markdown]
# First: does it go round, and how well does it transmit? `check` answers in closed form, before anything is swept.

# %%
ls.check(scene).linksweep

# %% [markdown]
# Now one revolution. The result is an xarray Dataset indexed by the crank angle, in degrees; every variable says its unit and its
# sign.

# %%
cycle = ls.sweep(scene, theta2=720)
cycle.F32x.attrs

# %%
ax = cycle.linksweep.forces()
# %% [markdown]
# Pin C is loaded hardest, shortly after the crank has passed the line of the frame. What does its load look like to the
# bearing? The load diagram shows direction and size together, with the crank angle ticked along the curve.

# %%
ax = cycle.linksweep.bearing("F43")
# %%
ax = cycle.linksweep.mechanism(theta2=17.5, forces=True)
# %% [markdown]
# The numbers themselves come from `peaks`:

# %%
worst = ls.peaks(scene)
worst.linksweep

# %% [markdown]
# ## Can we trust them?
#
# The fast path eliminates the 9×9 Newton–Euler system by hand. `system` returns it as the textbook prints it,
# `solver="dense"` solves it with partial pivoting, and the power balance checks the torque against energy, which no residual of
# one's own equations can do.

# %%
page = ls.system(scene, theta2=17.5)
page.matrix.isel(theta2=0).to_pandas().round(3)

# %%
dense = ls.sweep(scene, solver="dense")
largest = float(worst["F43_peak"])
unknowns = ["F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y"]
difference = max(float(abs(cycle[name] - dense[name]).max()) for name in unknowns) / largest
residual = ls.sweep(scene, of=["power_residual"]).power_residual
print(f"fast against dense, relative to the largest force: {difference:.1e}")
print(f"power balance, relative to the largest term:       {float(abs(residual).max()):.1e}")
assert difference < 1e-12
assert float(abs(residual).max()) < 1e-12

# %% [markdown]
# ## What if?
#
# Any number of a scene may be a DataArray with a named dimension. Here the rocker's length and the speed: a study of
# 60 × 80 designs, each swept over 720 angles. The kinematics do not depend on the load, nor the positions on the speed, and are not
# computed again for each.

# %%
rocker_length = np.linspace(0.14, 0.20, 60)
rpm = np.linspace(60, 900, 80)
study = ls.Scene(
    ls.FourBar(
        crank=press.crank,
        coupler=press.coupler,
        rocker=ls.Bar(length=xr.DataArray(rocker_length, {"rocker_length": rocker_length}, "rocker_length"), **bar),
        ground=press.ground,
    ),
    omega2=xr.DataArray(2 * np.pi * rpm / 60, {"rpm": rpm}, "rpm"),
    gravity=scene.gravity,
    loads=scene.loads,
)
map_of_peaks = ls.peaks(study, of=["F43"])
mesh = map_of_peaks.F43_peak.plot(x="rpm", y="rocker_length", cmap="viridis")
# %%
best = map_of_peaks.F43_peak.sel(rpm=300, method="nearest").idxmin()
print(f"at about 300 rpm pin C is loaded least with a rocker of {100 * float(best):.1f} cm")

# %% [markdown]
# ## A load that follows the stroke
#
# A punch pushes over the last 12 mm before its slider's outer dead centre, and only while it closes. Said over the crank angle, that
# load would be another one for each geometry; over the stroke it is the same for all. Here with the guide more and more aside:

# %%
aside = np.linspace(0.0, 0.04, 9)
punch = ls.SliderCrank(
    press.crank, press.coupler, slider_mass=2.0, offset=xr.DataArray(aside, {"aside": aside}, "aside")
)
push = xr.DataArray([-20e3, 0.0], {"position": [0.0, 0.012]}, "position")  # [N] from each distance on, to the next
load = ls.Load("slider", force=push, over="slider.to_end", while_="closing", interpolation="step")
punching = ls.peaks(ls.Scene(punch, omega2=scene.omega2, loads=[load]), of=["T12", "T12_mean"])
lines = punching.T12_max.plot(marker="o")
assert np.allclose(
    punching.T12_mean, 20e3 * 0.012 / (2 * np.pi), rtol=1e-9
)  # the work of a stroke, whatever the offset

# %% [markdown]
# ## Keep it
#
# The Dataset goes to NetCDF as it stands. The file holds the whole scene, so that it can be run again.

# %%
folder = Path(tempfile.mkdtemp())
ls.save(cycle, folder / "cycle.nc")
again = ls.sweep(ls.load_scene(folder / "cycle.nc"))
assert again.equals(cycle)
