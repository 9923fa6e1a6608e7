"""Loads on the links of a mechanism: forces and torques, gas pressure, springs and dampers.

Each class is one file with the rows that it adds to a machine's table, and one line in `kinds`. Other rooms import
`kinds` and the protocol `action`.
"""
