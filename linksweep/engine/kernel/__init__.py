"""Write and compile the kernel of a plan: nested loops over design dims, designs side by side, reductions.

numba compiles the kernels of plans (`compile`). Instructions alone, and the search for peaks, which `translate` turns
into instructions, become machine code without it (`machine_code`).
"""
