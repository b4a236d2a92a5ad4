"""A session for the lanes of one stacked player, in which this player is active."""

from __future__ import annotations

from typing import Any, cast

from PySide6.QtCore import QObject, Signal

from app.editor.session import Session
from app.plan.model import PlayerPlan
from app.project.performers import Player


class _PlayerChoice(QObject):
    """Holds the id of the active player of a `PlayerSession`, with a signal for its change."""

    players_changed = Signal()


class PlayerSession:
    """Stands for a session, but with an active player of its own, so that the same lanes can show and edit any player.

    Selections and edits are the session's own. Before a lane is used, its player is made active there, so that commands
    act on the lane with the keyboard focus.

    Parameters
    ----------
    session : Session
        Session that provides everything else.
    """

    def __init__(self, session: Session) -> None:
        self._session, self._player_id = session, ""
        self._choice = _PlayerChoice(session)
        self.players_changed = self._choice.players_changed

    def __getattr__(self, name: str) -> Any:
        return getattr(self._session, name)

    @property
    def of_lanes(self) -> Session:
        """Return this object, typed as a `Session` for lanes."""
        return cast("Session", self)

    @property
    def player_id(self) -> str:
        """Id of the displayed player; empty for none."""
        return self._player_id

    def show(self, player_id: str) -> None:
        """Display another player in the panels that use this session."""
        if player_id != self._player_id:
            self._player_id = player_id
            self.players_changed.emit()

    @property
    def player(self) -> Player | None:
        """The displayed player, if it is in the project."""
        try:
            return self._session.project.player(self._player_id)
        except KeyError:
            return None

    @property
    def players(self) -> tuple[str, ...]:
        """Ids of the displayed player, then of the others selected."""
        others = (id for id in self._session.players if id != self._player_id)
        return (self._player_id, *others) if self._player_id else ()

    @property
    def plan(self) -> PlayerPlan | None:
        """The latest plan of the player, if there is one."""
        return self._session.plans.get(self._player_id)

    @property
    def is_in_front(self) -> bool:
        """True if the player is also the active player of the session."""
        return self._session.players[:1] == (self._player_id,)

    def bring_forward(self) -> None:
        """Make the player the active one among the selected players."""
        if self.player is not None and not self.is_in_front:
            self._session.set_players(self.players)
