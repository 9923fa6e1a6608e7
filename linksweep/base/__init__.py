"""Foundation of all rooms: validation of input, equality by content, frozen objects, exact sines of degrees.

Every room may import from here; nothing here knows a machine, a scene or a file.
"""
