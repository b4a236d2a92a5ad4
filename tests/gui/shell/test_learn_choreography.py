"""Learn Choreography from the menu and from the dancers' section; what was learned is danced, and undone."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtWidgets import QPushButton

from app.choreography.model_file import write_model
from tests.gui.conftest import QUARTET
from tests.gui.shell.conftest import Studio, trigger
from tests.support.dances import model
from widgets.common.combo import Combo
from widgets.dialogs.learn_choreography import LearnDialog
from widgets.players.dancers import DancersSection


@pytest.fixture
def learned(tmp_path: Path) -> Path:
    path = tmp_path / "steps & more.choreography"
    write_model(path, model())
    return path


def test_a_learned_choreography_is_danced_by_the_selected_dancer_or_a_new_one(studio: Studio, learned: Path) -> None:
    program = studio.program
    session = program.session
    program.editor.files.open(QUARTET, ask=False)
    before = session.project
    trigger(program, "dancers.learn")
    dialog = program.window.findChild(LearnDialog)
    assert dialog is not None
    assert dialog.isVisible()
    use = dialog.findChild(QPushButton, "learn_use")
    assert use is not None
    assert use.text() == "Add a Dancer with It"
    dialog.used.emit(learned)
    (dancer,) = session.project.dancers
    assert dancer.choreography == str(learned)
    session.document.undo()
    assert session.project == before
    trigger(program, "dancers.add")
    (dancer,) = session.project.dancers
    assert use.text() == f"Use for {dancer.name}"
    dialog.used.emit(learned)
    assert [one.choreography for one in session.project.dancers] == [str(learned)]
    session.document.undo()
    assert session.project.dancers == (dancer,)
    dialog.close()


def test_it_is_where_a_choreography_is_chosen(studio: Studio) -> None:
    program = studio.program
    program.editor.files.open(QUARTET, ask=False)
    trigger(program, "dancers.add")
    (dancer,) = program.session.project.dancers
    section = program.window.findChild(DancersSection)
    assert section is not None
    combo = section.findChild(Combo, "dancer_choreography")
    assert combo is not None
    last = combo.count() - 1
    assert combo.itemText(last) == "Learn …"
    combo.setCurrentIndex(last)
    combo.activated.emit(last)
    dialog = program.window.findChild(LearnDialog)
    assert dialog is not None
    assert dialog.isVisible()
    assert combo.shown == dancer.choreography
    assert program.session.project.dancers == (dancer,)
    dialog.close()
