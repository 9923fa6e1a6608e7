"""Find where each machine can be assembled, and where it toggles, in closed form."""
