"""The one table of actions: menus, palette, tool tips and shortcuts are made from it."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Sequence
from functools import partial
from typing import Final

from PySide6.QtCore import QEvent, QObject, Qt, QTimer, Signal
from PySide6.QtGui import QAction, QFocusEvent, QKeyEvent, QKeySequence
from PySide6.QtWidgets import QApplication, QMenu, QMenuBar, QWidget
from shiboken6 import isValid

from app.editor.session import Session
from app.editor.settings import Settings
from app.editor.translated import tr
from app.shell.action import Action
from widgets.common.icons import icon
from widgets.common.plain import verbatim
from widgets.common.text import message_text

SUBJECTS: Final = (
    "file",
    "exchange",
    "stream",
    "edit",
    "notes",
    "fingerings",
    "events",
    "beat",
    "players",
    "dancers",
    "timeline",
    "viewport",
    "playback",
    "record",
    "takes",
    "generate",
    "problems",
    "characters",
    "application",
)
"""Modules of `app.shell.commands`, in the order in which their rows stand in a menu."""

MENUS: Final = {
    "File": "menu.file",
    "Edit": "menu.edit",
    "View": "menu.view",
    "Play": "menu.play",
    "Record": "menu.record",
    "Counting": "menu.count_in",
    "Generate": "menu.generate",
    "Export": "menu.export",
    "Help": "menu.help",
    "Notes": "menu.notes",
    "Fingering": "menu.fingering",
    "Events": "menu.breaths_and_acting",
    "Beat": "menu.felt_beat",
    "Gesture": "menu.add_gesture",
    "Select": "menu.select",
    "Tool": "menu.tool",
    "Players": "menu.players",
    "Takes": "menu.takes",
    "Go": "menu.go",
    "Recording": "menu.recording",
    "Sound": "menu.sound",
    "Speed": "menu.speed",
    "Viewport": "menu.viewport",
    "Panels": "menu.panels",
    "Theme": "menu.theme",
    "Language": "menu.language",
    "Pitch": "menu.pitch",
    "Time": "menu.time",
    "Recent": "menu.open_recent",
}
"""Names of menus and of those within them; a path such as ``Edit/Notes`` is made of the keys."""

BEFORE_LINE: Final = frozenset(
    (
        *("file.save", "file.import_midi", "file.piece_settings", "file.close", "file.quit"),
        *("application.preferences", "application.about"),
    )
)
"""Rows that a line goes before; another line stands wherever the subject of the rows changes."""

FILE_ORDER: Final = (
    "file.new",
    "file.open",
    "file.open_example",
    "file.open_danced_example",
    "file.save",
    "file.save_as",
    "file.import_midi",
    "file.reimport",
    "file.reimport_other",
    "file.add_audio",
    "file.add_character",
    "file.export_midi",
    "file.piece_settings",
    "file.close",
    "file.quit",
)
"""How the rows of the first menu stand, whichever module they are from."""

CONTEXTS: Final = {
    "window": "context.everywhere",
    "timeline": "context.in_timeline",
    "viewport": "context.in_viewport",
    "players": "context.in_players",
    "dancers": "context.in_dancers",
    "inspector": "context.in_inspector",
}


def rows() -> tuple[Action, ...]:
    """Every row of the table."""
    found: list[Action] = []
    place = {action_id: number for number, action_id in enumerate(FILE_ORDER)}
    for subject in SUBJECTS:
        found += importlib.import_module(f"app.shell.commands.{subject}").ACTIONS
    return tuple(sorted(found, key=lambda row: place.get(row.id, len(place))))


def sequences(keys: str) -> list[QKeySequence]:
    """Shortcuts as a row has them, ``;`` between several."""
    portable = QKeySequence.SequenceFormat.PortableText
    return [QKeySequence.fromString(part.strip(), portable) for part in keys.split(";") if part.strip()]


def plain(text: str) -> str:
    """An action's text without dots and marks."""
    return text.replace("&", "").removesuffix("...").removesuffix("…")


