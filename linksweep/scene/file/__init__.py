"""Read and write scene files: TOML with units, CSV tables, and messages that name the line."""
