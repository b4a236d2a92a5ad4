"""Commands that generate motion, and their messages."""

from __future__ import annotations

import pytest
from pytestqt.qtbot import QtBot

from app.editor import generator as module
from app.editor.generator import Generator
from app.editor.selection import Selection
from app.editor.session import Session
from app.errors import Message
from app.plan.by_hand.corrections import SetEmbouchure, Vary
from app.project.edit.corrections import with_corrections
from app.shell.commands import generate


@pytest.mark.parametrize("at_once", [True, False])
def test_it_says_how_many_corrections_it_kept(
    session: Session, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch, at_once: bool
) -> None:
    monkeypatch.setattr(module, "AT_ONCE_NOTES", 10_000 if at_once else 0)
    player = session.project.players[0]
    note = session.project.part(player).notes[3]
    said = [SetEmbouchure(note.id, tension=0.4), SetEmbouchure("9:99", tension=0.4)]
    session.apply(Message("edit.test"), with_corrections(session.project, player.id, said))
    reported: list[Message] = []
    session.noticed.connect(lambda message, severity: reported.append(message))
    generator = Generator(session, session.tasks)
    try:
        before = session.project
        generate.vary_everyone(session)
        qtbot.waitUntil(lambda: bool(reported))
        assert reported == [Message("generate.kept_and_lost", {"kept": 1, "lost": 1})]
        assert session.project.seed != before.seed
        assert session.project.corrections == before.corrections
        assert session.performance.project is session.project
        session.set_players((session.project.players[1].id,))
        generate.vary_players(session)
        qtbot.waitUntil(lambda: len(reported) == 2)
        assert reported[1] == Message("generate.kept", {"kept": 0})
        session.document.undo()
        session.document.undo()
        assert session.project is before
    finally:
        generator.close()


def test_bars_are_chosen_by_the_range_or_by_the_notes(session: Session) -> None:
    player = session.project.players[0]
    row = {action.id: action for action in generate.ACTIONS}
    asks = row["generate.bars"].enabled, row["generate.bars_back"].enabled
    assert asks[0] is not None
    assert asks[1] is not None
    assert not asks[0](session)
    session.select(Selection(span=(960, 4800)))
    assert asks[0](session)
    assert not asks[1](session)
    generate.vary_bars(session)
    (made,) = session.project.corrections[player.id]
    assert isinstance(made, Vary)
    assert (made.start_tick, made.end_tick) == (960, 4800)
    assert asks[1](session)
    generate.unvary_bars(session)
    assert not session.project.corrections
    notes = session.project.part(player).notes[4:7]
    session.select(Selection(notes=frozenset(note.id for note in notes)))
    generate.vary_bars(session)
    (made,) = session.project.corrections[player.id]
    assert isinstance(made, Vary)
    assert (made.start_tick, made.end_tick) == (notes[0].onset_tick, notes[-1].end_tick)
