"""Version of linksweep that is running."""

from __future__ import annotations

from functools import cache
from importlib.metadata import PackageNotFoundError, version

UNKNOWN = "0+unknown"
"""The version of a copy that was never installed."""


@cache
def installed_version() -> str:
    """Return the version of the installed package."""
    try:
        return version("linksweep")
    except PackageNotFoundError:
        return UNKNOWN
