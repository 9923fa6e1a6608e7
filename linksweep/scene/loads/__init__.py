"""Hold all that acts on a machine, each load a class with its parameters, and what changes over the crank angle."""
