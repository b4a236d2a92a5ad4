"""The transport bar: play, stop, loop; playhead position; audible sources; grid."""

from __future__ import annotations

from math import ceil, floor

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QResizeEvent, QShowEvent
from PySide6.QtWidgets import QLayout, QMenu, QSizePolicy, QToolButton, QWidget

from app.editor.design_tokens import LEAST_TARGET_PX
from app.editor.grids import GRIDS
from app.editor.listening import LEAST_SPEED, MOST_SPEED, SOURCES
from app.editor.session import Session
from app.editor.stretches_of_time import place_limits
from app.project.snap_grid import Grid
from app.project.undoable_document import Change
from widgets.common.actions import actions, with_keys
from widgets.common.clicks import on_click, on_switch
from widgets.common.combo import Combo, Option
from widgets.common.controls import Caption, Retranslated, named
from widgets.common.icons import icon, pixmap
from widgets.common.layouts import STRETCH, in_row
from widgets.common.menus import add_actions
from widgets.common.number_slider import NumberSlider
from widgets.common.plain import Label
from widgets.transport.beat_light import BeatLight
from widgets.transport.fields import BarsField, ClockField, FramesField

BUTTONS = (
    ("play.to_start", "to_start", "transport_bar.to_start"),
    ("play.toggle", "play", "transport_bar.play_tip"),
    ("play.stop", "stop", "transport_bar.stop_once_more_to_start"),
    ("play.loop", "loop", "transport_bar.loop_selection_else_bar"),
    ("record.toggle", "record", "transport_bar.record_player_in_front_or"),
)
"""Action ids with icons and ids of tool tips."""
TOGGLES = (
    ("play.click", "metronome", "transport_bar.metronome"),
    ("play.follow", "follow", "transport_bar.timeline_follows_playhead"),
)

RECORD_MENU = (
    *("record.count_in_0", "record.count_in_1", "record.count_in_2", ""),
    *("record.punch", "record.arm", ""),
    *("record.devices", "record.latency"),
)
"""Entries of the record button's menu, with lines between groups."""

_SPACING_PX = 3


