"""The recording panel: device and state, input, recorded player, and start of a take."""

from __future__ import annotations

from typing import Final

from PySide6.QtCore import Qt
from PySide6.QtGui import QFontMetrics, QResizeEvent, QShowEvent
from PySide6.QtWidgets import QProgressBar, QSizePolicy, QToolButton, QWidget

from app.editor.design_tokens import LEAST_TARGET_PX
from app.editor.recording import Connection
from app.editor.session import Session
from app.project.performers import Player
from instrument_maps.library import all_maps
from widgets.common.actions import actions
from widgets.common.combo import Combo, Option
from widgets.common.controls import Retranslated, named
from widgets.common.icons import pixmap
from widgets.common.layouts import STRETCH, in_column, in_form, in_row
from widgets.common.pitch import pitch_text
from widgets.common.plain import Label
from widgets.common.text import sentence

STATES: Final[dict[Connection, str]] = {
    "none": "recording_panel.no_device",
    "waiting": "recording_panel.waiting",
    "open": "recording_panel.connected",
    "lost": "recording_panel.disconnected",
    "refused": "recording_panel.refused",
}
BUTTONS: Final = (("record.toggle", "record.punch"), ("record.arm",), ("record.devices", "record.latency"))
"""Action ids of the buttons in rows."""
COUNT_INS: Final = ("record.count_in_0", "record.count_in_1", "record.count_in_2")
METER_STEPS: Final = 64
SIGN_PX: Final = 14
NOTE_PX: Final = 40


class RecordingPanel(Retranslated, QWidget):
    """All controls for recording a take.

    Parameters
    ----------
    session : Session
        Session whose actions the buttons trigger.
    """

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("recording")
        self._session = session
        self._sign, self._device = Label(), named(Label(), "recording_device")
        self._state = named(Label(), "recording_state")
        self._meter, self._note = named(QProgressBar(), "recording_breath"), named(Label(), "recording_note")
        self._player, self._takes = named(Label(), "recording_player"), named(Label(), "recording_takes")
        self._count_in = named(Combo(), "recording_count_in")
        self._buttons = {id: self._button(id) for row in BUTTONS for id in row}
        self._build()
        self._connect()
        self.retranslate()

    def _button(self, action_id: str) -> QToolButton:
        button = named(QToolButton(), f"recording_{action_id.replace('.', '_')}")
        button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        button.setMinimumHeight(LEAST_TARGET_PX + 2)
        button.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        return button

    def _build(self) -> None:
        self._sign.setFixedWidth(SIGN_PX + 2)
        self._meter.setRange(0, METER_STEPS)
        self._meter.setTextVisible(False)
        self.texted(self._meter, explained="recording_panel.breath_and_note")
        self._note.setMinimumWidth(NOTE_PX)
        for label in (self._device, self._player):
            label.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        form = in_form(
            {
                "recording_panel.breath": in_row((self._meter, 1), self._note, spacing=6),
                "recording_panel.player": in_row((self._player, 1), self._takes, spacing=6),
                "recording_panel.count_in": self._count_in,
            }
        )
        form.setContentsMargins(0, 0, 0, 0)
        rows = [in_row(*((self._buttons[id], 1) for id in row), spacing=4) for row in BUTTONS]
        in_column(
            in_row(self._sign, (self._device, 1), spacing=4),
            self._state,
            form,
            *rows,
            STRETCH,
            of=self,
            margins=(10, 8, 10, 8),
            spacing=6,
        )

    def _connect(self) -> None:
        session, recording = self._session, self._session.recording
        recording.changed.connect(self._show)
        recording.played.connect(self._show_played)
        session.changed.connect(self._show)
        session.players_changed.connect(self._show)
        session.theme_changed.connect(self._show)
        session.pitch_display.changed.connect(self._show_played)
        self._count_in.chosen.connect(lambda id: actions(self._session)[id].trigger())

    # Display

    def _recorded(self) -> Player | None:
        """Return the player to be recorded: the armed one, else the active one."""
        session, armed = self._session, self._session.recording.armed
        return next((player for player in session.project.players if player.id == armed), session.player)

    def _show(self) -> None:
        recording, tokens = self._session.recording, self._session.tokens
        name, colour = {
            "none": ("record", tokens.text_dim),
            "waiting": ("record", tokens.text_dim),
            "open": ("record", tokens.good),
            "lost": ("warning", tokens.warning),
            "refused": ("error", tokens.error),
        }[recording.connection]
        self._sign.setPixmap(pixmap(name, SIGN_PX, colour, self.devicePixelRatioF()))
        self._show_names()
        text = self.tr(STATES[recording.connection])
        if recording.connection == "open" and recording.latency_s:
            text = self.tr("recording_panel.connected_late").format(latency=1000 * recording.latency_s)
        self._state.setText(text)
        self._state.setVisible(recording.connection != "none")
        reason = recording.refusal
        self._state.setToolTip("" if reason is None else sentence(reason, self._session))
        self._state.setStyleSheet(f"color: {colour if recording.connection != 'open' else tokens.text_dim};")
        self._takes.setStyleSheet(f"color: {tokens.text_dim};")
        player = self._recorded()
        recorded = self._session.project.takes.get(player.id) if player is not None else None
        count = len(recorded.takes) if recorded is not None else 0
        self._takes.setText(self.tr("recording_panel.takes").format(count=count))
        chosen = f"record.count_in_{recording.count_in_bars}"
        self._count_in.show_option(chosen if chosen in COUNT_INS else None)
        self._show_played()

    def _show_names(self) -> None:
        """Show the names of device and player, shortened to the available space."""
        recording, player = self._session.recording, self._recorded()
        device = recording.port or self.tr(STATES["none"])
        who = self.tr("recording_panel.no_player") if player is None else player.name
        if player is not None and recording.armed == player.id:
            who = self.tr("recording_panel.player_armed").format(name=who)
        for label, text in ((self._device, device), (self._player, who)):
            room = QFontMetrics(label.font()).elidedText(text, Qt.TextElideMode.ElideRight, max(label.width(), 40))
            label.setText(room)
            label.setToolTip(text)

    def _show_played(self) -> None:
        recording, player = self._session.recording, self._recorded()
        self._meter.setValue(round(METER_STEPS * recording.breath))
        instrument = all_maps().get(player.instrument_id) if player is not None else None
        written = instrument.transposition_semitones if instrument is not None else 0
        pitch = recording.pitch
        self._note.setText("" if pitch is None else pitch_text(self._session.pitch_display, pitch, written))

    # Texts

    def retranslate(self) -> None:
        table = actions(self._session)
        for id, button in self._buttons.items():
            if id in table:
                button.setDefaultAction(table[id])
        self._count_in.set_options([Option(id, table[id].iconText()) for id in COUNT_INS if id in table])
        self._show()

    # Qt overrides

    def showEvent(self, event: QShowEvent) -> None:
        # Actions may be registered after the panel is created.
        self.retranslate()
        super().showEvent(event)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._show_names()
