"""The import dialog by mouse and keys."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import mido
import msgspec
import pytest
from PySide6.QtCore import QEvent, QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QApplication,
    QCheckBox,
    QComboBox,
    QDialogButtonBox,
    QLabel,
    QLineEdit,
    QListWidget,
    QPushButton,
)
from pytestqt.qtbot import QtBot

from app.editor.design_tokens import DARK, LEAST_TARGET_PX
from app.project import importing
from app.project.importing import import_project, usual_rows
from app.project.model import Project, map_choices, project_from_score
from app.project.reimport import reimported
from app.project.usual_outfits import outfit_of_piece, with_outfit
from app.score.read import read_contents, read_midi
from instrument_maps.load import bundled_maps
from tests.support.take_files import take_file
from tests.support.tasks import ImmediateTasks
from tests.support.windows import child
from widgets.dialogs.import_midi import ImportDialog
from widgets.dialogs.notes_preview import ROW_PX, NotesPreview

LUTKIN = Path(__file__).parents[2] / "data" / "midi" / "ensemble" / "brass_quartet_lutkin_2tpt_tbn_tuba.mid"
MAPS = {
    id_: table
    for id_, table in bundled_maps().items()
    if not any(tuba in name for name in table.plays for tuba in ("tuba", "sousaphone"))
}
"""Instrument maps without those for tuba, so that the import must report omitted parts."""


@pytest.fixture
def dialog(qt_app: QApplication, qtbot: QtBot) -> ImportDialog:
    dialog = ImportDialog(read_contents(LUTKIN), MAPS, DARK, ImmediateTasks())
    qtbot.addWidget(dialog)
    dialog.show()
    return dialog


def imported(dialog: ImportDialog) -> Project:
    """Project made by the dialog."""
    return import_project(dialog._table.contents, dialog.rows, dialog._maps)


def choose(dialog: ImportDialog, name: str, data: object) -> None:
    box = child(dialog, QComboBox, name)
    box.setFocus()
    index = box.findData(data)
    assert index >= 0
    QTest.keyClick(box, Qt.Key.Key_Home)
    for _ in range(index):
        QTest.keyClick(box, Qt.Key.Key_Down)
    assert box.currentIndex() == index


def test_untouched_it_is_what_the_command_line_does(dialog: ImportDialog) -> None:
    score = read_midi(LUTKIN, maps=map_choices(MAPS.values()))
    contents = read_contents(LUTKIN)
    usual = with_outfit(project_from_score(score, MAPS), outfit_of_piece(contents, 3))
    project = import_project(contents, dialog.rows, MAPS, str(LUTKIN), outfit=dialog.assignment.outfit)
    assert project.players == usual.players
    assert project.score == usual.score
    assert project.source == str(LUTKIN)


def test_a_track_no_one_plays_is_ticked_and_given_an_instrument_and_a_character(dialog: ImportDialog) -> None:
    box = child(dialog, QCheckBox, "play_3")
    assert not box.isChecked()
    QTest.mouseClick(box, Qt.MouseButton.LeftButton)
    trombone = next(id_ for id_, table in MAPS.items() if "trombone" in table.plays)
    choose(dialog, "instrument_3", trombone)
    choose(dialog, "character_3", "woman_adult")
    name = child(dialog, QLineEdit, "name_3")
    name.selectAll()
    QTest.keyClicks(name, "Bass")
    bass = imported(dialog).players[-1]
    assert (bass.name, bass.instrument_id, bass.character_id) == ("Bass", trombone, "woman_adult")
    summary = child(dialog, QLabel, "import_summary")
    assert "4" in summary.text()


def test_what_everyone_wears_is_by_the_piece_until_it_is_chosen(dialog: ImportDialog) -> None:
    assert dialog.assignment.outfit is None
    box = child(dialog, QComboBox, "import_outfit")
    box.setFocus()
    QTest.keyClick(box, Qt.Key.Key_Down)
    assert box.currentText() == "Own clothes"
    assert dialog.assignment.outfit == ""
    QTest.keyClick(box, Qt.Key.Key_Up)
    assert dialog.assignment.outfit is None


def test_what_is_left_out_says_why(dialog: ImportDialog) -> None:
    reported = child(dialog, QListWidget, "import_warnings")
    assert any("tuba" in reported.item(row).text().lower() for row in range(reported.count()))


def test_tracks_are_merged_and_taken_apart(dialog: ImportDialog) -> None:
    table = dialog._table
    table.selectRow(0)
    table.selectionModel().select(
        table.model().index(1, 0),
        table.selectionModel().SelectionFlag.Select | table.selectionModel().SelectionFlag.Rows,
    )
    QTest.mouseClick(dialog.findChild(QPushButton, "merge"), Qt.MouseButton.LeftButton)
    assert [row.assignment.channels for row in dialog.rows] == [(0, 1), (2,), (3,)]
    choose(dialog, "split_0", "never")
    assert len(imported(dialog).players) == 2
    table.selectRow(0)
    QTest.mouseClick(dialog.findChild(QPushButton, "separate"), Qt.MouseButton.LeftButton)
    assert [row.assignment.channels for row in dialog.rows] == [(0,), (1,), (2,), (3,)]


def test_usual_rows_without_assignments_are_an_empty_stage() -> None:
    contents = read_contents(LUTKIN)
    rows = [type(row)(row.assignment, requested=False) for row in usual_rows(contents, MAPS)]
    project = import_project(contents, rows, MAPS)
    assert project.players == ()
    assert project.score.tempo_map == contents.tempo_map


def test_a_part_that_looks_written_is_reported_and_read_so(qt_app: QApplication, qtbot: QtBot, tmp_path: Path) -> None:
    low, high = (bundled_maps()["sax_alto_Eb"].range.low, bundled_maps()["sax_alto_Eb"].range.high)
    # The lowest and the highest note that the alto saxophone has, as they are written.
    path = piece(tmp_path, {"Alto Sax": (low + 9, low + 20, high + 9), "Flute": (72, 74, 76)})
    dialog = ImportDialog(read_contents(path), bundled_maps(), DARK, ImmediateTasks())
    qtbot.addWidget(dialog)
    dialog.show()
    reported = dialog.findChild(QListWidget, "import_warnings")
    assert any("imported as written" in reported.item(row).text() for row in range(reported.count()))
    assert dialog.findChild(QComboBox, "pitches_0").currentData() is True
    assert not dialog.findChild(QComboBox, "pitches_1").isEnabled()
    sax, flute = imported(dialog).score.parts
    assert [note.pitch for note in sax.notes] == [low, low + 11, high]
    assert sax.transposed_semitones == -9
    assert [note.pitch for note in flute.notes] == [72, 74, 76]
    choose(dialog, "pitches_0", False)
    assert imported(dialog).score.parts[0].notes[0].pitch == low + 9
    assert any("import this part as written" in reported.item(row).text() for row in range(reported.count()))
    # For an instrument that sounds as it is written there is nothing to choose.
    choose(dialog, "instrument_0", "oboe")
    assert not dialog.findChild(QComboBox, "pitches_0").isEnabled()


def piece(folder: Path, tracks: dict[str, tuple[int, ...]]) -> Path:
    """A MIDI file with these tracks."""
    made = [mido.MidiTrack([mido.MetaMessage("track_name", name=name)]) for name in tracks]
    for track, pitches in zip(made, tracks.values(), strict=True):
        for pitch in pitches:
            track.append(mido.Message("note_on", note=pitch, velocity=80))
            track.append(mido.Message("note_off", note=pitch, time=480))
    path = folder / "piece.mid"
    mido.MidiFile(type=1, tracks=made).save(path)
    return path


def test_a_long_title_does_not_widen_the_dialog(qt_app: QApplication, qtbot: QtBot) -> None:
    contents = msgspec.structs.replace(read_contents(LUTKIN), title="Allegro ma non troppo " * 500)
    dialog = ImportDialog(contents, MAPS, DARK, ImmediateTasks())
    qtbot.addWidget(dialog)
    dialog.show()
    heading = child(dialog, QLabel, "heading")
    assert "Allegro" in heading.text()
    assert "4/4" in heading.text()
    assert dialog.width() == ImportDialog(read_contents(LUTKIN), MAPS, DARK, ImmediateTasks()).width()


class SlowTasks(ImmediateTasks):
    """Task runner that holds all tasks, including repeated ones, until the test runs them."""

    def __init__(self) -> None:
        super().__init__()
        self.waiting: list[Callable[[], None]] = []

    def run(self, *arguments: Any, **options: Any) -> None:
        """Hold the work."""
        self.waiting.append(lambda: ImmediateTasks.run(self, *arguments, **options))

    def work(self, number: int) -> None:
        """Run the task with an index."""
        self.waiting.pop(number)()


def test_what_comes_of_the_choices_is_worked_out_beside_the_window(qt_app: QApplication, qtbot: QtBot) -> None:
    tasks = SlowTasks()
    dialog = ImportDialog(read_contents(LUTKIN), MAPS, DARK, tasks)
    qtbot.addWidget(dialog)
    dialog.show()
    agree = dialog._buttons.button(QDialogButtonBox.StandardButton.Ok)
    summary = child(dialog, QLabel, "import_summary")
    assert (dialog.rows, agree.isEnabled(), dialog._table.rowCount()) == ((), False, 0)
    QApplication.processEvents()
    tasks.work(0)
    assert (len(dialog.rows), agree.isEnabled(), summary.text()) == (4, True, "Players: 3")
    # The dialog has room for rows added after it was shown.
    QApplication.processEvents()
    columns = [place for place in range(dialog._table.columnCount()) if not dialog._table.isColumnHidden(place)]
    header = dialog._table.horizontalHeader()
    assert header.length() == header.viewport().width()
    for column in columns:
        widget = dialog._table.cellWidget(0, column)
        assert dialog._table.columnWidth(column) >= widget.sizeHint().width(), column
    for place in (0, 1):
        child(dialog, QCheckBox, f"play_{place}").click()
    # The newer task is finished first: the older result refers to rows that the dialog no longer has.
    tasks.work(1)
    assert summary.text() == "Players: 1"
    tasks.work(0)
    assert summary.text() == "Players: 1"


def test_closing_the_dialog_stops_the_work(qt_app: QApplication, qtbot: QtBot) -> None:
    tasks = SlowTasks()
    dialog = ImportDialog(read_contents(LUTKIN), MAPS, DARK, tasks)
    qtbot.addWidget(dialog)
    dialog.show()
    dialog.reject()
    tasks.work(0)
    assert dialog.rows == ()
    assert dialog._table.outcome is None


def test_many_tracks_are_shown_turn_by_turn(
    qt_app: QApplication, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = piece(tmp_path, {f"Flute {number}": (72, 74) for number in range(40)})
    dialog = ImportDialog(read_contents(path), bundled_maps(), DARK, ImmediateTasks())
    qtbot.addWidget(dialog)
    dialog.show()
    assert dialog._table.rowCount() == 40
    assert dialog.findChild(QLineEdit, "name_39") is None
    qtbot.waitUntil(lambda: dialog.findChild(QLineEdit, "name_39") is not None)
    looked: list[object] = []
    monkeypatch.setattr(
        importing, "_instruments", lambda contents, assignment, *more: looked.append(assignment) or ("flute",)
    )
    name = child(dialog, QLineEdit, "name_39")
    choose(dialog, "split_39", "every")
    assert [assignment.channels for assignment in looked] == [(39,)]  # type: ignore[attr-defined]
    QTest.keyClicks(name, "x")
    assert len(looked) == 1


def test_the_preview_draws_what_sounds(qt_app: QApplication, qtbot: QtBot) -> None:
    """Compared column by column with the notes of the pitch that sound there."""
    contents = read_contents(LUTKIN)
    end_tick = max(max(stream.end_ticks) for stream in contents.channels)
    preview = NotesPreview(contents.channels[:2], end_tick, DARK)
    qtbot.addWidget(preview)
    drawn = {(pitch, column) for pitch, begin, end in preview._runs(100.0) for column in range(begin, end)}
    expected = set()
    for stream in contents.channels[:2]:
        for onset, end, pitch in zip(stream.onset_ticks, stream.end_ticks, stream.pitches, strict=True):
            expected |= {
                (pitch, column)
                for column in range(100)
                if onset * 100 // end_tick == column
                or (onset * 100 < (column + 1) * end_tick and column * end_tick < end * 100)
            }
    assert drawn == expected


def test_an_unknown_name_is_asked_about(qt_app: QApplication, qtbot: QtBot, tmp_path: Path) -> None:
    path = piece(tmp_path, {"Lead": (60, 62, 64), "Flute": (72, 74, 76)})
    dialog = ImportDialog(read_contents(path), bundled_maps(), DARK, ImmediateTasks())
    qtbot.addWidget(dialog)
    dialog.show()
    play, instrument = dialog.findChild(QCheckBox, "play_0"), dialog.findChild(QComboBox, "instrument_0")
    ok = dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Ok)
    # Left alone it is left out; nothing is chosen for it.
    assert (play.isChecked(), ok.isEnabled(), instrument.isEnabled()) == (False, True, True)
    assert (instrument.currentData(), instrument.currentText()) == (None, "Select an instrument")
    assert [part.name for part in imported(dialog).score.parts] == ["Flute"]
    # Ticked, it must be answered before anything is imported.
    QTest.mouseClick(play, Qt.MouseButton.LeftButton)
    assert not ok.isEnabled()
    assert "Lead" in dialog.findChild(QLabel, "import_summary").text()
    QTest.mouseClick(play, Qt.MouseButton.LeftButton)
    assert ok.isEnabled()
    # Choosing an instrument selects the track to be played.
    choose(dialog, "instrument_0", "trumpet_Bb")
    assert (play.isChecked(), ok.isEnabled()) == (True, True)
    assert [part.map_id for part in imported(dialog).score.parts] == ["trumpet_Bb", "flute"]
    choose(dialog, "instrument_0", None)
    assert not ok.isEnabled()


PERCUSSION = LUTKIN.parents[1] / "awkward" / "test-all-gm-percussion.mid"


def test_a_percussion_track_is_shown_as_the_dancers(qt_app: QApplication, qtbot: QtBot) -> None:
    dialog = ImportDialog(read_contents(PERCUSSION), MAPS, DARK, ImmediateTasks())
    qtbot.addWidget(dialog)
    dialog.show()
    instrument = child(dialog, QComboBox, "instrument_0")
    assert instrument.currentText() == "Percussion (for dancers)"
    assert "not played by players" in instrument.toolTip()
    reported = child(dialog, QListWidget, "import_warnings")
    assert any(reported.item(row).text().endswith(". Dancers use it as percussion.") for row in range(reported.count()))
    dances = child(dialog, QCheckBox, "import_dancer")
    assert dances.isVisible()
    assert not dialog.assignment.dances
    QTest.mouseClick(dances, Qt.MouseButton.LeftButton, pos=QPoint(8, dances.height() // 2))
    assert dialog.assignment.dances
    assert dialog.assignment.rows == dialog.rows
    assert imported(dialog).score.percussion


@pytest.fixture
def kits(qt_app: QApplication, qtbot: QtBot, tmp_path: Path) -> ImportDialog:
    """A trumpet, the drum kit of XG on channel 11 and its sound effects on channel 12."""
    path = tmp_path / "kits.mid"
    file = mido.MidiFile(tracks=[mido.MidiTrack([mido.Message("sysex", data=(0x43, 0x10, 0x4C, 0, 0, 0x7E, 0))])])
    for channel, bank, program in ((0, 0, 56), (10, 127, 56), (11, 64, 56)):
        track = mido.MidiTrack([mido.Message("control_change", channel=channel, control=0, value=bank)])
        track.append(mido.Message("program_change", channel=channel, program=program))
        for pitch in (60, 62, 64, 65):
            track.append(mido.Message("note_on", channel=channel, note=pitch, velocity=90))
            track.append(mido.Message("note_off", channel=channel, note=pitch, time=240))
        file.tracks.append(track)
    file.save(path)
    dialog = ImportDialog(read_contents(path), MAPS, DARK, ImmediateTasks())
    qtbot.addWidget(dialog)
    dialog.show()
    return dialog


def shown(dialog: ImportDialog) -> list[tuple[bool, str]]:
    """For each row, whether it is played, and the displayed instrument."""
    rows = []
    for place in range(3):
        play, instrument = (
            dialog.findChild(kind, f"{name}_{place}") for kind, name in ((QCheckBox, "play"), (QComboBox, "instrument"))
        )
        assert play is not None
        assert instrument.isEnabled()
        rows.append((play.isChecked(), instrument.currentText()))  # type: ignore[attr-defined]
    return rows


def test_percussion_and_sound_effects_are_named_and_the_user_can_say_otherwise(kits: ImportDialog) -> None:
    trumpet, drums, effect = shown(kits)
    assert trumpet == (True, "Automatic: Trumpet in B♭")
    assert drums == (False, "Percussion (for dancers)")
    assert effect == (False, "Sound effect (not played)")
    dances = child(kits, QCheckBox, "import_dancer")
    assert dances.isVisible()
    score = imported(kits).score
    assert (len(score.parts), len(score.percussion)) == (1, 4)
    # The drums are a trumpet's after all: they are no percussion then.
    choose(kits, "instrument_1", "trumpet_Bb")
    assert shown(kits)[1] == (True, "Trumpet in B♭")
    assert not dances.isVisible()
    score = imported(kits).score
    assert (len(score.parts), len(score.percussion)) == (2, 0)
    # The trumpet is a drum kit, and then played again.
    choose(kits, "instrument_0", "percussion")
    assert shown(kits)[0] == (False, "Percussion (for dancers)")
    assert dances.isVisible()
    score = imported(kits).score
    assert (len(score.parts), len(score.percussion)) == (1, 4)
    assert [part.reason.id for part in score.unplayed] == ["score.percussion", "score.sound_effect"]
    QTest.mouseClick(child(kits, QCheckBox, "play_0"), Qt.MouseButton.LeftButton)
    assert shown(kits)[0] == trumpet
    choose(kits, "instrument_0", "percussion")
    choose(kits, "instrument_0", None)
    assert shown(kits)[0] == trumpet
    assert len(imported(kits).score.parts) == 2


def test_without_percussion_no_dancer_is_offered(dialog: ImportDialog) -> None:
    dances = child(dialog, QCheckBox, "import_dancer")
    assert not dances.isVisible()
    instruments = [box.itemText(0) for box in dialog.findChildren(QComboBox) if "instrument_" in box.objectName()]
    assert instruments
    assert not any("dancers" in text for text in instruments)


def test_a_file_without_notes_offers_an_empty_stage_and_says_why(
    qt_app: QApplication, qtbot: QtBot, tmp_path: Path
) -> None:
    path = tmp_path / "empty.mid"
    mido.MidiFile(tracks=[mido.MidiTrack([mido.MetaMessage("track_name", name="Horn")])]).save(path)
    dialog = ImportDialog(read_contents(path), MAPS, DARK, ImmediateTasks())
    qtbot.addWidget(dialog)
    summary, reported = dialog.findChild(QLabel, "import_summary"), dialog.findChild(QListWidget, "import_warnings")
    assert reported is not None
    assert summary.text() == "No notes to import. You get an empty stage."
    assert [reported.item(row).text() for row in range(reported.count())] == [
        "The file has 1 track and no notes",
        "Track 1 (Horn) has no notes and 0 other events",
    ]
    assert imported(dialog).players == ()


def japanese_piece(folder: Path) -> Path:
    """Two tracks whose names are in EUC-JP and too short for detection, and one without text."""
    path = piece(folder, {"xx": (60, 62, 64, 65), "yyyyyy": (72, 74, 76), "Lead": (67, 69, 71)})
    content = path.read_bytes()
    for name, given in ((b"\x02xx", "笛"), (b"\x06yyyyyy", "低音管")):
        encoded = given.encode("euc_jp")
        assert len(encoded) == len(name) - 1
        content = content.replace(b"\xff\x03" + name, b"\xff\x03" + name[:1] + encoded)
    path.write_bytes(content)
    return path


@pytest.mark.parametrize("by", ["mouse", "keys"])
def test_names_are_read_again_in_the_encoding_that_is_chosen(
    qt_app: QApplication, qtbot: QtBot, tmp_path: Path, by: str
) -> None:
    path = japanese_piece(tmp_path)
    dialog = ImportDialog(
        read_contents(path, encoding="cp1252"),
        bundled_maps(),
        DARK,
        ImmediateTasks(),
        None,
        lambda encoding: read_contents(path, encoding=encoding),
    )
    qtbot.addWidget(dialog)
    dialog.show()
    box = child(dialog, QComboBox, "import_encoding")
    assert box.isEnabled()
    assert (box.itemText(0), box.itemData(0)) == ("Automatic", None)
    # The former choice is kept.
    choose(dialog, "instrument_2", "trumpet_Bb")
    assert names(dialog)[1] != "低音管"
    place = box.findData("euc_jp")
    if by == "keys":
        choose(dialog, "import_encoding", "euc_jp")
    else:
        QTest.mouseClick(box, Qt.MouseButton.LeftButton)
        view = box.view()
        spot = view.visualRect(view.model().index(place, 0)).center()
        # Qt takes a quicker click for the end of the one that opened the list.
        qtbot.wait(QApplication.doubleClickInterval() + 50)
        QTest.mouseMove(view.viewport(), spot)
        QTest.mouseClick(view.viewport(), Qt.MouseButton.LeftButton, pos=spot)
    assert box.currentData() == "euc_jp"
    assert names(dialog) == ["笛", "低音管", "Lead"]
    assert dialog.assignment.encoding == "euc_jp"
    assert [row.assignment.map_id for row in dialog.rows] == [None, None, "trumpet_Bb"]
    project = import_project(
        dialog.assignment.contents, dialog.rows, MAPS, str(path), encoding=dialog.assignment.encoding
    )
    assert "Lead" in [player.name for player in project.players]
    assert project.imported.encoding == "euc_jp"
    assert reimported(project, path, MAPS).project is project


def test_a_file_that_is_gone_meanwhile_leaves_the_names_as_they_were(
    qt_app: QApplication, qtbot: QtBot, tmp_path: Path
) -> None:
    path = japanese_piece(tmp_path)
    dialog = ImportDialog(
        read_contents(path),
        bundled_maps(),
        DARK,
        ImmediateTasks(),
        None,
        lambda encoding: read_contents(path, encoding=encoding),
    )
    qtbot.addWidget(dialog)
    dialog.show()
    before = names(dialog)
    path.unlink()
    box = child(dialog, QComboBox, "import_encoding")
    summary = child(dialog, QLabel, "import_summary")
    box.setFocus()
    QTest.keyClick(box, Qt.Key.Key_Down)
    assert box.currentData() is None
    assert names(dialog) == before
    assert "piece.mid" in summary.text()
    assert dialog._table.isEnabled()


def names(dialog: ImportDialog) -> list[str]:
    """Names of all rows from top to bottom."""
    fields = [dialog._table.cellWidget(place, 1) for place in range(len(dialog.rows))]
    return [field.text() for field in fields if isinstance(field, QLineEdit)]


def test_a_take_is_cleaned_by_a_switch_that_says_why(qt_app: QApplication, qtbot: QtBot, tmp_path: Path) -> None:
    contents = read_contents(take_file(tmp_path / "take.mid", name="Alto Sax EWI"))
    dialog = ImportDialog(contents, MAPS, DARK, ImmediateTasks())
    qtbot.addWidget(dialog)
    dialog.show()
    assert not dialog._table.isColumnHidden(8)
    box = child(dialog, QCheckBox, "clean_0")
    reported = child(dialog, QListWidget, "import_warnings")
    assert box.isChecked()
    assert "wind controller" in box.toolTip()
    assert "1 note left out" in reported.item(0).text()
    cleaned = imported(dialog).score.parts[0].notes
    QTest.mouseClick(box, Qt.MouseButton.LeftButton)
    assert len(imported(dialog).score.parts[0].notes) == len(cleaned) + 1
    assert not any("left out" in reported.item(row).text() for row in range(reported.count()))


def test_where_no_track_is_a_take_there_is_no_such_switch(dialog: ImportDialog) -> None:
    assert dialog._table.isColumnHidden(8)


def chords(folder: Path, name: str, stray: int = 0) -> Path:
    """Track of twelve quarters with two notes at a time, or of a line with a number of short notes above it."""
    track = mido.MidiTrack([mido.MetaMessage("track_name", name=name)])
    for number in range(36 if stray else 12):
        pitches = (72, 65) if number < stray or not stray else (72,)
        lengths = (480, 480) if not stray else (480, 60)
        for pitch in pitches:
            track.append(mido.Message("note_on", note=pitch, velocity=80))
        if len(pitches) == 2:
            track.append(mido.Message("note_off", note=pitches[1], time=lengths[1]))
        track.append(mido.Message("note_off", note=72, time=480 - (lengths[1] if len(pitches) == 2 else 0)))
    path = folder / "chords.mid"
    mido.MidiFile(type=1, tracks=[track]).save(path)
    return path


@pytest.mark.parametrize("by", ["mouse", "keys"])
def test_each_player_of_a_split_track_has_an_instrument_of_its_own(
    qt_app: QApplication, qtbot: QtBot, tmp_path: Path, by: str
) -> None:
    path = chords(tmp_path, "Flutes")
    contents = read_contents(path)
    dialog = ImportDialog(contents, bundled_maps(), DARK, ImmediateTasks())
    qtbot.addWidget(dialog)
    dialog.show()
    assert [part.map_id for part in imported(dialog).score.parts] == ["flute", "flute"]
    second = child(dialog, QComboBox, "instrument_0_1")
    assert second.isVisible()
    assert (second.currentData(), second.currentText()) == (None, "Automatic: Flute")
    if by == "keys":
        choose(dialog, "instrument_0_1", "clarinet_Bb")
    else:
        QTest.mouseClick(second, Qt.MouseButton.LeftButton)
        view = second.view()
        view.scrollTo(view.model().index(second.findData("clarinet_Bb"), 0))
        spot = view.visualRect(view.model().index(second.findData("clarinet_Bb"), 0)).center()
        qtbot.wait(QApplication.doubleClickInterval() + 50)
        QTest.mouseMove(view.viewport(), spot)
        QTest.mouseClick(view.viewport(), Qt.MouseButton.LeftButton, pos=spot)
    project = imported(dialog)
    assert [part.map_id for part in project.score.parts] == ["flute", "clarinet_Bb"]
    assert [player.instrument_id for player in project.players] == ["flute", "clarinet_Bb"]
    # The decision is kept: reading the same file again reports nothing new.
    kept = import_project(contents, dialog.rows, bundled_maps(), str(path))
    assert reimported(kept, path, bundled_maps()).project is kept
    # The part's instrument is the other player's; one player needs no lists.
    choose(dialog, "instrument_0", "oboe")
    assert [part.map_id for part in imported(dialog).score.parts] == ["oboe", "clarinet_Bb"]
    assert child(dialog, QComboBox, "instrument_0_0").currentText() == "Automatic: Oboe"
    choose(dialog, "instrument_0_1", None)
    assert [part.map_id for part in imported(dialog).score.parts] == ["oboe", "oboe"]
    choose(dialog, "split_0", "never")
    QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    assert dialog.findChild(QComboBox, "instrument_0_1") is None


def test_the_instruments_of_a_split_track_lie_below_one_another(
    qt_app: QApplication, qtbot: QtBot, tmp_path: Path
) -> None:
    tasks = SlowTasks()
    dialog = ImportDialog(read_contents(chords(tmp_path, "Flutes")), bundled_maps(), DARK, tasks)
    qtbot.addWidget(dialog)
    dialog.show()
    QApplication.processEvents()

    def work() -> None:
        while tasks.waiting:
            tasks.work(0)
        QApplication.processEvents()

    def places() -> list[tuple[int, int]]:
        cell = child(dialog, QComboBox, "instrument_0").parentWidget()
        shown = [box for box in cell.findChildren(QComboBox) if box.isVisible()]
        boxes = sorted(shown, key=lambda box: box.mapTo(cell, box.rect().topLeft()).y())
        tops = [box.mapTo(cell, box.rect().topLeft()).y() for box in boxes]
        assert tops[-1] + boxes[-1].height() <= cell.height()
        return [(top, box.height()) for top, box in zip(tops, boxes, strict=True)]

    def is_apart(rows: list[tuple[int, int]]) -> bool:
        return all(top + height <= below for (top, height), (below, _) in pairwise(rows)) and all(
            height >= LEAST_TARGET_PX for _, height in rows
        )

    # The result of the tracks is known only after the dialog is shown.
    work()
    assert len(places()) == 3
    assert is_apart(places()), places()
    # The row of a single player is as low as before.
    choose(dialog, "split_0", "never")
    work()
    assert len(places()) == 1
    assert dialog._table.rowHeight(0) == ROW_PX
    choose(dialog, "split_0", "every")
    work()
    assert len(places()) == 3
    assert is_apart(places()), places()


def test_notes_left_out_do_not_read_as_a_lost_part(qt_app: QApplication, qtbot: QtBot, tmp_path: Path) -> None:
    dialog = ImportDialog(read_contents(chords(tmp_path, "Flute", stray=2)), bundled_maps(), DARK, ImmediateTasks())
    qtbot.addWidget(dialog)
    dialog.show()
    reported = child(dialog, QListWidget, "import_warnings")
    (text,) = [reported.item(row).text() for row in range(reported.count())]
    assert text.startswith("Flute: 2 notes that overlap others are left out, the first at 1.1.000 (F4)")
    assert "will not be played" not in text
    assert "All other notes of the part are played." in text
    # The text describes a remedy, and the remedy works.
    assert "Overlapping notes to Split among players" in text
    choose(dialog, "split_0", "every")
    assert reported.count() == 0 or "left out" not in reported.item(0).text()
    assert sum(len(part.notes) for part in imported(dialog).score.parts) >= 38
