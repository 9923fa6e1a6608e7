"""Measure errors beside run time, against fifty digits and against dense samples."""
