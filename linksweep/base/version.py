"""Version of linksweep that is running."""

from __future__ import annotations

from functools import cache

UNKNOWN = "0+unknown"
"""The version of a copy that was never installed."""


@cache
def installed_version() -> str:
    """Return the version of the installed package."""
    from importlib.metadata import PackageNotFoundError, version  # here: it takes as long as all else that is imported

    try:
        return version("linksweep")
    except PackageNotFoundError:
        return UNKNOWN
