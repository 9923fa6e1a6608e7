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
# # A six-bar press, from sketch to bearing
#
# To coin a medal takes 600 kN over the last millimetres of a stroke, ninety times a minute. A crank and a connecting rod
# could do that, but then the crank pin and the main bearing would bear all of it, at full speed. A knuckle joint does not
# ask this of the crank: two levers stand almost in line between frame and ram, and the rod only has to push their joint
# sideways. Which pins bear the load instead, how large must their bearings be, and what does the drive notice?
#
# ## The sketch
#
# A machine is a line of text: each link by its pins, the crank first. A is the crankshaft, D the pin in the head of the
# frame, 552 mm beside it and 360 mm above.

# %%
import tempfile
from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import xarray as xr

import linksweep as ls

rpm = 2 * np.pi / 60  # rad/s
press = ls.Linkage(
    "crank A-B, rod B-C, upper D-C, lower C-E, ram E on slide",
    ground={"A": (0.0, 0.0), "D": (0.552, 0.360)},
    guides={"slide": ls.Guide(through=(0.552, 0.0), angle=-90.0, friction=0.08)},
    branch={"C": "crossed"},  # the knuckle lies to the right of the line from B to D
    crank=ls.Link(0.060, mass=380.0, inertia=9.0),
    rod=ls.Link(0.490, mass=85.0, inertia=2.1, cg_distance=0.21),
    upper=ls.Link(0.360, mass=110.0, inertia=1.9, cg_distance=0.18),
    lower=ls.Link(0.360, mass=110.0, inertia=1.9, cg_distance=0.18),
    ram=ls.Slider(mass=850.0),
)
theta2 = [0.0, 8.0, 150.0, 295.0, 310.0, 330.0, 350.0]  # the bottom dead centre is at 0
medal = xr.DataArray(1e3 * np.array([600, 0, 0, 0, 150, 400, 590]), {"theta2": theta2}, "theta2")  # N, upwards
scene = ls.Scene(
    press,
    omega2=90 * rpm,
    gravity=(0.0, -9.81),
    loads=[ls.Load("ram", force=(0.0, medal), interpolation="pchip")],
)

fig, panels = plt.subplots(1, 2, figsize=(10, 5.4), layout="constrained")
for ax, place in zip(panels, (180.0, 330.0), strict=True):
    ls.plot.mechanism(scene, place, ax=ax)
# %% [markdown]
# ## Does it go round?
#
# The machine closes pair by pair: rod and upper lever find C, then the lower lever and the ram find E. `check` states whether each
# pair closes over the whole turn, and how far it stays from a toggle, where it would jam.

# %%
ls.check(scene).linksweep

# %% [markdown]
# ## Why a knuckle
#
# Beside a plain crank press of the same stroke, the ram dwells at the bottom: the metal gets time to flow. To compare the forces as
# well, let the medal resist both in the same way over the height of the ram.

# %%
motion = ls.geometry(scene)
stroke = float(motion.x_ram_travel)
x_ram = ls.sweep(scene, of=["x_ram"]).x_ram
height = x_ram.max() - x_ram  # of the ram above its lowest place [m]
at = height.sel(theta2=[350.0, 330.0, 310.0, 295.0]).values
over_height = xr.DataArray([-590e3, -400e3, -150e3, 0.0], {"position": at}, "position")
plain = ls.SliderCrank(
    replace(press.crank, length=stroke / 2), press.lower, slider_mass=850.0, slide_angle=-90.0, friction=0.08
)
medal_too = ls.Load("slider", force=over_height, over="slider.to_end", while_="closing")
crank_press = ls.Scene(plain, omega2=90 * rpm, gravity=(0.0, -9.81), loads=[medal_too])
x_slider = ls.sweep(crank_press, of=["x_slider"]).x_slider

fig, ax = plt.subplots(figsize=(9, 3.4), layout="constrained")
for name, curve in {"knuckle press": height, "crank press": x_slider.max() - x_slider}.items():
    curve = curve.assign_coords(theta2=(curve.theta2 - curve.idxmin() + 180) % 360 - 180).sortby("theta2")
    ax.plot(curve.theta2, 1e3 * curve, label=name)
ax.set(xlabel="crank angle from the bottom dead centre [°]", ylabel="ram above its lowest place [mm]")
ax.set(xticks=np.arange(-180, 181, 45), ylim=(0, None))
ax.legend()
ax.grid(alpha=0.3)
print(f"stroke {1e3 * stroke:.1f} mm")
# %% [markdown]
# ## Which pin is the worst?

