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
# # A worked example, line by line
#
# Every course on machines has this page: a four-bar at one crank angle, three free-body diagrams, nine equations, a 9×9 matrix,
# nine numbers. Here is one such page, *Matrix Dynamic Analysis for Four Bar*, compared with linksweep's results for the same
# machine. Its third digits do not hold, a velocity points the wrong way, a row of its matrix has the wrong signs, and one
# dimension is missing. All of this can be seen without knowing the right answer, and that is what this notebook is
# about.

# %%
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.patches import Rectangle

import linksweep as ls

# %% [markdown]
# ## The numbers that the page states, and those that it lacks
#
# Three uniform bars of stainless steel, 2 × 2 cm, of 7.75 g/cm³, in a vertical plane. The crank stands at 45°, turns clockwise at
# 20 rad/s and is accelerated counter-clockwise by 100 rad/s². The page gives masses, and no lengths. But a bar of known section
# weighs what its length says:

# %%
steel = {"width": 0.02, "thickness": 0.02, "density": 7750.0}  # m, kg/m³
printed_mass = {"crank": 0.248, "coupler": 0.372, "rocker": 0.341}  # kg
for link, mass in printed_mass.items():
    print(f"{link:8} {100 * mass / (7750.0 * 0.02 * 0.02):5.1f} cm")

# %% [markdown]
# The ground's length has no mass to betray it. The loop does: crank and coupler, one behind the other, end where the rocker ends,
# so with the printed angles of 45°, 20° and 117.4° the vectors a + b − c must add up to d.

# %%
a, b, c = 8 * np.exp(1j * np.radians(45.0)), 12 * np.exp(1j * np.radians(20.0)), 11 * np.exp(1j * np.radians(117.4))
print(f"a + b − c = {a + b - c:.3f} cm")

# %% [markdown]
# 22 cm, and along x to 0.1 mm: the misfit is that of angles rounded to 0.1°. Now the machine is known.

# %%
crank, coupler, rocker = (ls.Bar(length=length, **steel) for length in (0.08, 0.12, 0.11))
page = ls.Scene(ls.FourBar(crank, coupler, rocker, ground=0.22), omega2=-20.0, alpha2=100.0, gravity=(0.0, -9.81))
ax = ls.sweep(page).linksweep.mechanism(theta2=45.0, forces=True)
# %% [markdown]
# ## Motion
#
# What the page prints, and the same from the lengths:

# %%
printed = {"theta3": 20.0, "theta4": 117.4, "omega3": 12.82, "omega4": -6.20, "alpha3": -39.6, "alpha4": 482.5}
printed |= {"aG3x": -36.725, "aG3y": -22.609, "aG4x": -22.624, "aG4y": -14.124}  # m/s²
at_45 = ls.sweep(page, theta2=[45.0], of=list(printed)).isel(theta2=0)
motion = pd.DataFrame({"printed": printed, "computed": {name: float(at_45[name]) for name in printed}})
motion["off by [%]"] = 100 * (motion.printed / motion.computed - 1)
motion.round(3)

# %% [markdown]
# The page goes on from angles rounded to 0.1°. α3 suffers most, by half a percent: in it large terms nearly cancel.
#
# The page also lists the velocities of the centres of gravity, 30.27 − j 15.71 "cps" for that of the rocker ("cps" is cm/s). A
# rocker that turns clockwise and leans to the left takes its middle to the right and *up*. So the sign must be wrong, and it is:

# %%
rocker_middle = 5.5 * np.exp(1j * np.radians(float(at_45.theta4)))  # cm from D
print(f"V_G4 = {1j * float(at_45.omega4) * rocker_middle:.2f} cm/s")

# %% [markdown]
# ## Nine equations
#
# ΣFx, ΣFy and ΣM about the centre of gravity, for each of three links; eight components of pin forces and the torque of the
# drive. `ls.system` writes them down.

