"""Choose a design: objective, Pareto front, geometry."""
