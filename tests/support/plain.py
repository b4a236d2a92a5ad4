"""Plug-in for running tests without the plug-ins for Qt and the display, which declares their options (``-p
tests.support.plain -p no:pytest-qt -p no:xvfb``).
"""

from __future__ import annotations

import pytest


def pytest_addoption(parser: pytest.Parser) -> None:
    """Declare the options of the missing plug-ins."""
    for name in ("qt_log_level_fail", "xvfb_width", "xvfb_height", "xvfb_colordepth"):
        parser.addini(name, "of a plug-in that is left out")
