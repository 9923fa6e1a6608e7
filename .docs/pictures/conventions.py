"""The drawings of the conventions: `python .docs/pictures/conventions.py` writes them beside this file.

The machines are drawn by `ls.plot.mechanism`; angles, and the arrow of a load, are added here.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc, FancyArrowPatch
from matplotlib.spines import Spine
from matplotlib.text import Text
from matplotlib.transforms import Bbox

import linksweep as ls

HERE = Path(__file__).parent
BLUE, RED, GREY = "#0072B2", "#D55E00", "0.35"
STEEL = {"width": 0.02, "thickness": 0.02, "density": 7750.0}  # m, kg/m³


def main() -> None:
    """Write four_bar.png and slider_crank.png."""
    plt.rcParams.update({"font.size": 11.0})
    for name, draw in {"four_bar": four_bar, "slider_crank": slider_crank}.items():
        fig, ax = plt.subplots(figsize=(7.0, 4.6), layout="constrained")
        draw(ax)
        finish(ax)
        fig.savefig(HERE / f"{name}.png", dpi=180, bbox_inches=drawn(ax))
        plt.close(fig)


def four_bar(ax: Axes) -> None:
    """Draw pins A to D, links 2 to 4, their angles, and a load on the coupler."""
    crank, coupler, rocker = (ls.Bar(length, **STEEL) for length in (0.08, 0.22, 0.18))
    scene = ls.Scene(ls.FourBar(crank, coupler, rocker, ground=0.20), omega2=30.0)
    theta2, distance, angle = 60.0, 0.12, 30.0
    ls.plot.mechanism(scene, theta2, ax=ax, link="coupler", point=(distance, angle))
    at = ls.sweep(scene, [theta2], of=["Bx", "By", "Cx", "Cy", "theta3", "theta4"]).isel(theta2=0)
    B, C, D = (float(at.Bx), float(at.By)), (float(at.Cx), float(at.Cy)), (0.20, 0.0)
    theta3, theta4 = float(at.theta3), float(at.theta4)
    turn(ax, (0.0, 0.0), 0.04, 0.0, theta2, r"$\theta_2$")
    turn(ax, B, 0.07, 0.0, theta3, r"$\theta_3$")
    turn(ax, D, 0.04, 0.0, theta4, r"$\theta_4$")
    load(ax, B, C, theta3, distance, angle)


def slider_crank(ax: Axes) -> None:
    """Draw pins A to C, links 2 to 4, the angles, the offset, and a load on the rod."""
    crank, rod = ls.Bar(0.08, **STEEL), ls.Bar(0.22, **STEEL)
    scene = ls.Scene(ls.SliderCrank(crank, rod, slider_mass=1.0, offset=0.02), omega2=30.0)
    theta2, distance, angle = 75.0, 0.10, 45.0
    ls.plot.mechanism(scene, theta2, ax=ax, link="rod", point=(distance, angle))
    at = ls.sweep(scene, [theta2], of=["Bx", "By", "theta3", "x_slider"]).isel(theta2=0)
    B, C = (float(at.Bx), float(at.By)), (float(at.x_slider), 0.02)
    turn(ax, (0.0, 0.0), 0.04, 0.0, theta2, r"$\theta_2$")
    turn(ax, B, 0.07, 0.0, float(at.theta3), r"$\theta_3$")
    load(ax, B, C, float(at.theta3), distance, angle)
    arrow(ax, (0.0, -0.06), (C[0], -0.06), GREY)
    ax.text(0.6 * C[0], -0.054, "x_slider", color=GREY, ha="center")
    ax.plot([C[0]] * 2, [C[1], -0.06], color=GREY, linewidth=0.8, linestyle=":")


def finish(ax: Axes) -> None:
    """Leave out scales and title, and draw the axes x and y from A."""
    ax.set_title("", loc="left")
    ax.set_axis_off()
    ax.set_aspect("equal", adjustable="box")
    for name, tip in {"x": (0.115, 0.0), "y": (0.0, 0.115)}.items():
        arrow(ax, (0.0, 0.0), tip, GREY)
        ax.text(tip[0] + 0.004, tip[1] + 0.004, name, color=GREY)
    for text in ax.texts:
        text.set_zorder(9.0)
    for letter in ax.findobj(lambda artist: isinstance(artist, Text) and artist.get_text() == "P"):
        letter.set_visible(False)  # the arrow of the load shows the point


def drawn(ax: Axes) -> Bbox:
    """Return the box about all that is drawn [inch], with a small margin."""
    ax.figure.canvas.draw()
    artists = [
        artist for artist in ax.get_children() if artist.get_visible() and artist not in {ax.patch, ax.xaxis, ax.yaxis}
    ]
    boxes = [artist.get_window_extent() for artist in artists if not isinstance(artist, Spine)]
    inches = ax.figure.dpi_scale_trans.inverted()
    return Bbox.union([box for box in boxes if box.width or box.height]).transformed(inches).padded(0.08)


def arrow(ax: Axes, start: tuple[float, float], end: tuple[float, float], color: str, width: float = 1.2) -> None:
    """Draw an arrow."""
    style = {"arrowstyle": "-|>", "mutation_scale": 9.0 + 4.0 * width, "shrinkA": 0.0, "shrinkB": 0.0}
    ax.add_patch(FancyArrowPatch(start, end, color=color, linewidth=width, zorder=8.0, **style))


def turn(ax: Axes, centre: tuple[float, float], radius: float, start: float, end: float, name: str) -> None:
    """Draw an angle [degree] from the direction of x as an arc with an arrow, counter-clockwise where positive."""
    ax.plot([centre[0], centre[0] + 1.5 * radius], [centre[1]] * 2, color=GREY, linewidth=0.8, linestyle=":")
    ends = {"theta1": min(start, end), "theta2": max(start, end)}
    ax.add_patch(Arc(centre, 2 * radius, 2 * radius, color=BLUE, linewidth=1.4, **ends))
    last, before = (on_circle(centre, radius, end - back * np.sign(end - start)) for back in (0.0, 8.0))
    arrow(ax, before, last, BLUE)
    ax.text(*on_circle(centre, radius + 0.014, 0.5 * (start + end)), name, color=BLUE, ha="center", va="center")


def load(ax: Axes, first: tuple, second: tuple, line: float, distance: float, angle: float) -> None:
    """Draw a force at a point of a link, with the distance and the angle that state the point."""
    point = on_circle(first, distance, line + angle)
    ax.plot(*np.transpose([first, point]), color=RED, linewidth=1.0, linestyle="--")
    turn_from = on_circle(first, 0.6 * distance, line + 0.5 * angle)
    ax.add_patch(Arc(first, 0.9 * distance, 0.9 * distance, theta1=line, theta2=line + angle, color=RED, lw=1.2))
    ax.text(*turn_from, f"{angle:.0f}°", color=RED, ha="center", va="center")
    middle = on_circle(first, 0.55 * distance, line + angle + 4.0)
    ax.text(*middle, f"{distance} m ", color=RED, ha="right", va="bottom")
    arrow(ax, (point[0], point[1] + 0.055), point, RED, width=2.2)
    words = f"force=(0, -80)\nat=({distance}, {angle:.0f})"
    ax.text(point[0] + 0.008, point[1] + 0.024, words, color=RED, family="monospace", fontsize=10.5)


def on_circle(centre: tuple[float, float], radius: float, angle: float) -> tuple[float, float]:
    """Return the point of a circle at an angle [degree]."""
    return centre[0] + radius * np.cos(np.radians(angle)), centre[1] + radius * np.sin(np.radians(angle))


if __name__ == "__main__":
    main()
