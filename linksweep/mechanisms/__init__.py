"""Which machines there are: each a frozen dataclass and a table of what can be computed of it."""
