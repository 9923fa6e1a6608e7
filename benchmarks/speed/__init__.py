"""Time linksweep against its rivals, as ratios within one run."""
