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
# # What does friction cost this pump?
#
# A plunger pump for 60 bar: a crank, a rod, and a plunger of 40 mm in its guide. While it presses, the full pressure acts on
# it; while it sucks, nothing to speak of. The valves open and close by themselves at the ends of the stroke, so that
# the load belongs to the direction of motion and not to an angle. The packing rubs, and so do the pins. How much of the
# motor's work reaches the water?

# %%
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

import linksweep as ls

rpm = 2 * np.pi / 60  # rad/s
area = np.pi / 4 * 0.040**2  # m²
pressure = 60e5  # Pa
machine = ls.SliderCrank(
    crank=ls.Disk(0.035, radius=0.09, thickness=0.04, density=7850),
    rod=ls.Bar(0.16, 0.03, 0.03, 7850),
    slider_mass=1.2,
    friction=0.08,  # of plunger and packing
)
delivery = ls.Load("slider", force=-pressure * area, over="slider.position", while_="closing")
pump = ls.Scene(machine, omega2=300 * rpm, gravity=(0.0, -9.81), loads=[delivery])
ax = ls.plot.mechanism(pump, theta2=50.0, forces=True)

# %% [markdown]
# ## Forces and torque
#
# Both jump at the dead centres, where the load comes and goes and friction changes sides. `peaks` looks at both sides of
# each jump.

# %%
cycle = ls.sweep(pump)
fig, (upper, lower) = plt.subplots(2, 1, figsize=(9, 6), layout="constrained")
cycle.linksweep.forces(ax=upper)
cycle.linksweep.torque(ax=lower)
ls.peaks(pump, of=["F12", "F32", "F43", "F14", "T12"]).linksweep

# %% [markdown]
# ## The guide's share
#
# The mean torque times 2π is the work of a turn. The water gets pressure times swept volume, whatever rubs.

# %%
of_the_water = pressure * area * 2 * 0.035  # J a turn


def work(friction):
    """Work of the drive in a turn [J], for a coefficient of friction of the guide."""
    scene = replace(pump, mechanism=replace(machine, friction=friction))
    return 2 * np.pi * ls.peaks(scene, of=["T12_mean"]).T12_mean


coefficient = np.linspace(0.0, 0.3, 13)
turns = work(xr.DataArray(coefficient, {"friction": coefficient}, "friction"))
fig, ax = plt.subplots(figsize=(7, 3.4), layout="constrained")
ax.plot(coefficient, 100 * of_the_water / turns)
ax.set(xlabel="coefficient of friction of the guide", ylabel="efficiency [%]", ylim=(None, 100.5))
ax.grid(alpha=0.3)

# %% [markdown]
# ## The pins' share
#
# The pins rub, too, and their friction changes the forces that cause it: `pin_friction` solves both together.

# %%
bushes = {"A": ls.Bearing(diameter=0.045, length=0.05, friction=0.06)}
bushes |= {pin: ls.Bearing(diameter=0.030, length=0.035, friction=0.06) for pin in "BC"}
rubbing = ls.pin_friction(pump, bushes)
for pin in bushes:
    print(f"pin {pin}: {float(rubbing.friction_loss.sel(pin=pin).mean('theta2')):6.1f} W")
delivered = of_the_water * 300 / 60
print(f"water:  {delivered:.0f} W")
print(f"efficiency of guide and pins together: {100 * float(rubbing.efficiency):.1f} %, ", end="")
print(f"of the guide alone {100 * of_the_water / float(work(0.08)):.1f} %")

# %% [markdown]
# ## Three plungers
#
# One plunger gives the motor a torque that comes and goes. Three, a third of a turn apart, even it out:

# %%
triplex = ls.MultiCylinder(pump, crank_angles=[0, 120, 240], positions=[-0.1, 0.0, 0.1])
fig, ax = plt.subplots(figsize=(9, 3.4), layout="constrained")
ax.plot(cycle.theta2, cycle.T12, label="one plunger")
three = triplex.sweep()
ax.plot(three.theta2, three.T12, label="three")
ax.set(xlabel="crank angle θ₂ [°]", ylabel="torque of the drive [N m]", xticks=np.arange(0, 361, 45))
ax.legend()
ax.grid(alpha=0.3)
one_wheel, three_wheel = ls.flywheel(pump, fluctuation=0.05), ls.flywheel(triplex, fluctuation=0.05)
print(f"flywheel for 5 % fluctuation: {float(one_wheel.flywheel_inertia):.3f} kg m² for one plunger, ", end="")
print(f"{float(three_wheel.flywheel_inertia):.3f} kg m² for three")

# %%
assert np.isclose(turns.values[0], of_the_water, rtol=1e-9)  # without friction all work reaches the water
assert float(three_wheel.flywheel_inertia) < 0.2 * float(one_wheel.flywheel_inertia)
