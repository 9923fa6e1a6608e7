"""Loads on the links of a mechanism: forces and torques, gas pressure, springs and dampers."""
