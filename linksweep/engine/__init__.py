"""Evaluate a table of rows, of any machine: trace/ makes a plan of it, kernel/ compiles one function of the plan, and
interpreter/ evaluates small plans without; peaks/ searches for peaks, near_zero/ for dips and zeros; linear/ solves
square systems.
"""
