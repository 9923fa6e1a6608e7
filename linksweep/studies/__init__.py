"""Compute studies of many designs in chunks that resume after a stop: jobs, cluster, assembly, opening.

`study.study`, `screen.screen`, `checked.open_study` and `scene_at.scene_at` are public; the command line and reports
import them.
"""
