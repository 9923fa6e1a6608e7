"""Dyads: pairs of joints and links that find their place between two known pins or guides.

The rows of each are written once, in the names of the textbooks' machine with that dyad, and renamed for the place
where it stands in a linkage (`names`).
"""
