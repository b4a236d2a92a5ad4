"""An editor in which every name from a file looks like HTML, and a check that the window displays all of them as plain
text.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import msgspec
from PySide6.QtCore import QEvent, QPoint, QPointF, QRect, Qt
from PySide6.QtGui import QContextMenuEvent, QHelpEvent, QKeySequence, QMouseEvent, QTextDocument
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractItemView,
    QApplication,
    QComboBox,
    QGroupBox,
    QLabel,
    QLineEdit,
    QMenu,
    QTabBar,
    QTableView,
    QTextEdit,
    QToolTip,
    QWidget,
)
from shiboken6 import isValid

from app.capture.protocol import Opened, Ports
from app.plan.by_hand.corrections import AddExpression
from app.project.edit.takes import add_takes, comp_whole
from app.project.model import Project
from app.project.presets import Preset, save_preset
from app.project.recording import AudioTrack
from app.project.video import VideoTrack
from app.score.model import Marker, Score
from metadata.model import Expression
from tests.support.canary import Canary
from tests.support.recorder import Clock, SpokenFor
from tests.support.takes import take_of

CHARACTER = Path(__file__).parents[1] / "data" / "characters" / "toddler_vrm1.vrm"
FIELD = re.compile(r'alt="(\w+)"')
KEY = QKeySequence("Alt+8")
"""Shortcut that ``&8`` in a name would create."""
PLACES = 4
"""Number of positions of the mouse across a widget that responds to hovering."""


def hostile_score(score: Score, canary: Canary) -> Score:
    """Copy of a score with hostile titles, part names and markers."""
    parts = tuple(msgspec.structs.replace(part, name=canary.name("track")) for part in score.parts)
    markers = (Marker(0, canary.name("marker")), Marker(4 * score.ticks_per_quarter, canary.name("marker")))
    return msgspec.structs.replace(score, title=canary.name("title"), parts=parts, markers=markers)


def with_more(project: Project, canary: Canary) -> Project:
    """Add content that no MIDI file contains to a project: a take, a displayed expression, a recording."""
    front = project.players[0]
    played = [(1.0 + 0.5 * beat, 1.45 + 0.5 * beat, 60 + beat, 0.7) for beat in range(8)]
    named = {"name": canary.name("take"), "device": canary.name("device"), "recorded": canary.name("recorded")}
    project, (take,) = add_takes(project, front.id, [msgspec.structs.replace(take_of(played), **named)])
    project = comp_whole(project, front.id, take)
    face = Expression(canary.name("expression"), canary.name("described"), {"mouthSmileLeft": 0.5}, False, 0.2, 0.3)
    quarter = project.score.ticks_per_quarter
    shown = AddExpression("x", face.name, 2 * quarter, 6 * quarter)
    return replace(
        project,
        expressions=(face,),
        corrections={**project.corrections, front.id: (shown,)},
        audio=AudioTrack(str(canary.folder / canary.file_name("audio"))),
        video=VideoTrack(str(canary.folder / canary.file_name("video"))),
        players=(msgspec.structs.replace(front, name=canary.name("player"), instrument_id="own"), *project.players[1:]),
    )


def write_library(canary: Canary, instruments: Path, characters: Path, presets: Path) -> None:
    """Write a user's own instruments, characters and presets: a valid and an invalid file of each."""
    for folder in (instruments, characters):
        folder.mkdir(parents=True)
    name, title = (msgspec.json.encode(canary.name(field)).decode() for field in ("instrument", "character"))
    map_ = f'extends = "trumpet_Bb"\nid = "own"\nname = {{ en = {name}, ja = {name} }}\n'
    (instruments / "own.toml").write_text(map_, "utf-8")
    (instruments / f"{canary.file_name('map_file')}.toml").write_text('id = "a"\n', "utf-8")
    shutil.copy(CHARACTER, characters / "own.vrm")
    (characters / "own.toml").write_text(f'file = "own.vrm"\ntitle = {title}\n', "utf-8")
    (characters / f"{canary.file_name('wrong_character')}.toml").write_text("file = 1\n", "utf-8")
    save_preset(presets, Preset(canary.name("preset"), {"amplitude": 0.5}))
    (presets / f"{canary.file_name('wrong_preset')}.toml").write_text("name = 1\n", "utf-8")


class Spoken(SpokenFor):
    """A MIDI device with a hostile name."""

    def __init__(self, on_news: Callable[[], None], port: str) -> None:
        super().__init__(on_news, Clock())
        self.reported = [Ports((port,), (), "test")]

    def open(self, port: str | None) -> None:
        if port:
            self.say(Opened(port, 0))


