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
# # A final project: choose values, find the highest forces
#
# The sheet *ME 470 Final Project* leads through a four-bar in one table: choose a, b, c, d, ω2, α2; angles, speeds,
# accelerations; masses and R vectors; a 9×9 matrix. And it says what all that is for: do it "at all possible values of θ2", to
# see where the forces will be the highest. We follow the sheet formula by formula in numpy, with linksweep beside it as the
# second opinion. Then we let linksweep do the part that the sheet leaves to the eye.

# %%
import tempfile
from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import linksweep as ls

# %% [markdown]
# ## Choose values
#
# A pusher that moves cartons off a belt: the rocker's tip pushes with 25 lbf, the coupler carries a 10 lb tool. The crank is a
# "circle link", coupler and rocker are "bar links", all of steel. The sheet leaves the units open, "slugs, blobs, or kg". A scene
# file takes them as they come.

# %%
project = Path(tempfile.mkdtemp()) / "pusher.toml"
project.write_text("""
omega2 = "150 rpm"

[mechanism]
type = "FourBar"
ground = "7.5 in"
crank = {type = "Disk", length = "2 in", radius = "2.5 in", thickness = "0.5 in", density = "0.283 lb/in^3"}
coupler = {type = "Bar", length = "7 in", width = "1 in", thickness = "0.5 in", density = "0.283 lb/in^3"}
rocker = {type = "Bar", length = "5 in", width = "1 in", thickness = "0.5 in", density = "0.283 lb/in^3"}

[[loads]]
link = "coupler"
force = [0, "-10 lbf"]
at = ["3.5 in", "20 deg"]

[[loads]]
link = "rocker"
force = ["-25 lbf", 0]
at = ["5 in", 0]
""")
pusher = ls.load_scene(project)
machine = pusher.mechanism
ls.check(pusher).linksweep

# %% [markdown]
# The file becomes SI at the door. In the sheet's letters:

# %%
a, b, c, d = machine.lengths().values()
omega2, alpha2 = pusher.omega2, 0.0
m2, m3, m4 = (link.mass for link in (machine.crank, machine.coupler, machine.rocker))
I2, I3, I4 = (link.inertia for link in (machine.crank, machine.coupler, machine.rocker))
s, p, u = 0.0, b / 2, c / 2  # centres of gravity: the disk's on its pin, the bars' in the middle, so that all δ are 0
inch, pound, gravity = 0.0254, 0.45359237, 9.80665

assert np.isclose(m2, 0.283 * pound / inch**3 * np.pi * (2.5 * inch) ** 2 * 0.5 * inch)
assert np.isclose(I2, m2 * (2.5 * inch) ** 2 / 2)  # circle link
assert np.isclose(I3, m3 * ((1 * inch) ** 2 + b**2) / 12)  # bar link
blob = pound * gravity / inch  # kg
pd.DataFrame({"kg": [m2, m3, m4], "blob": [m2 / blob, m3 / blob, m4 / blob], "kg m²": [I2, I3, I4]}, index=[2, 3, 4])

# %% [markdown]
# ## Position
#
# Freudenstein's equations give two solutions, ±, and the sheet does not say which is which. linksweep calls them open and
# crossed. `ls.position_equation` has K1 … K5 and A … F as on the sheet; the roots are taken here, by the sheet's
# formula.

# %%
theta2 = np.arange(360.0)
cos, sin = np.cos(np.radians(theta2)), np.sin(np.radians(theta2))
page = ls.position_equation(pusher, theta2)
A, B, C, D, E, F = (page[letter].values for letter in "ABCDEF")

for sign, name in ((-1, "−"), (1, "+")):
    theta3 = 2 * np.arctan((-E + sign * np.sqrt(E**2 - 4 * D * F)) / (2 * D))
    theta4 = 2 * np.arctan((-B + sign * np.sqrt(B**2 - 4 * A * C)) / (2 * A))
    for branch in ("open", "crossed"):
        ours = page.sel(branch=branch)
        apart = np.exp(1j * np.array([theta3, theta4])) - np.exp(1j * np.radians([ours.theta3, ours.theta4]))
        print(f"{name} and {branch:8}: up to {abs(apart).max():.1e} apart")

page.sel(theta2=[0, 45, 90])[["K1", "K2", "K3", "K4", "K5", *"ABCDEF"]].to_dataframe().round(4)

# %% [markdown]
# So − is open and + is crossed. Ours is the open one. Its transmission angle: the sheet's μ = θ4 − θ3 passes 90°, and what
# matters is how far it is from there. linksweep has it as `transmission_angle_signed`, and folds it to an acute angle.

