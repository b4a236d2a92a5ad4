"""Re-import File and Update from Newer File in the window: the project afterwards, and its history."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import mido
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QDialogButtonBox, QListWidget, QTreeWidget

from app.editor.design_tokens import Tokens
from app.editor.questions import ReadAgain
from app.editor.tasks import Tasks
from app.plan.by_hand.corrections import Correction, PinFingering, SetBreath, SetCue
from app.project.edit.corrections import with_corrections
from app.project.importing import ImportRequest, ImportRow
from app.project.model import Project
from app.project.performers import Player
from app.project.reimport import reimported
from app.score.assignments import PartAssignment
from app.score.contents import PieceContents
from app.shell.app import Program
from instrument_maps.load import bundled_maps
from tests.gui.japanese import speaking
from tests.gui.shell.conftest import Answers, Start, trigger
from tests.support.windows import child
from tests.unit.project.test_rereading import BAR, QUINTET, quintet, tracks, written
from widgets.dialogs.reimport_midi import ReimportDialog


@pytest.fixture(params=["kept", "an older program's"])
def program(request: pytest.FixtureRequest, start: Start, tmp_path: Path) -> Program:
    """An editor with a quintet with 13 corrections, or one whose import decisions were not stored."""
    project = quintet(written(tmp_path / "quintet.mid", tracks()))
    for number, player in enumerate(project.players):
        notes = project.part(player).notes
        items: list[Correction] = [SetBreath(notes[4].id, -60, -10), SetCue(notes[8].id, 1.0)]
        if number < 3:
            items.append(PinFingering(notes[16].id, "1"))
        project = with_corrections(project, player.id, items)
    assert sum(map(len, project.corrections.values())) == 13
    if request.param != "kept":
        project = replace(project, imported=None, read_timing=None)
    result = start()
    result.session.document.open(project)
    result.editor.files.is_open = True
    return result


def shown(program: Program) -> ReimportDialog:
    return program.window.findChildren(ReimportDialog)[-1]


def onsets(project: Project, player: Player) -> list[int]:
    return [note.onset_tick for note in project.part(player).notes]


def agree(dialog: ReimportDialog) -> None:
    ok = dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Ok)
    assert ok.isEnabled()
    QTest.mouseClick(ok, Qt.MouseButton.LeftButton)


def test_an_unchanged_file_is_no_step(program: Program) -> None:
    before = program.session.project
    trigger(program, "file.reimport")
    dialog = shown(program)
    assert not dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Ok).isEnabled()
    QTest.keyClick(dialog, Qt.Key.Key_Return)
    dialog.reject()
    assert program.session.project is before
    assert program.session.document.done == ()


def test_update_from_a_newer_file_keeps_players_and_corrections(
    program: Program, answers: Answers, tmp_path: Path
) -> None:
    before = program.session.project
    content = tracks(("", "Piano", "Stimme", "Low", "Bottom"), 2 * BAR)
    answers.path = written(tmp_path / "newer.mid", [content[place] for place in (3, 0, 4, 2, 1)])
    trigger(program, "file.reimport_other")
    agree(shown(program))
    after = program.session.project
    assert after is not before
    assert after.players == before.players
    assert after.corrections == before.corrections
    for player in before.players:
        assert [note.onset_tick + 2 * BAR for note in before.part(player).notes] == [
            note.onset_tick for note in after.part(player).notes
        ]
    program.session.document.undo()
    assert program.session.project is before


def test_a_source_that_is_gone_is_named_where_another_is_asked_for(
    program: Program, answers: Answers, tmp_path: Path
) -> None:
    """In both languages, the title of the file dialog names it."""
    (tmp_path / "quintet.mid").unlink()
    trigger(program, "file.reimport")
    with speaking():
        trigger(program, "file.reimport")
    trigger(program, "file.reimport_other")
    assert answers.titles == [
        "quintet.mid not found: choose the file to re-import",
        "quintet.mid が見つかりません: 再読み込みするファイルを選択",
        "Re-import File",
    ]


def test_a_player_that_is_unchecked_keeps_its_notes_in_one_step(
    program: Program, answers: Answers, tmp_path: Path
) -> None:
    before = program.session.project
    answers.path = written(tmp_path / "newer.mid", tracks(("", "Piano", "Stimme", "Low", "Bottom"), 2 * BAR))
    trigger(program, "file.reimport_other")
    tree = child(shown(program), QTreeWidget, "reimport_parts")
    tree.setCurrentItem(tree.topLevelItem(1))
    QTest.keyClick(tree, Qt.Key.Key_Space)
    agree(shown(program))
    after = program.session.project
    shifts = [
        {
            new.onset_tick - old.onset_tick
            for old, new in zip(before.part(one).notes, after.part(one).notes, strict=True)
        }
        for one in before.players
    ]
    assert shifts == [{0} if place == 1 else {2 * BAR} for place in range(5)]
    assert after.corrections == before.corrections
    assert len(program.session.document.done) == 1
    program.session.document.undo()
    assert program.session.project is before


def test_a_player_is_removed_with_the_update_as_one_step(program: Program, answers: Answers, tmp_path: Path) -> None:
    before = program.session.project
    flute = mido.MidiTrack([mido.MetaMessage("track_name", name="Flute")])
    for place in range(12):
        flute.append(mido.Message("note_on", note=72 + 5 * place % 12, velocity=80))
        flute.append(mido.Message("note_off", note=72 + 5 * place % 12, time=240))
    answers.path = written(tmp_path / "newer.mid", [*tracks()[:2], tracks()[4], flute])
    trigger(program, "file.reimport_other")
    dialog = shown(program)
    gone = child(dialog, QListWidget, "reimport_gone")
    assert gone.count() == 2
    gone.setFocus()
    gone.setCurrentRow(0)
    QTest.keyClick(gone, Qt.Key.Key_Space)
    agree(dialog)
    after = program.session.project
    # The horn was checked, the trombone stays.
    kept = [player.id for index, player in enumerate(before.players) if index != 2]
    assert [player.id for player in after.players][:4] == kept
    assert after.players[-1].instrument_id == "flute"
    assert after.corrections == {id_: before.corrections[id_] for id_ in kept}
    program.session.document.undo()
    assert program.session.project is before


@pytest.mark.parametrize("language", ["en", "ja"])
def test_new_parts_without_a_player_are_listed_with_the_reason(
    program: Program, answers: Answers, language: str, tmp_path: Path
) -> None:
    program.editor.language.set(language)
    strings = mido.MidiTrack(
        [mido.MetaMessage("track_name", name="Violins"), mido.Message("program_change", program=48)]
    )
    drums = mido.MidiTrack([mido.MetaMessage("track_name", name="Kit")])
    for place in range(12):
        for track, pitch, channel in ((strings, 72 + place, 0), (drums, 36, 9)):
            track.append(mido.Message("note_on", note=pitch, velocity=80, channel=channel))
            track.append(mido.Message("note_off", note=pitch, time=240, channel=channel))
    answers.path = written(tmp_path / "newer.mid", [*tracks(), strings, drums])
    trigger(program, "file.reimport_other")
    dialog = shown(program)
    listed = child(dialog, QListWidget, "reimport_unplayed")
    assert listed.isVisible()
    texts = [listed.item(row).text() for row in range(listed.count())]
    assert [text.split()[0].rstrip(":") for text in texts] == ["Violins", "Kit"]
    assert all(text.isascii() == (language == "en") for text in texts)
    agree(dialog)
    # The second time they are known.
    trigger(program, "file.reimport")
    again = child(shown(program), QListWidget, "reimport_unplayed")
    assert not again.isVisible()
    shown(program).reject()


def test_the_encoding_chosen_at_the_import_is_used_again(
    start: Start, answers: Answers, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    path = written(tmp_path / "names.mid", tracks(("xx", "Voice B", "Lead", "Low", "Bottom")))
    path.write_bytes(path.read_bytes().replace(b"xx", "笛".encode("euc_jp")))

    def chosen(contents: PieceContents, read_again: ReadAgain, tokens: Tokens, tasks: Tasks) -> ImportRequest:
        rows = tuple(ImportRow(PartAssignment((place,), map_id)) for place, map_id in enumerate(QUINTET))
        return ImportRequest(rows, False, read_again("euc_jp"), "euc_jp")

    monkeypatch.setattr(answers, "import_midi", chosen)
    program = start()
    program.editor.files.open(path)
    before = program.session.project
    assert before.players[0].name == "笛"
    trigger(program, "file.reimport")
    shown(program).reject()
    outcome = reimported(before, path, bundled_maps())
    assert outcome.project is before