# %%
ours = ls.system(page, theta2=45.0).isel(theta2=0)
ours.matrix.to_pandas().round(5)

# %% [markdown]
# The page takes F23 and F34 as unknowns where most books take F32 and F43, so four columns change sign; and it counts in cm. Its
# own numbers, in newtons and metres and in our order:

# %%
printed_matrix = np.array(
    [
        [1, 0, -1, 0, 0, 0, 0, 0, 0],
        [0, 1, 0, -1, 0, 0, 0, 0, 0],
        [2.828, -2.828, 2.828, -2.828, 0, 0, 0, 0, 1],
        [0, 0, 1, 0, -1, 0, 0, 0, 0],
        [0, 0, 0, 1, 0, -1, 0, 0, 0],
        [0, 0, 2.052, -5.638, 2.052, -5.638, 0, 0, 0],
        [0, 0, 0, 0, 1, 0, 1, 0, 0],
        [0, 0, 0, 0, 0, 1, 0, 1, 0],
        [0, 0, 0, 0, -4.883, -2.531, 4.883, 2.531, 0],
    ]
)  # unknowns F12, F23, F34, F14 [N], T12 [N cm]; arms in cm
printed_rhs = np.array([-3.507, 0.329, 1.405, -13.662, -4.762, -1.817, -7.715, -1.471, 17.138])  # N, N cm
moments = [2, 5, 8]  # rows ΣM
to_ours = np.array([1, 1, -1, -1, -1, -1, 1, 1, 1.0])  # F23 = −F32, F34 = −F43


def in_metres(matrix, rhs):
    """The page's system in F12, F32, F43, F14 [N] and T12 [N m]."""
    matrix, rhs = matrix * to_ours, rhs.copy()
    matrix[moments, :8] /= 100
    rhs[moments] /= 100
    return matrix, rhs


def draw(ax, matrix, title, marked=()):
    """A matrix as one writes it, arms in cm: nothing where it is 0, blue where positive, red where negative."""
    ax.imshow(np.sign(matrix), cmap="RdBu", vmin=-4, vmax=4)
    for (i, j), entry in np.ndenumerate(matrix):
        if entry:
            text = f"{entry:.0f}" if abs(entry) == 1 else f"{100 * entry:.3f}"
            ax.text(j, i, text, ha="center", va="center", fontsize=8)
    for row in marked:
        ax.add_patch(Rectangle((-0.5, row - 0.5), 9, 1, fill=False, edgecolor="black", linewidth=2))
    ax.set_xticks(range(9), [f"${name[0]}_{{{name[1:]}}}$" for name in ours.unknown.values])
    ax.set_yticks(range(9), ours.equation.values)
    ax.tick_params(length=0)
    ax.set_title(title, loc="left")


matrix, rhs = in_metres(printed_matrix, printed_rhs)
fig, (left, right) = plt.subplots(1, 2, figsize=(13, 5.4), layout="constrained")
draw(left, matrix, "the page's numbers")
draw(right, ours.matrix.values, "ls.system(page, theta2=45.0)")
right.set_yticks([])
print(f"largest difference of an arm: {1000 * abs(matrix - ours.matrix.values).max():.3f} mm")

# %% [markdown]
# The same matrix, to what 0.1° moves a bar of 6 cm. The unknowns, from the page's own numbers and from ours:

# %%
cycle = ls.sweep(page, theta2=[45.0]).isel(theta2=0)
unknowns = pd.DataFrame(
    {
        "printed": [-22.236, -6.221, 18.729, 6.550, 5.067, 1.788, -2.648, 0.317, 0.81135],
        "page's matrix solved": np.linalg.solve(matrix, rhs),
        "our matrix solved": np.linalg.solve(ours.matrix.values, ours.rhs.values),
        "ls.sweep": [float(cycle[name]) for name in ours.unknown.values],
    },
    index=ours.unknown.values,
)
unknowns.round(4)

