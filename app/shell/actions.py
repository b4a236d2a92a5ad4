"""The action table, from which menus, palette, tool tips and shortcuts are made."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, Final

from PySide6.QtCore import QEvent, QObject, Qt, QTimer, Signal
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QApplication, QWidget

from app.editor.session import Session
from app.editor.settings import Settings
from app.editor.translated import tr
from app.shell.action import ActionRow, without_dots
from widgets.common.actions import TABLE
from widgets.common.clicks import on_click
from widgets.common.icons import icon
from widgets.common.plain import verbatim
from widgets.common.text import message_text

CONTEXTS: Final = {
    "window": "context.everywhere",
    **{id: f"context.in_{id}" for id in ("timeline", "viewport", "players", "dancers", "inspector")},
}


@cache
def sequences(keys: str) -> tuple[QKeySequence, ...]:
    """Return the key sequences of a shortcut text, which separates them by ``;``."""
    portable = QKeySequence.SequenceFormat.PortableText
    return tuple(QKeySequence.fromString(part.strip(), portable) for part in keys.split(";") if part.strip())


@cache
def written(keys: str) -> frozenset[str]:
    """Return the key sequences of a shortcut text in Qt's normalised form."""
    return frozenset(sequence.toString() for sequence in sequences(keys))


class RowAction(QAction):
    """An action of Qt made from a row of the action table, with the row's text, icon and state.

    Qt sends language changes (``QEvent.LanguageChange``) only to widgets, so the table notifies its actions.

    Parameters
    ----------
    table : ActionTable
        Table that knows the user's shortcuts and the session or editor that the row's functions take.
    """

    def __init__(self, row: ActionRow[Any], table: ActionTable) -> None:
        super().__init__(table)
        self.row, self._table = row, table
        self.setObjectName(row.id)
        self.setCheckable(row.checked is not None)
        self.setMenuRole(QAction.MenuRole.NoRole)
        if row.context != "window":
            self.setShortcutContext(Qt.ShortcutContext.WidgetWithChildrenShortcut)
        on_click(self, self._run)
        self.apply_theme()
        self.retranslate()

    def _run(self) -> None:
        about = self._table.about(self.row)
        if self.row.checked is None:
            self.row.run(about)
        else:
            self.row.run(about, self.isChecked())
        self._table.refresh_soon()

    def refresh(self, answers: dict[Callable[[Any], bool], bool]) -> None:
        """Update whether the action is available and checked.

        Parameters
        ----------
        answers : dict
            Cache of results, since many rows share a condition.
        """
        row, about = self.row, self._table.about(self.row)
        if about is None:
            self.setEnabled(False)
            return
        if row.enabled is not None and row.enabled not in answers:
            answers[row.enabled] = row.enabled(about)
        makes_sense = row.enabled is None or answers[row.enabled]
        self.setEnabled(makes_sense)
        if row.hides:
            self.setVisible(makes_sense)
        if row.checked is not None:
            self.setChecked(row.checked(about))
        if row.step is not None:
            self._name()

    def _name(self) -> None:
        text, step = self.row.text, self.row.step(self._table.about(self.row)) if self.row.step is not None else None
        if step is not None:
            text = tr("action_table.text").format(action=text, step=verbatim(message_text(step)))
        self.setText(text)

    def retranslate(self) -> None:
        """Update text and tool tip."""
        native = QKeySequence.SequenceFormat.NativeText
        text = without_dots(self.row.text)
        keys = ", ".join(sequence.toString(native) for sequence in sequences(self._table.keys(self.row.id)))
        self._name()
        self.setIconText(text)
        self.setToolTip(f"{text} ({keys})" if keys else text)

    def apply_theme(self) -> None:
        """Update the icon in the theme's colours."""
        if self.row.icon:
            self.setIcon(icon(self.row.icon, self._table.session.tokens))

    # Qt overrides

    def event(self, event: QEvent) -> bool:
        """Ignore shortcuts while a menu or list is open.

        Qt would pass the keys to the panel behind the menu, where Delete would remove a player.
        """
        if event.type() == QEvent.Type.Shortcut and QApplication.activePopupWidget() is not None:
            return True
        return super().event(event)


