"""How fast linksweep is, as ratios within one run: `python -m benchmarks`."""