# %% [markdown]
# The page solved its matrix correctly; the third digit is lost in the angles before that. And `ls.sweep`, which never builds a
# matrix, says the same as ours: it eliminates these nine equations by hand.

# %%
assert abs(unknowns["printed"] - unknowns["page's matrix solved"]).max() < 0.002
assert abs(unknowns["our matrix solved"] - unknowns["ls.sweep"]).max() < 1e-12

# %% [markdown]
# ## The row with the wrong signs
#
# The page writes its matrix twice, in symbols and in numbers. In symbols, the third row (moments on the crank) begins with
# +rA2y and −rA2x; the equation above it says −rA2y and +rA2x. The arm from G2 to A is (−2.828, −2.828) cm.
# Suppose one had trusted the symbols:

# %%
as_in_symbols = matrix.copy()
as_in_symbols[2, :2] *= -1
fig, ax = plt.subplots(figsize=(6.8, 5.4), layout="constrained")
draw(ax, as_in_symbols, "row 3 as the symbols have it", marked=[2])

# %% [markdown]
# The result has no look of being wrong: the forces stay what they were, and only the torque changes. So how does one notice? By
# energy, which is not among the nine equations. What the drive feeds in, T12·ω2, must be what kinetic energy and height take up:

# %%
balance = ls.sweep(page, theta2=[45.0], of=["power", "inertia_power", "gravity_power"]).isel(theta2=0)
taken_up = -float(balance.inertia_power + balance.gravity_power)
for label, system in {"row 3 in numbers": matrix, "row 3 in symbols": as_in_symbols}.items():
    torque = np.linalg.solve(system, rhs)[8]
    print(f"{label}: T12 = {100 * torque:7.3f} N cm, feeds {torque * page.omega2:7.3f} W of {taken_up:7.3f} W")

# %% [markdown]
# 16 W flow back into the motor at this instant, and only the first torque says so. linksweep makes this check for every sample of
# every design with `of=["power_residual"]`.
#
# ## Does it turn?
#
# The page never asks. 8 + 22 > 12 + 11, so no link of this four-bar turns fully: it is a triple rocker. The crank comes to a stop
# where coupler and rocker lie in one line, and near there everything grows without bound:

# %%
print(ls.check(page).linksweep)
torques = ls.sweep(page, theta2=[45.0, 80.0, 86.0]).T12.values
print("T12 at 45°, 80°, 86°:", *(f"{torque:.1f} N m" for torque in torques))
ax = ls.sweep(page).linksweep.forces(["F12", "F43"])
# %% [markdown]
# ## The slider-crank on the next page
#
# It is in symbols only, with a force P on the slider and friction, F14x = −μ·|F14y|·sign(v). Its matrix has ten columns for nine
# unknowns. The tenth is empty and does no harm; let us put numbers into the rest, just as it stands.

# %%
smooth_crank = ls.Link(length=0.05, mass=1.0, inertia=1e-3)  # balanced at A, as there
machine = ls.SliderCrank(smooth_crank, ls.Bar(length=0.15, **steel), slider_mass=0.3, friction=0.2)
pump = ls.Scene(machine, omega2=20.0, loads=[ls.Load("slider", force=-200.0)])