class ActionTable(QObject):
    """The rows as actions of Qt.

    Parameters
    ----------
    session : Session
        Gets the actions by id.
    settings : Settings
        Knows the user's own shortcuts.
    table : sequence of Action

    Signals
    -------
    shortcuts_changed()
        Some action has another shortcut.
    """

    shortcuts_changed = Signal()

    def __init__(self, session: Session, settings: Settings, table: Sequence[Action]) -> None:
        super().__init__(session)
        self.session = session
        self.settings = settings
        self.rows = {row.id: row for row in table}
        self.actions: dict[str, QAction] = {}
        self._context = "window"
        for row in table:
            self.actions[row.id] = self._action(row)
        session.actions = self.actions
        self._soon = QTimer(self)
        self._soon.setSingleShot(True)
        self._soon.setInterval(0)
        self._soon.timeout.connect(self.refresh)
        for signal in (
            session.changed,
            session.performance_changed,
            session.problems_changed,
            session.selection_changed,
            session.players_changed,
            session.dancer_changed,
            session.playing_changed,
            session.loop_changed,
            session.grid_changed,
            session.time_display_changed,
            session.follow_changed,
            session.pitch_display.changed,
            session.listening.changed,
            session.recording.changed,
            session.streaming.changed,
            session.viewport.changed,
        ):
            signal.connect(self.refresh_soon)
        session.theme_changed.connect(self._apply_theme)
        session.playhead_changed.connect(self._playhead_moved)
        application = QApplication.instance()
        if isinstance(application, QApplication):
            application.focusChanged.connect(self._focus_moved)
        self._give_shortcuts()
        self._apply_theme()
        self.retranslate()

    def _action(self, row: Action) -> QAction:
        action = QAction(self)
        action.setObjectName(row.id)
        action.setCheckable(row.checked is not None)
        action.setMenuRole(QAction.MenuRole.NoRole)
        if row.context != "window":
            action.setShortcutContext(Qt.ShortcutContext.WidgetWithChildrenShortcut)
        action.setShortcuts(sequences(self.keys(row.id)))
        action.triggered.connect(partial(self._run, row))
        return action

    def _run(self, row: Action, *_reported: bool) -> None:
        if row.checked is None:
            row.run(self.session)
        else:
            # PySide does not pass the state to a partial of a method.
            row.run(self.session, self.actions[row.id].isChecked())
        self.refresh_soon()

    def attach(self, context: str, widget: QWidget) -> None:
        """Shortcuts of a context hold while the keyboard is in this widget."""
        widget.addActions([self.actions[row.id] for row in self.rows.values() if row.context == context])

    # Shortcuts

    def keys(self, action_id: str) -> str:
        """The shortcuts of an action as text."""
        own = self.settings.shortcut(action_id)
        return self.rows[action_id].shortcut if own is None else own

    def set_keys(self, action_id: str, keys: str | None) -> None:
        """Give an action other shortcuts; None: as they come."""
        if keys == self.rows[action_id].shortcut:
            keys = None
        self.settings.set_shortcut(action_id, keys)
        self._give_shortcuts()
        self.retranslate()
        self.shortcuts_changed.emit()

    def conflicts(self, action_id: str, keys: str) -> tuple[str, ...]:
        """Actions that one of these shortcuts would do as well, in the same place."""
        requested = {sequence.toString() for sequence in sequences(keys)}
        context = self.rows[action_id].context
        return tuple(
            other.id
            for other in self.rows.values()
            if other.id != action_id
            and other.context == context
            and requested & {sequence.toString() for sequence in sequences(self.keys(other.id))}
        )

    def _focus_moved(self, before: QWidget | None, now: QWidget | None) -> None:
        context, widget = "window", now
        while widget is not None:
            if widget.objectName() in CONTEXTS:
                context = widget.objectName()
                break
            widget = widget.parentWidget()
        if context != self._context:
            self._context = context
            self._give_shortcuts()

    def _give_shortcuts(self) -> None:
        """Where a panel and the window know the same shortcut, the panel that has the keyboard has it alone, and
        without the keyboard none of it: Qt would do neither. So it is with a part of a panel and the panel."""
        keys = {
            row.id: {sequence.toString() for sequence in sequences(self.keys(row.id))} for row in self.rows.values()
        }
        of_context: dict[str, set[str]] = {}
        for row in self.rows.values():
            of_context.setdefault(row.context, set()).update(keys[row.id])
        here = of_context.get(self._context, set()) if self._context != "window" else set()
        everywhere = of_context.get("window", set())
        for row in self.rows.values():
            taken = here if row.context == "window" else set() if row.context == self._context else everywhere | here
            requested = [sequence for sequence in sequences(self.keys(row.id)) if sequence.toString() not in taken]
            action = self.actions[row.id]
            if action.shortcuts() != requested:
                action.setShortcuts(requested)

    # State and texts

    def refresh_soon(self, *changes: object) -> None:
        """Ask all rows again once whatever happens now is over."""
        if not self._soon.isActive():
            self._soon.start()

    def _playhead_moved(self, playhead_s: float) -> None:
        if not self.session.playing:
            self.refresh_soon()

    def refresh(self) -> None:
        """Ask every row whether it makes sense now, and whether it is on."""
        answers: dict[Callable[[Session], bool], bool] = {}
        for row in self.rows.values():
            action = self.actions[row.id]
            if row.enabled is not None:
                if row.enabled not in answers:
                    # Many rows ask the same question.
                    answers[row.enabled] = row.enabled(self.session)
                action.setEnabled(answers[row.enabled])
            if row.checked is not None:
                action.setChecked(row.checked(self.session))
        self._name_steps()

    def _name_steps(self) -> None:
        """What undo and redo would do."""
        document = self.session.document
        for action_id, steps in (("edit.undo", document.done), ("edit.redo", document.undone)):
            text = self.text(action_id)
            if steps:
                step = verbatim(message_text(steps[-1].name))
                text = tr("action_table.text").format(action=text, step=step)
            self.actions[action_id].setText(text)

    def text(self, action_id: str) -> str:
        """An action's text in the language of the editor."""
        return tr(f"action.{action_id}")

    def place(self, action_id: str) -> str:
        """Where an action stands in the menus, in the language of the editor; empty: nowhere."""
        return " › ".join(plain_menu(menu_text(key)) for key in self.rows[action_id].menu.split("/") if key)

    def retranslate(self) -> None:
        """Set all texts and tool tips anew."""
        native = QKeySequence.SequenceFormat.NativeText
        for row in self.rows.values():
            action, text = self.actions[row.id], self.text(row.id)
            action.setText(text)
            action.setIconText(plain(text))
            keys = ", ".join(sequence.toString(native) for sequence in sequences(self.keys(row.id)))
            action.setToolTip(f"{plain(text)} ({keys})" if keys else plain(text))
        self._name_steps()

    def _apply_theme(self) -> None:
        for row in self.rows.values():
            if row.icon:
                self.actions[row.id].setIcon(icon(row.icon, self.session.tokens))


