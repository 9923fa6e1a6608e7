"""Check random linkages against multibody equations in 50 digits: python -m benchmarks.stress.linkages."""