def as_printed(theta2, mended=False):
    """The page's slider-crank at a crank angle [degree]: matrix and right side in F12, F23, F34, F14 and T12."""
    now = ls.sweep(pump, [theta2], of=["theta3", "alpha3", "aG3x", "aG3y", "a_slider", "v_slider"]).isel(theta2=0)
    rod = machine.rod
    theta, phi = np.radians(theta2), -np.radians(float(now.theta3))
    AB, half = machine.crank.length, rod.length / 2
    matrix = np.array(
        [
            [1, 0, -1, 0, 0, 0, 0, 0, 0],
            [0, 1, 0, -1, 0, 0, 0, 0, 0],
            [0, 0, AB * np.sin(theta), -AB * np.cos(theta), 0, 0, 0, 0, 1],
            [0, 0, 1, 0, -1, 0, 0, 0, 0],
            [0, 0, 0, 1, 0, -1, 0, 0, 0],
            [0, 0, -half * np.sin(phi), -half * np.cos(phi), half * np.sin(phi), half * np.cos(phi), 0, 0, 0],
            [0, 0, 0, 0, 1, 0, 1, 0, 0],
            [0, 0, 0, 0, 0, 1, 0, 1, 0],
            [0, 0, 0, 0, 0, 0, 1, machine.friction * np.sign(float(now.v_slider)), 0],
        ]
    )
    if mended:
        matrix[5, 4:6] *= -1
    of_rod = rod.mass * float(now.aG3x), rod.mass * float(now.aG3y), rod.inertia * float(now.alpha3)
    of_slider = machine.slider_mass * float(now.a_slider) + 200.0  # m4 a − P
    return matrix, np.array([0, 0, 0, *of_rod, of_slider, 0, 0])


print("rank of the page's matrix:", np.linalg.matrix_rank(as_printed(60.0)[0]))

# %% [markdown]
# Eight: it has no solution. Row 6, the moments on the rod, is to blame. Its equation has F43, the unknown is F34 = −F43, and the
# signs were not turned with it. With the centre of gravity in mid-rod the row then says nothing that rows 4 and 5 have not said
# before. Mended:

# %%
angles = [60.0, 150.0, 240.0, 330.0]
ours = ls.sweep(pump, angles, of=["F14y", "T12"]).drop_vars("status").to_pandas()
ours["T12, page mended"] = [np.linalg.solve(*as_printed(theta2, mended=True))[8] for theta2 in angles]
ours.round(3)

# %% [markdown]
# The torques agree as long as the guide pushes upwards. Where F14y is negative they part: the page's last row drops the |…| of
# its own law, and friction then pushes the slider along. `ls.system` takes the sign that agrees with the solution.
#
# ## The same equations in two other documents
#
# *ME 470 Final Project* has arms as R vectors, F32 and F43 as unknowns, and loads on links 3 and 4: the form of `ls.system`. (One
# of its R vectors, "R_23", should read R_23x; and there are no weights in it.) *Lecture 17* writes out ΣT on the crank: its third
# term must be −R32y·F32x, and T12 is missing. It then takes a slider-crank whose T12 is known. Accelerations are prescribed there
# too, so some other torque must be unknown, and T13, on the rod, makes the matrix square again. Here this is `drive="coupler"`.
# Its matrix has T14 and the trivial row T14 = 0, which `form="document"` prints; our friction adds F14x and a row to its nine:

# %%
lecture = ls.Scene(machine, omega2=20.0, drive="coupler", loads=[ls.Load("crank", torque=2.0)])
driven = ls.system(lecture, theta2=30.0, form="document").isel(theta2=0)
print(*driven.unknown.values)
driven.matrix.sel(equation=[name for name in driven.equation.values if " M " in name]).to_pandas().round(4)

# %% [markdown]
# Lecture 17 ends with a rocket car in a loop (example 17-4): 100 m/s at 30° above the bottom, 10 kN of thrust, 700 kg, 30 m. Two
# unknowns, and a matrix that needs no solving. The page has F_N = 239 kN and a_T = 9.38 m/s², and these are right; but it calls
# the acceleration +v²/R "with the outward normal positive", and it points inwards.

# %%
rocket = ls.LoopTrack(radius=30.0, mass=700.0)
car = ls.Scene(rocket, speed=100.0, thrust=10_000.0, gravity=(0.0, -9.81), profile="constant")
at_30 = ls.sweep(car, [30.0]).isel(theta=0)
print(f"F_N = {float(at_30.normal_force) / 1000:.3f} kN, a_T = {float(at_30.a_tangential):.4f} m/s²")
print(f"a_R = {float(at_30.a_radial):.1f} m/s² towards the centre")
ls.system(car, 30.0).matrix.isel(theta=0).to_pandas()
