"""Pages of the documentation that are made of the package itself: each file writes its pages into a folder."""
