"""Dialog of the live stream: computer, port, players, names of face shapes, and state.

Choices apply immediately to `session.streaming`.
"""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QDialog, QLineEdit, QPushButton, QSpinBox, QTreeWidget, QTreeWidgetItem, QWidget

from app.editor.session import Session
from app.editor.streaming import RATES_HZ
from app.stream.sender import LEAST_PORT, LOOPBACK, MOST_PORT, TO_MANY, is_loopback
from widgets.common.clicks import on_click
from widgets.common.combo import Combo, Option
from widgets.common.controls import Button, Caption, ColumnList, Retranslated, named, wrapped
from widgets.common.help import HelpButton
from widgets.common.layouts import STRETCH, in_column, in_form, in_row
from widgets.common.plain import Label
from widgets.common.text import sentence

_LIST_PX = 130
"""Height in pixels of the list: four players."""


class StreamDialog(Retranslated, QDialog):
    """Dialog of the live stream; not modal, so that the user can play and watch the other program."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("stream")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._session, self._state = session, session.streaming
        self._explained = wrapped(Caption("stream_dialog.sends_performers_poses_faces_and"))
        self._warning = named(wrapped(Caption("stream_dialog.network_warning")), "stream_warning")
        self._reported = named(wrapped(Label()), "stream_status")
        self._host, self._port = named(QLineEdit(), "stream_host"), named(QSpinBox(), "stream_port")
        self._who, self._faces = named(Combo(), "stream_who"), named(Combo(), "stream_faces")
        self._rate = named(Combo(), "stream_rate")
        self._list = ColumnList("stream_list", "stream_dialog.performer", "stream_dialog.port")
        self._toggle = named(QPushButton(), "stream_toggle")
        self._anyway = Button(
            "stream_dialog.send_anyway", lambda: self._state.set(broadcast=self._state.host), "stream_anyway"
        )
        self._close = Button("stream_dialog.close", self.close, "stream_close")
        self._here = Button("stream_dialog.this_computer", lambda: self._state.set(host=LOOPBACK), "stream_here")
        self._listed: tuple[object, ...] = ()
        self._build()
        self._host.editingFinished.connect(lambda: self._state.set(host=self._host.text().strip() or LOOPBACK))
        self._port.valueChanged.connect(lambda port: self._state.set(port=port))
        self._who.chosen.connect(lambda who: self._state.set(everyone=who == "everyone"))
        self._faces.chosen.connect(lambda faces: self._state.set(faces=faces))
        self._rate.chosen.connect(lambda rate: self._state.set(rate_hz=int(rate)))
        on_click(self._toggle, lambda: self._state.set(on=not self._state.on))
        self._state.changed.connect(self._show)
        session.changed.connect(self._show)
        session.players_changed.connect(self._show)
        session.dancer_changed.connect(self._show)
        session.performance_changed.connect(self._show)
        session.theme_changed.connect(self._show)
        self.texted(
            self._who,
            options={
                "front": "stream_dialog.selected_player_centred",
                "everyone": "stream_dialog.everyone_on_stage_each_on",
            },
        )
        self.texted(
            self._faces,
            options={
                "arkit": "stream_dialog.arkit_jawopen",
                "arkit_capital": "stream_dialog.arkit_with_capitals_jawopen_perfect",
                "vrm": "stream_dialog.vrm_presets_blink_l_joy",
            },
        )
        self._rate.set_options([Option(str(rate), str(rate)) for rate in RATES_HZ])
        self.texted(self, title="stream_dialog.live_stream")
        self.retranslate()
        self.resize(620, 560)

    def _build(self) -> None:
        self._port.setRange(LEAST_PORT, MOST_PORT)
        self._port.setKeyboardTracking(False)
        self._list.setSelectionMode(QTreeWidget.SelectionMode.NoSelection)
        self._list.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._list.setMinimumHeight(_LIST_PX)
        host = in_row((self._host, 1), self._here)
        form = in_form(
            {
                "stream_dialog.computer": host,
                "stream_dialog.port": self._port,
                "stream_dialog.performers": self._who,
                "stream_dialog.blendshape_naming": self._faces,
                "stream_dialog.frames_per_second": self._rate,
            }
        )
        bottom = in_row(HelpButton(), self._toggle, STRETCH, self._close)
        reported = in_row((self._reported, 1), self._anyway)
        in_column(
            self._explained, form, self._warning, (self._list, 1), reported, bottom, of=self, margins=14, spacing=10
        )

    # Display

    def _show(self) -> None:
        state, tokens = self._state, self._session.tokens
        if not self._host.isModified() or not self._host.hasFocus():
            self._host.setText(state.host)
        self._port.blockSignals(True)
        self._port.setValue(state.port)
        self._port.blockSignals(False)
        self._who.show_option("everyone" if state.everyone else "front")
        self._faces.show_option(state.faces)
        self._rate.show_option(str(state.rate_hz))
        here = is_loopback(state.host)
        self._here.setEnabled(not here)
        self._warning.setVisible(not here)
        self._warning.setStyleSheet(f"color: {tokens.warning};")
        self._toggle.setText(
            self.tr("stream_dialog.stop_streaming") if state.on else self.tr("stream_dialog.start_streaming")
        )
        self._show_lines()
        self._anyway.setVisible(state.trouble is not None and state.trouble.id == TO_MANY)
        text, colour = self._state_text()
        self._reported.setText(text)
        self._reported.setStyleSheet(f"color: {colour};")

    def _show_lines(self) -> None:
        """List the players with the ports to which they are sent."""
        state, project = self._state, self._session.project
        lines = state.lines or state.planned(project, self._session.in_front)
        names, unseen = {one.id: one.name for one in project.performers}, self._session.performance.unseen
        shown = (lines, tuple(names.items()), bool(state.lines), self._session.tokens.name, dict(unseen))
        if shown == self._listed:
            return
        self._listed = shown
        self._list.clear()
        for line in lines:
            if line.player_id in names:
                item = QTreeWidgetItem([names[line.player_id], str(line.port)])
                item.setTextAlignment(1, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
                reason = unseen.get(line.player_id)
                if reason is not None:
                    text = sentence(reason, self._session, line.player_id)
                    item.setText(0, self.tr("stream_dialog.not_sent").format(name=item.text(0), reason=text))
                    for column in (0, 1):
                        item.setToolTip(column, item.text(0))
                        item.setForeground(column, QColor(self._session.tokens.warning))
                elif not state.lines:
                    for column in (0, 1):
                        item.setForeground(column, QColor(self._session.tokens.text_dim))
                self._list.addTopLevelItem(item)

    def retranslate(self) -> None:
        self._listed = ()
        self._show()

    def _state_text(self) -> tuple[str, str]:
        """Return a text about the state of the stream, and its colour."""
        state, tokens = self._state, self._session.tokens
        if state.trouble is not None:
            return sentence(state.trouble, self._session), tokens.error
        if state.state == "looking":
            return self.tr("stream_dialog.looking_for").format(host=state.host), tokens.text_dim
        if state.state == "no_receiver":
            return (self.tr("stream_dialog.no_receiver_there_yet_start"), tokens.warning)
        if state.state == "sending":
            return self.tr("stream_dialog.sending_rate").format(count=state.sent_hz), tokens.good
        return self.tr("stream_dialog.not_streaming"), tokens.text_dim
