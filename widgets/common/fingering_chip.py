"""A fingering as a chip: keys and holes as a small chart, valves and slide positions as labels."""

from __future__ import annotations

from PySide6.QtCore import QRectF, QSizeF, Qt
from PySide6.QtGui import QColor, QPainter
from PySide6.QtWidgets import QWidget

from app.editor.session import Session
from instrument_maps.fingering_label import says_words
from instrument_maps.fingering_words import fingering_words
from instrument_maps.key_chart import key_chart
from instrument_maps.model import Fingering, InstrumentMap
from widgets.common.chip import Chip
from widgets.common.fingering_picture import ChartColours, ChartPlace, chart_sides, draw_chart
from widgets.common.fingering_tags import words_of_tags
from widgets.common.instrument_name import language

HOLE_PX = 10.0
SQUEEZE = 0.6


class FingeringChip(Chip):
    """A chip that chooses a fingering. For screen readers its text describes the fingering in words.

    Parameters
    ----------
    note : str
        Text next to the fingering: deviation in cents, tags.
    """

    def __init__(
        self,
        session: Session,
        instrument: InstrumentMap,
        fingering: Fingering,
        note: str,
        parent: QWidget | None = None,
    ) -> None:
        words = fingering_words(instrument, fingering.label, language())
        super().__init__(session, words, note, parent)
        self.setObjectName(f"chip_{fingering.label}")
        self._chart = key_chart(instrument) if says_words(instrument.controls) else None
        self._fingering, self._values = fingering, fingering.controls

    def tip(self, generated: bool) -> str:
        """Return a description of the fingering: rank, tags, tuning, and whether the generator chose it."""
        one = self._fingering
        lines = [] if self._chart is None else [self.text()]
        lines.append(
            self.tr("note_section.first_choice")
            if one.rank == 1
            else self.tr("note_section.choice_no").format(rank=one.rank)
        )
        lines += words_of_tags(one.tags)
        if round(one.cents):
            lines.append(self.tr("note_section.uncorrected_cents").format(cents=f"{one.cents:+.0f}"))
        if generated:
            lines.append(self.tr("note_section.generated_choice"))
        return "\n".join(lines)

    def face_px(self) -> QSizeF:
        if self._chart is None:
            return super().face_px()
        left, right = chart_sides(self._chart, ChartPlace(0.0, 0.0, HOLE_PX, SQUEEZE), self._values)
        return QSizeF(left + right, (self._chart.bottom - self._chart.top) * HOLE_PX)

    def draw_face(self, painter: QPainter, box: QRectF, colour: QColor) -> None:
        if self._chart is None:
            super().draw_face(painter, box, colour)
            return
        left, _ = chart_sides(self._chart, ChartPlace(0.0, 0.0, HOLE_PX, SQUEEZE), self._values)
        place = ChartPlace(box.left() + left, box.top() - self._chart.top * HOLE_PX, HOLE_PX, SQUEEZE)
        line, nothing = QColor(colour), QColor(Qt.GlobalColor.transparent)
        line.setAlpha(150)
        draw_chart(
            painter,
            self._chart,
            self._values,
            place,
            ChartColours(colour, line, nothing, nothing, nothing),
            whole=False,
        )
