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
# # Is this press strong enough?
#
# A crank-rocker press of flat steel bars runs at 300 rpm and pushes with 80 lbf at a point of its coupler. Which of its links is the
# weakest, where, and at which crank angle? How thin may the bars be, and how thick must the pins be?
#
# A link is a beam: pulled and pressed by its pins, bent by its load, its weight and its own inertia. All of these change with the
# crank angle, so that the worst section of a link and the worst angle have to be sought together.

# %%
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

import linksweep as ls

press = ls.example("press")
steel = ls.material("S235")
rpm = 2 * np.pi / 60
press

# %% [markdown]
# ## Inside the links
#
# Section forces are quantities like others, over the dim `section`: places from one end of a link to the other. The exact peak of
# each is that of the continuous revolution.

# %%
inside = ls.peaks(press, of=["axial_force3", "bending_moment3", "stress3"])
print(f"largest stress of the coupler at one of 41 places: {float(inside.stress3_peak.max()) / 1e6:.2f} MPa")
ls.plot.moment_diagrams(press)
plt.show()

# %% [markdown]
# The moment of the coupler jumps where the load acts: it is applied off the line of pins, so that its component along the line bends
# the link as well. Crank and rocker are bent like cantilevers, because a torque acts on each at its pivot: the drive's on the crank,
# the load's on the rocker.
#
# ## Safety
#
# Stress concentrations at the eyes are for the designer to judge; here a factor of 2.5.

# %%
worst = ls.strength(press, steel, stress_concentration=2.5)
worst.linksweep

# %% [markdown]
# The crank fails first, by fatigue, beside its pivot: its stress changes sign in every turn. The rocker has two thirds of that stress
# and thrice the safety, since its torque always acts in one direction: what counts is the amplitude.
#
# ## How fast may it run?
#
# Inertia grows with the square of the speed. The safeties of 25 speeds are one call:

# %%
speeds = xr.DataArray(np.linspace(50.0, 1800.0, 25) * rpm, dims="speed")
faster = ls.strength(replace(press, omega2=speeds), steel, stress_concentration=2.5)
for link in faster.link.values:
    plt.semilogy(speeds / rpm, faster.goodman_safety.sel(link=link), label=str(link))
plt.axhline(2.0, color="grey", linestyle="--")
plt.xlabel("crank speed [rpm]")
plt.ylabel("safety against fatigue (Goodman)")
plt.legend()
plt.show()

# %% [markdown]
# ## As thin as it may be
#
# Bars of 20 × 20 mm are far too heavy for 300 rpm. For a safety of 2 in every respect (yield, fatigue, buckling), with the loads that
# their own smaller masses bring:

# %%
sized = ls.size_links(press, steel, safety=2.0, stress_concentration=2.5)
lighter = ls.scene_at(sized)
for link in sized.link.values:
    print(f"{link}: {1e3 * float(sized.thickness.sel(link=link)):.1f} mm thick")
before, after = (sum(bar.mass for bar in scene.mechanism.parts.values()) for scene in (press, lighter))
print(f"{before:.2f} kg before, {after:.2f} kg now")
ls.strength(lighter, steel, stress_concentration=2.5).linksweep

# %% [markdown]
# ## The pins
#
# A pin of 8 mm in double shear, in an eye 20 mm wide, is more than enough; bending decides, as it does wherever eyes are wide.

# %%
pins = ls.size_pins(lighter, allowable={"shear": 60e6, "pressure": 15e6, "bending": 120e6}, eye=0.02)
for pin in pins.pin.values:
    by = str(pins.criterion.values[int(pins.governing.sel(pin=pin))])
    print(f"pin {pin}: {1e3 * float(pins.diameter.sel(pin=pin)):.1f} mm, by {by}")

# %% [markdown]
# Would clearance in the pins make it knock? With 50 µm it takes this part of each pin's force, at the worst angle, to keep the journal
# on the wall of its bush; contact would be lost beyond 1:

# %%
loss = ls.contact_loss(lighter, clearance=50e-6)
for pin in loss.pin.values:
    print(f"pin {pin}: {float(loss.knock.sel(pin=pin).max()):.1e}")
assert not bool((loss.knock > 1.0).any())
