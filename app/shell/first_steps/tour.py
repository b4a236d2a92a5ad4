"""The tour in the window: opens the quartet, points at controls, and observes the user's actions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from PySide6.QtCore import QEvent, QMargins, QObject, QPoint, QRect, Qt, QTimer
from PySide6.QtWidgets import QScrollArea, QWidget

from app.editor.files import EXAMPLE
from app.project.undoable_document import Change
from app.shell.editor import Editor
from app.shell.first_steps.bubble import Bubble, Spotlight, place_beside
from app.shell.first_steps.progress import STOPS, TourFacts, TourProgress, facts_of
from app.shell.window import Window
from widgets.common.actions import actions
from widgets.common.section import Section

AIR: Final = QMargins(3, 3, 3, 3)
"""Margins between a control and the frame around it in pixels."""
LOOK_AGAIN_MS: Final = 200
"""Interval in milliseconds at which the tour follows controls that have moved, as when panels are resized or
scrolled.
"""


@dataclass(frozen=True)
class TourTarget:
    """The control that a stop is about.

    Attributes
    ----------
    control : callable
        Function that finds the control in the window.
    avoided : callable
        Function that returns the part of the window that the bubble must not cover, since the task needs it.
    prepare : callable
        Function that scrolls or opens what is necessary to show the control.
    action : str
        Id of the action whose shortcut is named in the text of the stop.
    """

    control: Callable[[Window], QRect]
    avoided: Callable[[Window], QRect]
    prepare: Callable[[Window], None]
    action: str = ""


def _named(name: str) -> Callable[[Window], QRect]:
    def find(window: Window) -> QRect:
        widget = window.findChild(QWidget, name)
        return QRect() if widget is None else _seen(widget, window)

    return find


def _seen(widget: QWidget, window: Window) -> QRect:
    """Return the visible part of a widget in the window's coordinates; empty if the widget is hidden."""
    if not widget.isVisible() or not window.isAncestorOf(widget):
        return QRect()
    box = QRect(widget.mapTo(window, QPoint()), widget.size())
    above = widget.parentWidget()
    while above is not None and above is not window:
        box = box.intersected(QRect(above.mapTo(window, QPoint()), above.size()))
        above = above.parentWidget()
    return box


def _export_menu(window: Window) -> QRect:
    bar = window.menuBar()
    box: QRect = bar.actionGeometry(window.menus.menu("export").menuAction())
    return QRect(bar.mapTo(window, box.topLeft()), box.size())


def _bars(window: Window) -> QRect:
    return _seen(window.menuBar(), window).united(_seen(window.bar, window))


def _show_lane(lane_id: str) -> Callable[[Window], None]:
    def show(window: Window) -> None:
        window.docks["timeline"].show()
        window.docks["timeline"].raise_()
        window.timeline.open_lane(lane_id, True)

    return show


def _show_amplitude(window: Window) -> None:
    window.docks["players"].show()
    window.docks["players"].raise_()
    section, slider = window.findChild(Section, "players_motion"), window.findChild(QWidget, "parameter_amplitude")
    if section is None or slider is None:
        return
    section.header.set_open(True)
    above = slider.parentWidget()
    while above is not None:
        if isinstance(above, QScrollArea):
            above.ensureWidgetVisible(slider)
        above = above.parentWidget()


def _nothing(window: Window) -> None:
    pass


_timeline: Final = _named("dock_timeline")
TARGETS: Final[Mapping[str, TourTarget]] = {
    "play": TourTarget(_named("play_toggle"), _bars, _nothing, "play.toggle"),
    "fingering": TourTarget(_named("lane_fingering"), _timeline, _show_lane("fingering"), "fingering.cycle"),
    "breath": TourTarget(_named("lane_breath"), _timeline, _show_lane("breath")),
    "amplitude": TourTarget(_named("parameter_amplitude"), _named("dock_players"), _show_amplitude, "play.toggle"),
    "export": TourTarget(_export_menu, _bars, _nothing, "export.files"),
}
"""The controls by the names of `STOPS`."""


