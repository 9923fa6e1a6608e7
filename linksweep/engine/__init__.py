"""Evaluate a table of rows: trace/ (table → plan), kernel/ (plan → one fused kernel), peaks/ (search); no mechanism.

Mechanisms import `quantity`; scenes and results import `run` and `trace.plan`, and results `peaks.find_peaks`.
"""