def menu_text(key: str) -> str:
    """Name of a menu in the language of the editor."""
    return tr(MENUS[key])


def plain_menu(text: str) -> str:
    """A menu's name without the mark of its key: ``&File``, ``ファイル(&F)``."""
    if text.endswith(")") and "(&" in text:
        text = text[: text.rindex("(&")]
    return text.replace("&", "")


def menu_with_keys(keys: str) -> str:
    """Name of the menu that one of these shortcuts opens in the language of the editor; empty: none."""
    requested = {sequence.toString() for sequence in sequences(keys)}
    titles = map(menu_text, MENUS)
    return next((plain_menu(title) for title in titles if QKeySequence.mnemonic(title).toString() in requested), "")


class Menus(QObject):
    """The menus of a menu bar, made from a table.

    Parameters
    ----------
    bar : QMenuBar
    table : ActionTable
    """

    def __init__(self, bar: QMenuBar, table: ActionTable) -> None:
        super().__init__(bar)
        self._bar = bar
        self.menus: dict[str, QMenu] = {}
        used = {row.menu.split("/")[0] for row in table.rows.values()}
        for key in MENUS:
            if key in used:
                self.menu(key)
        last: dict[str, str] = {}
        for row in table.rows.values():
            if not row.menu:
                continue
            menu = self.menu(row.menu)
            subject = row.id.split(".")[0]
            if menu.actions() and (row.id in BEFORE_LINE or last.get(row.menu, subject) != subject):
                menu.addSeparator()
            last[row.menu] = subject
            menu.addAction(table.actions[row.id])
        for menu in self.menus.values():
            menu.aboutToShow.connect(table.refresh)
        self.retranslate()

    def menu(self, path: str) -> QMenu:
        """The menu at a path, made if it is not there."""
        if path not in self.menus:
            above, _, _key = path.rpartition("/")
            parent = self.menu(above) if above else self._bar
            menu = QMenu(parent)
            menu.setObjectName(f"menu_{path.replace('/', '_').lower()}")
            menu.setToolTipsVisible(False)
            parent.addMenu(menu)
            self.menus[path] = menu
        return self.menus[path]

    def retranslate(self) -> None:
        """Set the names of all menus."""
        for path, menu in self.menus.items():
            menu.setTitle(menu_text(path.rpartition("/")[2]))


class KeyboardButtons(QObject):
    """Space plays; but who came to a button with the keyboard presses it with Space.

    A button that was clicked keeps the keyboard too, and there Space goes on to play. Watched is only what has the
    keyboard: a filter of the whole application would have Python asked a hundred times in every frame.

    Parameters
    ----------
    application : QApplication
    parent : QObject
    """

    def __init__(self, application: QApplication, parent: QObject) -> None:
        super().__init__(parent)
        self._watched: QWidget | None = None
        self._reason: Qt.FocusReason | None = None
        """Why the keyboard leaves what is watched."""
        self._reached = False
        application.focusChanged.connect(self._focus_moved)

    def _focus_moved(self, before: QWidget | None, now: QWidget | None) -> None:
        self._reached = now is not None and self._reason in _BY_KEYS
        self._reason = None
        if self._watched is not None and isValid(self._watched):
            self._watched.removeEventFilter(self)
        # Where nothing has the keyboard, its keys go to the window.
        self._watched = now if now is not None else QApplication.activeWindow()
        if self._watched is not None:
            self._watched.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Watch how the keyboard moves."""
        kind = event.type()
        if kind == QEvent.Type.FocusOut and isinstance(event, QFocusEvent):
            self._reason = event.reason()
        elif kind == QEvent.Type.KeyPress and isinstance(event, QKeyEvent):
            tab = event.key() in (Qt.Key.Key_Tab, Qt.Key.Key_Backtab)
            self._reason = Qt.FocusReason.TabFocusReason if tab else None
        elif (
            kind == QEvent.Type.ShortcutOverride
            and self._reached
            and isinstance(event, QKeyEvent)
            and event.key() == Qt.Key.Key_Space
            and _is_pressed_by_space(watched)
        ):
            event.accept()
        return False


_BY_KEYS = (Qt.FocusReason.TabFocusReason, Qt.FocusReason.BacktabFocusReason)


def _is_pressed_by_space(watched: QObject) -> bool:
    return watched.inherits("QAbstractButton") or watched.inherits("QComboBox")
