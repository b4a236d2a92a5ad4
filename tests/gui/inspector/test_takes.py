"""The selected take: its name, and cleaning by sliders with immediate effect and one undo step each."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import msgspec
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLabel, QLineEdit
from pytestqt.qtbot import QtBot

from app.editor.selection import Selection
from app.editor.session import Session, Severity
from app.editor.settings import Settings
from app.errors import Message
from app.project.edit.takes import add_takes, comp_whole
from app.score.take import Cleaning, Take
from app.shell.actions import ActionTable
from app.shell.commands import edit, takes
from tests.gui.inspector.hands import child, click, drag, number, type_into
from tests.support.takes import take_of
from tests.support.windows import pause
from widgets.common.actions import actions
from widgets.common.combo import Combo
from widgets.inspector.panel import InspectorPanel

PLAYED = [(0.1, 0.5, 60, 0.6), (0.52, 0.55, 62, 0.1), (0.6, 1.0, 64, 0.6), (1.01, 1.04, 66, 0.03), (1.2, 2.0, 65, 0.6)]


@pytest.fixture
def taken(panel: InspectorPanel, session: Session, tmp_path_factory: pytest.TempPathFactory) -> Session:
    """A selected take of the first selected player that makes up the whole part."""
    ActionTable(session, Settings(tmp_path_factory.mktemp("settings") / "editor.toml"), [*edit.ACTIONS, *takes.ACTIONS])
    assert session.player is not None
    project, (take_id,) = add_takes(
        session.project, session.player.id, [take_of(PLAYED, tempo_map=session.project.score.tempo_map)]
    )
    session.document.open(comp_whole(project, session.player.id, take_id))
    session.select(Selection(take=take_id))
    pause(1)
    return session


def the_take(session: Session) -> Take:
    return session.project.takes[session.player.id].takes[0]


def steps(session: Session) -> list[str]:
    return [step.name.id for step in session.document.done]


def pitches(session: Session) -> list[int]:
    """Pitches of the part's notes within the two seconds of the take."""
    assert session.player is not None
    end = session.project.score.tempo_map.ticks(2.0)
    return [note.pitch for note in session.project.part(session.player).notes if note.onset_tick < end]


def words(panel: InspectorPanel) -> str:
    return " ".join(label.text() for label in panel.findChildren(QLabel) if label.isVisible())


def test_it_says_what_is_left_out(panel: InspectorPanel, taken: Session) -> None:
    assert "Excluded: ghost notes: 1, inaudible: 1" in words(panel)
    assert "EWI5000" in words(panel)
    assert pitches(taken) == [60, 64, 65]


def test_a_number_is_typed_and_reset(panel: InspectorPanel, taken: Session) -> None:
    type_into(number(panel, "take_ghost_loudness"), "5")
    assert the_take(taken).cleaning.ghost_loudness == 0.05
    assert 62 in pitches(taken)
    assert "unheard" not in words(panel)
    QTest.mouseDClick(number(panel, "take_ghost_loudness"), Qt.MouseButton.LeftButton)
    assert the_take(taken).cleaning == Cleaning()
    assert steps(taken) == ["edit.clean_take", "edit.clean_take"]


def test_a_drag_is_one_step_and_seen_at_once(panel: InspectorPanel, taken: Session) -> None:
    seen: list[float] = []
    taken.changed.connect(lambda change: seen.append(the_take(taken).cleaning.ghost_s))
    drag(number(panel, "take_ghost_s"), -40)
    assert len(seen) > 1
    assert steps(taken) == ["edit.clean_take"]
    assert seen[0] > seen[-1] == the_take(taken).cleaning.ghost_s
    taken.document.undo()
    assert the_take(taken).cleaning == Cleaning()


def test_quantising_has_a_grid(panel: InspectorPanel, taken: Session) -> None:
    grid = child(panel, Combo, "take_grid_quarters")
    assert not grid.isEnabled()
    type_into(number(panel, "take_quantise"), "100")
    assert grid.isEnabled()
    grid.chosen.emit(str(Fraction(1)))
    assert taken.player is not None
    quarter = taken.project.score.ticks_per_quarter
    notes = [note for note in taken.project.part(taken.player).notes if note.id.startswith("t:")]
    assert notes
    assert all(note.onset_tick % quarter == 0 for note in notes)


def test_as_usual(panel: InspectorPanel, taken: Session) -> None:
    type_into(number(panel, "take_double_s"), "90")
    pause(1)
    click(panel, "take_usual")
    assert the_take(taken).cleaning == Cleaning()


def test_the_name_is_typed(panel: InspectorPanel, taken: Session) -> None:
    field = child(panel, QLineEdit, "take_name")
    field.selectAll()
    QTest.keyClicks(field, "The good one")
    QTest.keyClick(field, Qt.Key.Key_Return)
    assert the_take(taken).name == "The good one"
    assert steps(taken) == ["edit.rename_take"]
    field.selectAll()
    QTest.keyClicks(field, "   ")
    QTest.keyClick(field, Qt.Key.Key_Return)
    assert the_take(taken).name == "The good one"
    assert field.text() == "The good one"


def test_another_colour(panel: InspectorPanel, taken: Session) -> None:
    from widgets.common.swatch import ColourSwatch

    child(panel, ColourSwatch, "take_swatch").chosen.emit("#123456")
    assert the_take(taken).colour == "#123456"


def test_beats_of_an_ensemble_are_refused(panel: InspectorPanel, taken: Session) -> None:
    reported: list[Message] = []
    taken.noticed.connect(lambda message, severity: reported.append(message) if severity is Severity.ERROR else None)
    pause(1)
    click(panel, "take_beats")
    assert [message.id for message in reported] == ["take.not_free"]
    assert steps(taken) == []


def test_few_notes_have_no_beats(panel: InspectorPanel, taken: Session) -> None:
    assert taken.player is not None
    project = taken.project
    parts = tuple(
        part if part.id == taken.player.part_id else msgspec.structs.replace(part, notes=())
        for part in project.score.parts
    )
    taken.document.open(replace(project, score=msgspec.structs.replace(project.score, parts=parts)))
    taken.select(Selection(take="take:1"))
    reported: list[Message] = []
    taken.noticed.connect(lambda message, severity: reported.append(message))
    pause(1)
    click(panel, "take_beats")
    assert [message.id for message in reported] == ["take.too_few_notes"]


def test_it_goes_with_the_take(panel: InspectorPanel, taken: Session, qtbot: QtBot) -> None:
    actions(taken)["takes.remove"].trigger()
    assert not [field for field in panel.findChildren(QLineEdit, "take_name") if field.isVisible()]
    assert "Click a note" in words(panel)
    taken.select(Selection(take=""))
    assert "Click a note" in words(panel)
