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
# # What loads the bearings of this engine: the gas or the inertia?
#
# One upright cylinder of half a litre, four strokes, 3000 rpm. The gas presses on the piston once in two revolutions, the
# piston's own inertia in every one. Both go through the connecting rod into the crank pin, and from there into the main
# bearing. For the bearings we need their load diagrams, for the flywheel the torque, and for both the speed at which inertia
# takes over.

# %%
import tempfile
from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

import linksweep as ls

engine = ls.SliderCrank(
    crank=ls.Link(length=0.043, mass=3.0, inertia=8e-3),  # balanced: its centre of gravity is on the main bearing
    rod=ls.Link(length=0.145, mass=0.6, inertia=2.2e-3, cg_distance=0.045),
    slider_mass=0.45,
    friction=0.05,
    slide_angle=90.0,  # the cylinder stands upright
)
otto = ls.OttoCycle(compression_ratio=10.0, peak_pressure=60e5)
gas = ls.GasPressure(bore=0.086, pressure=otto)
rpm = 2 * np.pi / 60  # rad/s
scene = ls.Scene(engine, omega2=3000 * rpm, gravity=(0.0, -9.81), loads=[gas])
scene.period

# %% [markdown]
# Nothing here is a data file: an ideal air-standard Otto cycle is known from its compression ratio and peak pressure, and the
# volume from the mechanism itself. It repeats every 720°, so a sweep of this scene runs over two revolutions. The piston is at top
# dead centre at θ₂ = 90°, where the mixture burns, and again at 450°.
#
# The indicator diagram, as one would measure it:

# %%
cycle = ls.sweep(scene)
theta2 = cycle.theta2
pressure = otto.pressure(engine, theta2)
area = np.pi / 4 * gas.bore**2
distance = float(cycle.x_slider.max()) - cycle.x_slider  # of the piston from top dead centre [m]
swept = float(distance.max()) * area
volume = swept / (otto.compression_ratio - 1) + distance * area

fig, (left, right) = plt.subplots(1, 2, figsize=(10, 3.6), layout="constrained")
left.plot(theta2, pressure / 1e5)
left.set(xlabel="θ₂ [degree]", ylabel="pressure [bar]", xticks=np.arange(0, 721, 90), title="over the crank angle")
right.plot(volume * 1e3, pressure / 1e5)
right.set(xlabel="volume [litre]", ylabel="pressure [bar]", title="over the volume: the area is the work")
for ax in (left, right):
    ax.grid(alpha=0.3)

# %% [markdown]
# ## Gas force and inertia force
#
# Along the cylinder, upwards positive, the gas pushes the piston down with (p − p₀)·A. To accelerate the piston takes force too:
# its inertia force is −m·a. At this speed it pulls against the gas at top dead centre, and loads the rod in tension at the top
# of the exhaust stroke, when no gas holds against it.

# %%
gas_force = -(pressure - gas.crankcase) * area
inertia_force = -engine.slider_mass * cycle.a_slider

fig, ax = plt.subplots(figsize=(10, 3.6), layout="constrained")
ax.plot(theta2, gas_force / 1e3, label="gas")
ax.plot(theta2, inertia_force / 1e3, label="inertia of the piston")
ax.plot(theta2, (gas_force + inertia_force) / 1e3, "k", linewidth=1, label="together")
ax.set(xlabel="θ₂ [degree]", ylabel="force on the piston, upwards [kN]", xticks=np.arange(0, 721, 90))
ax.legend(loc="lower right")
ax.grid(alpha=0.3)

# %% [markdown]
# ## The bearings
#
# The load diagram of the main bearing is drawn in ground axes: F21, the force of the crank on the housing. It points down when the
# mixture burns, so the lower shell takes that load, and swings round with the inertia of piston and rod in the other strokes.

# %%
ax = cycle.linksweep.bearing("F21")
# %% [markdown]
# The crank pin turns with the crank, so its diagram is drawn in the crank's axes: F32, the force of the rod on the pin. It says on
# which side the pin wears, and where an oil hole may be drilled: where there is no load.

# %%
ax = cycle.linksweep.bearing("F32", frame="link")
# %% [markdown]
# ## The torque
#
# T12 is what a drive must give to keep the crank at its speed; an engine gives, so its mean is negative. What the engine delivers is
# −T12: one push in two revolutions, and a flywheel for the rest.

