"""Colours of Okabe and Ito, which colour-blind readers tell apart, and two greys."""

from __future__ import annotations

BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, VERMILION, PURPLE = "#0072B2", "#D55E00", "#CC79A7"
GREY, SHADE = "#666666", "#EBEBEB"
FORCE_COLORS = {"F12": BLUE, "F32": VERMILION, "F43": GREEN, "F14": PURPLE}


def force_color(force: str) -> str:
    """Return the colour of a force, such as F12; orange for a pair of links without one of its own."""
    return FORCE_COLORS.get(force, ORANGE)
