"""Run linksweep from the command line: `main` parses and states errors, by a `parser` that lists commands by task.

Commands stand with their options in a file for each few tasks, and call public functions; what they print is theirs.
Nothing imports from here.
"""
