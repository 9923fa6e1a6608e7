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
# # What does it take to stop a machine from shaking?
#
# A four-bar that runs fast walks across the floor. Its links are thrown to and fro, the frame has to hold them, and the floor has
# to hold the frame. Counterweights help. They can even cancel the shaking force altogether, at every speed, which is a small
# miracle; but the pins, the drive and the shaking moment pay for it. How much of the cure does one want?

# %%
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import linksweep as ls

bar = {"width": 0.02, "thickness": 0.01, "density": 7850.0}  # steel [m, kg/m³]
feeder = ls.FourBar(
    crank=ls.Bar(length=0.05, **bar),
    coupler=ls.Bar(length=0.20, **bar),
    rocker=ls.Bar(length=0.12, **bar),
    ground=0.20,
)
scene = ls.Scene(feeder, omega2=2 * np.pi * 600 / 60)  # 600 rpm, nothing but inertia
shaking = ls.sweep(scene, of=["Fsx", "Fsy", "Fs", "Ms"])
ax = ls.plot.hodograph(shaking)
# %% [markdown]
# The shaking force is −Σ m·a of the moving links: what they do to the frame, beside their weight. It changes direction and size
# within a turn. Its orders tell how fast: once, twice, three times a turn.

# %%
harmonics = ls.orders(shaking, ["Fsx", "Fsy"], n=6)
ax = ls.plot.orders(harmonics)
# %% [markdown]
# ## Why counterweights on two links are enough
#
# Σ m·a vanishes if the common centre of gravity of all links stands still. Berkof and Lowen (1969) wrote it down, with the first
# moments h = m·(xG + i·yG) of the links about their first pins:
#
# ```text
# Σ m·rG = (h2 + m3·a − h3·a/b)·e^(i·θ2) + (h4 + h3·c/b)·e^(i·θ4) + constant
# ```
#
# Two brackets, two counterweights. Nothing has to be put on the coupler, and no speed occurs: balanced once, balanced always. In
# numbers, by hand:

# %%
a, b, c, _ = feeder.lengths().values()
h2, h3, h4 = (link.mass * link.cg_distance for link in (feeder.crank, feeder.coupler, feeder.rocker))
print(f"crank:  {1000 * (h2 + feeder.coupler.mass * a - h3 * a / b):.2f} g m to be balanced")
print(f"rocker: {1000 * (h4 + h3 * c / b):.2f} g m")

full = ls.counterweights(scene, radius=0.06)
for weight in full:
    print(f"{weight.link}: {weight.mass:.3f} kg at {100 * weight.at[0]:.0f} cm, {weight.at[1]:.0f}°")
balanced = ls.with_counterweights(scene, full)
left_over = float(ls.sweep(balanced, of=["Fs"]).Fs.max()) / float(shaking.Fs.max())
print(f"what is left of the shaking force: {left_over:.0e}")

# %% [markdown]
# ## The bill
#
# Each of these two weights must itself be thrown to and fro, on the rocker at least. Before and after:

# %%
sizes = ("Fs_peak", "Ms_peak", "T12_peak", "F12_peak", "F32_peak", "F43_peak", "F14_peak")


def relative(after, of=sizes):
    """Sizes after balancing, relative to those before."""
    table = ls.compare(scene, after, of=of)
    return {name: float(table[name].sel(balance="after") / table[name].sel(balance="before")) for name in of}


pd.DataFrame({"unbalanced": dict.fromkeys(sizes, 1.0), "fully balanced": relative(balanced)}).round(2)

# %%
figure = ls.plot.balance(scene, balanced)

# %% [markdown]
# ## Every force is linear in the masses
#
# For a known geometry and motion, each force is a sum: coefficients that change with θ2, times the links' masses, first
# moments and moments of inertia. `regressor` returns the coefficients. Only three of the torque's are not zero. Whatever hangs on
# the crank, and the coupler's mass at B, takes none at constant speed: these go round and round. Remember it.

# %%
coefficients = ls.regressor(scene, ["T12", "F32x"])
shares = coefficients.T12 * coefficients.value
fig, ax = plt.subplots(figsize=(8, 3.2), layout="constrained")
for parameter in shares.parameter.values[abs(shares).max("theta2") > 1e-9]:
    ax.plot(shares.theta2, shares.sel(parameter=parameter), label=parameter)
ax.plot(shares.theta2, shares.sum("parameter"), "k--", linewidth=1, label="together: T12")
ax.set(xlabel="θ₂ [°]", ylabel="share in the torque [N m]", xticks=np.arange(0, 361, 45))
ax.legend(ncols=5, fontsize="small", loc="upper center")
ax.set_ylim(top=1.25 * ax.get_ylim()[1])
ax.grid(alpha=0.3)

