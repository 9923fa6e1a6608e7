"""Write the report of a scene on two sides of A4: results computed once, tables, figures, checks, the page.

`page.report` is public; only the command line imports from here.
"""
