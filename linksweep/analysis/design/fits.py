"""Limits of size by the names of ISO 286: the tolerance class H7 on 40 mm is 0 to +25 µm.

A class is a letter and a grade. The grade states the width of the tolerance (ISO 286-1:2010, table 1), the letter where
it lies: the fundamental deviation of a shaft (small letter) is its limit nearest to the nominal size (tables 4 and 5),
and that of a hole from A to H is the same with the opposite sign. JS and js lie evenly about the nominal size. Holes
that grip have the shaft's deviation with the opposite sign and, up to grade 8 (K, M, N) or 7 (P, R, S), more by the
difference Δ of the widths of their own grade n and the next finer one (tables 2 and 3):

    ES = −ei + Δ,   Δ = IT(n) − IT(n−1)   above 3 and up to 500 mm

Both are tabulated by ranges of nominal sizes up to 3150 mm, in µm; j, r and s up to 500 mm, r and s by finer ranges.
"""

from __future__ import annotations

import re
from bisect import bisect_left

from linksweep.base.validate import refuse

UP_TO = (3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500, 630, 800, 1000, 1250, 1600, 2000, 2500, 3150)
"""Upper ends of the ranges of nominal sizes [mm], each included."""

WIDTHS = {
    4: (3, 4, 4, 5, 6, 7, 8, 10, 12, 14, 16, 18, 20),
    5: (4, 5, 6, 8, 9, 11, 13, 15, 18, 20, 23, 25, 27, 32, 36, 40, 47, 55, 65, 78, 96),
    6: (6, 8, 9, 11, 13, 16, 19, 22, 25, 29, 32, 36, 40, 44, 50, 56, 66, 78, 92, 110, 135),
    7: (10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63, 70, 80, 90, 105, 125, 150, 175, 210),
    8: (14, 18, 22, 27, 33, 39, 46, 54, 63, 72, 81, 89, 97, 110, 125, 140, 165, 195, 230, 280, 330),
    9: (25, 30, 36, 43, 52, 62, 74, 87, 100, 115, 130, 140, 155, 175, 200, 230, 260, 310, 370, 440, 540),
    10: (40, 48, 58, 70, 84, 100, 120, 140, 160, 185, 210, 230, 250, 280, 320, 360, 420, 500, 600, 700, 860),
    11: (
        60, 75, 90, 110, 130, 160, 190, 220, 250, 290, 320, 360, 400,
        440, 500, 560, 660, 780, 920, 1100, 1350,
    ),
    12: (
        100, 120, 150, 180, 210, 250, 300, 350, 400, 460, 520, 570, 630,
        700, 800, 900, 1050, 1250, 1500, 1750, 2100,
    ),
    13: (
        140, 180, 220, 270, 330, 390, 460, 540, 630, 720, 810, 890, 970,
        1100, 1250, 1400, 1650, 1950, 2300, 2800, 3300,
    ),
    14: (
        250, 300, 360, 430, 520, 620, 740, 870, 1000, 1150, 1300, 1400, 1550,
        1750, 2000, 2300, 2600, 3100, 3700, 4400, 5400,
    ),
}  # fmt: skip
"""Width of the tolerance by grade and range [µm]; grade 4 for Δ alone."""

