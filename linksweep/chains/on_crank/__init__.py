"""Machines of one dyad on crank and ground, in the names of their textbooks.

Each has, besides the rows of its dyad, drives of its own and the ratios of its output, and its limits are closed forms:
where it can be assembled, where it toggles, stands still or jams.
"""
