"""Players currently driven by a controller, for display in the viewport."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from dataclasses import dataclass
from time import perf_counter
from types import MappingProxyType
from typing import Final

from PySide6.QtCore import QObject, Signal

from app.arrays import SingleArray
from app.performance.chunks import Pose
from app.performance.play_along import PlayAlong
from app.score.take import ControllerMapping

SAME_S: Final = 0.006
"""Seconds within which a requested pose is the same as the previous one, since the window and the network request it
for the same moment.
"""
BLEND_S: Final = 0.2
"""Duration in seconds of the transition between the performance's pose and the controller's."""


@dataclass(frozen=True)
class _Blend:
    """A gradual transition of a player's pose between generated (0) and live (1) motion: from the weight ``before`` to
    1 or 0 (``after``), starting at the time ``since_s``.
    """

    since_s: float
    before: float
    after: float

    def at(self, now_s: float) -> float:
        gone = min(max((now_s - self.since_s) / BLEND_S, 0.0), 1.0)
        return self.before + (self.after - self.before) * gone * gone * (3.0 - 2.0 * gone)


class LivePlayers(QObject):
    """The live players, each with the object that computes its current pose.

    The controller's listener creates a `PlayAlong`, registers it with `begin`, passes each message (with a time of
    ``time.perf_counter``) to `receive` and removes it with `end`. After a change of player, instrument or body another
    `PlayAlong` replaces it.

    Signals
    -------
    changed()
        A player became live or no longer is, or the object that computes a player's live pose was replaced.
    struck()
        A note began or ended: redraw at once.
    """

    changed = Signal()
    struck = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._playing: dict[str, PlayAlong] = {}
        self._lock = threading.Lock()
        """Guards the performers that play along: the thread that streams poses reads them too."""
        self._poses: dict[str, tuple[float, Pose]] = {}
        """The last pose of each player, and when it was made; also of players that have just ended."""
        self._blends: dict[str, _Blend] = {}

    @property
    def playing(self) -> Mapping[str, PlayAlong]:
        """Return the objects that compute the poses of the live players, by player id."""
        return MappingProxyType(self._playing)

    @property
    def is_shown(self) -> bool:
        """Return whether a player is live, or is changing back gradually to the performance."""
        with self._lock:
            now_s = perf_counter()
            return bool(self._playing) or any(blend.at(now_s) > 0.0 for blend in self._blends.values())

    def begin(self, play_along: PlayAlong) -> None:
        """Show the player of ``play_along`` live from now on."""
        with self._lock:
            self._playing[play_along.player_id] = play_along
            self._poses.pop(play_along.player_id, None)
            self._go(play_along.player_id, 1.0)
        self.changed.emit()

    def end(self, player_id: str) -> None:
        """Show a player as in the performance again."""
        with self._lock:
            gone = self._playing.pop(player_id, None)
            if gone is not None:
                self._go(player_id, 0.0)
        if gone is not None:
            self.changed.emit()

    def receive(self, player_id: str, time_s: float, raw: str, mapping: ControllerMapping) -> None:
        """Pass a MIDI message in hexadecimal from the controller to a live player; see `PlayAlong.receive`."""
        with self._lock:
            play_along = self._playing.get(player_id)
            struck = play_along is not None and play_along.receive(time_s, raw, mapping)
            if struck:
                self._poses.pop(player_id, None)
        if struck:
            self.struck.emit()

    def lying(self, player_id: str, other_id: str) -> tuple[SingleArray, SingleArray] | None:
        """Return position in metres (3,) and rotation quaternion (4,) of another instrument of a musician, while the
        musician plays the one of ``player_id`` live; None if that player is not live.
        """
        play_along = self._playing.get(player_id)
        return None if play_along is None else play_along.lying.get(other_id)

    def pose(self, player_id: str, at_s: float) -> tuple[Pose, float] | None:
        """Return a player's current live pose and its weight 0..1 relative to the performance; None if the player is
        not live.

        Parameters
        ----------
        at_s : float
            Time in the piece.
        """
        with self._lock:
            now_s = perf_counter()
            live, share = self._live(player_id, now_s, at_s), self._share(player_id, now_s)
        return (live, share) if live is not None and share > 0.0 else None

    def _live(self, player_id: str, now_s: float, at_s: float) -> Pose | None:
        play_along, known = self._playing.get(player_id), self._poses.get(player_id)
        if play_along is not None and (known is None or now_s - known[0] > SAME_S):
            known = self._poses[player_id] = (now_s, play_along.pose(now_s, at_s))
        return known[1] if known is not None else None

    def _share(self, player_id: str, now_s: float) -> float:
        blend = self._blends.get(player_id)
        share = blend.at(now_s) if blend is not None else 0.0
        if blend is not None and share == blend.after == 0.0:
            # The blend back to the performance is complete.
            del self._blends[player_id]
            self._poses.pop(player_id, None)
        return share

    def _go(self, player_id: str, share: float) -> None:
        now_s = perf_counter()
        before = self._blends.get(player_id)
        self._blends[player_id] = _Blend(now_s, before.at(now_s) if before is not None else 0.0, share)
