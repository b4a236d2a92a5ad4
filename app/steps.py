"""Pure functions computed from each other's results, each only if its inputs have changed.

The parameters of a step are names of other steps' results or of given values. Parameters with defaults keep them unless
`reading` names them. A parameter ``before`` is the step's own result of the previous run, or None; it may only save
work, since the result must be equal to that computed from None.
"""

from __future__ import annotations

import inspect
from collections import Counter
from collections.abc import Callable, Collection, Mapping
from graphlib import TopologicalSorter
from operator import attrgetter, is_
from typing import Any, Final, NamedTuple, TypeVar

import numpy as np

T = TypeVar("T")
BEFORE: Final = "before"


class StepInputs(NamedTuple):
    """A function as a step whose parameters are filled from values of other names: the names of the values by
    parameter.
    """

    function: Callable[..., object]
    names: Mapping[str, str | tuple[str, ...]]


def reading(function: Callable[..., object], **names: str | tuple[str, ...]) -> StepInputs:
    """Declare a step whose parameters are filled from values of other names; a tuple of names fills one parameter with
    several values.

    Raises
    ------
    TypeError
        The function has no such parameter.
    """
    unknown = names.keys() - inspect.signature(function).parameters.keys()
    if unknown:
        raise TypeError(f"{_name(function)} has no {sorted(unknown)}")
    return StepInputs(function, names)


class StepTable:
    """Steps by the names of their results, connected by the names of their parameters; a string is the path of an
    attribute of another result (``clock="piece.clock"``).

    Attributes
    ----------
    functions : dict of str to callable
        Function of each step, by the name of its result.
    paths : dict of str to str
        Path of each value that is an attribute of another result.
    getters : dict of str to (str, callable)
        For each attribute, the result that has it and a function that gets it.
    parameters, reads : dict of str to tuple
        For each step, its parameters other than `BEFORE`, and the name or names of the value of each.
    revised : frozenset of str
        Steps that receive their result of the previous run.
    given : frozenset of str
        Names that are not results of a step.

    Raises
    ------
    TypeError
        A function is a closure or has parameters without names, so that its inputs cannot be known.
    graphlib.CycleError
        Steps depend on each other in a circle.
    """

    def __init__(self, **steps: Callable[..., object] | StepInputs | str) -> None:
        self.paths: Final = {name: path for name, path in steps.items() if isinstance(path, str)}
        split = {name: path.split(".", 1) for name, path in self.paths.items()}
        self.getters: Final = {name: (base, attrgetter(attributes)) for name, (base, attributes) in split.items()}
        read = {
            name: step if isinstance(step, StepInputs) else StepInputs(step, {})
            for name, step in steps.items()
            if not isinstance(step, str)
        }
        self.functions: Final = {name: step.function for name, step in read.items()}
        parameters = {name: _parameters(step) for name, step in read.items()}
        self.revised: Final = frozenset(name for name, names in parameters.items() if BEFORE in names)
        self.parameters: Final = {
            name: tuple(one for one in ones if one != BEFORE) for name, ones in parameters.items()
        }
        self.reads: Final = {
            name: tuple(read[name].names.get(one, one) for one in ones) for name, ones in self.parameters.items()
        }
        count = Counter(self.functions.values())
        self.names: Final = {function: name for name, function in self.functions.items() if count[function] == 1}
        names = {name: [one for named in reads for one in _each(named)] for name, reads in self.reads.items()}
        names |= {name: [base] for name, (base, _) in self.getters.items()}
        TopologicalSorter(names).prepare()
        self.given: Final = frozenset(one for reads in names.values() for one in reads if one not in steps)

    def begin(self, before: StepResults | None = None, /, **given: object) -> StepResults:
        """Begin a run of the steps; each is computed when its result is first requested.

        Parameters
        ----------
        before : StepResults, optional
            Previous run of the same steps.
        given : object
            Values by name: at least those in the attribute `given`.

        Raises
        ------
        TypeError
            A value is missing.
        """
        try:
            taken = {name: given[name] for name in self.given}
        except KeyError:
            raise TypeError(f"not given: {sorted(self.given - given.keys())}") from None
        return StepResults(self, taken, before)


class _Done(NamedTuple):
    inputs: tuple[object, ...]
    result: Any


