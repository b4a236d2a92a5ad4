"""Python's cycles are collected in the window's thread alone, and what lasts is not walked through again and again.

A worker that happens to trigger the collection would destroy widgets in its own thread, which Qt does not survive.
"""

from __future__ import annotations

import gc

from PySide6.QtCore import QObject, QTimer

PERIOD_MS = 500
GROWN = 2.0
"""Everything is looked through again once so many times as much has lasted as the last time. Modules, maps and a large
piece are 200,000 objects, and each look at all of them would be a jerk of 100 ms."""


class Garbage(QObject):
    """Collects when Python would have; takes the matter out of its hands for good.

    What survives a collection of the oldest generation is frozen, so that the next one has only what came since. A
    cycle that dies frozen stays until everything is looked through.

    It is made before the first thread of the program, and what is left after `stop` goes with the process.
    """

    def __init__(self) -> None:
        super().__init__()
        gc.disable()
        # Modules and what they made.
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
        """Leave aside what lasts, once it is known to be no rubbish."""
        gc.freeze()
        if gc.get_freeze_count() > GROWN * self._lasting:
            gc.unfreeze()
            gc.collect()
            gc.freeze()
            self._lasting = gc.get_freeze_count()

    def stop(self) -> None:
        """Collect no more; threads that are still ending are not to do so either."""
        self._timer.stop()
        gc.unfreeze()