class TransportBar(Retranslated, QWidget):
    """Transport bar below the menu bar: playing, position, tempo and snapping.

    Parameters
    ----------
    session : Session
        Session whose actions the buttons trigger, so that menu, keys and buttons agree.
    """

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("transport")
        self._session = session
        self.buttons = {id: self._button(id, text_id) for id, _, text_id in (*BUTTONS, *TOGGLES)}
        self.snap_button = self.texted(self._tool("snap_on"), explained="transport_bar.edits_snap_to_grid_alt")
        self.bars, self.clock, self.frames = BarsField(session), ClockField(session), FramesField(session)
        self.tempo = self.texted(Label(), tip="transport_bar.tempo_and_metre_at_playhead")
        self.speed = self.texted(
            NumberSlider(
                session, 100 * LEAST_SPEED, 100 * MOST_SPEED, default=100.0, step=5.0, decimals=0, parent=self
            ),
            words=("transport_bar.speed", "%", "transport_bar.speed_pitch_stays_double_click"),
        )
        self.volume = self.texted(
            NumberSlider(session, 0.0, 100.0, default=80.0, step=5.0, decimals=0, parent=self),
            words=("transport_bar.volume", "%", "transport_bar.volume_double_click_80"),
        )
        self.source, self.snap = Combo(), Combo()
        self.silent_sign, self.silent_text = Label(), Caption("transport_bar.no_audio_device_silent")
        for label in (self.silent_sign, self.silent_text):
            self.texted(label, explained="transport_bar.there_is_no_audio_device")
        self.beat = BeatLight(session)
        self.take_text = named(Label(), "take_text")
        self.take_text.hide()
        self._name()
        self._build()
        self._connect()
        self._apply_theme()
        self.texted(self.bars, words=("", "", "transport_bar.position_tip"), name="transport_bar.bar_beat_ticks")
        self.texted(self.clock, words=("", "", "transport_bar.time_tip"), name="transport_bar.seconds")
        self.texted(
            self.frames,
            words=("transport_bar.frame", "", "transport_bar.frame_tip"),
            name="transport_bar.frame",
        )
        sources = {str(source): f"transport_bar.{source}" for source in SOURCES}
        self.texted(self.source, explained="transport_bar.playback_source", options=sources)
        self.snap.set_options([Option(name, name) for name in GRIDS])
        self.texted(self.snap, tip="transport_bar.step_of_grid_note_values", name="transport_bar.step_of_grid")
        self.retranslate()
        self._show_playhead(session.playhead_s)
        self._show_state()

    # Construction

    def _button(self, action_id: str, text_id: str) -> QToolButton:
        button = self._tool(action_id.replace(".", "_"))
        self.texted(button, tip=with_keys(self._session, action_id, text_id), name=text_id)
        on_click(button, lambda: self._trigger(action_id))
        return button

    def _tool(self, name: str) -> QToolButton:
        button = named(QToolButton(self), name)
        button.setAutoRaise(True)
        button.setMinimumSize(QSize(28, 28))
        button.setIconSize(QSize(18, 18))
        button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        return button

    def _name(self) -> None:
        names = {self.tempo: "tempo", self.speed: "speed", self.volume: "volume", self.source: "sound_source"}
        names |= {self.snap: "snap", self.silent_sign: "silent_sign", self.silent_text: "silent_text"}
        for widget, name in names.items():
            widget.setObjectName(name)
        menu = named(QMenu(self), "record_menu")
        menu.aboutToShow.connect(lambda: self._fill_record_menu(menu))
        self.buttons["record.toggle"].setMenu(menu)
        self.buttons["record.toggle"].setPopupMode(QToolButton.ToolButtonPopupMode.MenuButtonPopup)
        for button in (
            *(self.buttons[id] for id in ("play.loop", "play.click", "play.follow", "record.toggle")),
            self.snap_button,
        ):
            button.setCheckable(True)

    def _build(self) -> None:
        widths_px: dict[QWidget, tuple[int, int]] = {
            self.bars: (78, 112),
            self.clock: (84, 112),
            self.frames: (112, 140),
            self.source: (100, 190),
            self.snap: (66, 90),
        }
        for widget, (least_px, most_px) in widths_px.items():
            widget.setMinimumWidth(least_px)
            widget.setMaximumWidth(most_px)
        for slider in (self.volume, self.speed):
            slider.setMaximumWidth(150)
        for combo in (self.source, self.snap):
            combo.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
        self.tempo.setMinimumWidth(84)
        self.tempo.setAlignment(Qt.AlignmentFlag.AlignCenter)
        buttons = [self.buttons[id] for id, *_ in BUTTONS]
        places = ((self.bars, 3), (self.clock, 3), (self.frames, 3), self.tempo)
        beats = (self.buttons["play.click"], self.beat, self.take_text)
        sound = ((self.volume, 3), (self.speed, 3), (self.source, 2))
        snap = (self.snap_button, (self.snap, 1), 3, self.buttons["play.follow"])
        parts = (*buttons, 3, *places, 3, *beats, *sound, 3, *snap, STRETCH, self.silent_sign, self.silent_text)
        in_row(*parts, of=self, margins=(4, 1, 4, 1), spacing=_SPACING_PX)
        layout = self.layout()
        assert layout is not None
        layout.setSizeConstraint(QLayout.SizeConstraint.SetNoConstraint)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    def _connect(self) -> None:
        session, listening = self._session, self._session.listening
        session.playhead_changed.connect(self._show_playhead)
        session.changed.connect(self._project_changed)
        session.playing_changed.connect(self._show_state)
        session.loop_changed.connect(self._show_state)
        session.grid_changed.connect(self._show_state)
        session.follow_changed.connect(self._show_state)
        session.theme_changed.connect(self._apply_theme)
        listening.changed.connect(self._show_state)
        session.recording.changed.connect(self._show_state)
        self.bars.changed.connect(lambda tick, _: self._go(session.project.score.tempo_map.seconds(tick)))
        self.clock.changed.connect(lambda time_s, _: self._go(time_s))
        self.frames.changed.connect(lambda frame, _: self._go(frame / float(session.project.fps)))
        self.speed.changed.connect(lambda percent, _: listening.set(speed=percent / 100))
        self.volume.changed.connect(lambda percent, _: listening.set(volume=percent / 100))
        self.source.chosen.connect(self._choose_source)
        self.snap.chosen.connect(lambda name: self._session.set_grid(Grid(GRIDS[name])))
        on_switch(self.snap_button, lambda on: self._session.set_grid(Grid(self._session.grid.quarters, on)))

    # User actions

    def _trigger(self, action_id: str) -> None:
        action = actions(self._session).get(action_id)
        if action is not None:
            action.trigger()
        # A toggle without effect must show its actual state.
        self._show_state()

    def _fill_record_menu(self, menu: QMenu) -> None:
        menu.clear()
        add_actions(menu, self._session, RECORD_MENU)

    def _go(self, time_s: float) -> None:
        start_s, end_s = place_limits(self._session)
        time_s = min(max(time_s, start_s), end_s)
        self._session.set_playhead(time_s)
        self._session.reveal(time_s)
        # Also if the playhead was at the limit already: the field still shows the typed value.
        self._show_playhead(time_s)

    def _choose_source(self, source: str) -> None:
        for known in SOURCES:
            if known == source:
                self._session.listening.set(source=known)

    # Display

    def _project_changed(self, change: Change) -> None:
        before, after = change.before, change.after
        if change.opened or before.audio is not after.audio:
            self._show_state()
        if change.opened or before.score is not after.score or before.fps != after.fps:
            self._show_playhead(self._session.playhead_s)

    def _show_playhead(self, playhead_s: float) -> None:
        project = self._session.project
        score = project.score
        tick = floor(score.tempo_map.ticks(playhead_s) + 1e-6)
        frames = playhead_s * float(project.fps)
        self.bars.show_value(float(tick), by_hand=False)
        self.clock.show_value(playhead_s, by_hand=False)
        # The frame on the screen is the one that began last.
        self.frames.show_value(float(floor(frames + 1e-6)), by_hand=False)
        self.beat.show_time(playhead_s)
        self._show_take(playhead_s)
        metre = score.metre_map.metre_at(max(tick, 0))
        bpm = next((bpm for at, bpm in reversed(score.tempo_map.bpm) if at <= tick), score.tempo_map.bpm[0][1])
        text = f"♩= {bpm:.1f}".removesuffix(".0") + f"   {metre.numerator}/{metre.denominator}"
        if text != self.tempo.text():
            self.tempo.setText(text)

    def _show_take(self, playhead_s: float) -> None:
        """Show the remaining beats of the count-in, or the recorded pass of a loop."""
        recording, text = self._session.recording, ""
        if recording.running and playhead_s < recording.start_s - 1e-6:
            project = self._session.project
            now, start = map(project.score.tempo_map.ticks, (playhead_s, recording.start_s))
            beats = (start - now) / project.metre_map.felt_ticks_at(start)
            text = f"−{ceil(beats - 1e-6)}"
        elif recording.running:
            text = (
                self.tr("transport_bar.rec")
                if recording.passes < 2
                else self.tr("transport_bar.rec_2").format(number=recording.passes)
            )
        if text != self.take_text.text():
            self.take_text.setText(text)
            self.take_text.setVisible(bool(text))
            self._fit()

    def _show_state(self) -> None:
        session, listening = self._session, self._session.listening
        tokens = session.tokens
        self.buttons["play.loop"].setChecked(session.loop_s is not None)
        self.buttons["play.click"].setChecked(listening.click)
        self.buttons["play.follow"].setChecked(session.follow)
        self.buttons["record.toggle"].setChecked(session.recording.running)
        self._show_take(session.playhead_s)
        self.buttons["play.toggle"].setIcon(icon("pause" if session.playing else "play", tokens))
        self.speed.show_value(round(100 * listening.speed, 3), by_hand=listening.speed != 1.0)
        self.volume.show_value(round(100 * listening.volume, 3), by_hand=False)
        self.source.setVisible(session.project.audio is not None)
        self.source.show_option(listening.source)
        self.snap_button.setChecked(session.grid.enabled)
        quarters = session.grid.quarters
        self.snap.show_option(next((name for name, step in GRIDS.items() if step == quarters), None))
        self.silent_sign.setVisible(listening.silent)
        self._fit()

    def _spare(self) -> dict[QWidget, int]:
        """Return the fields that can be hidden because other panels show them, with the width in pixels that each
        needs; the last one is hidden first.
        """
        return {
            widget: max(widget.minimumWidth(), widget.minimumSizeHint().width()) + _SPACING_PX
            for widget in (self.clock, self.tempo, self.silent_text)
        }

    def _least_px(self) -> int:
        """Return the least width in pixels of the bar without the fields that can be hidden."""
        layout = self.layout()
        assert layout is not None
        items = [item for index in range(layout.count()) if (item := layout.itemAt(index)) is not None]
        spare = self._spare()
        kept = [item for item in items if not item.isEmpty() and item.widget() not in spare]
        spaces = sum(item.sizeHint().width() for item in items if item.spacerItem() is not None)
        margins = layout.contentsMargins()
        widths = sum(item.minimumSize().width() + _SPACING_PX for item in kept)
        return margins.left() + margins.right() + widths + spaces

    def _fit(self) -> None:
        """Hide fields that other panels show if the space is insufficient, so that all others keep their captions."""
        room = self.width() - self._least_px()
        for widget, width in self._spare().items():
            if widget is self.silent_text and not self._session.listening.silent:
                widget.hide()
                continue
            room -= width
            widget.setVisible(room >= 0)

    def _apply_theme(self) -> None:
        tokens = self._session.tokens
        for id, name, _ in (*BUTTONS, *TOGGLES):
            self.buttons[id].setIcon(icon(name, tokens))
        self.buttons["record.toggle"].setIcon(icon("record", tokens, tokens.error))
        self.take_text.setStyleSheet(f"color: {tokens.error}; font-weight: bold;")
        self.snap_button.setIcon(icon("snap", tokens))
        ratio = self.devicePixelRatioF()
        self.silent_sign.setPixmap(pixmap("mute", 18, tokens.warning, ratio))
        self.silent_text.setStyleSheet(f"color: {tokens.warning};")
        self.tempo.setStyleSheet(f"color: {tokens.text_dim};")
        self._show_state()

    def retranslate(self) -> None:
        for slider in (self.volume, self.speed):
            # The slider must be as wide as its name, or users would not find it.
            slider.setMinimumWidth(min(slider.sizeHint().width(), slider.maximumWidth()))
        self._show_state()

    # Qt overrides

    def showEvent(self, event: QShowEvent) -> None:
        # Actions may be registered after the bar is created.
        self.word()
        super().showEvent(event)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._show_state()

    def minimumSizeHint(self) -> QSize:
        return QSize(self._least_px(), LEAST_TARGET_PX + 8)
