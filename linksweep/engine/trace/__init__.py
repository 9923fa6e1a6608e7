"""Decide which operations a request needs: functions are traced into a graph, which is simplified and contracted; a
`plan.Plan` of it is what is evaluated. Sums of cycles, derivatives and bounds on rounding errors are added to a graph.
"""
