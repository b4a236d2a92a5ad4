"""Results kept for as long as the same values ask for them."""

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
    """Results of a pure function, each kept under its very inputs, compared by identity.

    Immutable values are equal for ever once they are the same object, and comparing large ones would cost more than
    making the result. The objects are held, so that an identity is never given to another one meanwhile.

    Parameters
    ----------
    size : int
        Results kept; the one unused for longest goes first.
    """

    def __init__(self, size: int) -> None:
        self._size = size
        self._kept: OrderedDict[tuple[int | str, ...], tuple[tuple[object, ...], V]] = OrderedDict()
        self._lock = Lock()

    def has(self, *inputs: object) -> bool:
        """Return whether the result for these inputs is there."""
        with self._lock:
            return _identity(inputs, {}) in self._kept

    def step(self, function: Callable[Inputs, V], *inputs: Inputs.args, **named: Inputs.kwargs) -> V:
        """``function(*inputs, **named)``, made if it is not there.

        Parameters
        ----------
        function : callable
            Of its arguments alone. One that closes over anything else is refused: the key would not know of it.
        """
        return self._step(function, (), inputs, named)

    def helped(
        self,
        function: Callable[Concatenate[Help, Inputs], V],
        help: Help,
        *inputs: Inputs.args,
        **named: Inputs.kwargs,
    ) -> V:
        """``function(help, *inputs, **named)``, where ``help`` only saves or shows work: the result is the same with
        any."""
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
        # Made outside the lock: two threads may make the same result, none waits for another's.
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
    """Large results that can be made again, kept as far as all together stay below a bound of memory.

    Their holders are not held here.

    Parameters
    ----------
    most_bytes : int
        Of all results together. The one used last is kept however large it is.
    """

    def __init__(self, most_bytes: int) -> None:
        self.most_bytes = most_bytes
        self._sizes: OrderedDict[WeakMethod[Callable[[], None]], int] = OrderedDict()
        self._lock = Lock()

    def use(self, forget: Callable[[], None], size_bytes: int) -> None:
        """Note that a result of a size is used; those unused for longest are forgotten where all are too much.

        Parameters
        ----------
        forget : bound method
            Gives back the memory of the result; known by its object, which is held weakly.
        size_bytes : int
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
