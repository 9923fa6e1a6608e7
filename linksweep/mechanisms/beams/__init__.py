"""Links as beams: cross-sections, and mass along the link."""
