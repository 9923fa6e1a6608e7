"""Analyses on top of sweeps and exact peaks, by subject: pins, drive, balance, design.

Import public functions from `linksweep`; plots, reports and commands import them, and their helpers, from the modules.
"""
