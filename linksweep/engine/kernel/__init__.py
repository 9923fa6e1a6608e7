"""Write and compile the kernel of a plan: nested loops over design dims, designs side by side, reductions.

LLVM makes machine code (`machine_code`) of instructions alone, and of what `translate` turns into instructions: the
kernels of plans (`compile`), the search for peaks, the solver of square systems.
"""
