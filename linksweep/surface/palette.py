"""Colours of Okabe and Ito, which colour-blind readers tell apart, and two greys."""

BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, VERMILION, PURPLE = "#0072B2", "#D55E00", "#CC79A7"
GREY, SHADE = "#666666", "#E4E4E4"
FORCES = {"F12": BLUE, "F32": VERMILION, "F43": GREEN, "F14": PURPLE}
