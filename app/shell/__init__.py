"""The editor: composition of the panels in a window, and nothing else.

For `from __feature__ import ...`, which no module here has, PySide puts an import of its own in the place of Python's:
it reads and keeps the source of each of the nine hundred modules that are imported after it. Python's own goes back.
"""

import builtins

import PySide6.QtCore  # noqa: F401 - it must have put its own there

builtins.__import__ = getattr(builtins, "__orig_import__", builtins.__import__)
