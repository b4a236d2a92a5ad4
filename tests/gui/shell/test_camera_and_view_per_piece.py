"""View, camera and timeline are stored per piece: they are restored when it is opened again, and other pieces open
framed.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.editor.settings import MOST_VIEWS, Settings
from app.shell.app import Program
from tests.gui.conftest import QUARTET
from tests.gui.shell.conftest import Answers, Start

pytestmark = pytest.mark.drawn


@pytest.fixture
def piece(tmp_path: Path) -> Path:
    """The quartet in a file of the user."""
    return Path(shutil.copy(QUARTET, tmp_path / "mine.mid"))


def _look(program: Program) -> None:
    """Show the third player's hands with a rotated camera, bars 4 to 6, and an additional open lane."""
    session, window = program.session, program.window
    session.set_players((session.project.players[2].id,))
    canvas = window.viewport.canvas_widget()
    assert canvas is not None
    canvas.setFocus()
    QTest.keyClick(canvas, Qt.Key.Key_5)
    window.viewport._eye.jump(window.viewport.camera)
    window.viewport._eye.orbit(30.0, -12.0)
    session.set_playhead(7.5)
    window.timeline.axis.show(6.0, 12.0)
    window.timeline.roll.zoom_pitch(1.5)
    window.timeline.open_lane("curves", True)


def _seen(program: Program) -> dict[str, object]:
    session, window = program.session, program.window
    camera, timeline = window.viewport.camera, window.timeline
    return {
        "player": session.players,
        "view": session.viewport.view,
        "camera": pytest.approx((camera.yaw_rad, camera.pitch_rad, camera.distance_m)),
        "playhead": session.playhead_s,
        "timeline": pytest.approx(tuple(timeline.seen), abs=0.01),
        "lane": timeline.is_lane_open("curves"),
    }


def _as_seen(expected: dict[str, object], program: Program) -> None:
    camera = program.window.viewport.camera
    QApplication.processEvents()
    found = _seen(program) | {
        "camera": (camera.yaw_rad, camera.pitch_rad, camera.distance_m),
        "timeline": tuple(program.window.timeline.seen),
    }
    assert found == expected


def test_it_comes_back_after_another_piece_and_after_the_program_ended(start: Start, piece: Path) -> None:
    program = start()
    program.editor.files.open(piece, ask=False)
    _look(program)
    seen = _seen(program)
    assert program.session.document.is_saved
    program.editor.files.open_danced_example()
    assert program.session.viewport.view == "ensemble"
    assert not program.window.viewport._eye.touched
    program.editor.files.open(piece, ask=False)
    _as_seen(seen, program)
    program.editor.files.end()
    again = start()
    again.editor.files.open(piece, ask=False)
    _as_seen(seen, again)


def test_another_piece_opens_with_its_first_player_in_front(start: Start, piece: Path, tmp_path: Path) -> None:
    program = start()
    program.editor.files.open(piece, ask=False)
    _look(program)
    # Read from a like file, its players have the same ids.
    program.editor.files.open(Path(shutil.copy(piece, tmp_path / "other.mid")), ask=False)
    assert program.session.players == (program.session.project.players[0].id,)


def test_a_saved_piece_has_the_view_it_was_left_with(
    start: Start, piece: Path, answers: Answers, tmp_path: Path
) -> None:
    program = start()
    program.editor.files.open(piece, ask=False)
    answers.path = tmp_path / "mine.suisou"
    program.editor.files.save()
    _look(program)
    seen = _seen(program)
    program.editor.files.close()
    program.editor.files.open(answers.path)
    _as_seen(seen, program)


@pytest.mark.parametrize(
    "change", [lambda text: text[:-5], lambda text: text.replace("hands", "moon"), lambda text: "{}"]
)
def test_a_view_that_cannot_be_read_is_none(start: Start, piece: Path, change: Callable[[str], str]) -> None:
    program = start()
    program.editor.files.open(piece, ask=False)
    _look(program)
    program.editor.files.close()
    settings = program.editor.settings
    settings.set_piece_view(str(piece), change(settings.piece_view(str(piece))))
    program.editor.files.open(piece, ask=False)
    assert program.session.viewport.view == "ensemble"


def test_a_player_who_is_gone_is_not_brought_to_the_front(start: Start, piece: Path) -> None:
    program = start()
    program.editor.files.open(piece, ask=False)
    _look(program)
    first = program.session.project.players[0].id
    program.editor.files.close()
    settings = program.editor.settings
    gone = program.editor.settings.piece_view(str(piece)).replace("4.3.1", "9.9.9")
    settings.set_piece_view(str(piece), gone)
    program.editor.files.open(piece, ask=False)
    assert program.session.players == (first,)


def test_what_is_remembered_has_an_end(settings: Settings) -> None:
    for number in range(300):
        settings.set_piece_view(f"/music/{number}.mid", "x" * 600)
    assert settings.piece_view("/music/299.mid")
    assert not settings.piece_view("/music/0.mid")
    kept = [number for number in range(300) if settings.piece_view(f"/music/{number}.mid")]
    assert kept == list(range(300 - len(kept), 300))
    assert 0.9 * MOST_VIEWS < 600 * len(kept) <= MOST_VIEWS
