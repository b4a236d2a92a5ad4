"""The window: panels, pages, menus, layout, title, closing."""

from __future__ import annotations

import shutil
import tomllib
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import msgspec
import numpy as np
import pytest
import soundfile
from PySide6.QtCore import QMimeData, QPoint, QPointF, QRect, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMenu, QPushButton
from pytestqt.qtbot import QtBot

from app.choreography.performed.dancers import dancing_of
from app.editor.settings import Settings
from app.errors import Message
from app.project.edit.marks import set_marks
from app.project.edit.piece import set_title
from app.project.storage import load
from app.score.marks import Mark
from app.score.model import Marker
from app.shell.app import Program
from app.shell.window import FRAME, Window
from tests.gui.conftest import QUARTET
from tests.gui.shell.conftest import Answers, Start, trigger
from tests.support.tasks import ImmediateTasks
from tests.support.windows import child, wait_until
from widgets.common.actions import actions
from widgets.common.number_slider import NumberSlider
from widgets.timeline.lanes.recording.waveform import WaveformLane

PANELS = {
    "players": Qt.DockWidgetArea.LeftDockWidgetArea,
    "inspector": Qt.DockWidgetArea.RightDockWidgetArea,
    "timeline": Qt.DockWidgetArea.BottomDockWidgetArea,
}
"""Panels that are open by default, with their areas."""


def edit(program: Program, title: str = "Another") -> None:
    program.session.attempt(Message("edit.set_tempo"), lambda project: set_title(project, title))


def drop(program: Program, path: Path) -> bool:
    """Drag a file onto the window; return whether it was accepted."""
    mime = QMimeData()
    mime.setUrls([QUrl.fromLocalFile(str(path))])
    action, left, none = Qt.DropAction.CopyAction, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    enter = QDragEnterEvent(QPoint(50, 50), action, mime, left, none)
    QApplication.sendEvent(program.window, enter)
    if enter.isAccepted():
        QApplication.sendEvent(program.window, QDropEvent(QPointF(50, 50), action, mime, left, none))
    return enter.isAccepted()


@pytest.mark.parametrize("room", [QRect(0, 0, 1366, 768), QRect(60, 32, 1306, 736), QRect(0, 0, 1600, 1000)])
def test_a_first_window_fits_the_screen_with_its_title_bar(
    start: Start, monkeypatch: pytest.MonkeyPatch, room: QRect
) -> None:
    monkeypatch.setattr(Window, "screen", lambda window: SimpleNamespace(availableGeometry=lambda: room))
    program = start()
    window = program.window
    assert room.contains(QRect(window.pos(), window.size() + FRAME))
    for language in ("en", "ja"):
        program.editor.speak(language)
        program.editor.files.open(QUARTET, ask=False)
        for workspace in ("animate", "record", "check"):
            trigger(program, f"workspace.{workspace}")
            QApplication.processEvents()
            # No widget requires more room.
            assert window.size() == room.size() - FRAME
            assert window.rect().contains(window.status.geometry())
            timeline = window.timeline
            assert window.rect().contains(timeline.rect().translated(timeline.mapTo(window, QPoint())))


def test_the_start_page_is_alone_until_something_is_open(empty: Program) -> None:
    window = empty.window
    assert window.start_page.isVisible()
    assert not any(dock.isVisible() for dock in window.docks.values())
    trigger(empty, "file.open_example")
    assert not window.start_page.isVisible()
    assert window.viewport.isVisible()
    assert all(window.docks[name].isVisible() for name in PANELS)
    trigger(empty, "file.close")
    assert window.start_page.isVisible()
    assert empty.session.project.players == ()


def test_the_example_with_a_dancer_is_on_the_start_page(empty: Program) -> None:
    QTest.mouseClick(child(empty.window.start_page, QPushButton, "start_danced_example"), Qt.MouseButton.LeftButton)
    session = empty.session
    assert [player.name for player in session.project.players] == ["Trumpet 1", "Trumpet 2", "Trombone", "Tuba"]
    (dancer,) = session.project.dancers
    assert (dancer.name, dancer.choreography) == ("Dancer", "salsa")
    # Before the players, towards the audience.
    assert all(dancer.stage.z_m > player.stage.z_m + 1.0 for player in session.project.players)
    dancing = dancing_of(session.performance, dancer)
    assert not dancing.rhythm.derived, "the dancer hears the drums"
    assert len({step.state for step in dancing.steps()}) > 4
    assert session.dancer == dancer
    # The project has no file yet, and no undo step removes the dancer.
    assert empty.editor.files.path is None
    assert empty.editor.settings.recent == ()
    assert not session.document.undone
    assert session.document.undo() is None
    assert session.project.dancers == (dancer,)


