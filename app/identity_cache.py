"""Results kept for as long as the very same values ask for them."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from threading import Lock
from typing import Generic, TypeVar

V = TypeVar("V")


class IdentityCache(Generic[V]):
    """Maps tuples of objects, compared by identity, to what was made from them.

    Immutable values are equal for ever once they are the same object, and comparing large ones would cost more than
    making the result. The objects are held, so that an identity is never given to another one meanwhile.

    Parameters
    ----------
    size : int
        Results kept; the one unused for longest goes first.
    """

    def __init__(self, size: int) -> None:
        self._size = size
        self._kept: OrderedDict[tuple[int, ...], tuple[tuple[object, ...], V]] = OrderedDict()
        self._lock = Lock()

    def has(self, keys: tuple[object, ...]) -> bool:
        """Whether the result for these objects is there."""
        with self._lock:
            return tuple(map(id, keys)) in self._kept

    def get(self, keys: tuple[object, ...], make: Callable[[], V]) -> V:
        """The result for these objects, made if it is not there."""
        identity = tuple(map(id, keys))
        with self._lock:
            if identity in self._kept:
                self._kept.move_to_end(identity)
                return self._kept[identity][1]
        # Made outside the lock: two threads may make the same result, none waits for another's.
        value = make()
        with self._lock:
            self._kept[identity] = (keys, value)
            while len(self._kept) > self._size:
                self._kept.popitem(last=False)
        return value
