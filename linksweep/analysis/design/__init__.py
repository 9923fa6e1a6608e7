"""Choice of a design: geometry of the motion, objective for optimizers, Pareto front."""
