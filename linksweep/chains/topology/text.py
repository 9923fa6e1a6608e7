"""The text of a linkage, part by part: links by their pins, sliders on guides, cylinders, wheels."""

from __future__ import annotations

import re
from typing import NamedTuple

PIN = r"[A-Z][0-9]*"
NAME = r"[^\W\d]\w*"
RATIO = r"-?[0-9]+(?:/0*[1-9][0-9]*)?"
PINS = rf"(?P<pins>{PIN}(?:-{PIN})+)"
WHEEL = "a wheel is written as wheel D-E : -2 crank, a ratio that is a fraction as -5/2"
FORMS = {
    "~": (rf"(?P<ends>{PIN}~{PIN})", "a cylinder is written as c1 P~B"),
    ":": (rf"{PINS}:(?:(?P<ratio>{RATIO}) )?(?P<mate>{NAME})", WHEEL),
    " on .* past ": (rf"on (?P<guide>{NAME}) past (?P<past>{PIN})", "a yoke is written as yoke on slide past B"),
    " past ": (rf"{PINS} past (?P<past>{PIN})", "a link past a pin is written as arm D-E past B"),
    " on ": (rf"(?P<pins>{PIN}) on (?P<guide>{NAME})", "a slider is written as ram F on slide"),
    "": (PINS, "a link is written by two pins or more, each a capital letter that digits may follow, as rod B-C"),
}
"""By a mark in a part of the text: the form that it then has, and its sentence."""


class Part(NamedTuple):
    """A part of the text: a link, slider, cylinder or wheel; what it does not state is empty."""

    role: str
    pins: tuple[str, ...] = ()
    ends: tuple[str, ...] = ()
    guide: str = ""
    past: str = ""
    mate: str = ""
    ratio: str = ""


def read(links: str) -> tuple[list[Part], list[str]]:
    """Return the parts of a text that have a form, and the problems of those that have none."""
    parts, problems = [], []
    for text in links.split(","):
        words = re.sub(r"\s*([-~:])\s*", r"\1", " ".join(text.split()))
        form, sentence = next(FORMS[mark] for mark in FORMS if re.search(mark, f"{words} "))
        if match := re.fullmatch(f"(?P<role>{NAME}) {form}", words):
            parts.append(_part(match.groupdict()))
        else:
            problems.append(f'links: "{text.strip()}" cannot be read: {sentence}')
    return parts, problems


def _part(groups: dict[str, str | None]) -> Part:
    values = {name: value or "" for name, value in groups.items()}
    pins, ends = values.pop("pins", ""), values.pop("ends", "")
    return Part(pins=tuple(filter(None, pins.split("-"))), ends=tuple(filter(None, ends.split("~"))), **values)
