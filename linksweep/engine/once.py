"""Properties that are computed once, also where several threads ask for one at the same time."""

from functools import cached_property
from threading import RLock
from typing import TYPE_CHECKING, Any

_lock = RLock()

if TYPE_CHECKING:
    from functools import cached_property as once
else:

    class once(cached_property):
        """A property that is kept, and computed by one thread alone: `cached_property` has no lock from Python 3.12."""

        def __get__(self, owner: Any, kind: type | None = None) -> Any:
            with _lock:
                return super().__get__(owner, kind)
