"""Common parts of all pictures: style, labels, signals, drawings of machines, films.

Plots, reports and the command line import them; no part knows a plot, and none a mechanism by name.
"""
