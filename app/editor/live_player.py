"""Shows the player to be recorded live in the viewport while the user plays the controller."""

from __future__ import annotations

import time
from collections.abc import Callable
from operator import is_not
from typing import Final

from PySide6.QtCore import QObject, QTimer

from app.editor.session import Session
from app.performance.cast import performers_of
from app.performance.motion import performance_curves
from app.performance.play_along import PlayAlong
from app.plan.events_by_hand import AdditiveEvent, PoseEvent
from app.score.take import ControllerMapping

REST_S: Final = 4.0
"""Seconds after the last received event until the player is shown as in the performance again."""


class LivePlayer(QObject):
    """Applies controller input to the pose of the player to be recorded.

    Parameters
    ----------
    chosen : callable
        Function that returns the id of the player to be recorded, or None.
    """

    def __init__(self, session: Session, chosen: Callable[[], str | None], parent: QObject) -> None:
        super().__init__(parent)
        self._session, self._chosen = session, chosen
        self._play_along: PlayAlong | None = None
        self._of: tuple[object, ...] = ()
        """Inputs of the performer that plays along."""
        self._held: tuple[tuple[PoseEvent, ...], tuple[AdditiveEvent, ...]] = ((), ())
        """Pose of that performer."""
        self._rest = QTimer(self, singleShot=True, interval=round(1000 * REST_S))
        self._rest.timeout.connect(self._rested)

    def report(self, time_s: float, raw: str, mapping: ControllerMapping) -> None:
        """Receive a message from the controller.

        Parameters
        ----------
        time_s : float
            Time of `time.perf_counter`.
        raw : str
            MIDI message in hexadecimal.
        """
        playing = self._ready()
        if playing is not None:
            self._session.live_players.receive(playing.player_id, time_s, raw, mapping)
            self._rest.start()

    def silence(self) -> None:
        """End all notes, since the device no longer sends."""
        if self._play_along is not None:
            self._play_along.all_off(time.perf_counter())
            self._rest.start()

    def _rested(self) -> None:
        """Show the player as in the performance again, unless a take is running or a note is held."""
        if self._play_along is None:
            return
        if self._session.recording.running or self._session.recording.pitch is not None:
            self._rest.start()
            return
        self._session.live_players.end(self._play_along.player_id)
        self._play_along, self._of = None, ()

    def _ready(self) -> PlayAlong | None:
        """Return the object that computes the live pose of the player to be recorded, replaced if the player, the
        instrument or the body has changed; None if the player cannot be shown.
        """
        player_id, performance = self._chosen(), self._session.performance
        player = next((player for player in performance.project.players if player.id == player_id), None)
        if player is None or player.id not in performance.plans or player.id in performance.waiting:
            return None
        plan = performance.plans[player.id]
        of = (
            player.id,
            player.instrument_id,
            player.character_id,
            performance.parameters(player),
            performance.metadata.all_rules,
        )
        if of != self._of:
            if self._play_along is not None:
                self._session.live_players.end(self._play_along.player_id)
            # A player that cannot be shown is listed among the problems.
            self._play_along = None
            for performer in performers_of(performance, (player,)).made.values():
                curves = performance_curves(performance, performer, danced=False)
                self._play_along = PlayAlong(curves, rules=performance.metadata.all_rules)
                self._session.live_players.begin(self._play_along)
            self._of = of
        held = (plan.poses, plan.additive)
        if self._play_along is not None and any(map(is_not, held, self._held)):
            self._play_along.hold(*held)
        self._held = held
        return self._play_along
