"""What happens to a machine: scenes, loads, scene files. Everything a person says is checked here, at the door."""