# %%
delivered = -cycle.T12
mean = float(delivered.mean())
fig, ax = plt.subplots(figsize=(10, 3.6), layout="constrained")
ax.plot(theta2, delivered)
ax.axhline(mean, color="k", linewidth=1, linestyle="--")
ax.annotate(f"mean {mean:.1f} N m", (715, mean), (0, 4), textcoords="offset points", ha="right")
ax.set(xlabel="θ₂ [degree]", ylabel="torque delivered [N m]", xticks=np.arange(0, 721, 90))
ax.grid(alpha=0.3)

# %% [markdown]
# The numbers for the report come from `peaks`, which also looks at both sides of each jump: that of the pressure at the dead
# centres, and that of friction where the piston turns round.

# %%
worst = ls.peaks(scene)
for pin, name in {"F12": "main bearing", "F32": "crank pin", "F43": "piston pin", "F14": "cylinder wall"}.items():
    print(f"{name:13} {pin}: {float(worst[f'{pin}_peak']) / 1e3:6.2f} kN at {float(worst[f'{pin}_peak_at']):5.1f}°")
print(f"power delivered: {mean * scene.omega2 / 1e3:.1f} kW at 3000 rpm")

# %% [markdown]
# ## Can we trust them?
#
# An ideal Otto cycle has the efficiency 1 − r^(1−γ), so the work of a cycle is known in closed form. Without friction, the torque must
# deliver that work, whatever the masses, for what goes into inertia and gravity comes back.

# %%
ideal = replace(scene, mechanism=replace(engine, friction=0.0))
delivered_work = -float(ls.sweep(ideal, 7200, of=["T12"]).T12.mean()) * 4 * np.pi  # 720° are 4π
r, gamma = otto.compression_ratio, otto.gamma
compressed = otto.intake_pressure * r**gamma
heat = (otto.peak_pressure - compressed) * swept / (r - 1) / (gamma - 1)
closed_form = (1 - r ** (1 - gamma)) * heat
residual = float(abs(ls.sweep(scene, of=["power_residual"]).power_residual).max())
print(f"work of a cycle from the torque:   {delivered_work:.3f} J")
print(f"work of a cycle in closed form:    {closed_form:.3f} J")
print(f"friction takes {100 * (1 - mean * 4 * np.pi / closed_form):.1f} % of it")
print(f"power balance, relative to the largest term: {residual:.1e}")
assert abs(delivered_work / closed_form - 1) < 1e-3
assert residual < 1e-12

# %% [markdown]
# ## Which speed?
#
# A study: the speed as a DataArray. Below some speed the gas decides how hard the crank pin is loaded, and inertia, which works against
# it at top dead centre, is a relief. Above, inertia alone decides, and its load grows with the square of the speed.

# %%
speeds = np.linspace(500, 9000, 35)
study = replace(scene, omega2=xr.DataArray(speeds * rpm, {"rpm": speeds}, "rpm"))
load = ls.peaks(study, of=["F32"]).F32_peak
motored = ls.peaks(replace(study, loads=[]), of=["F32"]).F32_peak
least = float(load.idxmin())
fig, ax = plt.subplots(figsize=(10, 3.6), layout="constrained")
ax.plot(speeds, load / 1e3, label="fired")
ax.plot(speeds, motored / 1e3, "--", label="inertia alone")
ax.plot(least, float(load.min()) / 1e3, "ko")
ax.annotate(f"least at {least:.0f} rpm", (least, float(load.min()) / 1e3), (10, -14), textcoords="offset points")
ax.set(xlabel="speed [rpm]", ylabel="largest crank-pin load [kN]", ylim=(0, None))
ax.legend()
ax.grid(alpha=0.3)

# %% [markdown]
# ## A flywheel
#
# The crank's speed was prescribed so far. In truth it gains where the gas pushes and loses it again in the other three strokes.
# How large a flywheel keeps the fluctuation, largest less least speed over their mean, down to 1 %?

# %%
wheel = ls.flywheel(scene, fluctuation=0.01)
ls.plot.flywheel(wheel)
print(f"{float(wheel.energy_fluctuation):.0f} J to store, of {-float(wheel.drive_torque) * 4 * np.pi:.0f} J a cycle")
# %% [markdown]
# ## More cylinders
#
# More than one cylinder on a crankshaft evens out the torque, and shaking forces can cancel each other. In an inline four the
# outer cranks stand opposite to the inner ones: two pistons rise while two fall, and the first order is gone. But all four second
# orders come to the same side at the same time. In a 90° V-twin the two first orders, at a right angle in space and in time, add
# up to one vector that turns with the crank. That, a counterweight can carry.