def test_every_menu_opens(program: Program, qtbot: QtBot) -> None:
    opened: list[QMenu] = []
    for menu in program.window.menus.menus.values():
        menu.aboutToShow.connect(lambda menu=menu: opened.append(menu))
        menu.popup(program.window.mapToGlobal(QPoint(20, 40)))
        qtbot.waitUntil(menu.isVisible)
        menu.close()
        assert menu.title()
        assert menu.actions()
    assert len(opened) == len(program.window.menus.menus)


def test_the_title_says_what_is_open_and_whether_it_is_saved(
    program: Program, tmp_path: Path, answers: Answers
) -> None:
    window = program.window
    assert window.windowTitle().startswith("quartet")
    assert not window.isWindowModified()
    edit(program)
    assert window.isWindowModified()
    answers.path = tmp_path / "mine"
    trigger(program, "file.save")
    assert window.windowTitle().startswith("mine.suisou")
    assert not window.isWindowModified()
    assert load(tmp_path / "mine.suisou") == program.session.project
    trigger(program, "edit.undo")
    assert window.isWindowModified()


@pytest.mark.parametrize(("answer", "is_closed"), [("cancel", False), ("discard", True), ("save", True)])
def test_closing_with_unsaved_changes_asks(
    program: Program, answers: Answers, tmp_path: Path, qtbot: QtBot, answer: str, is_closed: bool
) -> None:
    edit(program)
    answers.path = tmp_path / "kept.suisou"
    answers.answer = answer
    program.window.close()
    qtbot.wait(10)
    assert answers.asked[0] == "unsaved"
    assert program.window.isHidden() is is_closed
    assert (tmp_path / "kept.suisou").exists() is (answer == "save")


def test_closing_while_files_are_written_asks(
    program: Program, answers: Answers, monkeypatch: pytest.MonkeyPatch
) -> None:
    film = Message("work.playblast")
    monkeypatch.setattr(ImmediateTasks, "writing", (film,))
    trigger(program, "file.quit")
    assert (answers.asked, answers.works) == (["stop_writing"], (film,))
    assert program.window.isVisible()
    answers.stops = True
    edit(program)
    program.window.close()
    # Work is stopped when the window closes; it continues if closing is cancelled.
    assert answers.asked == ["stop_writing", "stop_writing", "unsaved"]
    assert program.window.isVisible()
    trigger(program, "edit.undo")
    program.window.close()
    assert program.window.isHidden()


def test_closing_without_changes_does_not_ask(program: Program, answers: Answers) -> None:
    program.window.close()
    assert program.window.isHidden()
    assert answers.asked == []


def test_saving_that_is_given_up_does_not_close(program: Program, answers: Answers) -> None:
    edit(program)
    answers.answer, answers.path = "save", None
    program.window.close()
    assert not program.window.isHidden()


def test_files_are_dropped_onto_the_window(empty: Program, answers: Answers, tmp_path: Path) -> None:
    sound, text = tmp_path / "take.wav", tmp_path / "notes.txt"
    sound.write_bytes(b"")
    text.write_text("no music")
    assert not drop(empty, text)
    assert drop(empty, QUARTET)
    assert answers.asked == ["import"]
    assert len(empty.session.project.players) == 4
    assert drop(empty, sound)
    assert empty.session.project.audio.path == str(sound)


def test_an_import_that_is_given_up_leaves_everything(empty: Program, answers: Answers) -> None:
    answers.imports = False
    drop(empty, QUARTET)
    assert not empty.editor.files.is_open


