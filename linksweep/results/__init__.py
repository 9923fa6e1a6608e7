"""What comes out: Datasets indexed by crank angle, peaks, the labelled system, checks."""
