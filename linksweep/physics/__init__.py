"""Laws of mechanics as small scalar functions: floats in, floats out; the argument names are the wiring.

They use arithmetic, `sqrt`, `atan2` and `where` only: no loops, no arrays, no exceptions. The engine traces them, so
one source runs compiled, on numpy arrays and on 50-digit numbers.
"""
