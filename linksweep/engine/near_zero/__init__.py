"""Dips and zeros of signals around the turn, for designs side by side."""
