"""Machines of crank and dyads: from the topology of a linkage to the rows of its table.

`topology` reads who is joined to whom, and in which order the dyads close. `dyads` has the rows of each kind, `rows`
those of links, pins and loads; `motion` and `forces` put them together, and `chain` makes a table of them.
"""
