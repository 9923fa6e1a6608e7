"""Evaluate a table of rows, of any machine: trace/ makes a plan of it, kernel/ one compiled function of the plan, which
interpreter/ does without; peaks/ searches for peaks, near_zero/ for dips and zeros; linear/ solves square systems.
"""
