"""A machine in motion: scenes, loads, scene files. All input is checked here, by the constructors."""
