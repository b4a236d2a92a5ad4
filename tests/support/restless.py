"""A restless user who clicks, drags, turns the wheel and presses keys randomly all over the editor."""

from __future__ import annotations

import random
import sys
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from types import TracebackType

import msgspec
from PySide6.QtCore import (
    QEvent,
    QMessageLogContext,
    QPoint,
    QPointF,
    QRect,
    Qt,
    QTimer,
    QtMsgType,
    qInstallMessageHandler,
)
from PySide6.QtGui import QContextMenuEvent, QKeySequence, QMouseEvent, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDialog, QMainWindow, QMenu, QMenuBar, QWidget

from app.errors import Message
from app.performance.ensemble import Performance
from app.project.edit.takes import add_takes, comp_whole
from app.project.model import Project
from app.project.storage import load, save
from app.shell.app import Program
from tests.support.takes import take_of
from tests.support.windows import pause
from widgets.common.actions import actions

QUARTET = Path(__file__).parents[2] / "resources" / "examples" / "quartet.mid"

LEFT_ALONE = frozenset(("file.quit",))
"""The only action that the user never triggers."""
ASKS_THE_SYSTEM = frozenset(
    (
        *("export_browse", "playblast_browse", "swatch"),
        *("evaluation_browse", "evaluation_browse_film", "evaluation_browse_keyframes", "evaluation_start"),
    )
)
"""Buttons that open a dialog of the system, which tests cannot close, and one that starts a process of
several minutes.
"""
KEYS = (
    *(Qt.Key.Key_Left, Qt.Key.Key_Right, Qt.Key.Key_Up, Qt.Key.Key_Down, Qt.Key.Key_Home, Qt.Key.Key_End),
    *(Qt.Key.Key_Tab, Qt.Key.Key_Backtab, Qt.Key.Key_Escape, Qt.Key.Key_Return, Qt.Key.Key_Space),
    *(Qt.Key.Key_Delete, Qt.Key.Key_Backspace, Qt.Key.Key_PageUp, Qt.Key.Key_PageDown, Qt.Key.Key_F2, Qt.Key.Key_Menu),
    *(Qt.Key.Key_1, Qt.Key.Key_2, Qt.Key.Key_3, Qt.Key.Key_0, Qt.Key.Key_Minus, Qt.Key.Key_Period, Qt.Key.Key_T),
)
MODIFIERS = (
    *([Qt.KeyboardModifier.NoModifier] * 5),
    Qt.KeyboardModifier.ShiftModifier,
    Qt.KeyboardModifier.ControlModifier,
    Qt.KeyboardModifier.AltModifier,
)
BUTTONS = (*([Qt.MouseButton.LeftButton] * 8), Qt.MouseButton.MiddleButton, Qt.MouseButton.RightButton)