class FirstSteps(QObject):
    """The introductory tour, which points at parts of the editor's window one after the other.

    Parameters
    ----------
    editor : Editor
        Editor whose window is the parent.
    """

    def __init__(self, editor: Editor) -> None:
        super().__init__(editor.window)
        self._editor, self._window, self._session = editor, editor.window, editor.session
        self.progress: TourProgress | None = None
        """None: the tour is not under way."""
        self._waits_for_piece = False
        self.bubble, self.frame = Bubble(self._session, self._window), Spotlight(self._session, self._window)
        self.bubble.back_requested.connect(lambda: self._go(TourProgress.back))
        self.bubble.next_requested.connect(lambda: self._go(TourProgress.next))
        self.bubble.closed.connect(self.end)
        self.bubble.left.connect(lambda: self._window.timeline.setFocus(Qt.FocusReason.OtherFocusReason))
        self._look_again = QTimer(self, interval=LOOK_AGAIN_MS)
        self._look_again.timeout.connect(self._observe)
        self._session.changed.connect(self._changed)
        self._session.playing_changed.connect(self._observe)
        self._session.performance_changed.connect(self._observe)
        self._session.language_changed.connect(self._show)
        editor.table.shortcuts_changed.connect(self._show)
        editor.files.opened.connect(self._opened)
        self._window.installEventFilter(self)

    def begin(self) -> None:
        """Open the quartet, unless the user keeps the present piece, and show the first stop. A running tour is brought
        into view and gets the keyboard focus.
        """
        if self.progress is not None:
            self._arrive()
            # Focused as if by Tab, so that Space presses the button and does not start playback.
            self.bubble.next.setFocus(Qt.FocusReason.TabFocusReason)
            return
        self._waits_for_piece = True
        self._editor.files.open_example()

    def end(self) -> None:
        """Close the tour; the user's edits stay."""
        had_keys = self.bubble.isAncestorOf(self._window.focusWidget() or self._window)
        self.progress = None
        self._look_again.stop()
        self.bubble.hide()
        self.frame.hide()
        if had_keys:
            self._window.timeline.setFocus(Qt.FocusReason.OtherFocusReason)

    # Piece

    def _changed(self, change: Change) -> None:
        if not change.opened:
            self._observe()
            return
        is_example = Path(change.after.source).name == EXAMPLE
        waited, self._waits_for_piece = self._waits_for_piece, False
        if self.progress is not None:
            self.end()
        if waited and is_example:
            # Panels are shown after the file reports that it is open.
            QTimer.singleShot(0, self, self._start)

    def _opened(self) -> None:
        if not self._editor.files.is_open:
            self._waits_for_piece = False
            self.end()

    def _start(self) -> None:
        if self._editor.files.is_open:
            self.progress = TourProgress(self._facts())
            self._look_again.start()
            self._arrive()

    # Stops

    def _facts(self) -> TourFacts:
        dialog = self._window.findChild(QWidget, "export_files")
        session = self._session
        return facts_of(session.project, session.plans, session.playing, dialog is not None and dialog.isVisible())

    def _go(self, step: Callable[[TourProgress, TourFacts], TourProgress]) -> None:
        if self.progress is None:
            return
        self.progress = step(self.progress, self._facts())
        if self.progress.stop:
            self._arrive()
        else:
            self.end()

    def _arrive(self) -> None:
        """Show the control of the current stop."""
        if self.progress is not None:
            self._window.set_full_screen(False)
            TARGETS[self.progress.stop].prepare(self._window)
            self._show()
            self._observe()

    def _observe(self, *changes: object) -> None:
        if self.progress is None:
            return
        before, self.progress = self.progress, self.progress.observe(self._facts())
        if self.progress is not before:
            self._show()
        else:
            self._place()

    # Appearance

    def _show(self) -> None:
        progress = self.progress
        if progress is None:
            return
        stop, is_done = progress.stop, progress.is_done
        action = actions(self._session).get(TARGETS[stop].action)
        keys = action.shortcut().toString(action.shortcut().SequenceFormat.NativeText) if action is not None else ""
        forward = "first_steps.finish" if progress.is_last and is_done else "first_steps.next"
        self.bubble.say(
            step=self.tr("first_steps.step").format(number=progress.number + 1, count=len(STOPS)),
            title=self.tr(f"first_steps.title.{stop}"),
            text=self.tr(f"first_steps.text.{stop}").format(keys=keys),
            state=self.tr(f"first_steps.done.{stop}").format(keys=keys) if is_done else self.tr("first_steps.waiting"),
            forward=self.tr(forward if is_done else "first_steps.skip"),
            is_done=is_done,
            is_first=progress.number == 0,
        )
        self._place()

    def _place(self) -> None:
        """Move the frame and the bubble to the control, which may have moved."""
        if self.progress is None:
            return
        target = TARGETS[self.progress.stop]
        control = target.control(self._window)
        self.frame.setVisible(not control.isEmpty())
        box = control.marginsAdded(AIR).intersected(self._window.rect())
        if self.frame.geometry() != box:
            self.frame.setGeometry(box)
        self.frame.raise_()
        room = self._window.rect().marginsRemoved(QMargins(8, 8, 8, 8))
        if control.isEmpty():
            place = room.center() - QPoint(self.bubble.width(), self.bubble.height()) / 2
        else:
            avoided = target.avoided(self._window).united(box)
            place = place_beside(avoided, box, self.bubble.size(), room)
        if self.bubble.pos() != place:
            self.bubble.move(place)
        self.bubble.show()
        self.bubble.raise_()

    # Qt overrides

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Move the bubble of the tour when the window changes its size."""
        if event.type() == QEvent.Type.Resize:
            self._place()
        return False
