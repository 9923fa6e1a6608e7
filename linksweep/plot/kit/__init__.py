"""Hold what all pictures share: style, labels, signals, drawings of machines, films."""
