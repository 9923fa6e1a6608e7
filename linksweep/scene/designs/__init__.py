"""Designs of a study: drawing them from distributions, choosing some of them, and numbers that dask computes later.

`sampling` and `distributions` are public; results, files and studies import the others.
"""
