"""Files of a project on another computer are not accessed before the user agrees in the window."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtWidgets import QApplication, QLabel, QPushButton

from app.editor.settings import Settings
from app.project.storage import save
from app.shell.app import Program
from app.shell.notices import folder_of
from tests.gui.conftest import quartet_project
from tests.gui.shell.conftest import Start, trigger
from tests.support import mouse
from tests.support.elsewhere import SHARES, on_share, paths_on
from tests.support.touched import Touched
from widgets.common.paths import _reachable

SHARE = SHARES[0]


def opened(program: Program, folder: Path) -> None:
    path = folder / "piece.suisou"
    save(on_share(quartet_project(), SHARE), path)
    program.editor.files.open(path)
    QApplication.processEvents()


@pytest.mark.parametrize("language", ["en", "ja"])
def test_the_window_asks_before_it_looks(program: Program, tmp_path: Path, touched: Touched, language: str) -> None:
    program.editor.speak(language)
    opened(program, tmp_path)
    banner = program.window.banner
    assert banner.isVisible()
    program.session.set_playhead(4.0)
    trigger(program, "players.mute")
    trigger(program, "video.behind")
    program.editor.files.write_now()
    program.editor.files.save()
    for player in program.session.project.players:
        program.session.set_players((player.id,))
    program.session.set_dancer(program.session.project.dancers[0].id)
    for _ in range(5):
        QApplication.processEvents()
    assert touched.elsewhere == []
    mouse.press(banner.findChild(QPushButton, "banner_answer_0"))
    QApplication.processEvents()
    found = set(touched.elsewhere)
    recording, video, moves, dance, _ = paths_on(SHARE)
    assert found >= {recording, video, moves, dance}
    # The file is missing: the window asks for its location.
    assert banner.isVisible()
    assert "take.wav" in banner.findChild(QLabel, "banner_text").text().replace("\u200b", "")


def test_who_does_not_connect_is_not_asked_again(program: Program, tmp_path: Path, touched: Touched) -> None:
    opened(program, tmp_path)
    mouse.press(program.window.banner.findChild(QPushButton, "banner_answer_1"))
    QApplication.processEvents()
    assert not program.window.banner.isVisible()
    assert touched.elsewhere == []


def test_recent_files_on_another_computer_are_offered_unasked(
    start: Start, settings: Settings, touched: Touched
) -> None:
    settings.add_recent(Path(r"\\host\share\piece.suisou"))
    program = start()
    row = program.window.start_page.findChild(QPushButton, "recent_file")
    assert row.isEnabled()
    menu = mouse.open_in_bar(
        program.window.menuBar(), [program.window.menus.menus[name] for name in ("file", "file/open_recent")]
    )
    assert menu.actions()[0].isEnabled()
    menu.close()
    assert touched.elsewhere == []
    mouse.press(row)
    assert touched.elsewhere != []


def test_dialogs_and_notices_do_not_begin_on_another_computer(touched: Touched) -> None:
    from app.errors import Message

    assert _reachable(Path("//host/share/take.wav")) == Path.home()
    assert folder_of(Message("file.cannot_read", {"file": "//host/share/take.wav", "reason": ""})) is None
    assert touched.elsewhere == []
