"""Answer what loads a pin: breakdown by cause, limits of speed, bearings and their friction."""
