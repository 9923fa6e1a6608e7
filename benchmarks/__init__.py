"""Measure the speed of linksweep as ratios within one run: `python -m benchmarks`."""
