"""Search for exact peaks within a kernel: lanes, trials, and the calls that run them."""
