"""Python's cycles are collected in the window's thread alone.

A worker that happens to trigger the collection would destroy widgets in its own thread, which Qt does not survive.
"""

from __future__ import annotations

import gc

from PySide6.QtCore import QObject, QTimer

PERIOD_MS = 500


class Garbage(QObject):
    """Collects when Python would have; takes the matter out of its hands for good.

    It is made before the first thread of the program, and what is left after `stop` goes with the process.
    """

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        gc.disable()
        self._timer = QTimer(self)
        self._timer.setInterval(PERIOD_MS)
        self._timer.timeout.connect(self.collect)
        self._timer.start()

    def collect(self) -> None:
        """What Python's thresholds ask for."""
        for generation in (2, 1, 0):
            if gc.get_count()[generation] > gc.get_threshold()[generation]:
                gc.collect(generation)
                return

    def stop(self) -> None:
        """Collect no more; threads that are still ending are not to do so either."""
        self._timer.stop()
