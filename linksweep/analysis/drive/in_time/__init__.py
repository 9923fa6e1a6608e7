"""Motion in time: a machine runs up on its motor, or runs down, from one state to another.

`run_up` and `run_down` are public. Systems of differential equations are integrated side by side in `time_steps`.
"""
