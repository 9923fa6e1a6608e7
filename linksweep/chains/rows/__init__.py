"""Rows and quantities of the machines' tables: bodies, pins, loads, the crank, the whole machine.

Machines import them; of other rooms, loads do (`load_forms`, `bodies`), and `results.system` (`bodies.Equation`).
"""
