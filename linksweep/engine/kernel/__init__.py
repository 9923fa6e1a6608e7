"""Write and compile the kernel of a plan: nested loops over design dims, batched designs, reductions.

Only `compile` imports numba.
"""