# %%
worst, of_the_plain = ls.peaks(scene), ls.peaks(crank_press, of=["F12", "F32", "F43", "F14"])
joints = {
    "F12": "A, main bearing",
    "F32": "B, crank pin",
    "F14": "D, head of the frame",
    "F43": "C, upper lever",
    "F53": "C, lower lever",
    "F65": "E, ram",
    "F16": "slide",
}
table = pd.DataFrame(
    {
        "joint": joints,
        "largest force [kN]": {force: float(worst[f"{force}_peak"]) / 1e3 for force in joints},
        "at θ₂ [°]": {force: float(worst[f"{force}_peak_at"]) for force in joints},
    }
)
table["in the crank press [kN]"] = pd.Series(
    {force: float(of_the_plain[f"{force}_peak"]) / 1e3 for force in ("F12", "F32")}
)
table.round(1).astype(object).fillna("–")

# %% [markdown]
# The levers' pins bear the 600 kN, and the crank less than a twentieth of it. In the crank press, crank pin and main bearing bear all.
# (Between two levers in line, gravity and inertia hardly matter: where does the load of pin C come from?)

# %%
ax = ls.plot.breakdown(ls.breakdown(scene, "F53"), "F53")
# %% [markdown]
# ## The bearings
#
# Levers that only swing run in bushes of bronze, the crank pin in a roller bearing. `ls.bearings` gives each its load, its rotation, and
# what follows: the pressure in a bush, the life of a roller bearing. A pin that several links share has a name for each,
# `"C:upper"` and `"C:lower"`.

# %%
bush = ls.Bearing(diameter=0.11, length=0.10, friction=0.08)
roller = ls.Bearing(capacity=60e3, kind="roller")
choice = {"D": bush, "C:upper": bush, "C:lower": bush, "E": bush, "A": roller, "B": roller}
loads = ls.bearings(scene, choice)
pd.DataFrame(
    {
        "largest force [kN]": loads.F.max("theta2") / 1e3,
        "rotation in a turn [°]": loads.rotation,
        "largest pressure [MPa]": loads.pressure.max("theta2") / 1e6,
        "L10h [h]": loads.L10h,
    },
    index=loads.pin,
).round(1).astype(object).fillna("–")
# %% [markdown]
# The bushes are worst at the bottom, where they hardly turn: 54 MPa is at home in a bronze bush at that speed. The crank's small roller
# bearings live for more than 40 000 h. Friction in the bushes is
# another matter. It takes more than half of the work:

# %%
rubbing = ls.pin_friction(scene, choice)
lost = rubbing.friction_loss.mean("theta2")  # W
print(", ".join(f"{pin}: {float(lost.sel(pin=pin)):.0f} W" for pin in lost.pin.values))
print(f"efficiency: {100 * float(rubbing.efficiency):.0f} %")

# %% [markdown]
# ## The drive
#
# The medal is struck in a fifth of a turn, and the motor would rather work all the time. A flywheel stores what the blow takes.

# %%
work = ls.duty(scene)
wheel = ls.flywheel(scene, fluctuation=0.10)
ls.plot.flywheel(wheel)
print(f"work of a stroke {float(work.work):.0f} J, mean torque {float(work.effort_mean):.0f} N m, ", end="")
print(f"largest {float(work.effort_peak):.0f} N m")
print(f"flywheel on the crankshaft: {float(wheel.flywheel_inertia):.0f} kg m²")
# %% [markdown]
# ## Does it shake?
#
# Ninety times a minute, 850 kg of ram are thrown up and down. Counterweights turn or swing, and cannot follow a line; the best that two
# of them on crank and upper lever can do, at 120 kg each at most, is this. (Forces are linear in the masses only without friction, so the
# search leaves it out.)

# %%
without_friction = replace(press, guides={"slide": replace(press.guides["slide"], friction=0.0)})
smooth = replace(scene, mechanism=without_friction)
weights = ls.best_counterweights(smooth, {"Fs_rms": 1.0, "T12_ripple": 0.3}, radius=0.2, most=120.0)
for weight in weights:
    print(f"{weight.link}: {weight.mass:.0f} kg at {100 * weight.at[0]:.0f} cm, {weight.at[1]:.0f}°")
balanced = ls.with_counterweights(scene, weights)
compared = ls.compare(scene, balanced, of=["Fs_peak", "Fs_rms", "T12_peak", "F14_peak"])
compared.to_dataframe().round(0)

# %% [markdown]
# A third less, for 180 kg. At 3.5 kN beside a blow of 600 kN, which stays within the frame, the press needs none of it.
#
# ## The report
#
# One page for the file: machine, checks, peaks, drive, bearings' loads, shaking.

# %%
page = Path(tempfile.mkdtemp()) / "knuckle-press.html"
ls.report(scene, page, title="Knuckle-joint press, 600 kN")
print(f"{page.name}: {page.stat().st_size / 1e3:.0f} kB")

# %%
assert worst.F32_peak < 0.05 * worst.F53_peak and of_the_plain.F32_peak > 0.95 * 590e3
assert loads.L10h.sel(pin="B") > 40_000 and loads.pressure.max() < 60e6
assert abs(float(work.work) / (2 * np.pi * float(work.effort_mean)) - 1) < 1e-9
