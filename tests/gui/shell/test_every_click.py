"""Buttons and menu entries of the window, clicked by the mouse."""

from __future__ import annotations

import pytest
from PySide6.QtWidgets import QMenu, QToolButton

from app.shell.app import Program
from tests.support import mouse
from widgets.viewport.header import SHOWN


@pytest.mark.parametrize("what", SHOWN)
def test_an_entry_of_the_eye_menu_shows_or_hides(program: Program, what: str) -> None:
    state = program.session.viewport
    eye = program.window.findChild(QToolButton, "viewport_show")
    assert eye is not None
    place = list(SHOWN).index(what)

    def click(menu: QMenu) -> None:
        mouse.choose(menu, menu.actions()[place])

    before = [state.shows(other) for other in SHOWN]
    mouse.in_menu_of(eye, click)
    assert [state.shows(other) for other in SHOWN] == [
        on != (other == what) for other, on in zip(SHOWN, before, strict=True)
    ]
    mouse.in_menu_of(eye, click)
    assert [state.shows(other) for other in SHOWN] == before
