"""Cache limited by the total size of its values in bytes."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Hashable
from threading import Lock
from typing import Generic, TypeVar

K = TypeVar("K", bound=Hashable)
V = TypeVar("V")


class ByteCache(Generic[K, V]):
    """Thread-safe cache; the least recently used values are dropped first.

    Parameters
    ----------
    most_bytes : int
        Largest total size of all values.
    largest_bytes : int
        Larger values are not stored.
    """

    def __init__(self, most_bytes: int, largest_bytes: int) -> None:
        self._most_bytes, self._largest_bytes = most_bytes, largest_bytes
        self._kept: OrderedDict[K, tuple[V, int]] = OrderedDict()
        self._bytes = 0
        self._lock = Lock()

    def get(self, key: K) -> V | None:
        with self._lock:
            if key not in self._kept:
                return None
            self._kept.move_to_end(key)
            return self._kept[key][0]

    def keep(self, key: K, value: V, size: int) -> None:
        """Store a value of ``size`` bytes; a value that is too large is not stored, and the least recently used ones
        are dropped.
        """
        if size > self._largest_bytes:
            return
        with self._lock:
            if key not in self._kept:
                self._kept[key] = value, size
                self._bytes += size
            while self._bytes > self._most_bytes:
                self._bytes -= self._kept.popitem(last=False)[1][1]
