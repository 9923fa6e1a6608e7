"""Load of the drive: duty over a cycle, flywheel, motor behind a gear."""
