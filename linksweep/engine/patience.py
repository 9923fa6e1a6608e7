"""Count the work that is interpreted before compiling pays."""


class Patience:
    """Something that is interpreted until enough work has added up."""

    waited: int = 0
    """Work that was interpreted so far."""

    def should_interpret(self, work: int, most: float) -> bool:
        """Return whether to interpret this much more work, where `most` is the most in all."""
        self.waited += work
        return self.waited <= most
