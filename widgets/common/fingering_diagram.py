"""Drawing of a fingering from the controls of an instrument map."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from PySide6.QtCore import QEvent, QMarginsF, QPointF, QRectF, QSize, QSizeF, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QFont,
    QFontMetricsF,
    QHelpEvent,
    QMouseEvent,
    QMoveEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QResizeEvent,
)
from PySide6.QtWidgets import QSizePolicy, QToolTip, QWidget

from app.editor.design_tokens import Tokens
from app.editor.session import Session
from app.editor.translated import tr
from instrument_maps.fingering_label import says_words
from instrument_maps.fingering_words import key_name, pressed_names
from instrument_maps.key_chart import key_chart
from instrument_maps.model import Control, InstrumentMap
from widgets.common.fingering_picture import ChartColours, ChartPlace, chart_sides, chart_size, draw_chart
from widgets.common.instrument_name import language

DOWN = 0.5
"""Value of a key's control above which it is drawn as pressed."""
TOP_PX = 30.0
COLUMN_PX = 50.0
HOLE_PX = 18.0
"""Distance of the holes in a chart in pixels."""
MARGIN_PX = 8.0
NAMES_GAP_PX = 8.0
"""Distance between a chart and the names beside it in pixels."""


@dataclass(frozen=True)
class Slot:
    """A named position of a slide, with its place 0..1."""

    name: str
    place: float


def hand_text(hand: str) -> str:
    """Return the translated abbreviation of a hand, ``"left"`` or ``"right"``."""
    hands = {"left": tr("fingering_name.l"), "right": tr("fingering_name.r")}
    return hands.get(hand, hand)


def part_text(part: str) -> str:
    """Return the translated name of a finger, or of the hand as a whole."""
    parts = {
        "thumb": tr("fingering_name.thumb"),
        "index": tr("fingering_name.index"),
        "middle": tr("fingering_name.middle"),
        "ring": tr("fingering_name.ring"),
        "little": tr("fingering_name.little"),
        "hand": tr("fingering_name.hand"),
    }
    return parts.get(part, part)


def finger_text(mover: str) -> str:
    """Return the name of the finger and hand for a mover such as ``"right.index"`` in the editor's language."""
    hand, _, part = mover.partition(".")
    return tr("fingering_name.text").format(hand=hand_text(hand), part=part_text(part))


