"""Run linksweep from the command line: `main` parses, `commands` call public functions, `text` and `summaries` print.

Nothing imports from here.
"""
