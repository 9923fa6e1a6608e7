"""Evaluate a table of rows: table → plan → one fused kernel. Knows no mechanism."""
