"""Write the report of a scene on two sides of A4."""
