"""Motors: torque over speed, with its exact derivative, and the inertia of the rotor; a file for each kind.

Their classes are public. Equations and sources are in `linksweep.physics.motor`.
"""
