"""Rows of a machine made of a crank and dyads: its motion, its forces, its square system of equations."""
