"""How it is computed: table → plan → one fused kernel. Knows no mechanism."""
