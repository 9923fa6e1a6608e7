"""Parameters of which some run every time and the others only with the long tests."""

from collections.abc import Iterable

import pytest


def long_but(values: Iterable, *quick) -> list:
    """Mark every value of a parameter long but the quick ones; raise ValueError where one of these is no such value."""
    values = list(values)
    if unknown := set(quick) - set(values):
        raise ValueError(f"none of the values: {unknown}")
    return [value if value in quick else pytest.param(value, marks=pytest.mark.long) for value in values]
