"""Limits of size by the names of ISO 286: the tolerance class H7 on 40 mm is 0 to +25 µm.

A class is a letter and a grade. The grade states the width of the tolerance (ISO 286-1:2010, table 1), the letter where
it lies: the fundamental deviation of a shaft (small letter) is its limit nearest to the nominal size (tables 4 and 5),
and that of a hole from A to H is the same with the opposite sign. JS and js lie evenly about the nominal size.

Both are tabulated by ranges of nominal sizes up to 500 mm, in µm.
"""

from __future__ import annotations

import re
from bisect import bisect_left

from linksweep.base.validate import refuse

UP_TO = (3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500)
"""Upper ends of the ranges of nominal sizes [mm], each included."""

WIDTHS = {
    5: (4, 5, 6, 8, 9, 11, 13, 15, 18, 20, 23, 25, 27),
    6: (6, 8, 9, 11, 13, 16, 19, 22, 25, 29, 32, 36, 40),
    7: (10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63),
    8: (14, 18, 22, 27, 33, 39, 46, 54, 63, 72, 81, 89, 97),
    9: (25, 30, 36, 43, 52, 62, 74, 87, 100, 115, 130, 140, 155),
    10: (40, 48, 58, 70, 84, 100, 120, 140, 160, 185, 210, 230, 250),
    11: (60, 75, 90, 110, 130, 160, 190, 220, 250, 290, 320, 360, 400),
    12: (100, 120, 150, 180, 210, 250, 300, 350, 400, 460, 520, 570, 630),
    13: (140, 180, 220, 270, 330, 390, 460, 540, 630, 720, 810, 890, 970),
    14: (250, 300, 360, 430, 520, 620, 740, 870, 1000, 1150, 1300, 1400, 1550),
}
"""Width of the tolerance by grade and range [µm]."""

UPPER = {
    "d": (-20, -30, -40, -50, -65, -80, -100, -120, -145, -170, -190, -210, -230),
    "e": (-14, -20, -25, -32, -40, -50, -60, -72, -85, -100, -110, -125, -135),
    "f": (-6, -10, -13, -16, -20, -25, -30, -36, -43, -50, -56, -62, -68),
    "g": (-2, -4, -5, -6, -7, -9, -10, -12, -14, -15, -17, -18, -20),
    "h": (0,) * 13,
}
"""Upper limit deviation of shafts by letter and range [µm]."""
LOWER = {
    "k": (0, 1, 1, 1, 2, 2, 2, 3, 3, 4, 4, 4, 5),
    "m": (2, 4, 6, 7, 8, 9, 11, 13, 15, 17, 20, 21, 23),
    "n": (4, 8, 10, 12, 15, 17, 20, 23, 27, 31, 34, 37, 40),
    "p": (6, 12, 15, 18, 22, 26, 32, 37, 43, 50, 56, 62, 68),
}
"""Lower limit deviation of shafts by letter and range [µm]; k of the grades 5 to 7."""
CLASS = re.compile(r"(?:(\d+(?:\.\d+)?)\s*)?([A-Za-z]{1,2})(\d{1,2})")
LETTERS = (*UPPER, *LOWER, "js", *map(str.upper, UPPER), "JS")


def is_fit(text: object) -> bool:
    """Return whether a text is the name of a tolerance class, as "40 H7" or "g6"."""
    return isinstance(text, str) and CLASS.fullmatch(text.strip()) is not None


def limit_deviations(text: str, size: float) -> tuple[float, float]:
    """Return the lower and upper limit deviation [m] of a tolerance class.

    Parameters
    ----------
    text : class with or without its nominal size in mm, as "40 H7" or "H7"
    size : nominal size [m] of a class without one

    Raises
    ------
    ValueError
        For a class or a size that is not in the tables.
    """
    match = CLASS.fullmatch(text.strip())
    assert match is not None, text
    nominal, letter, grade = float(match[1] or 1000.0 * size), match[2], int(match[3])
    problems = [] if letter in LETTERS else [f"{text!r}: letter {letter}: must be one of {', '.join(LETTERS)}"]
    problems += [] if grade in WIDTHS else [f"{text!r}: grade {grade}: must be from 5 to 14"]
    problems += [] if 0.0 < nominal <= UP_TO[-1] else [f"{text!r}: size {nominal:g} mm: must be above 0, up to 500 mm"]
    problems += [f"{text!r}: k has its deviation in grades 5 to 7 alone"] if letter == "k" and grade > 7 else []
    refuse(problems)
    k = bisect_left(UP_TO, nominal)
    lower, upper = _of_shaft(letter.lower(), k, WIDTHS[grade][k])
    lower, upper = (lower, upper) if letter.islower() else (-upper, -lower)
    return 1e-6 * lower + 0.0, 1e-6 * upper + 0.0


def _of_shaft(letter: str, k: int, width: float) -> tuple[float, float]:
    """Return the limit deviations [µm] of a shaft in a range of sizes."""
    if letter == "js":
        return -0.5 * width, 0.5 * width
    return (
        (UPPER[letter][k] - width, UPPER[letter][k])
        if letter in UPPER
        else (LOWER[letter][k], LOWER[letter][k] + width)
    )
