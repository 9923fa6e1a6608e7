"""Films of machines that move: forces in the joints as arrows, and their place on their curves.

`animation.animate` is public; it calls `machine_film` or `cylinder_film`, and both stand on `frames`.
"""
