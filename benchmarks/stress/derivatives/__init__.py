"""Derivatives of random scenes of all kinds against 50-digit differences: python -m benchmarks.stress.derivatives."""
