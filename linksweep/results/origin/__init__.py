"""The origin of a Dataset: its machine, and the units in which to show it."""
