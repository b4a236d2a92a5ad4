"""Edits of players and dancers that also select the result, shared by commands and the panel."""

from __future__ import annotations

from app.editor.edit_names import edit_of_players
from app.editor.session import Session
from app.errors import Message
from app.project.edit import dancers, players
from app.project.model import Project
from instrument_maps.library import all_maps
from widgets.common.instrument_name import instrument_name


def add_player(session: Session, instrument_id: str) -> None:
    """Add a player with an instrument, and make it active."""
    maps = all_maps()
    instrument = maps[instrument_id]
    name = instrument_name(instrument)
    made: list[str] = []

    def add(project: Project) -> Project:
        result, player_id = players.add_player(project, instrument, maps, name)
        made.append(player_id)
        return result

    if session.attempt(Message("edit.add_player", {"player": name}), add):
        session.set_players(tuple(made))


def add_dancer(session: Session, choreography: str, name: str) -> None:
    """Add a dancer with a choreography, and select it."""
    made: list[str] = []

    def add(project: Project) -> Project:
        result, dancer_id = dancers.add_dancer(project, choreography, name)
        made.append(dancer_id)
        return result

    if session.attempt(Message("edit.add_dancer"), add):
        session.set_dancer(made[-1])
        if not session.project.score.percussion:
            session.notice(Message("dance.no_percussion"))


def duplicate_dancer(session: Session) -> None:
    """Duplicate the selected dancer and select the copy."""
    dancer, made = session.dancer, list[str]()
    if dancer is None:
        return

    def duplicate(project: Project) -> Project:
        result, dancer_ids = dancers.duplicate_dancers(project, (dancer.id,))
        made.extend(dancer_ids)
        return result

    if session.attempt(Message("edit.duplicate_dancer", {"dancer": dancer.name}), duplicate):
        session.set_dancer(made[-1])


def remove_dancer(session: Session) -> None:
    """Remove the selected dancer, and select the next or previous one."""
    dancer = session.dancer
    if dancer is None:
        return
    others = [other.id for other in session.project.dancers if other.id != dancer.id]
    number = min(session.project.dancers.index(dancer), len(others) - 1)
    name = Message("edit.remove_dancer", {"dancer": dancer.name})
    if session.attempt(name, lambda project: dancers.remove_dancers(project, (dancer.id,))) and others:
        session.set_dancer(others[number])


def duplicate_players(session: Session) -> None:
    """Duplicate the selected players, and select the new ones."""
    chosen = session.players
    made: list[str] = []

    def duplicate(project: Project) -> Project:
        result, player_ids = players.duplicate_players(project, chosen)
        made.extend(player_ids)
        return result

    if session.attempt(edit_of_players(session.project, "edit.duplicate_players", chosen), duplicate):
        session.set_players(tuple(made))


def remove_players(session: Session) -> None:
    """Remove the selected players from the project, as one undoable step."""
    chosen = session.players
    session.attempt(
        edit_of_players(session.project, "edit.remove_players", chosen),
        lambda project: players.remove_players(project, chosen),
    )


def randomise_players(session: Session) -> None:
    """Randomise the parameters of the selected players, or of all players if fewer than two are selected."""
    several = len(session.players) > 1
    chosen = session.players if several else tuple(player.id for player in session.project.players)
    name, spread = edit_of_players(session.project, "edit.randomise_players", chosen), session.variety
    session.attempt(name, lambda project: players.randomise(project, chosen, spread))


def reset_players(session: Session) -> None:
    """Reset the parameters of the selected players to those of a new player."""
    chosen = session.players
    name = edit_of_players(session.project, "edit.reset_parameters", chosen)
    session.attempt(name, lambda project: players.reset_parameters(project, chosen))
