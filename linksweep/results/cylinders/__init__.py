"""Hold engines of several cylinders on one crankshaft: their sums, and exact peaks of these."""
