"""Names of joints, and of forces and torques between two links: F32 and T12; with two digits F11_3."""

from __future__ import annotations

import re

NAME = re.compile(r"[FT](?:(\d)(\d)|(\d+)_(\d+))")


def name_between(letter: str, i: int, j: int) -> str:
    """Return the name of what link i does to link j, F32 or T12; from ten links on with an underscore, F11_3."""
    return f"{letter}{i}{j}" if max(i, j) < 10 else f"{letter}{i}_{j}"


def force_name(i: int, j: int) -> str:
    """Return the name of the force of link i on link j."""
    return name_between("F", i, j)


def pair_of(name: str) -> tuple[int, int] | None:
    """Return the numbers i and j in a name such as F32, F11_3 or T12, without an ending; None for other names."""
    match = NAME.fullmatch(name)
    if match is None:
        return None
    i, j = (int(digits) for digits in match.groups() if digits)
    return i, j


def is_pin(joint: str) -> bool:
    """Return whether a joint is a pin, named by a letter, beside which a link may stand: "C", "C:lower"."""
    return joint.partition(":")[0].isupper()


def has_moment(slide: str) -> bool:
    """Return whether a slide passes on a moment: a block without mass, which a line passes, does not."""
    return " past " not in slide


def reaction(force: str) -> str:
    """Return the name of the opposite force, F23 of F32; a name without two numbers as it is."""
    pair = pair_of(force)
    return force if pair is None else name_between(force[0], *pair[::-1])
