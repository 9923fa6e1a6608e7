"""Where people meet it: files, plots, the accessor of Datasets, the command line."""
