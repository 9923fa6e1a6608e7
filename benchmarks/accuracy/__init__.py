"""Measure errors against fifty digits and against dense samples."""
