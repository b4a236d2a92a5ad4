"""Commands for players: adding, removing, muting, soloing and selecting them."""

from __future__ import annotations

from functools import partial

from app.editor.edit_names import edit_of_parameter, edit_of_players
from app.editor.player_marks import PlayerMark, mark_players
from app.editor.session import Session
from app.errors import Message
from app.project.edit import players as edit
from app.project.edit.outfits import dress_everyone as dress_all
from app.project.model import Project
from app.project.performers import Player
from app.project.player_sections import are_worth_grouping, in_sections_of, sections
from app.shell.action import Action
from app.shell.editor import EditorAction
from instrument_maps.library import library
from widgets.players import performer_edits


def _chosen(session: Session) -> list[Player]:
    return [session.project.player(player_id) for player_id in session.players]


def add(session: Session) -> None:
    """Add a player with the active player's instrument, or with the first instrument if there is no player."""
    front = session.player
    known = library()
    instrument_id = (
        front.instrument_id if front is not None and front.instrument_id in known.maps else known.in_score_order[0].id
    )
    performer_edits.add_player(session, instrument_id)


def join(session: Session) -> None:
    """Merge the selected players into one musician, the first in the list, who plays their parts in turn."""
    chosen = [player for player in session.project.players if player.id in session.players]
    first, *others = chosen

    def joined(project: Project) -> Project:
        for player in others:
            project = edit.join(project, player.id, first.id)
        return project

    session.attempt(edit_of_players(session.project, "edit.join_players", session.players), joined)


def separate(session: Session) -> None:
    """Split the selected doubling players into musicians with bodies of their own."""
    chosen = session.players
    doubling = [player.id for player in _chosen(session) if player.doubles]
    session.attempt(
        edit_of_players(session.project, "edit.separate_players", doubling),
        lambda project: edit.separate(project, chosen),
    )


def clear_mute_and_solo(session: Session) -> None:
    """Clear mute and solo of all players, as one undoable step."""
    everyone = [player.id for player in session.project.players]
    session.attempt(
        edit_of_players(session.project, "edit.unmute", everyone),
        lambda project: edit.change(project, everyone, muted=False, soloed=False),
    )


def step(session: Session, by: int) -> None:
    """Make the next player (1) or the previous player (-1) active."""
    players = session.project.players
    if session.player is None:
        return
    number = (players.index(session.player) + by) % len(players)
    session.set_players((players[number].id,))


def toggle_posture(session: Session) -> None:
    """Make the selected players sit if their instruments are played sitting; make them stand if all of them sit."""
    project = session.project
    free = [player for player in _chosen(session) if len(edit.postures_of_musician(project, player)) > 1]
    chosen = tuple(player.id for player in free)
    seated = all(player.parameters.posture == "seated" for player in free)
    session.attempt(
        edit_of_parameter(session.project, "posture", session.players),
        lambda project: edit.set_parameters(project, chosen, posture="standing" if seated else "seated"),
    )


def arrange(session: Session) -> None:
    """Place all players automatically on arcs around the conductor."""
    session.attempt(Message("edit.arrange_players"), edit.arrange)


def dress_everyone(session: Session) -> None:
    """Give everyone the outfit and the colours of the active player."""
    front = session.player
    if front is not None:
        choice = front.outfit
        session.attempt(Message("edit.dress_everyone"), lambda project: dress_all(project, choice))


def select_all(session: Session) -> None:
    """Select every player; the active one stays active."""
    others = tuple(player.id for player in session.project.players if player.id not in session.players[:1])
    session.set_players((*session.players[:1], *others))


def select_section(session: Session) -> None:
    """Select all players of the selected players' sections; the active player stays active."""
    others = (id for id in in_sections_of(session.project, session.players) if id not in session.players[:1])
    session.set_players((*session.players[:1], *others))


def _fold_sections(session: Session, folded: bool) -> None:
    for section in sections(session.project):
        session.set_folded(section.fold_name, folded)


def _are_folded(session: Session) -> bool:
    return all(session.folded.get(section.fold_name, False) for section in sections(session.project))


def _has_players(session: Session) -> bool:
    return bool(session.players)


