"""Answer what the drive must give: duty, motor, flywheel, several cylinders."""
