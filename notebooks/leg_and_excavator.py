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
# # A walking leg and an excavator
#
# Two machines that no four-bar can be. A leg must walk level, lift its foot, and take the weight of the machine all the while. An
# excavator's arm has three cylinders, and its driver moves all of them at once. In both one asks: where does the far end go, and
# what does that cost in pins, torque and thrust?

# %%
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import linksweep as ls

# %% [markdown]
# ## Two legs
#
# Theo Jansen's leg has eight links, whose lengths he calls his holy numbers; Joe Klann's has six, after a patent of 2001. Both come with
# linksweep as examples. The foot is pin H.

# %%
legs = {"Jansen": ls.example("jansen-leg"), "Klann": ls.example("klann-leg")}
for name, scene in legs.items():
    print(f"{name}: {scene.mechanism.links}")

fig, panels = plt.subplots(1, 2, figsize=(11, 5.5), layout="constrained")
for ax, (name, scene) in zip(panels, legs.items(), strict=True):
    ls.plot.mechanism(scene, theta2=60.0, ax=ax)
    ax.set_title(name)
# %% [markdown]
# ## The step
#
# How long is a step, how high is the foot lifted, and how level does it walk? Here in shares of the step, for one leg is twice as
# large as the other. The foot walks where it is lower than a tenth of its lift.

# %%
feet = {name: ls.sweep(scene, of=["Hx", "Hy"]) for name, scene in legs.items()}
steps = {}
fig, panels = plt.subplots(1, 2, figsize=(11, 3.4), layout="constrained")
for name, foot in feet.items():
    x, y = foot.Hx, foot.Hy - foot.Hy.min()
    walking = y < 0.1 * y.max()
    step = float(x.where(walking).max() - x.where(walking).min())
    steps[name] = {
        "step [cm]": 100 * step,
        "lift of the foot / step": float(y.max()) / step,
        "level within / step": float(y.where(walking).max()) / step,
        "on the ground [°]": int(walking.sum()) * 0.5,
    }
    panels[0].plot((x - 0.5 * (x.max() + x.min())) / step, y / step, label=name)
    panels[1].plot(foot.theta2, y / step, label=name)
panels[0].set(xlabel="forward / step", ylabel="height / step", aspect="equal", title="path of the foot")
panels[1].set(xlabel="crank angle θ₂ [°]", title="height of the foot", xticks=np.arange(0, 361, 45))
for ax in panels:
    ax.legend()
    ax.grid(alpha=0.3)
pd.DataFrame(steps).round(2)
# %% [markdown]
# Jansen's foot is on the ground for more than half of the turn and level within 3 % of its step: two legs on one crank, half a
# turn apart, already carry a machine without a jolt. Klann's goes higher, over stones, and pays with a hump on the way.
#
# ## What the pins bear
#
# In multiples of the load on the foot, since the legs are not of one size:

# %%
on_the_foot = {"Jansen": 60.0, "Klann": 150.0}  # N, as in the examples
bars = {}
for name, scene in legs.items():
    worst = ls.peaks(scene)
    forces = [force for force in ls.quantities(scene, "magnitude").names if f"{force}_peak" in worst]
    bars[name] = pd.Series({force: float(worst[f"{force}_peak"]) / on_the_foot[name] for force in forces}).nlargest(5)
fig, panels = plt.subplots(1, 2, figsize=(11, 2.8), sharex=True, layout="constrained")
for ax, (name, largest) in zip(panels, bars.items(), strict=True):
    ax.barh(largest.index[::-1], largest[::-1])
    ax.set(xlabel="largest force / load on the foot", title=name)
    ax.grid(alpha=0.3, axis="x")
# %% [markdown]
# The Strandbeest's tubes bear hardly more than the foot does. Klann's short lower rocker is a lever, and bears two and a half times as
# much. The torque has the rhythm of the step: it carries the foot over the unevenness of its path and lifts the leg. A second leg on
# the same crank, half a turn behind, shares the walking, but the peaks remain:

