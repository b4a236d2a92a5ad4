"""Who is played now, from a controller: the viewport shows them as they play and not as the performance has them."""

from __future__ import annotations

from collections.abc import Mapping
from time import perf_counter
from types import MappingProxyType

from PySide6.QtCore import QObject, Signal

from app.performance.chunks import Pose
from app.performance.play_along import PlayAlong
from app.score.take import Wiring


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

    @property
    def playing(self) -> Mapping[str, PlayAlong]:
        """By the player's id."""
        return MappingProxyType(self._playing)

    def begin(self, play_along: PlayAlong) -> None:
        """Show this player as played from now on."""
        self._playing[play_along.player_id] = play_along
        self.changed.emit()

    def end(self, player_id: str) -> None:
        """Show a player as the performance has it again."""
        if self._playing.pop(player_id, None) is not None:
            self.changed.emit()

    def hear(self, player_id: str, time_s: float, raw: str, wiring: Wiring) -> None:
        """A player is played so: a MIDI message in hexadecimal, see `PlayAlong.hear`."""
        play_along = self._playing.get(player_id)
        if play_along is not None and play_along.hear(time_s, raw, wiring):
            self.struck.emit()

    def pose(self, player_id: str) -> Pose | None:
        """How a player stands now; None for who is not played."""
        play_along = self._playing.get(player_id)
        return None if play_along is None else play_along.pose(perf_counter())
