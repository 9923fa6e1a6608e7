"""Compute studies of many designs in chunks that resume after a stop: jobs, cluster, assembly, opening."""
