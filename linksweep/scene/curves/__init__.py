"""Curves over the crank angle or a position: interpolation, evaluation, derivatives, and where they change quickly.

Scenes, loads, scene files and the peak search import them. Functions and arrays come in; arrays at the angles of a
grid go out.
"""
