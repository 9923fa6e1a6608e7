"""Choice of a design: geometry of the motion, objective for optimizers, Pareto front.

Their functions are public; plots and reports import from here.
"""
