"""Find where signals come near to zero around the turn, and where they are zero: near-toggles, toggles and jumps.

1. `find` takes designs and the ends of their pieces; `search` goes through them, block by block, side by side.
2. Signals are evaluated at `samples`, dense about the ends of pieces.
3. The `places` of samples that show a dip or a zero are noted, in all lanes at once.
4. `dips` are bracketed and refined as peaks are; those beyond zero have a zero on either side.
5. `crossings` are bracketed between samples of opposite signs, and refined with the zeros beside dips.
6. Narrow dips, zeros, and flat places where there may be more, are noted as events of their design.
"""
