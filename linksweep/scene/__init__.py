"""A machine in motion: `scene` with its loads/, curves/ over the angle, scene file/ and designs/.

All input is checked here, by the constructors. Results and all rooms above import `scene`, `grid` and what these four
folders export; nothing here knows a result.
"""