def _may_sit_or_stand(session: Session) -> bool:
    return any(len(edit.postures_of_musician(session.project, player)) > 1 for player in _chosen(session))


def _are_several(session: Session) -> bool:
    return len({session.project.musician(player).id for player in _chosen(session)}) > 1


def _has_several(session: Session) -> bool:
    return len(session.project.players) > 1


def _differ_in_dress(session: Session) -> bool:
    """Return whether any player has clothes or colours other than the active player's."""
    front = session.player
    return front is not None and any(one.outfit != front.outfit for one in session.project.performers)


def _marking(name: str, mark: PlayerMark, key: str) -> Action:
    return Action(
        f"players.{name}",
        lambda session, on: mark_players(session, mark, on, session.players),
        "edit/players",
        key,
        "players",
        enabled=_has_players,
        checked=lambda session: session.player is not None and getattr(session.player, mark),
        icon=name,
    )


def _marking_section(name: str, mark: PlayerMark, key: str) -> Action:
    """Return an action that marks the sections of the selected players, checked if all of them are marked."""

    def own(session: Session) -> tuple[str, ...]:
        return in_sections_of(session.project, session.players)

    return Action(
        f"players.{name}_section",
        lambda session, on: mark_players(session, mark, on, own(session)),
        "edit/players",
        key,
        "players",
        enabled=_has_players,
        checked=lambda session: (
            _has_players(session) and all(getattr(session.project.player(id), mark) for id in own(session))
        ),
        icon=name,
    )


ACTIONS: tuple[Action | EditorAction, ...] = (
    Action("players.add", add, "edit/players", icon="add"),
    EditorAction(
        "players.rename",
        lambda editor: editor.window.rename_player(),
        "edit/players",
        "F2",
        "players",
        enabled=lambda editor: _has_players(editor.session),
        icon="pencil",
    ),
    Action(
        "players.duplicate",
        performer_edits.duplicate_players,
        "edit/players",
        "Ctrl+D",
        "players",
        enabled=_has_players,
        icon="duplicate",
    ),
    Action("players.join", join, "edit/players", enabled=_are_several),
    Action(
        "players.separate",
        separate,
        "edit/players",
        enabled=lambda session: any(player.doubles for player in _chosen(session)),
    ),
    Action(
        "players.remove",
        performer_edits.remove_players,
        "edit/players",
        "Del",
        "players",
        enabled=_has_players,
        icon="delete",
    ),
    _marking("mute", "muted", "M"),
    _marking("solo", "soloed", "S"),
    _marking_section("mute", "muted", "Shift+M"),
    _marking_section("solo", "soloed", "Shift+S"),
    Action(
        "players.hear_everyone",
        clear_mute_and_solo,
        "edit/players",
        enabled=lambda session: any(player.muted or player.soloed for player in session.project.players),
        icon="sound",
    ),
    Action("players.next", partial(step, by=1), "edit/players", "Ctrl+PgDown", enabled=_has_several),
    Action("players.previous", partial(step, by=-1), "edit/players", "Ctrl+PgUp", enabled=_has_several),
    Action("players.posture", toggle_posture, "edit/players", enabled=_may_sit_or_stand, icon="seated"),
    Action("players.randomise", performer_edits.randomise_players, "edit/players", enabled=_has_players, icon="dice"),
    Action("players.dress_everyone", dress_everyone, "edit/players", enabled=_differ_in_dress),
    Action("players.arrange", arrange, "edit/players", enabled=_has_players, icon="stage"),
    Action("players.select_section", select_section, "edit/players", "Shift+A", "players", enabled=_has_players),
    Action("players.select_all", select_all, "edit/players", "Ctrl+Shift+A", enabled=_has_several),
    Action("players.reset", performer_edits.reset_players, "edit/players", enabled=_has_players, icon="reset"),
    Action(
        "players.grouped",
        lambda session, on: session.set_groups_players(on),
        "view",
        enabled=lambda session: are_worth_grouping(session.project),
        checked=lambda session: session.groups_players,
    ),
    Action(
        "players.fold_sections",
        _fold_sections,
        "view",
        enabled=lambda session: session.groups_players and are_worth_grouping(session.project),
        checked=_are_folded,
    ),
)
