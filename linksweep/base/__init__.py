"""Lay the foundation: validation of input, equality by content, exact sines of degrees.

Every room may import from here; nothing here knows a machine, a scene or a file.
"""
