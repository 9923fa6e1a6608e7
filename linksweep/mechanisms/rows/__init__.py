"""Hold the rows that the tables of several machines share: bodies, pins, loads, the crank, the whole machine."""
