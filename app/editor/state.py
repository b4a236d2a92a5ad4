"""Shared editor state that is not stored in files."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Generic, Self, TypeVar, cast, overload

from PySide6.QtCore import QObject, Signal

T = TypeVar("T")


class State(QObject):
    """Base of objects whose attributes share one signal of change.

    Signals
    -------
    changed()
        One of the attributes has changed.
    """

    changed = Signal()

    def set(self, **values: Any) -> None:
        """Change some attributes; `changed` is emitted once if any of them has changed."""
        different = [name for name, value in values.items() if getattr(self, name) != value]
        for name in different:
            setattr(self, name, values[name])
        if different:
            self.changed.emit()


class Watched(Generic[T]):
    """Descriptor of a value that is read as an attribute, and set by a method that emits a signal.

    Parameters
    ----------
    signal : str
        Name of the object's signal for a change of the value.
    initial : object
        Value at first.
    is_sent : bool
        Whether the signal carries the value.
    """

    def __init__(self, signal: str, initial: T, is_sent: bool = False) -> None:
        self._initial = initial

        def set_value(holder: QObject, value: T) -> None:
            if self.put(holder, value):
                getattr(holder, signal).emit(*([value] if is_sent else []))

        self.setter: Callable[[Any, T], None] = set_value
        """A method that sets the value and emits the signal."""

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = f"_{name}"
        self.setter.__name__ = f"set_{name}"

    @overload
    def __get__(self, holder: None, owner: type) -> Self: ...
    @overload
    def __get__(self, holder: QObject, owner: type) -> T: ...
    def __get__(self, holder: QObject | None, owner: type) -> T | Self:
        return self if holder is None else cast("T", vars(holder).get(self._name, self._initial))

    def put(self, holder: QObject, value: T) -> bool:
        """Set the value without emitting the signal, and return whether the value changed."""
        before = self.__get__(holder, type(holder))
        vars(holder)[self._name] = value
        return bool(before != value)
