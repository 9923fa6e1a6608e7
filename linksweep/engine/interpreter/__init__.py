"""Interpret plans: one function of machine code, kept on disk, runs any plan at once, without its own kernel."""
