"""Compute studies in chunks that go on where they stopped: jobs, cluster, assembly, opening."""