UPPER = {
    "d": (
        -20, -30, -40, -50, -65, -80, -100, -120, -145, -170, -190, -210, -230,
        -260, -290, -320, -350, -390, -430, -480, -520,
    ),
    "e": (
        -14, -20, -25, -32, -40, -50, -60, -72, -85, -100, -110, -125, -135,
        -145, -160, -170, -195, -220, -240, -260, -290,
    ),
    "f": (
        -6, -10, -13, -16, -20, -25, -30, -36, -43, -50, -56, -62, -68,
        -76, -80, -86, -98, -110, -120, -130, -145,
    ),
    "g": (-2, -4, -5, -6, -7, -9, -10, -12, -14, -15, -17, -18, -20, -22, -24, -26, -28, -30, -32, -34, -38),
    "h": (0,) * 21,
}  # fmt: skip
"""Upper limit deviation of shafts by letter and range [µm]."""
LOWER = {
    "k": (0, 1, 1, 1, 2, 2, 2, 3, 3, 4, 4, 4, 5, 0, 0, 0, 0, 0, 0, 0, 0),
    "m": (2, 4, 6, 7, 8, 9, 11, 13, 15, 17, 20, 21, 23, 26, 30, 34, 40, 48, 58, 68, 76),
    "n": (4, 8, 10, 12, 15, 17, 20, 23, 27, 31, 34, 37, 40, 44, 50, 56, 66, 78, 92, 110, 135),
    "p": (6, 12, 15, 18, 22, 26, 32, 37, 43, 50, 56, 62, 68, 78, 88, 100, 120, 140, 170, 195, 240),
}  # fmt: skip
"""Lower limit deviation of shafts by letter and range [µm]; k of the grades 4 to 7, in others it is 0."""
FINER = (
    3, 6, 10, 18, 30, 50, 65, 80, 100, 120, 140, 160, 180, 200, 225, 250, 280, 315, 355, 400, 450, 500,
)  # fmt: skip
"""Upper ends of the ranges of r and s [mm]."""
LOWER_FINER = {
    "r": (10, 15, 19, 23, 28, 34, 41, 43, 51, 54, 63, 65, 68, 77, 80, 84, 94, 98, 108, 114, 126, 132),
    "s": (14, 19, 23, 28, 35, 43, 53, 59, 71, 79, 92, 100, 108, 122, 130, 140, 158, 170, 190, 208, 232, 252),
}
"""Lower limit deviation of shafts r and s by their ranges [µm]."""
LOWER_J = {
    5: (-2, -2, -2, -3, -4, -5, -7, -9, -11, -13, -16, -18, -20),
    6: (-2, -2, -2, -3, -4, -5, -7, -9, -11, -13, -16, -18, -20),
    7: (-4, -4, -5, -6, -8, -10, -12, -15, -18, -21, -26, -28, -32),
}
"""Lower limit deviation of shafts j by grade and range [µm]."""
UPPER_J = {
    6: (2, 5, 5, 6, 8, 10, 13, 16, 18, 22, 25, 29, 33),
    7: (4, 6, 8, 10, 12, 14, 18, 22, 26, 30, 36, 39, 43),
    8: (6, 10, 12, 15, 20, 24, 28, 34, 41, 47, 55, 60, 66),
}
"""Upper limit deviation of holes J by grade and range [µm]."""
CLASS = re.compile(r"(?:(\d+(?:\.\d+)?)\s*)?([A-Za-z]{1,2})(\d{1,2})")
SHAFTS = (*UPPER, *LOWER, *LOWER_FINER, "js", "j")
LETTERS = (*SHAFTS, *map(str.upper, SHAFTS))
J_GRADES = {"j": LOWER_J, "J": UPPER_J}


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
    problems += [] if 5 <= grade <= 14 else [f"{text!r}: grade {grade}: must be from 5 to 14"]
    problems += _size_problems(text, letter, nominal)
    known = J_GRADES.get(letter, WIDTHS)
    problems += (
        [] if problems or grade in known else [f"{text!r}: {letter} is of the grades {', '.join(map(str, known))}"]
    )
    refuse(problems)
    lower, upper = (_of_shaft if letter.islower() else _of_hole)(letter.lower(), grade, nominal)
    return 1e-6 * lower + 0.0, 1e-6 * upper + 0.0


def _size_problems(text: str, letter: str, nominal: float) -> list[str]:
    most = FINER[-1] if letter.lower() in (*LOWER_FINER, "j") else UP_TO[-1]
    return [] if 0.0 < nominal <= most else [f"{text!r}: size {nominal:g} mm: must be above 0, up to {most} mm"]


def _of_shaft(letter: str, grade: int, size: float) -> tuple[float, float]:
    """Return the limit deviations [µm] of a shaft of a size [mm]."""
    width = _width(grade, size)
    if letter == "js":
        return -0.5 * width, 0.5 * width
    if letter in UPPER:
        upper = UPPER[letter][bisect_left(UP_TO, size)]
        return upper - width, upper
    lower = _lower(letter, grade, size)
    return lower, lower + width


def _of_hole(letter: str, grade: int, size: float) -> tuple[float, float]:
    """Return the limit deviations [µm] of a hole of a size [mm]; its letter small."""
    width = _width(grade, size)
    if letter in UPPER or letter == "js":
        lower, upper = _of_shaft(letter, grade, size)
        return -upper, -lower
    if letter == "j":
        upper = UPPER_J[grade][bisect_left(UP_TO, size)]
        return upper - width, upper
    most = 8 if letter in "kmn" else 7
    grips = -_lower(letter, min(grade, 7), size)  # K of the grade 8 has the deviation of finer ones
    differs = UP_TO[0] < size <= FINER[-1]
    if letter == "n" and grade > most and differs:
        grips = 0
    if letter == "m" and grade == 6 and 250.0 < size <= 315.0:
        grips += 2  # table 2 has -9 there, and not -11
    upper = grips + (width - _width(grade - 1, size) if grade <= most and differs else 0)
    return upper - width, upper


def _width(grade: int, size: float) -> int:
    """Return the width of a grade [µm]."""
    return WIDTHS[grade][bisect_left(UP_TO, size)]


def _lower(letter: str, grade: int, size: float) -> int:
    """Return the lower limit deviation [µm] of a shaft that grips, or of j."""
    if letter in LOWER_FINER:
        return LOWER_FINER[letter][bisect_left(FINER, size)]
    if letter == "j":
        return LOWER_J[grade][bisect_left(UP_TO, size)]
    return 0 if letter == "k" and grade > 7 else LOWER[letter][bisect_left(UP_TO, size)]
