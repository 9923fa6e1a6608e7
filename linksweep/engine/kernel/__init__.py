"""Write and compile the kernel of a plan: nested loops over design dims, designs side by side, reductions.

numba is imported in `compile` alone.
"""
