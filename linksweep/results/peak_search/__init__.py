"""Exact peaks and integrals over the continuous revolution.

`exact` sends each design to the fused search or along paths; `paths` and `arcs` make these, `along_paths` searches and
`quadrature` integrates along them; `pieces` and `on_arcs` search many designs side by side.
"""
