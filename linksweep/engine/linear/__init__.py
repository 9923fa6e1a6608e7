"""Solve small square systems of equations, many side by side: numbers in lanes, elimination, and the calls that run it.

Results import `solve`.
"""
