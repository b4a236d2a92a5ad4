"""Who is played now, from a controller: the viewport shows them as they play and not as the performance has them."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from time import perf_counter
from types import MappingProxyType
from typing import Final

from PySide6.QtCore import QObject, Signal

from app.performance.chunks import Pose
from app.performance.play_along import PlayAlong
from app.score.take import Wiring

SAME_S: Final = 0.006
"""A pose that is asked for again so soon is the same: the window shows it, and the network is sent it."""


class LivePlayers(QObject):
    """The players that are armed, each with what makes the pose of now.

    Whoever listens to a controller makes a `PlayAlong` of the player, hands it over with `begin`, tells `hear` what is
    played (stamped by ``time.perf_counter``) and takes it back with `end`. After a change of the player, the
    instrument or the body another one is begun in its place.

    Signals
    -------
    changed()
        Others are played now, or somebody otherwise.
    struck()
        A note began or ended: whoever draws need not wait.
    """

    changed = Signal()
    struck = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._playing: dict[str, PlayAlong] = {}
        self._lock = threading.Lock()
        """What plays along is asked for poses by the thread that streams them, too."""
        self._poses: dict[str, tuple[float, Pose]] = {}
        """The pose that was made last of each, and when."""

    @property
    def playing(self) -> Mapping[str, PlayAlong]:
        """By the player's id."""
        return MappingProxyType(self._playing)

    def begin(self, play_along: PlayAlong) -> None:
        """Show this player as played from now on."""
        with self._lock:
            self._playing[play_along.player_id] = play_along
            self._poses.pop(play_along.player_id, None)
        self.changed.emit()

    def end(self, player_id: str) -> None:
        """Show a player as the performance has it again."""
        with self._lock:
            gone = self._playing.pop(player_id, None)
        if gone is not None:
            self.changed.emit()

    def hear(self, player_id: str, time_s: float, raw: str, wiring: Wiring) -> None:
        """A player is played so: a MIDI message in hexadecimal, see `PlayAlong.hear`."""
        with self._lock:
            play_along = self._playing.get(player_id)
            struck = play_along is not None and play_along.hear(time_s, raw, wiring)
            if struck:
                self._poses.pop(player_id, None)
        if struck:
            self.struck.emit()

    def pose(self, player_id: str) -> Pose | None:
        """How a player stands now; None for who is not played."""
        with self._lock:
            play_along = self._playing.get(player_id)
            if play_along is None:
                return None
            now_s = perf_counter()
            known = self._poses.get(player_id)
            if known is None or now_s - known[0] > SAME_S:
                known = self._poses[player_id] = (now_s, play_along.pose(now_s))
            return known[1]
