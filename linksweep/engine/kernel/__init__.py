"""Write and compile the kernel of a plan: nested loops over design dims, designs side by side, reductions.

numba compiles the kernels of plans (`compile`). Instructions alone, and what `translate` turns into instructions (the
search for peaks, the solver of square systems), become machine code without it (`machine_code`).
"""
