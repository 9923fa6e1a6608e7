"""Strength of links and pins: stress over the exact cycle, fatigue, buckling, and the sizes that are needed."""
