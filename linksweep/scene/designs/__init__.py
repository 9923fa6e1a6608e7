"""Draw designs from distributions, and choose some of them."""
