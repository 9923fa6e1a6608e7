"""Evaluate a table of rows: trace/ (table → plan), kernel/ (plan → one fused kernel), peaks/ (search); no mechanism.

linear/ solves square systems. Mechanisms import `quantity`; scenes and results import `run` and `trace.plan`, and
results `peaks.find_peaks` and `linear.solve`.
"""
