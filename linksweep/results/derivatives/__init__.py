"""Derivatives of results to parameters: of samples, of exact peaks, of means over time.

Nothing here is public; `linksweep.analysis.design` puts names, units and status on what comes out.
"""
