"""Streaming to other programs: to which computer and port, who, how the face is named, and how it goes.

What is chosen holds at once, in `session.streaming`.
"""

from __future__ import annotations

from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import (
    QDialog,
    QFormLayout,
    QHBoxLayout,
    QHeaderView,
    QLineEdit,
    QPushButton,
    QSpinBox,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.editor.session import Session
from app.editor.streaming import RATES_HZ
from app.stream.sender import LEAST_PORT, LOOPBACK, MOST_PORT, TO_MANY, is_loopback
from widgets.common.combo import Combo, Option
from widgets.common.plain import Label
from widgets.common.text import sentence

_LIST_PX = 130
"""Four players are seen."""


class StreamDialog(QDialog):
    """The live stream. Not modal: one plays, and looks at the other program.

    Parameters
    ----------
    session : Session
    parent : QWidget, optional
    """

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("stream")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._session, self._state = session, session.streaming
        self._explained, self._warning, self._reported = Label(), Label(), Label()
        self._host, self._port = QLineEdit(), QSpinBox()
        self._who, self._faces, self._rate = Combo(), Combo(), Combo()
        self._list = QTreeWidget()
        self._toggle, self._here, self._close, self._anyway = (QPushButton() for _ in range(4))
        self._names = {field: Label() for field in (self._host, self._port, self._who, self._faces, self._rate)}
        self._listed: tuple[object, ...] = ()
        self._build()
        self._host.editingFinished.connect(self._choose_host)
        self._port.valueChanged.connect(lambda port: self._state.set(port=port))
        self._here.clicked.connect(lambda: self._state.set(host=LOOPBACK))
        self._who.chosen.connect(lambda who: self._state.set(everyone=who == "everyone"))
        self._faces.chosen.connect(lambda faces: self._state.set(faces=faces))
        self._rate.chosen.connect(lambda rate: self._state.set(rate_hz=int(rate)))
        self._toggle.clicked.connect(lambda: self._state.set(on=not self._state.on))
        self._close.clicked.connect(self.close)
        self._anyway.clicked.connect(lambda: self._state.set(broadcast=self._state.host))
        self._state.changed.connect(self._show)
        session.changed.connect(self._show)
        session.players_changed.connect(self._show)
        session.dancer_changed.connect(self._show)
        session.performance_changed.connect(self._show)
        session.theme_changed.connect(self._show)
        self.retranslate()
        self.resize(620, 560)

    def _build(self) -> None:
        named: dict[QWidget, str] = {self._host: "stream_host", self._port: "stream_port", self._who: "stream_who"}
        named |= {self._faces: "stream_faces", self._rate: "stream_rate", self._list: "stream_list"}
        named |= {self._toggle: "stream_toggle", self._here: "stream_here", self._close: "stream_close"}
        named |= {self._anyway: "stream_anyway"}
        named |= {self._warning: "stream_warning", self._reported: "stream_status"}
        for widget, name in named.items():
            widget.setObjectName(name)
        for label in (self._explained, self._warning, self._reported):
            label.setWordWrap(True)
        self._port.setRange(LEAST_PORT, MOST_PORT)
        self._port.setKeyboardTracking(False)
        for button in (self._here, self._close, self._anyway):
            button.setAutoDefault(False)
        self._list.setColumnCount(2)
        self._list.setRootIsDecorated(False)
        self._list.setUniformRowHeights(True)
        self._list.setSelectionMode(QTreeWidget.SelectionMode.NoSelection)
        self._list.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._list.setMinimumHeight(_LIST_PX)
        header = self._list.header()
        header.setStretchLastSection(False)
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        header.setSectionResizeMode(1, QHeaderView.ResizeMode.ResizeToContents)
        host = QHBoxLayout()
        host.addWidget(self._host, 1)
        host.addWidget(self._here)
        form = QFormLayout()
        form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        for field, label in self._names.items():
            label.setBuddy(field)
            if field is self._host:
                form.addRow(label, host)
            else:
                form.addRow(label, field)
        bottom = QHBoxLayout()
        bottom.addWidget(self._toggle)
        bottom.addStretch(1)
        bottom.addWidget(self._close)
        page = QVBoxLayout(self)
        page.setContentsMargins(14, 14, 14, 14)
        page.setSpacing(10)
        page.addWidget(self._explained)
        page.addLayout(form)
        page.addWidget(self._warning)
        page.addWidget(self._list, 1)
        reported = QHBoxLayout()
        reported.addWidget(self._reported, 1)
        reported.addWidget(self._anyway)
        page.addLayout(reported)
        page.addLayout(bottom)

    def _choose_host(self) -> None:
        self._state.set(host=self._host.text().strip() or LOOPBACK)

    # What is shown

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
        """Who is sent where, or would be."""
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
        """Set all texts."""
        self.setWindowTitle(self.tr("stream_dialog.live_stream"))
        self._explained.setText(self.tr("stream_dialog.sends_performers_poses_faces_and"))
        for field, text in (
            (self._host, self.tr("stream_dialog.computer")),
            (self._port, self.tr("stream_dialog.port")),
            (self._who, self.tr("stream_dialog.performers")),
            (self._faces, self.tr("stream_dialog.names_of_face")),
            (self._rate, self.tr("stream_dialog.frames_per_second")),
        ):
            self._names[field].setText(text)
            field.setAccessibleName(text)
        self._here.setText(self.tr("stream_dialog.this_computer"))
        self._warning.setText(self.tr("stream_dialog.what_is_sent_leaves_this"))
        self._who.set_options(
            [
                Option("front", self.tr("stream_dialog.selected_player_in_middle")),
                Option("everyone", self.tr("stream_dialog.everyone_on_stage_each_on")),
            ]
        )
        self._faces.set_options(
            [
                Option("arkit", self.tr("stream_dialog.arkit_jawopen")),
                Option("arkit_capital", self.tr("stream_dialog.arkit_with_capitals_jawopen_perfect")),
                Option("vrm", self.tr("stream_dialog.vrm_presets_blink_l_joy")),
            ]
        )
        self._rate.set_options([Option(str(rate), str(rate)) for rate in RATES_HZ])
        self._list.setHeaderLabels([self.tr("stream_dialog.performer"), self.tr("stream_dialog.port")])
        self._close.setText(self.tr("stream_dialog.close"))
        self._anyway.setText(self.tr("stream_dialog.send_anyway"))
        self._listed = ()
        self._show()

    def changeEvent(self, event: QEvent) -> None:
        """Another language."""
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)

    def _state_text(self) -> tuple[str, str]:
        """How it goes, and the colour of that."""
        state, tokens = self._state, self._session.tokens
        if state.trouble is not None:
            return sentence(state.trouble, self._session), tokens.error
        if state.state == "looking":
            return self.tr("stream_dialog.looking_for").format(host=state.host), tokens.text_dim
        if state.state == "no_receiver":
            return (
                self.tr("stream_dialog.no_receiver_there_yet_start"),
                tokens.warning,
            )
        if state.state == "sending":
            return self.tr("stream_dialog.sending_frames_per_second_fewer").format(count=state.sent_hz), tokens.good
        return self.tr("stream_dialog.nothing_is_sent"), tokens.text_dim
