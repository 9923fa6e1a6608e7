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
# # Does this motor carry it?
#
# A crank-rocker press is to run at about 300 rpm on a four-pole induction motor behind a gear of 5 : 1. Pin forces at constant speed
# are one thing; on its motor the press slows down where it works and speeds up where its links fall. How far does that change the
# forces? Does the motor start the press at all, from any crank angle, and how hot does its rotor get? What does a flywheel change?

# %%
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

import linksweep as ls

press = ls.example("press")
motor = ls.InductionMotor("1500 rpm", "15 N m", rated_torque="6 N m", rated_speed="1425 rpm", inertia=0.004)
ratio, rpm = 5.0, 2 * np.pi / 60
pins = ["F12", "F32", "F43", "F14"]

# %% [markdown]
# ## The motor's curve
#
# Kloss's equation gives the torque of an induction motor at any speed from the numbers of its nameplate: weak at standstill, strongest
# at the breakdown slip, and steep beside the synchronous speed, where it works.

# %%
speeds = np.linspace(0.0, 1500.0, 200) * rpm
plt.plot(speeds / rpm, motor.torque_at(speeds))
plt.plot([1425.0], [6.0], "o", color="C0")
plt.annotate("rated", (1425.0, 6.0), textcoords="offset points", xytext=(-36, 2))
plt.xlabel("motor speed [rpm]")
plt.ylabel("motor torque [N m]")
plt.show()

# %% [markdown]
# ## The steady cycle
#
# `steady_cycle` returns the speed over the crank angle that repeats itself, with and without a flywheel on the crank's shaft. The
# loads of this press are constant: over a turn they give back what they take, so that the press runs at about the synchronous speed,
# and its motor drives and brakes in turn.

# %%
wheels = xr.DataArray([0.0, 0.3], dims="flywheel", coords={"flywheel": [0.0, 0.3]})
cycle = ls.steady_cycle(press, motor, ratio=ratio, flywheel=wheels)
for wheel in wheels.values:
    plt.plot(cycle.theta2, cycle.omega2.sel(flywheel=wheel) / rpm, label=f"{wheel:g} kg m²")
plt.xlabel("crank angle [°]")
plt.ylabel("crank speed [rpm]")
plt.legend(title="flywheel")
plt.show()
for wheel in wheels.values:
    one = cycle.sel(flywheel=wheel)
    print(
        f"{wheel:g} kg m²: mean {float(one.speed_mean) / rpm:.1f} rpm, fluctuation {100 * float(one.fluctuation):.1f} %"
    )

# %% [markdown]
# ## Pin forces: at constant speed, and on the motor
#
# The scene of a steady cycle has that motion in it, speed and acceleration; `peaks`, `bearings`, `strength` and all others take it.

# %%
mean = float(cycle.speed_mean.sel(flywheel=0.0))
constant = ls.peaks(replace(press, omega2=mean), of=[*pins, "T12"])
on_motor = ls.peaks(ls.steady_cycle(press, motor, ratio=ratio).linksweep.scene, of=[*pins, "T12"])
for name in [*pins, "T12"]:
    before, after = float(constant[f"{name}_peak"]), float(on_motor[f"{name}_peak"])
    print(f"{name}: {before:6.1f} at constant speed, {after:6.1f} on the motor ({100 * (after / before - 1):+.0f} %)")

# %% [markdown]
# The speed changes by 6.5 % over the cycle, the largest pin forces by 1 % only: at 300 rpm that is little, and flywheels are there for the motor rather than for the pins.
#
# ## Run-up
#
# Switched on at rest, the motor takes the press and a flywheel to 99 % of the speed of its operating point, at which it gives the mean
# torque that the press takes, in less than a turn of the crank.
# The largest forces on the way are below those of the steady cycle.

# %%
start = ls.run_up(press, motor, ratio=ratio, flywheel=0.3)
start.linksweep

# %%
start.linksweep.run_up()
plt.show()

# %% [markdown]
# An induction motor that starts a flywheel alone turns as much energy into heat as the flywheel then has, whatever its torque: half of
# what it takes from the mains is lost. Here the load adds to that.
#
# The crank may have stopped anywhere. Does the motor start the press from every angle? Thirty starts are one call:

# %%
angles = xr.DataArray(np.arange(0.0, 360.0, 12.0), dims="start", coords={"start": np.arange(0.0, 360.0, 12.0)})
starts = ls.run_up(press, motor, ratio=ratio, flywheel=0.3, start=angles, of=["F32"])
print("of", starts.status.size, "starts, those that fail:", int((starts.status != 0).sum()))
plt.plot(angles, starts.duration)
plt.xlabel("crank angle at the start [°]")
plt.ylabel("run-up [s]")
plt.show()

# %% [markdown]
# A weaker motor, with a fifth of the breakdown torque, does not:

# %%
weak = ls.InductionMotor("1500 rpm", "3 N m", rated_torque="1.5 N m", rated_speed="1425 rpm", inertia=0.004)
weakly = ls.run_up(press, weak, ratio=ratio, flywheel=0.3, start=angles, of=["F32"])
words = weakly.status.attrs["flag_meanings"].split()
for k, word in enumerate(words):
    count = int((weakly.status == k).sum())
    if count:
        print(f"{word}: {count} of {weakly.status.size} starts")

# %% [markdown]
# ## Which flywheel?
#
# A heavier flywheel evens the speed, and makes the rotor hotter at every start. Twelve flywheels side by side:

# %%
sizes = np.linspace(0.0, 1.0, 12)
wheels = xr.DataArray(sizes, dims="wheel", coords={"wheel": sizes})
even = ls.steady_cycle(press, motor, ratio=ratio, flywheel=wheels)
slow = ls.run_up(press, motor, ratio=ratio, flywheel=wheels, of=["F32"])
figure, (above, below) = plt.subplots(2, 1, sharex=True, layout="constrained")
above.plot(sizes, 100 * even.fluctuation)
above.set_ylabel("fluctuation [%]")
below.plot(sizes, slow.motor_heat)
below.set_ylabel("heat in the rotor at the start [J]")
below.set_xlabel("flywheel [kg m²]")
plt.show()

# %% [markdown]
# ## Run-down
#
# After the power is cut, nothing stops a press without friction. With a damper in place of the friction of its bearings:

# %%
print(ls.run_down(replace(press, omega2=mean, loads=[]), motor, ratio=ratio, flywheel=0.3, of=["F32"]).linksweep)
bearing = ls.TorsionDamper("ground", "crank", coefficient=0.2)
ls.run_down(replace(press, omega2=mean, loads=[bearing]), motor, ratio=ratio, flywheel=0.3, of=["F32"]).linksweep
