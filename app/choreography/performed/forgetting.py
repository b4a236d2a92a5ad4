"""Large results that can be made again, kept as far as all of them together stay below a bound of memory."""

from __future__ import annotations

from collections import OrderedDict
from threading import Lock
from typing import Protocol
from weakref import ref


class Forgetful(Protocol):
    """Holds a result that it can make again."""

    def forget(self) -> None:
        """Give back the memory of the result."""


class Remembered:
    """Those that hold a result now, the one used last at the end. They are not held here.

    Parameters
    ----------
    most_bytes : int
        Of all results together. The one used last is kept however large it is.
    """

    def __init__(self, most_bytes: int) -> None:
        self.most_bytes = most_bytes
        self._sizes: OrderedDict[ref[Forgetful], int] = OrderedDict()
        self._lock = Lock()

    def use(self, holder: Forgetful, size_bytes: int) -> None:
        """Note that a result of a size is used; those unused for longest are forgotten where all are too much."""
        with self._lock:
            for gone in [one for one in self._sizes if one() is None]:
                del self._sizes[gone]
            used = ref(holder)
            self._sizes[used] = size_bytes
            self._sizes.move_to_end(used)
            while len(self._sizes) > 1 and sum(self._sizes.values()) > self.most_bytes:
                oldest = self._sizes.popitem(last=False)[0]()
                if oldest is not None:
                    oldest.forget()
