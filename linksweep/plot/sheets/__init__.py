"""Drawings as files: a machine in a position and the curves of its points, on a page to scale, or as DXF for CAD.

`save_drawing` is public. It writes SVG and PDF by matplotlib, as `plot.machine` draws, and DXF of the lines of
`skeleton` by ezdxf, an optional extra of the package.
"""