def test_panels_close_come_back_float_and_return_to_their_places(program: Program) -> None:
    window = program.window
    dock = window.docks["players"]
    assert dock.isVisible()
    trigger(program, "panel.players")
    assert not dock.isVisible()
    trigger(program, "panel.players")
    assert dock.isVisible()
    dock.setFloating(True)
    assert dock.isFloating()
    trigger(program, "workspace.reset")
    assert not dock.isFloating()
    assert all(window.dockWidgetArea(window.docks[name]) == area for name, area in PANELS.items())


def test_the_layout_is_remembered(start: Start) -> None:
    first = start()
    first.editor.files.open(QUARTET, ask=False)
    trigger(first, "panel.inspector")
    first.window.addDockWidget(Qt.DockWidgetArea.RightDockWidgetArea, first.window.docks["players"])
    first.window.resize(1234, 777)
    first.window.close()
    second = start()
    assert (second.window.width(), second.window.height()) == (1234, 777)
    second.editor.files.open(QUARTET, ask=False)
    assert second.window.docks["inspector"].isHidden()
    assert not second.window.docks["timeline"].isHidden()
    assert second.window.dockWidgetArea(second.window.docks["players"]) == Qt.DockWidgetArea.RightDockWidgetArea


def test_nothing_is_written_beside_the_example(empty: Program, tmp_path: Path) -> None:
    """The example is within the program; the user's files go to the last used folder."""
    files = empty.editor.files
    trigger(empty, "file.open_example")
    assert files.folder == str(Path.home())
    own = Path(shutil.copy(QUARTET, tmp_path))
    files.open(own, ask=False)
    assert files.folder == str(tmp_path)
    trigger(empty, "file.open_example")
    assert files.folder == str(tmp_path)


def test_the_layout_survives_the_start_page(start: Start) -> None:
    first = start()
    first.editor.files.open(QUARTET, ask=False)
    trigger(first, "panel.inspector")
    trigger(first, "file.close")
    first.window.close()
    second = start()
    second.editor.files.open(QUARTET, ask=False)
    assert second.window.docks["inspector"].isHidden()
    assert not second.window.docks["players"].isHidden()


def test_full_screen_shows_the_viewport_alone(program: Program, qtbot: QtBot) -> None:
    window = program.window
    trigger(program, "application.full_screen")
    assert window.isFullScreen()
    assert window.viewport.isVisible()
    assert not any(dock.isVisible() for dock in window.docks.values())
    assert not window.menuBar().isVisible()
    qtbot.keyClick(window, Qt.Key.Key_Escape)
    assert not window.isFullScreen()
    assert all(window.docks[name].isVisible() for name in PANELS)
    assert window.menuBar().isVisible()


def test_a_missing_recording_is_asked_for_and_its_offset_stays(
    start: Start, answers: Answers, tmp_path: Path, qtbot: QtBot
) -> None:
    first = start()
    first.editor.files.open(QUARTET, ask=False)
    sound = tmp_path / "take.wav"
    sound.write_bytes(b"")
    first.editor.files.add_audio(sound)
    answers.path = tmp_path / "piece.suisou"
    trigger(first, "file.save")
    first.window.close()
    moved = sound.rename(tmp_path / "moved.wav")
    second = start()
    second.editor.files.open(tmp_path / "piece.suisou")
    assert second.window.banner.isVisible()
    answers.path = moved
    qtbot.mouseClick(second.window.banner.findChild(object, "banner_answer_0"), Qt.MouseButton.LeftButton)
    assert second.session.project.audio.path == str(moved)
    assert not second.window.banner.isVisible()


@pytest.mark.parametrize(("width", "height"), [(1280, 800), (1600, 1000), (1920, 1080)])
def test_a_new_window_shares_its_height_between_players_and_timeline(start: Start, width: int, height: int) -> None:
    program = start()
    window = program.window
    window.resize(width, height)
    program.editor.files.open(QUARTET, ask=False)
    QApplication.processEvents()
    assert 0.42 * height <= window.docks["timeline"].height() <= 0.48 * height
    assert window.viewport.height() >= 0.41 * height
    lanes = window.timeline.stack.viewport()
    heights = {lane.id: lane.mapTo(lanes, lane.rect().topLeft()).y() for lane in window.timeline.stack.lanes}
    assert window.timeline.roll.height() >= min(220, 0.6 * lanes.height())
    assert heights["fingering"] < lanes.height()
    assert not window.timeline.lanes["audio"].isVisible()


