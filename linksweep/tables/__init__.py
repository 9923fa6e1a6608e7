"""Results as tables, as the command line prints it and as a notebook shows it."""
