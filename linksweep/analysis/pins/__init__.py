"""Loads of pins: breakdown by cause, speed limits, bearings and their life, friction in the pins.

Their functions are public; plots, reports and the command line import from here.
"""
