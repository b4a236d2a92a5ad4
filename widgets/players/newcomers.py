"""Players and dancers who come: the edit, and who is in front afterwards."""

from __future__ import annotations

from app.errors import Message
from app.project.edit import players as edit
from app.project.edit.dancers import add_dancer as add_dancer_to
from app.project.model import Project
from instrument_maps.library import all_maps
from widgets.common.instrument_name import instrument_name
from widgets.common.session import Session


def add_player(session: Session, instrument_id: str) -> None:
    """Add a player of this instrument, in front."""
    maps = all_maps()
    instrument = maps[instrument_id]
    name = instrument_name(instrument)
    made: list[str] = []

    def add(project: Project) -> Project:
        result, player_id = edit.add_player(project, instrument, maps, name)
        made.append(player_id)
        return result

    if session.attempt(Message("edit.add_player", {"player": name}), add):
        session.set_players(tuple(made))


def add_dancer(session: Session, choreography: str, name: str) -> None:
    """Add a dancer of a choreography, who is selected then."""
    made: list[str] = []

    def add(project: Project) -> Project:
        result, dancer_id = add_dancer_to(project, choreography, name)
        made.append(dancer_id)
        return result

    if session.attempt(Message("edit.add_dancer"), add):
        session.set_dancer(made[-1])
        if not session.project.score.percussion:
            session.notice(Message("dance.no_percussion"))


def duplicate_players(session: Session) -> None:
    """Let others play what the selected players play; they are selected then."""
    chosen = session.players
    made: list[str] = []

    def duplicate(project: Project) -> Project:
        result, player_ids = edit.duplicate_players(project, chosen)
        made.extend(player_ids)
        return result

    if session.attempt(Message("edit.duplicate_players", {"count": len(chosen)}), duplicate):
        session.set_players(tuple(made))
