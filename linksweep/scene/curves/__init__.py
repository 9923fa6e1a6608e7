"""Bring functions and arrays to the angles, or positions, at which a scene is looked at."""