class ActionTable(QObject):
    """The table of the editor's actions, which makes a Qt action of each row.

    Parameters
    ----------
    session : Session
        Parent of the table; `widgets.common.actions` finds the Qt actions among its children.
    settings : Settings
        Settings with the user's shortcuts.
    rows : sequence of ActionRow
        Rows of the table; those whose functions take the editor are unavailable before `begin`.

    Signals
    -------
    shortcuts_changed()
        The user changed the shortcuts of an action.
    context_changed(str)
        The keyboard focus moved to the panel of this name, or to no panel (``"window"``).
    """

    shortcuts_changed = Signal()
    context_changed = Signal(str)

    def __init__(self, session: Session, settings: Settings, rows: Sequence[ActionRow[Any]]) -> None:
        super().__init__(session)
        self.session = session
        self.settings = settings
        self._editor: object | None = None
        self.rows = {row.id: row for row in rows}
        self._context = "window"
        self.setObjectName(TABLE)
        self.actions = {row.id: RowAction(row, self) for row in rows}
        self._soon = QTimer(self, singleShot=True, interval=0)
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
            session.folded_changed,
            session.groups_players_changed,
            session.language_changed,
            session.theme_changed,
            session.pitch_display.changed,
            session.listening.changed,
            session.recording.changed,
            session.streaming.changed,
            session.video.changed,
            session.viewport.changed,
        ):
            signal.connect(self.refresh_soon)
        session.language_changed.connect(self._retranslate)
        session.theme_changed.connect(self._apply_theme)
        session.playhead_changed.connect(self._playhead_moved)
        application = QApplication.instance()
        if isinstance(application, QApplication):
            application.focusChanged.connect(self._focus_moved)
        self._give_shortcuts()

    def begin(self, editor: object) -> None:
        """Set the editor that is passed to the functions of `EditorAction` rows, and make these rows available."""
        self._editor = editor
        self.refresh()

    def about(self, row: ActionRow[Any]) -> object | None:
        """Return the session or editor that a row's functions take; None if the editor does not exist yet."""
        return self._editor if row.about_editor else self.session

    def attach(self, context: str, widget: QWidget) -> None:
        """Enable the shortcuts of a context while a widget has the keyboard focus."""
        widget.addActions([self.actions[row.id] for row in self.rows.values() if row.context == context])

    def _retranslate(self) -> None:
        for action in self.actions.values():
            action.retranslate()

    def _apply_theme(self) -> None:
        for action in self.actions.values():
            action.apply_theme()

    # Shortcuts

    def keys(self, action_id: str) -> str:
        """Return the shortcuts of an action as text: the user's, else the default ones."""
        own = self.settings.shortcut(action_id)
        return self.rows[action_id].shortcut if own is None else own

    def set_keys(self, action_id: str, keys: str | None) -> None:
        """Set the shortcuts of an action; None restores the default ones."""
        if keys == self.rows[action_id].shortcut:
            keys = None
        self.settings.set_shortcut(action_id, keys)
        self._give_shortcuts()
        self.actions[action_id].retranslate()
        self.shortcuts_changed.emit()

    def conflicts(self, action_id: str, keys: str) -> tuple[str, ...]:
        """Return the ids of other actions in the same scope that use one of the shortcuts ``keys``."""
        requested = written(keys)
        context = self.rows[action_id].context
        return tuple(
            other.id
            for other in self.rows.values()
            if other.id != action_id and other.context == context and requested & written(self.keys(other.id))
        )

    def _focus_moved(self, before: QWidget | None, now: QWidget | None) -> None:
        context, widget = "window", now
        while widget is not None:
            # Tools of a panel may be in the title of its dock.
            name = widget.objectName().removeprefix("dock_")
            if name in CONTEXTS:
                context = name
                break
            widget = widget.parentWidget()
        if context != self._context:
            self._context = context
            self._give_shortcuts()
            self.context_changed.emit(context)

    def _give_shortcuts(self) -> None:
        """Decide between actions of a panel and of the window that have the same shortcut.

        The panel's action gets the shortcut while the panel has the keyboard focus, the window's action otherwise,
        since Qt would activate neither. The same is done for parts of panels.
        """
        keys = {row.id: self.keys(row.id) for row in self.rows.values()}
        of_context: dict[str, set[str]] = {}
        for row in self.rows.values():
            of_context.setdefault(row.context, set()).update(written(keys[row.id]))
        here = of_context.get(self._context, set()) if self._context != "window" else set()
        everywhere = of_context.get("window", set())
        for row in self.rows.values():
            taken = here if row.context == "window" else set() if row.context == self._context else everywhere | here
            requested = [sequence for sequence in sequences(keys[row.id]) if sequence.toString() not in taken]
            action = self.actions[row.id]
            if action.shortcuts() != requested:
                action.setShortcuts(requested)

    # State

    def refresh_soon(self, *changes: object) -> None:
        """Update all rows after the current event."""
        if not self._soon.isActive():
            self._soon.start()

    def _playhead_moved(self, playhead_s: float) -> None:
        if not self.session.playing:
            self.refresh_soon()

    def refresh(self) -> None:
        """Update the availability and checked state of all rows."""
        answers: dict[Callable[[Any], bool], bool] = {}
        for action in self.actions.values():
            action.refresh(answers)
