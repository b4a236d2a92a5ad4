"""Results of the steps of a plan, kept so that after an edit only the steps are done whose inputs changed."""

from __future__ import annotations

from collections.abc import Callable
from itertools import islice
from typing import Any, NamedTuple, TypeVar, TypeVarTuple

T = TypeVar("T")
Inputs = TypeVarTuple("Inputs")


class _Done(NamedTuple):
    """A step that was done: its inputs, its result, and the names of the steps within it."""

    inputs: tuple[object, ...]
    result: Any
    within: tuple[str, ...]


class Memo:
    """Steps of one run by name, each with its inputs and its result.

    Steps are pure functions of their inputs, so a step whose inputs equal those of the run before has its result too.

    Parameters
    ----------
    before : Memo, optional
        Of the run before; let go of with `close`, so that runs do not hold each other for ever.
    """

    def __init__(self, before: Memo | None = None) -> None:
        self._before: dict[str, _Done] = {} if before is None else before._steps
        self._steps: dict[str, _Done] = {}

    def step(self, name: str, function: Callable[[*Inputs], T], *inputs: *Inputs) -> T:
        """``function(*inputs)``: the result before where the inputs are equal, or where the new one equals it.

        Parameters
        ----------
        function : callable
            Of its arguments alone. One that closes over anything else is refused: the key would not know of it.
        """
        return self._step(name, function, inputs, ())

    def nested(self, name: str, function: Callable[[Memo, *Inputs], T], *inputs: *Inputs) -> T:
        """The same of a step that has steps of its own: it is given this memo too."""
        return self._step(name, function, inputs, (self,))

    def revised(self, name: str, function: Callable[[T | None, *Inputs], T], *inputs: *Inputs) -> T:
        """The same of a step that can use its result in the run before, whatever the inputs were: to save work, since
        the result must be the one it makes from None."""
        known = self._before.get(name)
        return self._step(name, function, inputs, (None if known is None else known.result,))

    def _step(self, name: str, function: Callable[..., T], inputs: tuple[object, ...], given: tuple[object, ...]) -> T:
        if getattr(function, "__closure__", None):
            raise TypeError(f"step {name!r} reads more than its arguments")
        known = self._before.get(name)
        # Items that are the same objects are not compared.
        if known is not None and known.inputs == inputs:
            # The inputs of the run before: equal ones that are the same objects are distinguished from others at once.
            self._steps[name] = known
            # What was done within it is needed where the next run has other inputs.
            for inner in known.within:
                self._steps[inner] = self._before[inner]
            return known.result  # type: ignore[no-any-return]
        count = len(self._steps)
        result: T = function(*given, *inputs)
        if known is not None and known.result == result:
            result = known.result
        self._steps[name] = _Done(inputs, result, tuple(islice(self._steps, count, None)))
        return result

    def close(self) -> None:
        """Forget the run before."""
        self._before = {}
