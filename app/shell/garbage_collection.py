"""Garbage collection of Python in the window's thread only, which passes over long-lived objects.

A collection in a worker thread would destroy widgets in that thread, which crashes Qt.
"""

from __future__ import annotations

import gc

from PySide6.QtCore import QObject, QTimer

PERIOD_MS = 500
GROWN = 2.0
"""Growth factor of the long-lived objects after which all of them are collected again. Modules, maps and a large piece
are 200,000 objects, whose collection takes 100 ms.
"""


class Garbage(QObject):
    """Runs the collection at Python's thresholds, replacing the automatic one permanently.

    Objects that survive a collection of the oldest generation are frozen, so that the next collection examines only
    newer ones. A frozen cycle that becomes garbage stays until everything is examined.

    Create it before the program's first thread. Garbage left after `stop` is freed when the process ends.
    """

    def __init__(self) -> None:
        super().__init__()
        gc.disable()
        # Modules and their objects.
        gc.freeze()
        self._lasting = gc.get_freeze_count()
        self._timer = QTimer(self, interval=PERIOD_MS)
        self._timer.timeout.connect(self.collect)
        self._timer.start()

    def collect(self) -> None:
        """Collect the generations that exceed Python's thresholds."""
        for generation in (2, 1, 0):
            if gc.get_count()[generation] > gc.get_threshold()[generation]:
                gc.collect(generation)
                if generation == 2:
                    self._freeze()
                return

    def _freeze(self) -> None:
        """Freeze the objects that have survived a collection."""
        gc.freeze()
        if gc.get_freeze_count() > GROWN * self._lasting:
            gc.unfreeze()
            gc.collect()
            gc.freeze()
            self._lasting = gc.get_freeze_count()

    def stop(self) -> None:
        """Stop collecting, also for threads that are still ending."""
        self._timer.stop()
        gc.unfreeze()
