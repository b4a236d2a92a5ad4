"""The note section by mouse and keys, judged by the project."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLabel

from app.editor.selection import EventKey, Selection
from app.editor.session import Session
from app.errors import Message
from app.plan.by_hand.corrections import PinFingering, SetEmbouchure
from app.project.edit.corrections import with_corrections
from app.project.performers import Player
from app.score.model import Note
from instrument_maps.library import find_map
from tests.gui.inspector.hands import child, click, drag, number, type_into
from widgets.common.chip import Chip
from widgets.common.fingering_diagram import FingeringDiagram, slide_slots
from widgets.common.pitch import pitch_from
from widgets.inspector.by_hand import ByHandLine
from widgets.inspector.panel import InspectorPanel


def with_alternates(session: Session, player: Player) -> Note:
    instrument = find_map(player.instrument_id)
    return next(note for note in session.project.part(player).notes if len(instrument.fingerings_for(note.pitch)) > 1)


def select(session: Session, *notes: Note) -> None:
    session.select(Selection(notes=frozenset(note.id for note in notes)))


def note_now(session: Session, note_id: str) -> Note:
    return next(note for part in session.project.score.parts for note in part.notes if note.id == note_id)


def corrections(session: Session, player: Player) -> tuple[object, ...]:
    return session.project.corrections.get(player.id, ())


def test_nothing_selected_teaches(panel: InspectorPanel) -> None:
    texts = [label.text() for label in panel.findChildren(QLabel) if label.isVisible()]
    assert any("Click a note" in text for text in texts)


def test_a_note_is_edited_as_numbers(panel: InspectorPanel, planned: Session) -> None:
    note = planned.project.part(planned.project.players[0]).notes[3]
    select(planned, note)
    type_into(number(panel, "note_pitch"), "C5")
    assert note_now(planned, note.id).pitch == 72
    type_into(number(panel, "note_pitch"), "70")
    assert note_now(planned, note.id).pitch == 70
    type_into(number(panel, "note_velocity"), "33")
    assert note_now(planned, note.id).velocity == 33
    type_into(number(panel, "note_onset"), "40.2.10")
    score = planned.project.score
    beat = 4 * score.ticks_per_quarter // score.metres[-1].denominator
    assert note_now(planned, note.id).onset_tick == score.metre_map.tick_of_bar(40) + beat + 10
    type_into(number(panel, "note_length"), "3/2")
    assert note_now(planned, note.id).duration_tick == round(1.5 * beat)
    assert len(planned.document.done) == 5


def test_several_notes_move_together_and_a_drag_is_one_step(panel: InspectorPanel, planned: Session) -> None:
    notes = planned.project.part(planned.project.players[0]).notes[4:7]
    select(planned, *notes)
    drag(number(panel, "note_pitch"), 12)
    moved = [note_now(planned, note.id).pitch - note.pitch for note in notes]
    assert len(set(moved)) == 1
    assert moved[0] > 0
    assert len(planned.document.done) == 1
    velocity = number(panel, "note_velocity")
    assert velocity.mixed == (len({note.velocity for note in notes}) > 1)
    type_into(velocity, "50")
    assert {note_now(planned, note.id).velocity for note in notes} == {50}


def test_a_refused_number_shows_what_is_there(panel: InspectorPanel, planned: Session) -> None:
    notes = planned.project.part(planned.project.players[0]).notes[:2]
    select(planned, *notes)
    reported = []
    planned.noticed.connect(lambda message, severity: reported.append(message.id))
    # The first would go to the lowest pitch there is, the other below it.
    low = min(notes, key=lambda note: note.onset_tick)
    type_into(number(panel, "note_pitch"), "127" if notes[1].pitch > notes[0].pitch else "0")
    assert reported == ["note.pitch_outside"]
    assert note_now(planned, low.id).pitch == low.pitch
    assert number(panel, "note_pitch").value == low.pitch


def test_a_chip_pins_and_the_arrow_takes_it_back(panel: InspectorPanel, planned: Session) -> None:
    player = planned.project.players[0]
    note = with_alternates(planned, player)
    alternate = find_map(player.instrument_id).fingerings_for(note.pitch)[1]
    select(planned, note)
    click(panel, f"chip_{alternate.label}")
    assert corrections(planned, player) == (PinFingering(note.id, alternate.label),)
    chip = child(panel, Chip, f"chip_{alternate.label}")
    assert chip.isChecked()
    assert chip.by_hand
    first = find_map(player.instrument_id).fingerings_for(note.pitch)[0]
    assert child(panel, Chip, f"chip_{first.label}").outlined
    line = child(panel, ByHandLine, "fingering_by_hand")
    assert f"generated {first.label}" in line.text()
    diagram = child(panel, FingeringDiagram, "fingering_diagram")
    pressed = {name for name, value in diagram.values.items() if value > 0.5}
    assert {name for name, value in alternate.controls.items() if value > 0.5} <= pressed
    click(line, "revert")
    assert corrections(planned, player) == ()
    assert line.isHidden()


def test_a_chip_is_pinned_by_keys(panel: InspectorPanel, planned: Session) -> None:
    player = planned.project.players[0]
    note = with_alternates(planned, player)
    select(planned, note)
    label = find_map(player.instrument_id).fingerings_for(note.pitch)[1].label
    QTest.keyClick(child(panel, Chip, f"chip_{label}"), Qt.Key.Key_Space)
    assert corrections(planned, player) == (PinFingering(note.id, label),)


def test_the_embouchure_is_set_and_reset_value_by_value(panel: InspectorPanel, planned: Session) -> None:
    player = planned.project.players[0]
    note = planned.project.part(player).notes[2]
    select(planned, note)
    generated = number(panel, "embouchure_tension").value
    type_into(number(panel, "embouchure_tension"), "0.9")
    type_into(number(panel, "embouchure_air"), "0.1")
    assert corrections(planned, player) == (SetEmbouchure(note.id, tension=0.9, air=0.1),)
    assert number(panel, "embouchure_tension").by_hand
    assert not number(panel, "embouchure_effort").by_hand
    QTest.keyClick(number(panel, "embouchure_tension"), Qt.Key.Key_Backspace)
    assert corrections(planned, player) == (SetEmbouchure(note.id, air=0.1),)
    assert number(panel, "embouchure_tension").value == pytest.approx(generated)
    click(child(panel, ByHandLine, "embouchure_by_hand"), "revert")
    assert corrections(planned, player) == ()


def test_escape_from_a_drag_leaves_no_correction(panel: InspectorPanel, planned: Session) -> None:
    player = planned.project.players[0]
    select(planned, planned.project.part(player).notes[2])
    control, before = number(panel, "embouchure_tension"), planned.project
    generated = control.value
    start = QPoint(20, control.height() // 2)
    QTest.mousePress(control, Qt.MouseButton.LeftButton, pos=start)
    for x in (24, 60, 90):
        QTest.mouseMove(control, QPoint(x, start.y()))
    assert corrections(planned, player) != ()
    QTest.keyClick(control, Qt.Key.Key_Escape)
    QTest.mouseRelease(control, Qt.MouseButton.LeftButton, pos=QPoint(90, start.y()))
    assert planned.project is before
    assert not planned.document.done
    assert control.value == pytest.approx(generated)
    assert not control.by_hand


def test_a_pin_of_a_user_else_is_left_alone(panel: InspectorPanel, planned: Session) -> None:
    player, other = planned.project.players[:2]
    note = with_alternates(planned, player)
    pin = PinFingering(planned.project.part(other).notes[0].id, "13")
    planned.attempt(_name(), lambda project: with_corrections(project, other.id, [pin]))
    select(planned, note)
    label = find_map(player.instrument_id).fingerings_for(note.pitch)[1].label
    click(panel, f"chip_{label}")
    click(child(panel, ByHandLine, "fingering_by_hand"), "revert")
    assert corrections(planned, other) == (pin,)


def test_written_pitch_and_other_octaves_are_read_as_shown(panel: InspectorPanel, planned: Session) -> None:
    note = planned.project.part(planned.project.players[0]).notes[0]
    planned.pitch_display.set(written=True, middle_c_octave=3)
    select(planned, note)
    type_into(number(panel, "note_pitch"), "D4")
    assert note_now(planned, note.id).pitch == 72
    planned.pitch_display.set(names="syllables")
    assert number(panel, "note_pitch").value_text() == "Re4"
    type_into(number(panel, "note_pitch"), "mi♭4")
    assert note_now(planned, note.id).pitch == 73


def test_an_embouchure_that_is_selected_shows_its_note(panel: InspectorPanel, planned: Session) -> None:
    player = planned.project.players[1]
    note = planned.project.part(player).notes[3]
    planned.select(Selection(events=frozenset((EventKey(player.id, f"embouchure:{note.id}"),))))
    type_into(number(panel, "embouchure_effort"), "0.7")
    assert corrections(planned, player) == (SetEmbouchure(note.id, effort=0.7),)


def test_pitches_are_read(planned: Session) -> None:
    display = planned.pitch_display
    assert pitch_from(display, "c4") == 60
    assert pitch_from(display, "B♭3") == 58
    assert pitch_from(display, "bb3") == 58
    assert pitch_from(display, "F#-1") == 6
    assert pitch_from(display, "Ｃ４") == 60
    assert pitch_from(display, "61") == 61
    for text in ("", "X3", "128", "C11", "C", "sol"):
        assert pitch_from(display, text) is None


def test_slide_positions_are_in_order() -> None:
    instrument = find_map("trombone_tenor_F_attachment")
    slots = slide_slots(instrument, instrument.control("slide"))
    assert [slot.name for slot in slots] == ["1", "2", "3", "4", "5", "6", "7"]
    places = [slot.place for slot in slots]
    assert places == sorted(places)
    assert places[0] < 0.02
    assert 0.85 < places[-1] <= 1.0


def _name() -> Message:
    return Message("edit.pin_fingerings", {"count": 1, "of": ""})
