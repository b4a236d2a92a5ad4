"""Tasks of one export done side by side: numpy and zlib let other threads run while they work."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from typing import Final

from app.child import core_count

_MOST: Final = 4


def in_threads(tasks: Sequence[Callable[[], None]], finished: Callable[[int], None]) -> None:
    """Do all tasks.

    Parameters
    ----------
    tasks : sequence of callable
        What one raises is raised here; those that have not begun are dropped then.
    finished : callable
        Called in this thread with the index of each task that is done; what it raises stops the work.
    """
    with ThreadPoolExecutor(min(core_count(), _MOST)) as pool:
        indices = {pool.submit(task): index for index, task in enumerate(tasks)}
        try:
            for future in as_completed(indices):
                future.result()
                finished(indices[future])
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
