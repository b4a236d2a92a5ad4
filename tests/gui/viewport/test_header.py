"""The row of buttons above the players, and the note in it."""

from __future__ import annotations

import pytest
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from tests.support.windows import show
from widgets.common.plain import Label
from widgets.viewport.header import ViewportHeader


@pytest.mark.parametrize("language", ["en", "ja"])
def test_the_note_says_whole_parts_as_far_as_there_is_room(qtbot: QtBot, session: Session, language: str) -> None:
    header = ViewportHeader(session)
    qtbot.addWidget(header)
    show(header)
    note = header.findChild(Label, "viewport_note")
    assert note is not None
    parts = ("Drag a handle", "Shift: fine", "Double-click: revert")
    if language == "ja":
        parts = ("ハンドルをドラッグ", "Shift: 微調整", "ダブルクリック: 元に戻す")
    header.set_note(" · ".join(parts))
    shown = set[str]()
    for width in range(header.minimumSizeHint().width(), 1600, 20):
        header.resize(width, header.height())
        shown.add(note.text())
        assert note.sizeHint().width() <= header.width()
    assert shown == {"", *(" · ".join(parts[:count]) for count in (1, 2, 3))}
    assert note.toolTip() == " · ".join(parts)
