"""Answer what engineers ask next, from sweeps and exact peaks."""
