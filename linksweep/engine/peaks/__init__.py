"""Search for exact peaks within a kernel: lanes (brackets of candidate peaks), trials, and the calls that run them."""
