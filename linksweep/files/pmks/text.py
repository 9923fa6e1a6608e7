"""The text of a document: checksum, sections, and numbers in base 64."""

from __future__ import annotations

import string
from typing import NamedTuple

from linksweep.base.validate import quote

DIGITS = string.digits + string.ascii_uppercase + string.ascii_lowercase + "_-"


class Sections(NamedTuple):
    """Sections of a document: flags, scales, speeds and units, then the records."""

    settings: list[str]
    joints: list[str]
    links: list[str]
    forces: list[str]
    extras: list[str]


def sections(text: str) -> Sections:
    """Return the sections of a document's text. Raises ValueError where it is damaged, cut off, or no document."""
    parts = _checked(text).split(".")
    start, records = 4, dict[str, list[str]]()
    for what in ("joints", "links", "forces"):
        if "" not in parts[start:]:
            raise ValueError(f"{quote(text)} is no document of PMKS+: it has no list of {what}")
        end = parts.index("", start)
        records[what] = parts[start:end]
        start = end + 1
    extras = ".".join(parts[start + 1 :]).split(",")  # behind the selection
    return Sections(parts[:4], **records, extras=[extra for extra in extras if extra])


def integer(digits: str) -> int:
    """Return the integer that base-64 digits stand for, 0 for none; a 0 in front makes it negative.

    >>> integer("Fe"), integer("0Fe"), integer("")
    (1000, -1000, 0)
    """
    size = unsigned(digits)
    return -size if digits.startswith("0") else size


def unsigned(digits: str) -> int:
    """Return the integer that base-64 digits stand for, whatever its first one."""
    size = 0
    for digit in digits:
        size = 64 * size + DIGITS.index(digit)
    return size


def _checked(text: str) -> str:
    """Return the text without its checksum and the character that tells its length."""
    body, mark, checksum = text.rpartition("*")
    body = body if mark else text
    if mark and checksum != _checksum(body):
        raise ValueError(f"the document is damaged: its checksum is {checksum}, not {_checksum(body)}; copy it again")
    if len(body) < 2 or body[-1] != DIGITS[(len(body) - 1) % 62]:
        raise ValueError(
            f"{quote(text)} is no document of PMKS+, or it is cut off: copy it whole; the name of a file ends in .pmks"
        )
    return body[:-1]


def _checksum(text: str) -> str:
    """Return the FNV-1a hash of a text as six digits of base 62."""
    value = 0x811C9DC5
    for character in text:
        value = (value ^ ord(character)) * 0x01000193 % 2**32
    return "".join(DIGITS[value // 62**place % 62] for place in reversed(range(6)))
