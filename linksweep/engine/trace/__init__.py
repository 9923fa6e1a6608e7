"""Decide what is computed: functions traced to operations, the plan of a request, sums of cycles, rounding errors."""
