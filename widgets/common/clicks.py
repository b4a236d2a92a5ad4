"""Connection of ``clicked`` and ``triggered`` signals; no other module connects them directly.

Both signals have an optional argument, and the arguments that PySide passes to a slot that is not a plain function or
method depend on its version: 6.11 calls a `functools.partial` without it. These two functions have typed slots instead.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVarTuple

from PySide6.QtGui import QAction
from PySide6.QtWidgets import QAbstractButton

Arguments = TypeVarTuple("Arguments")


def on_click(source: QAction | QAbstractButton, run: Callable[[*Arguments], object], *arguments: *Arguments) -> None:
    """Call ``run(*arguments)`` whenever a button or menu entry is clicked."""
    clicked = source.triggered if isinstance(source, QAction) else source.clicked
    clicked.connect(lambda _checked: run(*arguments))


def on_switch(source: QAction | QAbstractButton, switch: Callable[[bool], object]) -> None:
    """Call ``switch`` with the new state whenever the user clicks a checkable button or menu entry."""
    clicked = source.triggered if isinstance(source, QAction) else source.clicked
    clicked.connect(lambda checked: switch(checked))
