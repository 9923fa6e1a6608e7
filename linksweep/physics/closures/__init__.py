"""Positions, velocities and forces of closed chains: the crank's angle, the dyads, and the machines made of them.

They import `linksweep.physics.algebra` and the laws beside this folder; only mechanisms import them.
"""
