"""Decide which operations a request needs: tracing, planning, superposition of cycles, rounding error analysis.

A `plan.Plan` is what goes to the kernel.
"""
