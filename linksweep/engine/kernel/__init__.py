"""Write and compile the kernel of a plan: nested loops over design dims, designs side by side, reductions.

Only `compile` imports numba.
"""
