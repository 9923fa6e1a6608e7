"""Write and read files whole: NetCDF with its scene, tables, checksums, damaged files."""
