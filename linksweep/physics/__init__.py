"""What is true: small scalar functions, floats in and floats out, whose argument names are the wiring.

They hold arithmetic, `sqrt`, `atan2` and `where` only: no loops, no arrays, nothing raised. The engine
traces them, so the same source runs compiled, on numpy arrays and on 50-digit numbers.
"""
