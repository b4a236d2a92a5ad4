"""Learn Choreography from the menu and from the dancers' section; the result is danced and can be undone."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtWidgets import QPushButton

from app.choreography.model_file import write_model
from app.choreography.performed.dancers import dancing_of
from app.errors import Message
from app.performance.ensemble import Performance
from app.project.edit.dancers import add_dancer
from tests.gui.conftest import QUARTET, delete_now
from tests.gui.shell.conftest import trigger
from tests.support.dances import model
from tests.support.studio import Studio
from tests.support.windows import child, wait_until
from widgets.common.combo import Combo
from widgets.dialogs.choreography.learn import LearnDialog
from widgets.players.choreography.dancers import DancersSection


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
    dialog = child(program.window, LearnDialog)
    assert dialog.isVisible()
    use = child(dialog, QPushButton, "learn_use")
    assert use.text() == "Add Dancer with This Choreography"
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
    # A closed dialog ignores edits.
    delete_now()
    trigger(program, "dancers.add")
    assert len(session.project.dancers) == 2


def test_it_is_where_a_choreography_is_chosen(studio: Studio) -> None:
    program = studio.program
    program.editor.files.open(QUARTET, ask=False)
    trigger(program, "dancers.add")
    (dancer,) = program.session.project.dancers
    section = child(program.window, DancersSection)
    combo = child(section, Combo, "dancer_choreography")
    last = combo.count() - 1
    assert combo.itemText(last) == "Learn..."
    combo.setCurrentIndex(last)
    combo.activated.emit(last)
    dialog = child(program.window, LearnDialog)
    assert dialog.isVisible()
    assert combo.shown == dancer.choreography
    assert program.session.project.dancers == (dancer,)
    dialog.close()


def test_who_dances_a_choreography_that_is_learned_again_dances_the_new_one(studio: Studio, learned: Path) -> None:
    program = studio.program
    session = program.session
    program.editor.files.open(QUARTET, ask=False)
    program.session.attempt(Message("edit.add_dancer"), lambda project: add_dancer(project, learned, "Ana")[0])
    (dancer,) = session.project.dancers
    section = child(program.window, DancersSection)
    source = child(section, Combo, "dancer_source")
    assert [source.itemText(row) for row in range(source.count())] == ["None", "one", "other"]
    before = dancing_of(session.performance, dancer).steps()
    shown: list[Performance] = []
    session.performance_changed.connect(lambda: shown.append(session.performance))
    other = model(seed=7)
    write_model(learned, replace(other, sources=tuple(replace(one, motion_name="new.bvh") for one in other.sources)))
    session.choreographies_changed.emit()
    assert wait_until(lambda: bool(shown))
    assert dancing_of(shown[-1], dancer).steps() != before
    assert [source.itemText(row) for row in range(source.count())] == ["None", "new", "new"]
    assert session.project.dancers == (dancer,)
