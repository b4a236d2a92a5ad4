"""Running of tasks of an export on threads; numpy and zlib release the interpreter's lock."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from typing import Final

from app.child import core_count

_MOST: Final = 4


def in_threads(tasks: Sequence[Callable[[], None]], finished: Callable[[int], None]) -> None:
    """Run all tasks, and return when they are finished.

    Parameters
    ----------
    tasks : sequence of callable
        Tasks; the first exception is raised again, and tasks not yet started are dropped.
    finished : callable
        Called in this thread with the index of each finished task; its exceptions stop the work.
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
