"""Results of the steps of a plan, kept so that after an edit only the steps are done whose inputs changed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

T = TypeVar("T")


class Memo:
    """Steps of one run by name, each with its inputs and its result.

    Steps are pure functions of their inputs, so a step whose inputs equal those of the run before has its result too.

    Parameters
    ----------
    before : Memo, optional
        Of the run before; let go of with `close`, so that runs do not hold each other for ever.
    """

    def __init__(self, before: Memo | None = None) -> None:
        self._before: dict[str, tuple[tuple[object, ...], Any]] = {} if before is None else before._steps
        self._steps: dict[str, tuple[tuple[object, ...], Any]] = {}

    def step(self, name: str, make: Callable[[], T], *inputs: object) -> T:
        """The result of a step: the one before where the inputs are equal, or where the new one equals it."""
        known = self._before.get(name)
        if known is not None and _equal(known[0], inputs):
            # The inputs of the run before: equal ones that are the same objects are told apart from others at once.
            self._steps[name] = known
            return known[1]  # type: ignore[no-any-return]
        result = make()
        if known is not None and known[1] == result:
            result = known[1]
        self._steps[name] = (inputs, result)
        return result

    def before(self, name: str) -> Any:
        """The result of a step in the run before, whatever its inputs were; None where there was none."""
        known = self._before.get(name)
        return None if known is None else known[1]

    def close(self) -> None:
        """Forget the run before."""
        self._before = {}


def _equal(before: tuple[object, ...], inputs: tuple[object, ...]) -> bool:
    return len(before) == len(inputs) and all(a is b or a == b for a, b in zip(before, inputs, strict=True))
