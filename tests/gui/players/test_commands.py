"""Commands about players."""

from __future__ import annotations

from dataclasses import replace

from app.editor.session import Session
from app.project.casting import StagePosition, stage_arc
from app.project.edit.players import place
from app.shell.commands import players as commands
from tests.support.doubled import flutist

ROWS = {row.id: row for row in commands.ACTIONS}


def ids(session: Session) -> tuple[str, ...]:
    return tuple(player.id for player in session.project.players)


def test_every_row_has_its_own_id_and_shortcut() -> None:
    assert len(ROWS) == len(commands.ACTIONS)
    shortcuts = [row.shortcut for row in commands.ACTIONS if row.shortcut]
    assert len(set(shortcuts)) == len(shortcuts)


def test_add_duplicate_remove(session: Session) -> None:
    session.set_players((ids(session)[3],))
    ROWS["players.add"].run(session)
    assert session.player.instrument_id == session.project.players[3].instrument_id
    ROWS["players.duplicate"].run(session)
    assert len(session.project.players) == 6
    ROWS["players.remove"].run(session)
    assert len(session.project.players) == 5
    session.document.open(replace(session.project, players=()))
    ROWS["players.add"].run(session)
    assert len(session.project.players) == 1


def test_mute_and_solo_are_toggles(session: Session) -> None:
    session.set_players(ids(session)[:2])
    for id, field in (("players.mute", "muted"), ("players.solo", "soloed")):
        row = ROWS[id]
        assert row.checked is not None
        assert not row.checked(session)
        row.run(session, True)
        assert row.checked(session)
        assert [getattr(player, field) for player in session.project.players] == [True, True, False, False]
        row.run(session, False)
        assert not row.checked(session)
    ROWS["players.solo"].run(session, True)
    ROWS["players.hear_everyone"].run(session)
    assert not any(player.soloed for player in session.project.players)


def test_next_and_previous_go_round(session: Session) -> None:
    everyone = ids(session)
    ROWS["players.previous"].run(session)
    assert session.players == (everyone[3],)
    ROWS["players.next"].run(session)
    ROWS["players.next"].run(session)
    assert session.players == (everyone[1],)
    ROWS["players.select_all"].run(session)
    assert session.players == (everyone[1], everyone[0], everyone[2], everyone[3])


def test_posture_dice_arc_and_reset(session: Session) -> None:
    before = session.project
    ROWS["players.select_all"].run(session)
    ROWS["players.posture"].run(session)
    assert {player.parameters.posture for player in session.project.players} == {"seated"}
    ROWS["players.posture"].run(session)
    assert session.project == before
    ROWS["players.randomise"].run(session)
    assert session.project.players != before.players
    ROWS["players.reset"].run(session)
    assert session.project == before
    session.document.open(place(session.project, {ids(session)[0]: StagePosition(4.0, 0.0, 0.0)}))
    ROWS["players.arrange"].run(session)
    assert tuple(player.stage for player in session.project.players) == stage_arc(4)


def test_one_musician_plays_several_and_is_taken_apart_again(session: Session) -> None:
    session.document.open(flutist())
    before = session.project
    flute, piccolo, oboe = ids(session)
    session.set_players((piccolo,))
    enabled = ROWS["players.separate"].enabled
    assert enabled is not None
    assert enabled(session)
    ROWS["players.separate"].run(session)
    assert len(session.project.bodies) == 3
    assert not enabled(session)
    session.set_players((piccolo, flute))
    ROWS["players.join"].run(session)
    assert session.project.players == before.players
    joins = ROWS["players.join"].enabled
    assert joins is not None
    assert not joins(session)
    session.document.undo()
    session.document.undo()
    assert session.project is before
    # An oboe sounds all the time: refused with a message, and nothing has changed.
    session.set_players((flute, oboe))
    ROWS["players.join"].run(session)
    assert session.project is before
