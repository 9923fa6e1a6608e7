"""Search for exact peaks and integrals outside the kernel: along arcs between toggles, jumps and quick loads."""