class StepResults:
    """Results of one run; results equal to those of the previous run are the same objects.

    A run must be used by one thread at a time.
    """

    def __init__(self, steps: StepTable, given: Mapping[str, object], before: StepResults | None) -> None:
        self._steps = steps
        self._given = given
        self._before: dict[str, _Done] = {} if before is None else before._done
        self._done: dict[str, _Done]
        self._values: dict[str, Any]
        # With the same table both mappings have the same order of keys.
        if before is not None and before._steps is steps and _are_equal(before._given.values(), given.values()):
            # No input changed, so no step is examined.
            self._given, self._done, self._values = before._given, dict(before._done), dict(before._values)
        else:
            self._done, self._values = {}, dict(given)

    def of(self, function: Callable[..., T]) -> T:
        """Return the result of the step that uses this function; there must be only one."""
        result: T = self[self._steps.names[function]]
        return result

    def __getitem__(self, name: str) -> Any:
        """Return the result of a step, computed on first use, or a given value, by its name."""
        values = self._values
        if name in values:
            return values[name]
        if name in self._steps.getters:
            base, attribute = self._steps.getters[name]
            values[name] = value = attribute(values[base] if base in values else self[base])
            return value
        known = self._before.get(name)
        inputs = tuple([
            tuple(map(self.__getitem__, one)) if isinstance(one, tuple) else values[one] if one in values else self[one]
            for one in self._steps.reads[name]
        ])  # fmt: skip
        if known is None or not _are_equal(known.inputs, inputs):
            known = self._do(name, inputs, known)
        self._done[name] = known
        values[name] = known.result
        return known.result

    def _do(self, name: str, inputs: tuple[object, ...], known: _Done | None) -> _Done:
        former = None if known is None else known.result
        called = dict(zip(self._steps.parameters[name], inputs, strict=True))
        if name in self._steps.revised:
            called[BEFORE] = former
        result = self._steps.functions[name](**called)
        return _Done(inputs, former if known is not None and former == result else result)

    def close(self) -> None:
        """Drop the reference to the previous run, so that runs do not keep each other in memory."""
        self._before = {}


class StepRuns:
    """Current runs of step tables by subject, such as a player; each continues from the previous run of the same
    subject.

    Parameters
    ----------
    former : StepRuns, optional
        Runs of a previous or any other state; they save work without changing results.
    """

    def __init__(self, former: StepRuns | None = None) -> None:
        self._former = {} if former is None else former._runs
        self._runs: dict[tuple[StepTable, str], StepResults] = {}

    def begin(self, table: StepTable, about: str = "", /, **given: object) -> StepResults:
        """Begin a run as `StepTable.begin` does, continuing from and replacing the earlier run of the same table and
        subject ``about``.
        """
        key = table, about
        self._runs[key] = results = table.begin(self._former.get(key), **given)
        return results

    def of(self, table: StepTable, about: str = "") -> StepResults:
        """Return the current run of a table for the subject ``about``. Raises KeyError if there is none."""
        return self._runs[table, about]

    def close(self) -> None:
        """Drop the references to previous runs, so that runs do not keep each other in memory."""
        self._former = {}
        for results in self._runs.values():
            results.close()


def _are_equal(before: Collection[object], now: Collection[object]) -> bool:
    """Return whether inputs are equal; identical objects, which are the usual case, are not compared."""
    if len(before) != len(now):
        return False
    return all(map(is_, before, now)) or all(
        one is other or _is_equal(one, other) for one, other in zip(before, now, strict=True)
    )


def _is_equal(one: object, other: object) -> bool:
    """Return whether two inputs are equal: arrays, as wholes, to arrays only."""
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return isinstance(one, np.ndarray) and isinstance(other, np.ndarray) and np.array_equal(one, other)
    return bool(one == other)


def _each(named: str | tuple[str, ...]) -> tuple[str, ...]:
    return (named,) if isinstance(named, str) else named


def _parameters(step: StepInputs) -> tuple[str, ...]:
    """Return the names of the step's parameters, which receive inputs or results of other steps. Raises TypeError for
    functions that cannot be a step."""
    if getattr(step.function, "__closure__", None):
        raise TypeError(f"{_name(step.function)} reads more than its parameters")
    parameters = inspect.signature(step.function).parameters.values()
    if any(one.kind not in (one.POSITIONAL_OR_KEYWORD, one.KEYWORD_ONLY) for one in parameters):
        raise TypeError(f"{_name(step.function)} has parameters without names")
    return tuple(one.name for one in parameters if one.default is one.empty or one.name in step.names)


def _name(function: Callable[..., object]) -> str:
    return getattr(function, "__qualname__", str(function))