# %%
theta3 = 2 * np.arctan((-E - np.sqrt(E**2 - 4 * D * F)) / (2 * D))
theta4 = 2 * np.arctan((-B - np.sqrt(B**2 - 4 * A * C)) / (2 * A))
mu = np.degrees(theta4 - theta3)
cycle = ls.sweep(pusher, theta2, of=["transmission_angle", "transmission_angle_signed"])
assert np.allclose(mu, cycle.transmission_angle_signed)

fig, ax = plt.subplots(figsize=(8, 3.2), layout="constrained")
ax.plot(theta2, mu, label="μ = θ4 − θ3")
ax.plot(theta2, cycle.transmission_angle, "--", label="transmission angle")
ax.set(xlabel="θ₂ [°]", ylabel="angle [°]", xticks=np.arange(0, 361, 45), ylim=(0, 120))
ax.legend(loc="lower right")
ax.grid(alpha=0.3)
print(f"μ up to {mu.max():.1f}°, least transmission angle {float(cycle.transmission_angle.min()):.1f}°")

# %% [markdown]
# ## Speeds and accelerations
#
# The sheet's next two blocks, word for word. Centres of gravity as complex numbers, x + jy.

# %%
t2 = np.radians(theta2)
omega3 = a * omega2 * np.sin(theta4 - t2) / (b * np.sin(theta3 - theta4))
omega4 = a * omega2 * np.sin(t2 - theta3) / (c * np.sin(theta4 - theta3))

A, B = c * np.sin(theta4), b * np.sin(theta3)
C = a * alpha2 * sin + a * omega2**2 * cos + b * omega3**2 * np.cos(theta3) - c * omega4**2 * np.cos(theta4)
D, E = c * np.cos(theta4), b * np.cos(theta3)
F = a * alpha2 * cos - a * omega2**2 * sin - b * omega3**2 * np.sin(theta3) + c * omega4**2 * np.sin(theta4)
alpha3, alpha4 = (C * D - A * F) / (A * E - B * D), (C * E - B * F) / (A * E - B * D)


def acceleration(length, angle, omega, alpha):
    """Of a point at the end of a vector that turns."""
    return length * (1j * alpha - omega**2) * np.exp(1j * angle)


aG2 = acceleration(s, t2, omega2, alpha2)
aG3 = acceleration(a, t2, omega2, alpha2) + acceleration(p, theta3, omega3, alpha3)
aG4 = acceleration(u, theta4, omega4, alpha4)

ours = ls.sweep(pusher, theta2, of=["omega3", "omega4", "alpha3", "alpha4", "aG3x", "aG4y"])
for name, sheet in {"omega4": omega4, "alpha3": alpha3, "aG3x": aG3.real, "aG4y": aG4.imag}.items():
    print(f"{name}: up to {abs(sheet).max():8.3f}, apart by {float(abs(sheet - ours[name]).max()):.0e}")

# %% [markdown]
# ## Forces
#
# R vectors from the centres of gravity to the pins, and the 9×9, for all 360 angles at once. "R_23" of the sheet must read R_23x.
# The external loads F_P3 and F_P4 act at R_P3 and R_P4.


# %%
def polar(length, angle):
    return length * np.exp(1j * angle)


R12, R23, R14 = -polar(s, t2), -polar(p, theta3), -polar(u, theta4)
R32, R43, R34 = polar(a, t2) + R12, polar(b, theta3) + R23, polar(c, theta4) + R14
ours = ls.sweep(pusher, theta2, of=["R43x", "R34y"])
assert np.allclose(R43.real, ours.R43x) and np.allclose(R34.imag, ours.R34y)
FP3, FP4 = -10j * pound * gravity, -25 * pound * gravity
RP3 = polar(3.5 * inch, theta3 + np.radians(20)) + R23
RP4 = polar(5 * inch, theta4) + R14


def moment(R, force):
    return R.real * force.imag - R.imag * force.real


at_pins = [  # of each link: the force's column, its arm, and −1 where the unknown is the opposite one
    [(0, R12, 1), (2, R32, 1)],
    [(2, R23, -1), (4, R43, 1)],
    [(4, R34, -1), (6, R14, 1)],
]


