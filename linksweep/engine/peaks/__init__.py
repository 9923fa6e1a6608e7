"""Search for the exact peaks of signals over the turn, for many designs.

1. `find_peaks` and `laid_out` take a plan's designs, block by block, with functions that evaluate its signals: compiled
   for eight designs side by side (`evaluators`, with vectors by `lanewise`), or `interpreted` for one.
2. Signals are evaluated at `samples` of whole `turns`, of pieces between jumps (`on_pieces`), or of any `paths`.
3. Of each signal the best summit is tried: the vertex through five samples, confirmed by four evaluations.
4. Where these do not settle the peak, `summits` opens brackets about all that may be the highest.
5. `brackets` are refined until none may exceed the highest value: the peak. (`zeros` are where pieces end at kinks.)
"""
