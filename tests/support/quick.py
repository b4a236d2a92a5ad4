"""Plug-in for the tests that `./test --quick` runs: Qt's modules cannot be imported, so that no system package is
needed.

The plug-ins for Qt and the display are left out (``-p no:pytest-qt -p no:xvfb``); their options are known all
the same. A test that loads one of Qt's modules fails here, wherever Qt is installed.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib.machinery import ModuleSpec
from types import ModuleType

import pytest

from tests.support import plain

NEEDS_A_SYSTEM = ("PySide6.QtGui", "PySide6.QtWidgets", "PySide6.QtOpenGL", "rtmidi", "rtmidi2", "bpy")


class _Refused:
    """Import hook that refuses modules with system libraries."""

    def find_spec(self, name: str, path: Sequence[str] | None, target: ModuleType | None = None) -> ModuleSpec | None:
        if name in NEEDS_A_SYSTEM:
            raise ImportError(f"{name} is not for quick tests")
        return None


def pytest_addoption(parser: pytest.Parser) -> None:
    """Declare the options of the missing plug-ins, and deselect tests that need system packages."""
    plain.pytest_addoption(parser)
    sys.meta_path.insert(0, _Refused())
