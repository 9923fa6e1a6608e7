"""Load of the drive: duty over a cycle, flywheel, motor behind a gear.

Their functions are public; plots, reports and the command line import from here.
"""
