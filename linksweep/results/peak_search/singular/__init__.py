"""Angles at which quantities may grow without bound: `poles` finds those at which they do, `rounding_errors` the peaks
beside them that consist of rounding errors, and `search_again` replaces these.
"""
