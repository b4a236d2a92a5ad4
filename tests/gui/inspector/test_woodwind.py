"""A woodwind's note in the inspector: its chart with names of keys, alternates as charts, and texts for both."""

from __future__ import annotations

from dataclasses import replace

import msgspec
import pytest
from PySide6.QtCore import QEvent
from PySide6.QtGui import QHelpEvent
from PySide6.QtWidgets import QApplication, QToolTip

from app.editor.selection import Selection
from app.editor.session import Session
from app.errors import Message
from app.plan.by_hand.corrections import PinFingering
from app.score.model import Note
from instrument_maps.key_chart import key_chart
from instrument_maps.load import bundled_maps
from tests.gui.inspector.hands import child, click, show_tab
from tests.gui.japanese import speaking
from widgets.common.fingering_chip import FingeringChip
from widgets.common.fingering_diagram import FingeringDiagram
from widgets.inspector.by_hand import ByHandLine
from widgets.inspector.panel import InspectorPanel
from widgets.inspector.rows import LineList

SAXOPHONE = bundled_maps()["sax_alto_Eb"]
B_FLAT = 61
"""Written B flat 4, with four fingerings."""
SIDE, BIS = "1L 2L sbb", "1L bbb"


@pytest.fixture
def note(planned: Session) -> Note:
    """Select the only note of the first player, a saxophone's written B flat."""
    project = planned.project
    player = project.players[0]
    part = project.part(player)
    first = msgspec.structs.replace(part.notes[0], pitch=B_FLAT)
    own = msgspec.structs.replace(part, notes=(first,))
    parts = tuple(own if one is part else one for one in project.score.parts)
    players = (msgspec.structs.replace(player, instrument_id="sax_alto_Eb"), *project.players[1:])
    score = msgspec.structs.replace(project.score, parts=parts)
    planned.document.apply(Message("edit.rename"), replace(project, score=score, players=players))
    planned.select(Selection(notes=frozenset({first.id})))
    return first


def tip_at(diagram: FingeringDiagram, name: str) -> str:
    place = next(key for key in key_chart(SAXOPHONE).keys if key.control.name == name)
    at = diagram.chart_place.box(place).center().toPoint()
    QApplication.sendEvent(diagram, QHelpEvent(QEvent.Type.ToolTip, at, diagram.mapToGlobal(at)))
    return QToolTip.text()


def test_the_keys_of_a_chart_have_names_in_both_languages(panel: InspectorPanel, note: Note) -> None:
    diagram = child(panel, FingeringDiagram, "fingering_diagram")
    assert diagram.names == ["L1·2", "side B♭ key"]
    assert diagram.accessibleDescription() == "L1·2, side B♭ key"
    # A click has no effect here, so the tool tip names the place where it has one.
    only_shown = "Display only: click another fingering below to choose it"
    assert tip_at(diagram, "key_octave") == f"octave key\nL thumb\n{only_shown}"
    with speaking():
        assert diagram.names == ["左1·2", "サイド B♭ キー"]
        assert tip_at(diagram, "key_octave").startswith("オクターブキー\n")


def test_the_whole_chart_and_its_names_have_room(panel: InspectorPanel, note: Note) -> None:
    diagram = child(panel, FingeringDiagram, "fingering_diagram")
    boxes = [diagram.chart_place.box(key) for key in key_chart(SAXOPHONE).keys]
    assert all(diagram.rect().contains(box.toAlignedRect()) for box in boxes)
    assert diagram.width() - max(box.right() for box in boxes) > 120.0


def test_alternates_are_charts_and_what_is_pinned_is_said_in_words(
    panel: InspectorPanel, planned: Session, note: Note
) -> None:
    offered = SAXOPHONE.fingerings_for(B_FLAT)
    chips = {one.label: child(panel, FingeringChip, f"chip_{one.label}") for one in offered}
    assert len(chips) >= 3
    assert chips[SIDE].isChecked()
    assert chips[BIS].toolTip().startswith("L1 + bis key\n")
    assert len({chip.grab().toImage().cacheKey() for chip in chips.values()}) == len(chips)
    click(panel, f"chip_{BIS}")
    player = planned.project.players[0]
    assert planned.project.corrections[player.id] == (PinFingering(note.id, BIS),)
    line = child(panel, ByHandLine, "fingering_by_hand")
    assert "generated L1·2 + side B♭ key" in line.text()
    assert "L1 + bis key" in line.text()
    show_tab(panel, 1)
    rows = child(panel, LineList, "correction_list").lines.lines
    assert [row.title for row in rows] == ["Fingering L1 + bis key"]
    assert "side B♭ key" in rows[0].detail
    assert not any(sign in f"{rows[0].title} {rows[0].detail}" for sign in ("sbb", "bbb"))
    with speaking():
        rows = child(panel, LineList, "correction_list").lines.lines
        assert [row.title for row in rows] == ["運指 左1 + ビスキー"]
        assert child(panel, FingeringChip, f"chip_{BIS}").toolTip().startswith("左1 + ビスキー")
