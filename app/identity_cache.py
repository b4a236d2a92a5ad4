"""Caches of results, keyed by the identity of their (immutable) inputs."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from threading import Lock
from typing import Concatenate, Generic, ParamSpec, TypeVar
from weakref import WeakMethod

V = TypeVar("V")
Help = TypeVar("Help")
Inputs = ParamSpec("Inputs")


class IdentityCache(Generic[V]):
    """Cached results of pure functions, whose inputs are compared by identity.

    Immutable values that are the same object remain equal, and comparing large values would cost more than computing
    the result. The cache holds the inputs, so that no other object gets their identity.

    Parameters
    ----------
    size : int
        Number of results; the least recently used is dropped first.
    """

    def __init__(self, size: int) -> None:
        self._size = size
        self._kept: OrderedDict[tuple[int | str, ...], tuple[tuple[object, ...], V]] = OrderedDict()
        self._lock = Lock()

    def has(self, *inputs: object) -> bool:
        """Return whether the result for these inputs is cached."""
        with self._lock:
            return _identity(inputs, {}) in self._kept

    def step(self, function: Callable[Inputs, V], *inputs: Inputs.args, **named: Inputs.kwargs) -> V:
        """Return ``function(*inputs, **named)`` from the cache, computing it if it is missing.

        Parameters
        ----------
        function : callable
            Function of its arguments alone. Closures are refused, since the key would not include their variables.
        """
        return self._step(function, (), inputs, named)

    def helped(
        self,
        function: Callable[Concatenate[Help, Inputs], V],
        help: Help,
        *inputs: Inputs.args,
        **named: Inputs.kwargs,
    ) -> V:
        """Return ``function(help, *inputs, **named)`` from the cache, where ``help`` only saves or reports work and
        does not influence the result.
        """
        return self._step(function, (help,), inputs, named)

    def _step(
        self,
        function: Callable[..., V],
        given: tuple[object, ...],
        inputs: tuple[object, ...],
        named: dict[str, object],
    ) -> V:
        if getattr(function, "__closure__", None):
            raise TypeError(f"{function!r} reads more than its arguments")
        identity = _identity(inputs, named)
        with self._lock:
            if identity in self._kept:
                self._kept.move_to_end(identity)
                return self._kept[identity][1]
        # Computed outside the lock: two threads may compute the same result, but neither waits for the other.
        value = function(*given, *inputs, **named)
        with self._lock:
            self._kept[identity] = ((*inputs, *named.values()), value)
            while len(self._kept) > self._size:
                self._kept.popitem(last=False)
        return value


def _identity(inputs: tuple[object, ...], named: dict[str, object]) -> tuple[int | str, ...]:
    if not named:
        return tuple(map(id, inputs))
    return (*map(id, inputs), *(part for name in sorted(named) for part in (name, id(named[name]))))


class LargeResults:
    """Large recomputable results, dropped when their total size exceeds a bound.

    Only weak references to the owners are held.

    Parameters
    ----------
    most_bytes : int
        Bound of the total size. The most recently used result is never dropped.
    """

    def __init__(self, most_bytes: int) -> None:
        self.most_bytes = most_bytes
        self._sizes: OrderedDict[WeakMethod[Callable[[], None]], int] = OrderedDict()
        self._lock = Lock()

    def use(self, forget: Callable[[], None], size_bytes: int) -> None:
        """Record that a result was used, and drop the least recently used results if the total size is too large.

        Parameters
        ----------
        forget : bound method
            Method that frees the result; its object identifies the result and is held weakly.
        size_bytes : int
            Size of the result.
        """
        with self._lock:
            for gone in [one for one in self._sizes if one() is None]:
                del self._sizes[gone]
            used = WeakMethod(forget)
            self._sizes[used] = size_bytes
            self._sizes.move_to_end(used)
            while len(self._sizes) > 1 and sum(self._sizes.values()) > self.most_bytes:
                oldest = self._sizes.popitem(last=False)[0]()
                if oldest is not None:
                    oldest()
