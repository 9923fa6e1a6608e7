"""Linkages that meet every public function: two made here, and examples."""

from functools import partial

import linksweep as ls


def bar(length: float) -> ls.Bar:
    return ls.Bar(length, 0.02, 0.02, 7750.0)


def six_bar() -> ls.Scene:
    """Return a Watt II six-bar."""
    links = ls.Linkage(
        "crank A-B, coupler B-C, rocker D-C-E, rod E-F, output G-F",
        ground={"A": (0.0, 0.0), "D": (0.20, 0.0), "G": (0.42, 0.05)},
        points={"E": (0.12, -35.0)},
        crank=bar(0.08),
        coupler=bar(0.22),
        rocker=bar(0.18),
        rod=bar(0.20),
        output=bar(0.15),
    )
    return ls.Scene(links, omega2=30.0, gravity=(0.0, -9.81), loads=[ls.Load("output", torque=-12.0)])


def knuckle_press() -> ls.Scene:
    """Return a knuckle-joint press, whose pin C joins three links, and whose ram slides with friction."""
    links = ls.Linkage(
        "crank A-B, rod B-C, upper D-C, lower C-E, ram E on slide",
        ground={"A": (0.0, 0.0), "D": (0.26, 0.16)},
        guides={"slide": ls.Guide(through=(0.26, 0.0), angle=-90.0, friction=0.1)},
        crank=bar(0.03),
        rod=bar(0.25),
        upper=bar(0.15),
        lower=bar(0.15),
        ram=ls.Slider(mass=3.0),
    )
    return ls.Scene(links, omega2=30.0, gravity=(0.0, -9.81), loads=[ls.Load("ram", force=-500.0)])


EXAMPLES = {name: partial(ls.example, name) for name in ("excavator", "whitworth", "geared-five-bar")}
EXAMPLES["yoke"] = partial(ls.example, "scotch-yoke")
LINKAGES = {"six-bar": six_bar, "knuckle-press": knuckle_press, **EXAMPLES}