class Judge:
    """Examines all visible texts and tool tips, and records those that are not plain text."""

    def __init__(self, canary: Canary) -> None:
        self.canary = canary
        self.seen: set[str] = set()
        """Fields of which a text was found, so that the walk is known to have come there."""
        self.faults: list[str] = []
        self._state = ""

    def look(self, state: str, beside: QWidget | None = None) -> None:
        """Check the visible widgets; ``beside`` is a window that was checked before."""
        self._state = state
        for _ in range(3):
            QApplication.processEvents()
        for widget in QApplication.allWidgets():
            # A tip is gone when the next one comes.
            if isValid(widget) and widget.isVisible() and (beside is None or widget.window() is not beside):
                self._judge(widget)
        self._opened("shown")

    def _judge(self, widget: QWidget) -> None:
        self._note(widget.toolTip(), widget.accessibleName())
        if isinstance(widget, QLabel):
            self._judge_label(widget)
        elif isinstance(widget, QAbstractButton):
            self._note(widget.text())
            self._key(widget, widget.shortcut())
        elif isinstance(widget, QLineEdit):
            self._note(widget.text())
        elif isinstance(widget, QComboBox):
            self._note(*(widget.itemText(row) for row in range(widget.count())))
        elif isinstance(widget, QTabBar):
            for place in range(widget.count()):
                self._key(widget, QKeySequence.mnemonic(widget.tabText(place)))
        elif isinstance(widget, QGroupBox):
            self._key(widget, QKeySequence.mnemonic(widget.title()))
        elif isinstance(widget, QMenu):
            self._judge_menu(widget)
        elif isinstance(widget, QTextEdit):
            self._fault(f"{_described(widget)}: shows rich text")
        if widget.isWindow():
            title = widget.windowTitle()
            self._note(title)
            # Qt removes a single placeholder from the title in the window's frame.
            handle = widget.windowHandle()
            if "&8" in title and handle is not None and "&8[*]" not in handle.title():
                self._fault(f"{_described(widget)}: the title has a mark")
        for place in self._places(widget):
            self.rest(widget, place)

    def _judge_label(self, label: QLabel) -> None:
        self._note(label.text())
        if label.textFormat() != Qt.TextFormat.PlainText:
            self._fault(f"{_described(label)}: {label.textFormat().name}")
        for document in label.findChildren(QTextDocument):
            if "\ufffc" in document.toPlainText():
                self._fault(f"{_described(label)}: holds a picture")

    def _judge_menu(self, menu: QMenu) -> None:
        for action in menu.actions():
            self._note(action.text())
            self._key(menu, QKeySequence.mnemonic(action.text()))

    def open_menus(self, state: str) -> None:
        """Check the menus of the menu bar and of buttons, filled as when opened."""
        self._state = state
        for menu in (widget for widget in QApplication.allWidgets() if isinstance(widget, QMenu)):
            menu.aboutToShow.emit()
            self._judge_menu(menu)

    def ask_menus(self, widget: QWidget) -> None:
        """Check the context menus of a widget at some positions."""
        for place in _grid(widget.rect(), 3):
            event = QContextMenuEvent(QContextMenuEvent.Reason.Mouse, place, widget.mapToGlobal(place))
            QApplication.sendEvent(widget, event)
            QApplication.processEvents()
            while (popup := QApplication.activePopupWidget()) is not None:
                for menu in (popup, *popup.findChildren(QMenu)):
                    if isinstance(menu, QMenu):
                        self._judge_menu(menu)
                popup.close()

    def hover(self, widget: QWidget) -> None:
        """Move the mouse over a widget that describes what is under the pointer."""
        no = Qt.MouseButton.NoButton
        for place in _grid(widget.rect(), 12):
            local, screen = QPointF(place), QPointF(widget.mapToGlobal(place))
            QApplication.sendEvent(
                widget, QMouseEvent(QEvent.Type.MouseMove, local, screen, no, no, Qt.KeyboardModifier.NoModifier)
            )
            if widget.toolTip():
                self.rest(widget, place)

    def _places(self, widget: QWidget) -> Iterator[QPoint]:
        """Yield the positions of a widget at which a tool tip may appear."""
        if "<img" in widget.toolTip():
            yield widget.rect().center()
        elif any(
            "event" in vars(kind) for kind in type(widget).__mro__ if kind.__module__.startswith(("widgets", "app."))
        ):
            yield from _grid(widget.rect(), PLACES)
        view = widget.parentWidget()
        if isinstance(view, QAbstractItemView) and view.viewport() is widget and view.model() is not None:
            model = view.model()
            for row in range(min(model.rowCount(view.rootIndex()), 12)):
                for column in range(view.horizontalHeader().count() if isinstance(view, QTableView) else 1):
                    index = model.index(row, column, view.rootIndex())
                    self._note(str(index.data()))
                    yield view.visualRect(index).center()

    def rest(self, widget: QWidget, place: QPoint) -> None:
        """Show a tool tip and check it."""
        QApplication.sendEvent(widget, QHelpEvent(QEvent.Type.ToolTip, place, widget.mapToGlobal(place)))
        if not QToolTip.isVisible():
            return
        self._note(QToolTip.text())
        for tip in QApplication.topLevelWidgets():
            if isinstance(tip, QLabel) and tip.metaObject().className() == "QTipLabel":
                self._judge_label(tip)
        self._opened(f"tip of {_described(widget)}")
        QToolTip.hideText()

    def _note(self, *texts: str) -> None:
        for text in texts:
            self.seen.update(FIELD.findall(text))

    def _key(self, widget: QWidget, key: QKeySequence) -> None:
        if key == KEY:
            self._fault(f"{_described(widget)}: a name became a key")

    def _opened(self, what: str) -> None:
        for name in self.canary.opened():
            self._fault(f"{what}: {name} was opened")

    def _fault(self, what: str) -> None:
        text = f"{self._state}: {what}"
        if text not in self.faults:
            self.faults.append(text)


def _described(widget: QWidget) -> str:
    return f"{type(widget).__name__} {widget.objectName()}"


def _grid(room: QRect, count: int) -> Iterator[QPoint]:
    for row in range(count):
        for column in range(count):
            x, y = (2 * column + 1) * room.width() // (2 * count), (2 * row + 1) * room.height() // (2 * count)
            yield room.topLeft() + QPoint(x, y)