@pytest.mark.parametrize("beside", ["", "dynamics", "flags", "dynamics and flags"])
@pytest.mark.parametrize("instrument_id", ["trumpet_Bb", "oboe", "bassoon"])
def test_notes_fingerings_and_breaths_are_in_sight_at_first(start: Start, instrument_id: str, beside: str) -> None:
    program = start()
    window, session = program.window, program.session
    window.resize(1600, 1000)
    program.editor.files.open(QUARTET, ask=False)
    project = session.project
    front = msgspec.structs.replace(project.players[0], instrument_id=instrument_id)
    project = replace(project, players=(front, *project.players[1:]))
    if "dynamics" in beside:
        project = set_marks(project, front.id, [Mark("dynamic", tick=0, text="mf")])
    if "flags" in beside:
        project = replace(project, score=msgspec.structs.replace(project.score, markers=(Marker(0, "A"),)))
    session.apply(Message("edit.piece_settings"), project)
    window.reset_workspace()
    QApplication.processEvents()
    stack = window.timeline.stack
    room = stack.viewport()
    ids = [id for id in ("roll", "dynamics", "fingering", "breath") if window.timeline.lanes[id].isVisible()]
    assert ("dynamics" in ids) == ("dynamics" in beside)
    for id in ids:
        lane = window.timeline.lanes[id]
        top = lane.mapTo(room, lane.rect().topLeft()).y()
        assert 0 <= top < top + lane.height() <= room.height(), id
        assert lane.height() >= lane.least_height_px
    assert window.timeline.roll.height() >= 220
    assert window.viewport.height() >= 0.45 * window.height()


def test_the_audio_lane_is_there_with_a_recording(program: Program, tmp_path: Path) -> None:
    lane = program.window.timeline.lanes["audio"]
    assert not lane.isVisible()
    sound = tmp_path / "tone.wav"
    soundfile.write(sound, np.zeros(4410, np.float32), 44_100)
    assert drop(program, sound)
    assert lane.isVisible()
    trigger(program, "edit.undo")
    assert not lane.isVisible()
    # A lane opened by the user explains what to do.
    trigger(program, "lanes.audio")
    assert lane.isVisible()


def test_how_a_user_listens_is_remembered(start: Start, settings: Settings) -> None:
    first = start()
    actions(first.session)["play.click"].trigger()
    volume = child(first.window, NumberSlider, "volume")
    QTest.keyClick(volume, Qt.Key.Key_Down)
    chosen = first.session.listening.volume
    assert chosen < 0.8
    first.session.listening.set(source="both", scrub_sound=False)
    first.session.listening.set(ready=0.5, speed=1.5)
    settings.sync()
    assert set(tomllib.loads(settings.path.read_text("utf-8"))["sound"]) == {"volume", "click", "scrub", "source"}
    first.window.close()
    listening = start().session.listening
    assert (listening.volume, listening.click, listening.source, listening.scrub_sound) == (chosen, True, "both", False)
    assert listening.speed == 1.0


def test_a_dancer_of_the_import_is_part_of_it(empty: Program, answers: Answers) -> None:
    path = QUARTET.parents[2] / "tests" / "data" / "midi" / "awkward" / "test-all-gm-percussion.mid"
    for dances in (False, True):
        answers.dances = dances
        empty.editor.files.open(path)
        project = empty.session.project
        assert project.score.percussion
        assert [dancer.name for dancer in project.dancers] == ["Dancer"] * dances
        assert not empty.session.document.done
        assert answers.asked[-1] == "import"


def test_the_empty_audio_lane_says_how_audio_comes_and_asks_for_it(program: Program, answers: Answers) -> None:
    trigger(program, "lanes.audio")
    lane = child(program.window.timeline, WaveformLane)
    QApplication.processEvents()
    assert lane.isVisible()
    for hint in ("File > Import Audio", "double-click"):
        assert hint in lane.empty_text()
    answers.asked.clear()
    QTest.mouseDClick(lane.plot, Qt.MouseButton.LeftButton, pos=lane.plot.rect().center())
    assert wait_until(lambda: answers.asked == ["open"])
