"""Foundation of all rooms: validation, equality by content, frozen objects, sines of degrees, numbers with units.

Every room may import from here; nothing here knows a machine, a scene or a file.
"""