class Restless:
    """The restless user.

    Parameters
    ----------
    program : Program
        With a piece open.
    seed : int
    """

    def __init__(self, program: Program, seed: int) -> None:
        self.program = program
        self.session = program.session
        self.random = random.Random(seed)
        self.deeds: list[str] = []
        self.slowest_s: list[tuple[float, str]] = []
        self._busy = False
        self._closer = QTimer()
        self._closer.setInterval(100)
        self._closer.timeout.connect(self._end_loops)
        self._closer.start()

    def _end_loops(self) -> None:
        """Close a menu or dialog of Qt that runs an event loop within a click."""
        if not self._busy:
            return
        popup = QApplication.activePopupWidget()
        modal = QApplication.activeModalWidget()
        if popup is not None:
            popup.close()
        elif isinstance(modal, QDialog):
            modal.reject()

    def step(self) -> None:
        """Do one random thing."""
        if not self.program.editor.files.is_open:
            self.program.editor.files.open(QUARTET, ask=False)
            QApplication.processEvents()
        deed = self.random.choices(
            (self.click, self.drag, self.wheel, self.press, self.command, self.context_menu, self.play_on, self.record),
            (8, 6, 3, 5, 6, 2, 1, 1),
        )[0]
        start_s = time.perf_counter()
        self.busy(deed)
        QApplication.processEvents()
        self.slowest_s.append((time.perf_counter() - start_s, self.deeds[-1] if self.deeds else ""))
        self.look_away()

    def busy(self, deed: Callable[[], None]) -> None:
        """Do something while nested event loops of Qt are ended by a timer."""
        self._busy = True
        try:
            deed()
        finally:
            self._busy = False

    def look_away(self) -> None:
        """Sometimes close a menu or dialog, which would otherwise receive every other event."""
        popup = QApplication.activePopupWidget()
        if popup is not None and self.random.random() < 0.7:
            if isinstance(popup, QMenu):
                self._choose(popup)
            popup.close()
        for widget in QApplication.topLevelWidgets():
            if isinstance(widget, QDialog) and widget.isVisible() and self.random.random() < 0.15:
                self.deeds.append(f"close {widget.objectName()}")
                widget.close()

    def _choose(self, menu: QMenu) -> None:
        entries = [action for action in menu.actions() if action.isEnabled() and not action.isSeparator()]
        if not entries:
            return
        entry = self.random.choice(entries)
        if entry.menu() is not None or entry.objectName() in LEFT_ALONE:
            return
        self.deeds.append(f"choose {entry.objectName() or entry.text()}")
        menu.close()
        entry.trigger()

    # Targets

    def _widget(self) -> QWidget | None:
        """Choose any visible widget of any window."""
        windows = [
            widget
            for widget in QApplication.topLevelWidgets()
            if widget.isVisible() and isinstance(widget, QMainWindow | QDialog)
        ]
        if not windows:
            return None
        modal = QApplication.activeModalWidget()
        window = modal if modal is not None else self.random.choice(windows)
        found = [
            child
            for child in window.findChildren(QWidget)
            if child.isVisible()
            and child.isEnabled()
            and not isinstance(child, QMenuBar | QMenu)
            and not child.visibleRegion().isEmpty()
            and self._is_harmless(child)
        ]
        return self.random.choice(found) if found else None

    @staticmethod
    def _is_harmless(widget: QWidget) -> bool:
        name = widget.objectName()
        return (
            not any(part in name for part in ("browse", "swatch", "folder", "show_in", "log"))
            and type(widget).__name__ not in ("Swatch", "QDialogButtonBox")
            and "start" not in name
        )

    def _place(self, widget: QWidget) -> QPoint:
        bounds: QRect = widget.visibleRegion().boundingRect()
        return QPoint(
            self.random.randint(bounds.left(), max(bounds.left(), bounds.right())),
            self.random.randint(bounds.top(), max(bounds.top(), bounds.bottom())),
        )

    def _reported(self, what: str, widget: QWidget, place: QPoint) -> None:
        self.deeds.append(f"{what} {type(widget).__name__} {widget.objectName()} {place.x()},{place.y()}")

    # Actions

    def click(self) -> None:
        """Click or double-click something."""
        widget = self._widget()
        if widget is None:
            return
        place, button, keys = self._place(widget), self.random.choice(BUTTONS), self.random.choice(MODIFIERS)
        twice = self.random.random() < 0.2
        self._reported("double-click" if twice else "click", widget, place)
        QTest.mouseMove(widget, place)
        if twice:
            QTest.mouseDClick(widget, button, keys, place)
        else:
            QTest.mouseClick(widget, button, keys, place)

    def drag(self) -> None:
        """Press the mouse, move it, perhaps press Escape, and release."""
        widget = self._widget()
        if widget is None:
            return
        place, button, keys = self._place(widget), self.random.choice(BUTTONS), self.random.choice(MODIFIERS)
        self._reported("drag", widget, place)
        gone = [False]
        widget.destroyed.connect(lambda: gone.__setitem__(0, True))
        self._mouse(widget, QEvent.Type.MouseButtonPress, place, button, button, keys)
        for _ in range(self.random.randint(1, 4)):
            place = place + QPoint(self.random.randint(-120, 120), self.random.randint(-60, 60))
            if not gone[0]:
                self._mouse(widget, QEvent.Type.MouseMove, place, Qt.MouseButton.NoButton, button, keys)
            QApplication.processEvents()
        if self.random.random() < 0.15 and not gone[0]:
            self.deeds.append("escape")
            QTest.keyClick(widget, Qt.Key.Key_Escape)
        if not gone[0]:
            self._mouse(widget, QEvent.Type.MouseButtonRelease, place, button, Qt.MouseButton.NoButton, keys)

    @staticmethod
    def _mouse(
        widget: QWidget,
        kind: QEvent.Type,
        place: QPoint,
        button: Qt.MouseButton,
        held: Qt.MouseButton,
        keys: Qt.KeyboardModifier,
    ) -> None:
        screen = QPointF(widget.mapToGlobal(place))
        QApplication.sendEvent(widget, QMouseEvent(kind, QPointF(place), screen, button, held, keys))

    def wheel(self) -> None:
        """Turn the wheel."""
        widget = self._widget()
        if widget is None:
            return
        place, keys = self._place(widget), self.random.choice(MODIFIERS)
        self._reported("wheel", widget, place)
        event = QWheelEvent(
            QPointF(place),
            QPointF(widget.mapToGlobal(place)),
            QPoint(),
            QPoint(0, self.random.choice((-240, -120, 120, 240))),
            Qt.MouseButton.NoButton,
            keys,
            Qt.ScrollPhase.NoScrollPhase,
            False,
        )
        QApplication.sendEvent(widget, event)

    def press(self) -> None:
        """Press a key in the widget with the focus, sometimes after changing the focus."""
        if self.random.random() < 0.5:
            widget = self._widget()
            if widget is not None and widget.focusPolicy() != Qt.FocusPolicy.NoFocus:
                widget.setFocus()
        target = QApplication.focusWidget() or self.program.window
        key, keys = self.random.choice(KEYS), self.random.choice(MODIFIERS)
        if key == Qt.Key.Key_Return and "start" in target.objectName():
            return
        if key in (Qt.Key.Key_Return, Qt.Key.Key_Space) and not self._is_harmless(target):
            return
        self.deeds.append(f"key {key.name} {keys} in {type(target).__name__} {target.objectName()}")
        QTest.keyClick(target, key, keys)

    def command(self) -> None:
        """Trigger an action, by its shortcut if it has one."""
        table = self.program.editor.table
        action_id = self.random.choice([row for row in table.rows if row not in LEFT_ALONE])
        if action_id == "file.close" and self.random.random() < 0.8:
            return
        self.deeds.append(f"command {action_id}")
        keys = table.keys(action_id)
        target = QApplication.focusWidget()
        if keys and target is not None and self.random.random() < 0.5:
            first = QKeySequence.fromString(keys.split(";")[0], QKeySequence.SequenceFormat.PortableText)[0]
            QTest.keyClick(target, first.key(), first.keyboardModifiers())
            return
        table.refresh()
        if actions(self.session)[action_id].isEnabled():
            actions(self.session)[action_id].trigger()

    def context_menu(self) -> None:
        """Open the context menu of a widget."""
        widget = self._widget()
        if widget is None:
            return
        place = self._place(widget)
        self._reported("menu", widget, place)
        event = QContextMenuEvent(QContextMenuEvent.Reason.Mouse, place, widget.mapToGlobal(place))
        QApplication.sendEvent(widget, event)
        QApplication.processEvents()
        popup = QApplication.activePopupWidget()
        if isinstance(popup, QMenu):
            self._choose(popup)
            popup.close()

    def play_on(self) -> None:
        """Wait a moment for slow work."""
        self.deeds.append("wait")
        pause(self.random.randint(1, 40))

    def record(self) -> None:
        """Add notes as if played on a wind controller."""
        player = self.session.player
        if player is None:
            return
        self.deeds.append(f"record {player.name}")
        chance = self.random
        played = [
            (0.4 * beat + chance.uniform(0.0, 0.1), 0.4 * beat + chance.uniform(0.1, 0.5), chance.randint(60, 72), 0.6)
            for beat in range(30)
        ]
        take = take_of(played, tempo_map=self.session.project.score.tempo_map)
        name = Message("edit.record", {"count": 1})
        if self.session.attempt(name, lambda project: add_takes(project, player.id, [take])[0]):
            take_id = self.session.project.takes[player.id].takes[-1].id
            self.session.attempt(name, lambda project: comp_whole(project, player.id, take_id))

    # Invariants

    def calm_down(self) -> None:
        """Close everything that is open, stop playback and leave full screen."""
        for _ in range(5):
            popup = QApplication.activePopupWidget()
            if popup is not None:
                popup.close()
        for widget in QApplication.topLevelWidgets():
            if isinstance(widget, QDialog) and widget.isVisible():
                widget.close()
        if self.session.playback is not None and self.session.playback.is_playing:
            self.session.playback.stop()
        self.program.window.set_full_screen(False)
        QApplication.processEvents()

    def judge(self, folder: Path) -> None:
        """Check the document: it can be stored, its plans equal freshly computed ones, undo leads to the first project
        and redo to the last.
        """
        self.calm_down()
        end_s = time.monotonic() + 90.0
        while self.session.performance.project is not self.session.project:
            assert time.monotonic() < end_s, "plans never came"
            QApplication.processEvents()
            time.sleep(0.002)
        project: Project = self.session.project
        held = folder / "held.suisou"
        save(project, held)
        assert by_hand(load(held)) == by_hand(project)
        fresh = Performance(project)
        for player in project.players:
            mine, anew = self.session.performance.plan(player), fresh.plan(player)
            assert mine == anew, f"{player.name}: plans differ from those made anew"
        document = self.session.document
        steps = document.done
        first = steps[0].before if steps else project
        while document.undo() is not None:
            pass
        assert document.project is first
        # No further, since steps undone before are not included.
        for _ in steps:
            document.redo()
        assert document.project is project


def by_hand(project: Project) -> object:
    """All decisions of the user as a comparable value."""
    return (
        tuple((part.id, part.notes) for part in project.score.parts),
        project.players,
        {player: frozenset(map(msgspec.json.encode, items)) for player, items in project.corrections.items() if items},
        project.expressions,
        project.audio,
        project.video,
        project.takes,
    )


class Complaints:
    """Lines logged by Qt, and uncaught exceptions."""

    def __init__(self) -> None:
        self.found: list[str] = []

    def install(self) -> None:
        """Start collecting."""
        sys.excepthook = self._uncaught
        qInstallMessageHandler(self._logged)

    def take(self, error: BaseException) -> None:
        """Record a line."""
        self.found.append("".join(traceback.format_exception(error)))

    def _uncaught(self, kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        self.found.append("".join(traceback.format_exception(kind, error, trace)))

    def _logged(self, kind: QtMsgType, context: QMessageLogContext, text: str) -> None:
        self.found.append(f"Qt: {text}")