# %% [markdown]
# A linear dependence is a gift. It foretells what any other link would do without another sweep; and to make a mix of squares of
# such forces small, with masses that must not be negative, is a bounded least-squares problem. It has one minimum, and one finds
# it.
#
# ## A compromise
#
# `best_counterweights` takes weights for what should be small. Let us count the shaking force and the ripple of the torque, and
# move the emphasis from one to the other:

# %%
mixes = [{"Fs_rms": 1.0, "T12_ripple": weight} for weight in np.geomspace(0.02, 2.0, 8)]
compromises = [ls.best_counterweights(scene, mix, radius=0.06, theta2=180) for mix in mixes]


def point(weights):
    """RMS of the shaking force and ripple of the torque, relative to no counterweights, and their mass."""
    both = relative(ls.with_counterweights(scene, weights), of=("Fs_rms", "T12_ripple"))
    return *both.values(), sum(weight.mass for weight in weights)


front = np.array([point(weights) for weights in compromises])
ends = {"none": (1.0, 1.0, 0.0), "Berkof–Lowen": point(full)}
fig, ax = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
dots = ax.scatter(front[:, 0], front[:, 1], c=front[:, 2], s=60, cmap="viridis", zorder=3, label="compromises")
fig.colorbar(dots, label="mass of the counterweights [kg]")
ax.plot(front[:, 0], front[:, 1], color="0.7")
for name, (force, ripple, _) in ends.items():
    ax.plot(force, ripple, "k*", markersize=11)
    ax.annotate(name, (force, ripple), (8, 6), textcoords="offset points")
ax.set(xlabel="shaking force, rms, relative", ylabel="ripple of the torque, relative")
ax.set(xlim=(-0.05, 1.2), ylim=(0.8, 1.6))
ax.grid(alpha=0.3)

# %% [markdown]
# The curve has a corner. From the right up to there, a counterweight on the crank halves the shaking force, and for nothing: on
# the crank it takes no torque. All that lies beyond is bought with a weight on the rocker, and the price per newton is always the
# same. With the load of the pins counted as well, the solver leaves the rocker alone:

# %%
aims = {"Fs_rms": 1.0, "T12_ripple": 0.5, "F43_peak": 0.5}
best = ls.best_counterweights(scene, aims, radius=0.06, most=0.5)
better = ls.with_counterweights(scene, best)
for weight in best:
    print(f"{weight.link}: {weight.mass:.3f} kg at {100 * weight.at[0]:.1f} cm, {weight.at[1]:.0f}°")
pd.DataFrame({"fully balanced": relative(balanced), "compromise": relative(better)}).round(2)

# %%
figure = ls.plot.balance(scene, better)

# %% [markdown]
# ## A slider-crank cannot be balanced by its crank
#
# Its piston moves on a line, a counterweight on a circle. What the counterweight takes away along the cylinder it adds across it.
# With none of the reciprocating mass balanced, all of the first order shakes along the cylinder; with all of it, across; with
# half, it goes round in a circle of half the size, which no weight on this crank can make smaller. What is left beside it is the
# second order, and that only another shaft or another cylinder can take away (see the notebook engine.py).

# %%
engine = ls.SliderCrank(
    crank=ls.Link(length=0.04, mass=2.0, inertia=4e-3),
    rod=ls.Link(length=0.14, mass=0.5, inertia=1.6e-3, cg_distance=0.04),
    slider_mass=0.4,
    slide_angle=90.0,
)
running = ls.Scene(engine, omega2=2 * np.pi * 3000 / 60)
fig, (left, right) = plt.subplots(1, 2, figsize=(10, 4.4), layout="constrained")
fractions = (0.0, 0.5, 1.0)
for k, fraction in enumerate(fractions):
    throw = ls.with_counterweights(running, ls.counterweights(running, radius=0.04, fraction=fraction))
    path = ls.sweep(throw, of=["Fsx", "Fsy"])
    left.plot(path.Fsx / 1e3, path.Fsy / 1e3, label=f"{100 * fraction:.0f} % balanced")
    order = ls.orders(path, ["Fsx", "Fsy"], n=3).sel(order=[1, 2])
    bars = order[["Fsx_amplitude", "Fsy_amplitude"]].to_dataarray().transpose("order", ...).values.ravel()
    right.bar(np.arange(4) + 0.27 * (k - 1), bars / 1e3, 0.25)
left.set(xlabel="across the cylinder [kN]", ylabel="along the cylinder [kN]", aspect="equal", title="shaking force")
left.legend(fontsize="small")
right.set_xticks(range(4), ["1st, across", "1st, along", "2nd, across", "2nd, along"])
right.set(ylabel="amplitude [kN]", title="its orders")
for ax in (left, right):
    ax.grid(alpha=0.3)

# %%
assert left_over < 1e-10
assert relative(better)["Fs_peak"] < 1 and relative(better)["T12_peak"] < relative(balanced)["T12_peak"]
