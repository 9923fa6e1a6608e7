"""Random and hard mechanisms, judged in 50 digits by formulas of their own: python -m benchmarks.stress."""
