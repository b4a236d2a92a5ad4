"""Python's own import, back in its place: imported by the package, for its effect.

For `from __feature__ import ...`, which no module here has, PySide puts another there: it reads and keeps the source of
each of the nine hundred modules that are imported after it.
"""

import builtins

import PySide6.QtCore  # noqa: F401 - it must have put its own there

builtins.__import__ = getattr(builtins, "__orig_import__", builtins.__import__)