# %%
fig, panels = plt.subplots(1, 2, figsize=(11, 3.2), layout="constrained")
for ax, (name, scene) in zip(panels, legs.items(), strict=True):
    one = ls.sweep(scene, of=["T12"]).T12
    both = one + one.roll(theta2=one.sizes["theta2"] // 2, roll_coords=False)
    ax.plot(one.theta2, one, label="one leg")
    ax.plot(one.theta2, both, label="two, half a turn apart")
    ax.set(xlabel="crank angle θ₂ [°]", ylabel="torque [N m]", title=name, xticks=np.arange(0, 361, 45))
    ax.grid(alpha=0.3)
legend = panels[1].legend()
# %% [markdown]
# ## An excavator digs
#
# The boom is the crank: its angle counts the motion, from 0° to 40°. The boom's cylinder c1 drives it; the two others, for stick and bucket,
# are given as lengths over that angle, as the driver's hands would. Results are asked for over the arc and not over the turn.

# %%
arm = ls.example("excavator")
arc = np.arange(0.0, 40.5, 0.5)
print(arm.mechanism.links)
fig, panels = plt.subplots(1, 3, figsize=(14, 5.5), sharey=True, layout="constrained")
teeth = ls.sweep(arm, arc, of=["Tx", "Ty"])
for ax, theta2 in zip(panels, (0.0, 13.0, 40.0), strict=True):
    ls.plot.mechanism(arm, theta2, ax=ax)
    ax.plot(teeth.Tx, teeth.Ty, color="tab:brown", linewidth=3, zorder=2)
    ax.set_aspect("equal", adjustable="box")
    ax.set(xlim=(-0.5, 8.0), ylim=(-4.5, 4.5))
# %% [markdown]
# The teeth go down to four metres below the boom's pivot, some two below the ground, come nearer and rise, and the bucket closes
# over its earth (the brown path). What do the cylinders do?

# %%
cylinders = {"c1": "boom", "c2": "stick", "c3": "bucket"}
motion = ls.sweep(arm, arc, of=[f"{what}_{c}" for c in cylinders for what in ("length", "rate", "force")])
fig, panels = plt.subplots(1, 3, figsize=(13, 3.4), layout="constrained")
for c, name in cylinders.items():
    panels[0].plot(arc, motion[f"length_{c}"], label=f"{c}, {name}")
    panels[1].plot(arc, motion[f"rate_{c}"])
    panels[2].plot(arc, motion[f"force_{c}"] / 1e3)
panels[0].set(ylabel="length [m]")
panels[1].set(ylabel="rate [m/s]")
panels[2].set(ylabel="force, positive pushing [kN]")
panels[0].legend()
for ax in panels:
    ax.set(xlabel="angle of the boom θ₂ [°]")
    ax.grid(alpha=0.3)
# %% [markdown]
# ## How hard could it dig?
#
# Forces are linear in the loads. A sweep with the teeth's force and one without therefore tell how far that force could grow until
# a cylinder reaches the pressure at which its valve opens, here 350 bar. The boom's cylinders hold; those of stick and bucket dig,
# and the weaker of the two decides.

# %%
bores = {"c2": 0.140, "c3": 0.120}  # m
limits = {c: 350e5 * np.pi / 4 * bore**2 for c, bore in bores.items()}  # N
digging = slice(1.0, 16.0)
forces = [f"force_{c}" for c in bores]
together = ls.sweep(arm, arc, of=forces).sel(theta2=digging)
without = ls.sweep(replace(arm, loads=arm.loads[1:]), arc, of=forces).sel(theta2=digging)
teeth_force = np.hypot(*(together[f"loads[1].force[{k}]"] for k in (1, 2)))

fig, ax = plt.subplots(figsize=(8, 3.6), layout="constrained")
for c in bores:
    share = together[f"force_{c}"] - without[f"force_{c}"]
    factor = (limits[c] * np.sign(share) - without[f"force_{c}"]) / share
    ax.plot(share.theta2, factor * teeth_force / 1e3, label=f"until {c}, {cylinders[c]}, gives way")
ax.plot(teeth_force.theta2, teeth_force / 1e3, "k--", label="the force in the example")
ax.set(xlabel="angle of the boom θ₂ [°]", ylabel="force on the teeth [kN]", ylim=(0, 160))
ax.legend()
ax.grid(alpha=0.3)
# %%
moved = (
    sum(float(np.trapezoid(motion[f"force_{c}"] * motion[f"rate_{c}"], np.radians(arc))) for c in cylinders)
    / arm.omega2
)
print(f"work of the three cylinders: {moved / 1e3:.0f} kJ")

# %%
assert steps["Jansen"]["level within / step"] < 0.04 and steps["Klann"]["lift of the foot / step"] > 0.5
assert bars["Klann"].max() > 2 * bars["Jansen"].max()
