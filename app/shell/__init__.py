"""The editor's window, composed of the panels.

PySide replaces Python's import function for its optional `from __feature__ import ...`, and then reads and stores the
source of all further modules. No module here uses that feature, so the original function is restored.
"""

import builtins

import PySide6.QtCore  # noqa: F401 - it must have put its own there

builtins.__import__ = getattr(builtins, "__orig_import__", builtins.__import__)