# %%
four = ls.MultiCylinder(scene, crank_angles=[0, 540, 180, 360], positions=[-0.15, -0.05, 0.05, 0.15])
throw = ls.with_counterweights(scene, ls.counterweights(scene, radius=0.05, fraction=0.5))
machines = {
    "one cylinder": ls.MultiCylinder(scene, [0]),
    "inline four": four,
    "V-twin": ls.MultiCylinder(scene, crank_angles=[0, 0], bank_angles=[45, -45]),
    "V-twin, counterweight": ls.MultiCylinder(throw, crank_angles=[0, 0], bank_angles=[45, -45]),
}
sweeps = {name: machine.sweep() for name, machine in machines.items()}
harmonics = {name: ls.orders(ds, ["Fsx", "Fsy"], n=4).sel(order=[1, 2, 3, 4]) for name, ds in sweeps.items()}

fig, panels = plt.subplots(1, 4, figsize=(13, 3.4), sharey=True, layout="constrained")
for ax, (name, force) in zip(panels, harmonics.items(), strict=True):
    ax.bar(force.order - 0.2, force.Fsx_amplitude / 1e3, 0.4, label="sideways")
    ax.bar(force.order + 0.2, force.Fsy_amplitude / 1e3, 0.4, label="up and down")
    ax.set(title=name, xlabel="order", xticks=force.order)
    ax.grid(alpha=0.3)
panels[0].set_ylabel("shaking force [kN]")
legend = panels[0].legend(fontsize="small")

# %% [markdown]
# These are the textbook's results. The inline four keeps 4 times the second order of one cylinder. The balanced V-twin keeps √2
# times as much, across the middle of its V, and no first order. And the torque of four cylinders, against that of one:

# %%
first, second = (float(harmonics["one cylinder"].Fsy_amplitude.sel(order=k)) for k in (1, 2))
inline, balanced = harmonics["inline four"], harmonics["V-twin, counterweight"]
print(f"inline four: {float(inline.Fsy_amplitude.sel(order=2)) / second:.6f} times the second order of one cylinder")
print(f"V-twin:      {float(balanced.Fsx_amplitude.sel(order=2)) / second:.6f} times")
assert float(inline.sel(order=[1, 3]).Fsy_amplitude.max()) < 1e-10 * first
assert float(balanced[["Fsx_amplitude", "Fsy_amplitude"]].sel(order=1).to_dataarray().max()) < 1e-10 * first

fig, ax = plt.subplots(figsize=(10, 3.6), layout="constrained")
for name in ("one cylinder", "inline four"):
    ax.plot(theta2, -sweeps[name].T12, label=name)
ax.set(xlabel="θ₂ [degree]", ylabel="torque delivered [N m]", xticks=np.arange(0, 721, 90))
ax.legend()
ax.grid(alpha=0.3)

# %% [markdown]
# ## A measured diagram
#
# With a measured diagram the pressure stands in a CSV file beside the scene file, with its columns named in the first line. Between
# the samples it is interpolated, by default by a periodic cubic spline. Where a diagram jumps, a spline leaves the range of the
# samples, and linksweep warns of it; `interpolation = "pchip"` stays within them. (Here the "measurement" is the ideal cycle every 4°.)

# %%
folder = Path(tempfile.mkdtemp())
samples = np.arange(0, 720, 4)
rows = [f"{angle},{p:.4f}" for angle, p in zip(samples, otto.pressure(engine, samples).values / 1e5, strict=True)]
(folder / "indicator.csv").write_text("\n".join(["theta2,p", *rows]))
(folder / "engine.toml").write_text("""
omega2 = "3000 rpm"
gravity = [0, "-9.81 m/s^2"]

[mechanism]
type = "SliderCrank"
slide_angle = 90
slider_mass = "0.45 kg"
friction = 0.05
crank = {length = "43 mm", mass = "3 kg", inertia = "8e-3 kg m^2"}
rod = {length = "145 mm", mass = "0.6 kg", inertia = "2.2e-3 kg m^2", cg_distance = "45 mm"}

[[loads]]
type = "GasPressure"
bore = "86 mm"
pressure = {csv = "indicator.csv", column = "p", unit = "bar"}
interpolation = "pchip"
""")
measured = ls.sweep(ls.load_scene(folder / "engine.toml"))
print(f"mean torque delivered: {-float(measured.T12.mean()):.1f} N m, with the cycle itself {mean:.1f} N m")
assert abs(float(measured.T12.mean()) / mean + 1) < 0.05
