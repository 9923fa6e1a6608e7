"""Write and read files: NetCDF with its scene, tables, atomic writes, checksums, files that may be damaged.

`netcdf.save` and `netcdf.load_scene` are public; studies import the parts, and everything that writes uses `atomic`.
"""
