"""Load of the drive: duty over a cycle, flywheel, motors, and a machine on its motor.

Their functions are public; plots, reports and the command line import from here.
"""