def slide_slots(instrument: InstrumentMap, control: Control) -> tuple[Slot, ...]:
    """Return the named positions of a slide: the mean place of each fingering label that moves only this control.

    A mean is used because a position is slightly shorter or longer for some notes.
    """
    places: dict[str, list[float]] = {}
    for fingering in instrument.fingerings:
        others = [name for name in fingering.controls if name != control.name]
        if not others:
            places.setdefault(fingering.label, []).append(fingering.controls.get(control.name, control.rest_value))
    middles = {label: sorted(values)[len(values) // 2] for label, values in places.items()}
    return tuple(Slot(label, place) for label, place in sorted(middles.items(), key=lambda item: item[1]))


class FingeringDiagram(QWidget):
    """Diagram of a fingering: valves filled when down, levers beside them, a slide as a rail with positions, each with
    its finger; keys and holes of a woodwind as a chart with the names of pressed keys.

    Signals
    -------
    pressed(str)
        A key, valve or hole of this name was clicked; emitted only if the diagram is editable (`set_editable`).
    placed()
        Position or size of the diagram has changed.
    """

    pressed = Signal(str)
    placed = Signal()

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._instrument: InstrumentMap | None = None
        self._values: dict[str, float] = {}
        self._slots: dict[str, tuple[Slot, ...]] = {}
        self._editable = False
        self.setMouseTracking(True)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        session.theme_changed.connect(self.update)

    def set_editable(self, editable: bool) -> None:
        """Set whether a click on a key in the diagram changes the fingering."""
        self._editable = editable

    @property
    def values(self) -> Mapping[str, float]:
        """Value of every displayed control (key, valve, slide) by name."""
        return self._values

    def show_fingering(self, instrument: InstrumentMap, controls: Mapping[str, float]) -> None:
        """Draw a fingering; missing controls are at rest."""
        if instrument is not self._instrument:
            self._instrument = instrument
            self._slots = {
                control.name: slide_slots(instrument, control)
                for control in instrument.controls
                if control.kind == "slide" and control.role == "pitch"
            }
            self.updateGeometry()
        self._values = {control.name: controls.get(control.name, control.rest_value) for control in instrument.controls}
        self.setAccessibleDescription(self.spoken())
        self.update()

    def spoken(self) -> str:
        """Return the displayed fingering in words, for screen readers."""
        if self._instrument is None:
            return ""
        if self._is_chart:
            return ", ".join(self.names)
        return ", ".join(
            f"{control.label or control.name} {finger_text(control.finger)}"
            for control in self._keys()
            if self._values[control.name] >= DOWN
        )

    def _keys(self) -> list[Control]:
        assert self._instrument is not None
        return [control for control in self._instrument.controls if control.kind != "slide" and control.role == "pitch"]

    def _slides(self) -> list[Control]:
        """Return the slides that change the pitch."""
        assert self._instrument is not None
        return [control for control in self._instrument.controls if control.kind == "slide" and control.role == "pitch"]

    def _correcting(self) -> list[Control]:
        """Return the controls for intonation only."""
        assert self._instrument is not None
        return [control for control in self._instrument.controls if control.role == "intonation"]

    # Drawing

    def _tip(self, control: Control) -> str:
        assert self._instrument is not None
        lines = [key_name(self._instrument, control.name, language()), finger_text(control.finger)]
        return "\n".join(lines if self._editable else [*lines, tr("fingering_name.only_shown")])

    def _line_px(self) -> float:
        return QFontMetricsF(self._small()).height()

    def _small(self) -> QFont:
        font = QFont(self.font())
        font.setPointSizeF(9.0)
        return font

    @property
    def _is_chart(self) -> bool:
        """Return whether the diagram is a chart of keys and holes."""
        return self._instrument is not None and says_words(self._instrument.controls)

    @property
    def names(self) -> list[str]:
        """Return the names of the pressed keys beside a chart."""
        assert self._instrument is not None
        return pressed_names(self._instrument, self._values, language())

    @property
    def chart_place(self) -> ChartPlace:
        """Place and size of the key chart in the diagram's pixels."""
        assert self._instrument is not None
        chart = key_chart(self._instrument)
        hole_px = HOLE_PX * min((self.width() - 2 * MARGIN_PX) / self._chart_px().width(), 1.0)
        left, _ = chart_sides(chart, ChartPlace(0.0, 0.0, hole_px))
        return ChartPlace(MARGIN_PX + left, MARGIN_PX - chart.top * hole_px, hole_px)

    def _chart_px(self) -> QSizeF:
        """Return the preferred size of the chart in pixels."""
        assert self._instrument is not None
        return chart_size(key_chart(self._instrument), HOLE_PX)

    def _key_row_px(self) -> float:
        return TOP_PX + self._line_px() + 8.0

    def _rail_px(self, control: Control) -> float:
        return 34.0 + self._line_px()

    def _paint_key(
        self, painter: QPainter, tokens: Tokens, control: Control, centre: QPointF, column_px: float
    ) -> None:
        down = self._values[control.name] >= DOWN
        radius = TOP_PX / 2.0 - 2.0
        painter.setPen(QPen(QColor(tokens.accent if down else tokens.line_strong), 1.6))
        painter.setBrush(QColor(tokens.accent) if down else QColor(tokens.surface))
        if control.kind == "lever":
            painter.drawRoundedRect(QRectF(centre.x() - radius * 1.3, centre.y() - 8.0, radius * 2.6, 16.0), 8, 8)
        else:
            painter.drawEllipse(centre, radius, radius)
        painter.setPen(QColor(tokens.accent_text if down else tokens.text))
        painter.setFont(self.font())
        label = QRectF(centre.x() - column_px / 2, centre.y() - radius, column_px, 2 * radius)
        painter.drawText(label, Qt.AlignmentFlag.AlignCenter, control.label)
        painter.setFont(self._small())
        painter.setPen(QColor(tokens.text if down else tokens.text_dim))
        under = QRectF(centre.x() - column_px / 2, centre.y() + radius + 3.0, column_px, self._line_px())
        metrics, text = QFontMetricsF(self._small()), finger_text(control.finger)
        if metrics.horizontalAdvance(text) > column_px - 2:
            text = part_text(control.finger.partition(".")[2])
        painter.drawText(
            under, Qt.AlignmentFlag.AlignCenter, metrics.elidedText(text, Qt.TextElideMode.ElideRight, column_px - 1)
        )

    def _paint_chart(self, painter: QPainter, tokens: Tokens) -> None:
        assert self._instrument is not None
        painter.setFont(self._small())
        colours = ChartColours(
            *map(QColor, (tokens.accent, tokens.line_strong, tokens.surface, tokens.accent_text, tokens.text_dim))
        )
        draw_chart(painter, key_chart(self._instrument), self._values, self.chart_place, colours)
        left = round(self._chart_px().width() + 2 * MARGIN_PX + NAMES_GAP_PX)
        box = QRectF(left, MARGIN_PX, self.width() - left - MARGIN_PX, self.height() - 2 * MARGIN_PX)
        painter.setPen(QColor(tokens.text))
        flags = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter | Qt.TextFlag.TextWordWrap
        painter.drawText(box, flags, "\n".join(self.names))

    def _keys_px(self) -> float:
        if self._is_chart:
            return self._chart_px().height() + 2 * MARGIN_PX - 6.0
        return self._key_row_px() if self._keys() else 0.0

    def _control_at(self, x: float, y: float) -> Control | None:
        if self._instrument is None:
            return None
        if self._is_chart:
            drawn, grown = self.chart_place, QMarginsF(2.0, 2.0, 2.0, 2.0)
            charted = key_chart(self._instrument).keys
            return next((key.control for key in charted if drawn.box(key).marginsAdded(grown).contains(x, y)), None)
        keys = self._keys()
        column_px = min(COLUMN_PX * 1.3, (self.width() - 12.0) / max(len(keys), 1))
        place = int((x - (self.width() - column_px * len(keys)) / 2.0) // column_px)
        return keys[place] if 0 <= place < len(keys) and 6.0 <= y <= 6.0 + self._key_row_px() else None

    def _paint_rail(self, painter: QPainter, tokens: Tokens, control: Control, top: float) -> None:
        left, right, value = 18.0, self.width() - 18.0, self._values[control.name]
        line_px = self._line_px()
        painter.setFont(self._small())
        middle = top + line_px + 10.0
        at = left + value * (right - left)
        painter.setPen(QPen(QColor(tokens.line_strong), 4.0, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
        painter.drawLine(QPointF(left, middle), QPointF(right, middle))
        painter.setPen(QPen(QColor(tokens.accent), 4.0, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
        painter.drawLine(QPointF(left, middle), QPointF(at, middle))
        slots = self._slots.get(control.name, ())
        nearest = min(slots, key=lambda slot: abs(slot.place - value), default=None)
        for slot in slots:
            x = left + slot.place * (right - left)
            is_here = slot is nearest
            painter.setPen(QPen(QColor(tokens.text if is_here else tokens.text_dim), 1.4))
            painter.drawLine(QPointF(x, middle - 8.0), QPointF(x, middle - 3.0))
            box = QRectF(x - 14.0, top, 28.0, line_px)
            painter.drawText(box, Qt.AlignmentFlag.AlignCenter, slot.name)
        painter.setPen(QPen(QColor(tokens.sunken), 2.0))
        painter.setBrush(QColor(tokens.accent))
        painter.drawEllipse(QPointF(at, middle), 7.0, 7.0)
        painter.setPen(QColor(tokens.text_dim))
        below = QRectF(8.0, middle + 8.0, self.width() - 16.0, line_px)
        painter.drawText(below, Qt.AlignmentFlag.AlignLeft, finger_text(control.finger))
        travel_m = control.travel_m
        if travel_m:
            length = tr("fingering_name.cm").format(cm=f"{value * travel_m * 100.0:.1f}")
            painter.setPen(QColor(tokens.text))
            painter.drawText(below, Qt.AlignmentFlag.AlignRight, length)

    def _paint_corrections(self, painter: QPainter, tokens: Tokens, top: float) -> None:
        """Draw the controls for intonation below the diagram, two per line, from the height ``top``."""
        painter.setFont(self._small())
        wide = (self.width() - 24.0) / 2.0
        for number, control in enumerate(self._correcting()):
            left = 8.0 + (number % 2) * (wide + 8.0)
            height = self._line_px() + 6.0
            box = QRectF(left, top + (number // 2) * (height + 2.0), wide, height)
            self._paint_correction(painter, tokens, control, box)

    def _paint_correction(self, painter: QPainter, tokens: Tokens, control: Control, box: QRectF) -> None:
        """Draw a slide for intonation as a thin bar."""
        value = self._values[control.name]
        name_px = box.width() * 0.5
        painter.setPen(QColor(tokens.text if value > 0.01 else tokens.text_dim))
        name = QFontMetricsF(self._small()).elidedText(
            finger_text(control.finger), Qt.TextElideMode.ElideRight, name_px - 4
        )
        painter.drawText(
            QRectF(box.left(), box.top(), name_px, box.height()),
            Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft,
            name,
        )
        bar = QRectF(box.left() + name_px, box.center().y() - 3.0, box.width() - name_px, 6.0)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(tokens.line))
        painter.drawRoundedRect(bar, 3, 3)
        if value > 0.005:
            painter.setBrush(QColor(tokens.accent))
            painter.drawRoundedRect(QRectF(bar.left(), bar.top(), max(bar.width() * value, 6.0), bar.height()), 3, 3)

    # Qt overrides

    def moveEvent(self, event: QMoveEvent) -> None:
        super().moveEvent(event)
        self.placed.emit()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self.placed.emit()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        at = event.position()
        control = self._control_at(at.x(), at.y())
        if self._editable and control is not None and event.button() == Qt.MouseButton.LeftButton:
            self.pressed.emit(control.name)
            return
        super().mousePressEvent(event)

    def event(self, event: QEvent) -> bool:
        if isinstance(event, QHelpEvent) and event.type() == QEvent.Type.ToolTip:
            control = self._control_at(event.pos().x(), event.pos().y())
            text = "" if control is None else self._tip(control)
            QToolTip.showText(event.globalPos(), text, self)
            return True
        return super().event(event)

    def sizeHint(self) -> QSize:
        if self._instrument is None:
            return QSize(200, 40)
        height = 8.0 + self._keys_px() + sum(self._rail_px(slide) for slide in self._slides())
        height += -(-len(self._correcting()) // 2) * (self._line_px() + 8.0)
        return QSize(200, round(height) + 4)

    def minimumSizeHint(self) -> QSize:
        return QSize(120, self.sizeHint().height())

    def paintEvent(self, event: QPaintEvent) -> None:
        if self._instrument is None:
            return
        tokens, painter = self._session.tokens, QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(tokens.line), 1.0))
        painter.setBrush(QColor(tokens.sunken))
        painter.drawRoundedRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5), 5, 5)
        if self._is_chart:
            self._paint_chart(painter, tokens)
        else:
            keys = self._keys()
            column_px = min(COLUMN_PX * 1.3, (self.width() - 12.0) / max(len(keys), 1))
            left = (self.width() - column_px * len(keys)) / 2.0
            for number, control in enumerate(keys):
                centre = QPointF(left + (number + 0.5) * column_px, 6.0 + TOP_PX / 2.0)
                self._paint_key(painter, tokens, control, centre, column_px)
        top = 6.0 + self._keys_px()
        for slide in self._slides():
            self._paint_rail(painter, tokens, slide, top)
            top += self._rail_px(slide)
        self._paint_corrections(painter, tokens, top)
