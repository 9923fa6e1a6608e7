"""Scenes with derivatives: parameters as numbers with slopes, carried on to the inputs of the physics.

Nothing here is public.
"""
