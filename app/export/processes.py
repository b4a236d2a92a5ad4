"""The musicians of an export shared over processes.

This process works too, and does again what a process that has ended did not finish: what is wrong is reported as if
there were no other processes.
"""

from __future__ import annotations

import contextlib
import subprocess
from collections import deque
from collections.abc import Callable
from functools import partial
from pathlib import Path
from threading import Thread

import msgspec

from app.export.player import ExportedPlayer, export_player
from app.export.request import ExportCast, Request
from app.export.worker import Answer, Exported, job_of
from app.own_process import core_count, own_process, receive, send
from app.performance.cast import Performer

WORTH_FRAMES = 6000
"""Frames of players for which it is worth to start a process, which takes about a second."""
_MOST = 8
_POLL_S = 0.05


def process_count(request: Request, cast: ExportCast) -> int:
    """How many processes, this one among them, an export is worth on this machine."""
    if request.processes is not None:
        return min(request.processes, max(len(cast.performers), 1))
    frames = request.span.count * len(cast.performers)
    return max(1, min(core_count(), len(cast.performers), frames // WORTH_FRAMES, _MOST))


def export_players(
    request: Request,
    cast: ExportCast,
    folder: Path,
    processes: int,
    reported: Callable[[str, float], None],
) -> dict[str, ExportedPlayer]:
    """Export all musicians of a cast.

    Parameters
    ----------
    request : Request
    cast : ExportCast
    folder : path
        What is in it when something is raised is not complete.
    processes : int
        This one among them.
    reported : callable
        Called, always in this thread, with the id of a musician and the share 0..1 of the work on it that is done; what
        it raises stops the work.

    Returns
    -------
    dict of str to ExportedPlayer
        By the id of the musician.
    """
    waiting = deque(cast.performers)
    finished: dict[str, ExportedPlayer] = {}
    shares: dict[str, float] = {}
    helpers: list[_Helper] = []

    def report(player_id: str, share: float) -> None:
        for other, done in list(shares.items()):
            reported(other, done)
        reported(player_id, share)

    try:
        if processes > 1:
            job = msgspec.msgpack.encode(job_of(request, folder))
            with contextlib.suppress(OSError):  # where no process can be started, this one does all
                for _ in range(processes - 1):
                    helpers.append(_Helper(job, waiting, finished, shares))
        while waiting or any(helper.is_alive() for helper in helpers):
            try:
                performer = waiting.popleft()
            except IndexError:
                for helper in helpers:
                    helper.join(_POLL_S)
                for other, done in list(shares.items()):
                    reported(other, done)
                continue
            player_id = performer.player.id
            finished[player_id] = export_player(request, cast, performer, folder, partial(report, player_id))
    finally:
        for helper in helpers:
            helper.end()
    return finished


class _Helper(Thread):
    """Has a process export what is waiting.

    Parameters
    ----------
    job : bytes
        An encoded `Job`.
    waiting : deque of Performer
        Those that have not been started: taken from the left; one whose process ended comes back.
    finished : dict of str to ExportedPlayer
        What was exported is put there.
    shares : dict of str to float
        How much is done of each musician.
    """

    def __init__(
        self,
        job: bytes,
        waiting: deque[Performer],
        finished: dict[str, ExportedPlayer],
        shares: dict[str, float],
    ) -> None:
        super().__init__(daemon=True, name="export helper")
        self._job, self._waiting, self._finished, self._shares = job, waiting, finished, shares
        self._child = subprocess.Popen(
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, **own_process("app.export.worker")
        )
        self.start()

    def run(self) -> None:
        to, back = self._child.stdin, self._child.stdout
        assert to is not None
        assert back is not None
        decoder = msgspec.msgpack.Decoder(Answer)
        with contextlib.suppress(BrokenPipeError):
            send(to, self._job)
        while self._waiting:
            try:
                performer = self._waiting.popleft()
            except IndexError:
                return
            player_id = performer.player.id
            try:
                send(to, player_id.encode())
                while not isinstance(answer := decoder.decode(receive(back)), Exported):
                    self._shares[player_id] = answer.done
            except (OSError, msgspec.MsgspecError):
                self._shares.pop(player_id, None)
                self._waiting.append(performer)
                return
            self._finished[player_id] = answer.player
            self._shares[player_id] = 1.0

    def end(self) -> None:
        """End the process, whatever it does."""
        self._child.kill()
        self._child.wait()
        self.join()
        for stream in (self._child.stdin, self._child.stdout):
            assert stream is not None
            with contextlib.suppress(OSError):
                stream.close()
