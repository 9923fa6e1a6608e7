"""Colours of Okabe and Ito, which colour-blind readers tell apart, and two greys."""

from __future__ import annotations

from linksweep.chains.between_links import pair_of

BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, VERMILION, PURPLE = "#0072B2", "#D55E00", "#CC79A7"
GREY, SHADE = "#666666", "#EBEBEB"
LOAD = "#5A5148"
OTHER_COLORS = (ORANGE, SKY, "#8C510A", "#01665E", "#7B3294")
FORCE_COLORS = {"F12": BLUE, "F32": VERMILION, "F43": GREEN, "F14": PURPLE}


def force_color(force: str) -> str:
    """Return the colour of a force, such as F12; orange for another pair of the first four links, one of several for
    later links."""
    pair = pair_of(force) or (1, 1)
    later = max(0, max(pair) - 4)
    return FORCE_COLORS.get(force, OTHER_COLORS[(2 * later + (later > 0 and 1 in pair)) % len(OTHER_COLORS)])
