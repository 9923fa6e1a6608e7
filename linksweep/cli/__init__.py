"""Run linksweep from the command line."""