def solved(weight3=0.0, weight4=0.0):
    """The sheet's nine unknowns over θ2; its right side has no weights, but they are loads like others."""
    matrix, rhs = np.zeros((360, 9, 9)), np.zeros((360, 9))
    for link, pins in enumerate(at_pins):
        for column, R, side in pins:
            matrix[:, 3 * link, column] = matrix[:, 3 * link + 1, column + 1] = side
            matrix[:, 3 * link + 2, column], matrix[:, 3 * link + 2, column + 1] = -side * R.imag, side * R.real
    matrix[:, 2, 8] = 1
    loads = (0, 0, 0), (FP3, moment(RP3, FP3), -1j * weight3), (FP4, moment(RP4, FP4), -1j * weight4)
    inertia = (m2 * aG2, I2 * alpha2), (m3 * aG3, I3 * alpha3), (m4 * aG4, I4 * alpha4)
    for link, ((force, turn, weight), (ma, torque)) in enumerate(zip(loads, inertia, strict=True)):
        resting = ma - force - weight
        rhs[:, 3 * link], rhs[:, 3 * link + 1], rhs[:, 3 * link + 2] = resting.real, resting.imag, torque - turn
    return np.linalg.solve(matrix, rhs[..., None])[..., 0]


unknowns = ["F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y", "T12"]
ours = ls.sweep(pusher, theta2, of=unknowns).to_dataframe()[unknowns]
print(f"largest {abs(ours).max().max():.1f} N; sheet and linksweep apart by {abs(solved() - ours).max().max():.0e}")

# %% [markdown]
# The sheet has no weights and none of the links are light. Put them in, as forces at the centres of gravity, and as `gravity` in
# the scene:

# %%
heavy = replace(pusher, gravity=(0.0, -gravity))
ours = ls.sweep(heavy, theta2, of=unknowns).to_dataframe()[unknowns]
with_weights = solved(m3 * gravity, m4 * gravity)
with_weights[:, 1] += m2 * gravity  # the crank's own hangs in pin A alone
print(f"sheet and linksweep apart by {abs(with_weights - ours).max().max():.0e}")
print(f"weights change F12y by {abs(with_weights - solved())[:, 1].mean():.1f} N on average")

# %% [markdown]
# ## Where are they the highest?
#
# All that was the preparation. One line in linksweep, and one look:

# %%
cycle = ls.sweep(heavy)
ax = cycle.linksweep.forces()
# %%
worst = ls.peaks(heavy)
pins = {"A": "F12", "B": "F32", "C": "F43", "D": "F14"}
table = pd.DataFrame({"force [N]": {pin: float(worst[f"{f}_peak"]) for pin, f in pins.items()}})
table["force [lbf]"] = table["force [N]"] / (pound * gravity)
table["at θ2 [°]"] = [float(worst[f"{f}_peak_at"]) for f in pins.values()]
table.round(2)

# %%
ax = cycle.linksweep.mechanism(theta2=float(worst.F12_peak_at), forces=True)
# %% [markdown]
# Pin A, where the crank turns in the frame, bears most. Had we done the table by hand, with a row every 30° or every 10°, how
# much of the peaks would we have seen?

# %%
for step in (30, 10, 1):
    seen = ls.sweep(heavy, 360 // step, of=list(pins.values()))
    short = {pin: 100 * (1 - float(seen[f].max() / worst[f"{f}_peak"])) for pin, f in pins.items()}
    print(f"every {step:2}°: " + ", ".join(f"pin {pin} {missing:5.2f} % short" for pin, missing in short.items()))

# %% [markdown]
# Ten degrees would have done. Nobody knows that before; a linkage that comes near a toggle has peaks a degree wide. `ls.peaks`
# finds the peak of the continuous revolution.
#
# ## Why there?
#
# `breakdown` splits a force into the parts of its sources, over the cycle:

# %%
shares = ls.breakdown(heavy, "F12")
ax = ls.plot.breakdown(shares)
# %% [markdown]
# At 150 rpm it is the push that counts, not the inertia: the pusher could run faster. How fast, if no pin is to bear more than 60
# lbf?

# %%
limit = 60 * pound * gravity
fastest = {pin: float(ls.speed_limit(heavy, f, below=limit).omega2_limit) * 30 / np.pi for pin, f in pins.items()}
first = min(fastest, key=fastest.get)
print({pin: f"{rpm:.0f} rpm" for pin, rpm in fastest.items()})
ax = ls.plot.over_speed(heavy, pins[first], speeds=np.linspace(0, 1.3, 27) * fastest[first] * np.pi / 30, below=limit)
# %% [markdown]
# Inertia at first even relieves pin A; only at five times the speed does it reach 60 lbf. The sheet's question is answered,
# for this speed and the others.

# %%
assert first == "A" and 700 < fastest[first] < 800
assert abs(with_weights - ours).max().max() < 1e-10
