"""Engines of several cylinders on one crankshaft.

`multi_cylinder` is the machine, `cylinder_sums` its quantities as sums over cylinders, `cylinders_between` these sums
at any angle for the peak search, and `cylinder_peaks` their peaks.
"""
