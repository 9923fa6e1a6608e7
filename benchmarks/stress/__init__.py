"""Check random and hard mechanisms against formulas of their own in 50 digits: python -m benchmarks.stress."""
