"""Write and read files: NetCDF with its scene, tables, atomic writes, checksums, files that may be damaged."""
