"""Loads of pins: breakdown by cause, speed limits, bearings and their life, friction in the pins."""
