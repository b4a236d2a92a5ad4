"""Distribution of the musicians of an export over processes.

The current process works too, and repeats the work of a process that failed, so that errors are reported as if there
were no other processes.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from threading import Lock, Thread

import msgspec

from app.child import Child, ForkedChild, StartedChild, can_fork, core_count
from app.export.player import ExportedPlayer, export_player
from app.export.request import CastMusician, ExportCast, ExportRequest
from app.export.worker import Answer, Exported, job_of, serve

WORTH_FRAMES, WORTH_COPY_FRAMES = 6000, 1000
"""Least number of players' frames for which starting a process, which takes about a second, or copying the current one
saves time.
"""
_MOST = 8
_POLL_S = 0.05


def process_count(request: ExportRequest, cast: ExportCast) -> int:
    """Return the number of processes, including this one, that is worthwhile on this machine."""
    most = max(1, min(_cores(request), len(cast.musicians)))
    if request.processes is not None:
        return most
    frames = request.span.count * len(cast.musicians)
    return max(1, min(most, frames // (WORTH_COPY_FRAMES if can_fork() else WORTH_FRAMES), _MOST))


def _cores(request: ExportRequest) -> int:
    """Return the largest number of processes for an export."""
    return core_count() if request.processes is None else request.processes


def export_players(
    request: ExportRequest,
    cast: ExportCast,
    folder: Path,
    processes: int,
    reported: Callable[[str, float], None],
) -> dict[str, ExportedPlayer]:
    """Export all musicians of a cast.

    Parameters
    ----------
    request : ExportRequest
        The export.
    cast : ExportCast
        Musicians to export.
    folder : path
        Folder to write into; incomplete if an exception is raised.
    processes : int
        Number of processes, including this one.
    reported : callable
        Called in this thread with the id of a musician and the share of its work done, 0..1; its exceptions stop the
        work.

    Returns
    -------
    dict of str to ExportedPlayer
        Results by the id of the musician.
    """
    waiting = Waiting(cast.musicians)
    last: CastMusician | None = None
    finished: dict[str, ExportedPlayer] = {}
    shares: dict[str, float] = {}
    helpers: list[_Helper] = []

    def report(player_id: str, share: float) -> None:
        for other, done in list(shares.items()):
            reported(other, done)
        reported(player_id, share)

    try:
        for child in _children(request, cast, folder, processes - 1):
            helpers.append(_Helper(child, waiting, finished, shares))
        while len(waiting) or any(helper.is_alive() for helper in helpers):
            musician = waiting.take(last)
            if musician is None:
                for helper in helpers:
                    helper.join(_POLL_S)
                for other, done in list(shares.items()):
                    reported(other, done)
                continue
            last, player_id = musician, musician.player.id
            cores = 1 if helpers else _cores(request)
            finished[player_id] = export_player(request, musician, folder, partial(report, player_id), cores)
    finally:
        for helper in helpers:
            helper.end()
    return finished


def _children(request: ExportRequest, cast: ExportCast, folder: Path, count: int) -> list[Child[Answer]]:
    """Start processes that export the musicians whose ids are sent; fewer if no more can be started."""
    children: list[Child[Answer]] = []
    copies = can_fork()
    job = None if copies or not count else job_of(request, folder)
    with contextlib.suppress(OSError):
        for _ in range(count):
            if copies:
                children.append(
                    ForkedChild(Answer, partial(serve, request, cast.musicians, folder), tuple(children), str)
                )
                continue
            children.append(StartedChild(Answer, "app.export.worker"))
            with contextlib.suppress(BrokenPipeError):
                children[-1].send(job)
    return children


class Waiting:
    """Musicians who are still to be exported.

    Data for an instrument and a body can be reused, so each process prefers musicians like its last one.

    Parameters
    ----------
    musicians : sequence of CastMusician
        All musicians to export.
    """

    def __init__(self, musicians: Sequence[CastMusician]) -> None:
        self._left = list(musicians)
        self._begun: set[str] = set()
        self._lock = Lock()

    def __len__(self) -> int:
        return len(self._left)

    def take(self, last: CastMusician | None) -> CastMusician | None:
        """Take the next musician, preferably similar to ``last``; None if none is left."""

        def worth(one: CastMusician) -> tuple[bool, bool, bool]:
            kind = one.player.instrument_id
            same = last is not None and kind == last.player.instrument_id
            return same, kind not in self._begun, last is not None and one.character is last.character

        with self._lock:
            if not self._left:
                return None
            musician = max(self._left, key=worth)
            self._left.remove(musician)
            self._begun.add(musician.player.instrument_id)
            return musician

    def give_back(self, musician: CastMusician) -> None:
        """Return a musician to the queue, so that another process exports it."""
        with self._lock:
            self._left.append(musician)


class _Helper(Thread):
    """Thread that controls a process while musicians are left.

    Parameters
    ----------
    child : Child
        Process that exports the musicians whose ids are sent.
    waiting : Waiting
        Queue of musicians; if the process fails, its musician is returned to it.
    finished : dict of str to ExportedPlayer
        Receives the results.
    shares : dict of str to float
        Share of the work done for each musician.
    """

    def __init__(
        self,
        child: Child[Answer],
        waiting: Waiting,
        finished: dict[str, ExportedPlayer],
        shares: dict[str, float],
    ) -> None:
        super().__init__(daemon=True, name="export helper")
        self._child, self._waiting, self._finished, self._shares = child, waiting, finished, shares
        self.start()

    def run(self) -> None:
        musician: CastMusician | None = None
        while (musician := self._waiting.take(musician)) is not None:
            player_id = musician.player.id
            try:
                self._child.send(player_id)
                while not isinstance(answer := self._child.receive(), Exported):
                    self._shares[player_id] = answer.done
            except (OSError, msgspec.MsgspecError):
                self._shares.pop(player_id, None)
                self._waiting.give_back(musician)
                return
            self._finished[player_id] = answer.player
            self._shares[player_id] = 1.0

    def end(self) -> None:
        """End the process and the thread."""
        self._child.end()
        self.join()
