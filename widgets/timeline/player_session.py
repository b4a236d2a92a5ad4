"""A session for the lanes of one stacked player, in which this player is in front."""

from __future__ import annotations

from typing import Any, cast

from PySide6.QtCore import QObject, Signal

from app.editor.session import Session
from app.plan.model import PlayerPlan
from app.project.performers import Player


class _PlayerChoice(QObject):
    """Signal of the one thing in which a `PlayerSession` differs from its session."""

    players_changed = Signal()


class PlayerSession:
    """All of a session but the player in front: so the same lanes show and edit any player.

    What is selected or edited is the session's own. Before a lane is used, its player is put in front there, so that
    commands are about the lane that has the keyboard.

    Parameters
    ----------
    session : Session
        Everything else is read from and done by it.
    """

    def __init__(self, session: Session) -> None:
        self._session, self._player_id = session, ""
        self._choice = _PlayerChoice(session)
        self.players_changed = self._choice.players_changed

    def __getattr__(self, name: str) -> Any:
        return getattr(self._session, name)

    @property
    def of_lanes(self) -> Session:
        """Itself, for lanes."""
        return cast("Session", self)

    @property
    def player_id(self) -> str:
        """Id of the player that is shown; empty: none."""
        return self._player_id

    def show(self, player_id: str) -> None:
        """Show another player."""
        if player_id != self._player_id:
            self._player_id = player_id
            self.players_changed.emit()

    @property
    def player(self) -> Player | None:
        """The player who is shown, while the project has the player."""
        try:
            return self._session.project.player(self._player_id)
        except KeyError:
            return None

    @property
    def players(self) -> tuple[str, ...]:
        """The player who is shown, and the others that are selected."""
        others = (id for id in self._session.players if id != self._player_id)
        return (self._player_id, *others) if self._player_id else ()

    @property
    def plan(self) -> PlayerPlan | None:
        """The newest plan of the player, if there is one."""
        return self._session.plans.get(self._player_id)

    @property
    def is_in_front(self) -> bool:
        """True if the player is in front in the session too."""
        return self._session.players[:1] == (self._player_id,)

    def bring_forward(self) -> None:
        """Put the player in front of the others that are selected."""
        if self.player is not None and not self.is_in_front:
            self._session.set_players(self.players)
