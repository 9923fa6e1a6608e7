"""Angles at which friction changes: `jams` finds those at which it jams a slide, `contacts` those at which one of two
contacts bears nothing; `motion` finds the peaks of motion beside jams, `directions` tells which of sliding are known.
"""
