"""Results of a scene as Datasets: `sweep`, `peaks`, `check`, `system`, `quantities`.

`compute` goes from a scene to arrays, `dataset` from arrays to labelled Datasets; `peak_search/` finds exact peaks and
integrals, `cylinders/` has engines of several cylinders.
"""
