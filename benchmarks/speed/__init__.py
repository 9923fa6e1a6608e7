"""Time linksweep against its peers, as ratios within one run."""
