"""The editor: composition of the panels in a window, and nothing else."""

import builtins

import PySide6.QtCore  # noqa: F401 - it must have put its own in place

# For `from __feature__ import ...`, which no module here has, PySide takes the place of Python's import: it reads and
# keeps the source of each of the nine hundred modules that are imported after it.
builtins.__import__ = getattr(builtins, "__orig_import__", builtins.__import__)
