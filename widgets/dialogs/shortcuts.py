"""List of keyboard shortcuts with search, change and reset; conflicts are reported immediately."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeySequence
from PySide6.QtWidgets import QAbstractItemView, QKeySequenceEdit, QLineEdit, QTreeWidgetItem, QWidget

from app.editor.session import Session
from widgets.common.controls import Button, Caption, ColumnList, Retranslated, named, wrapped
from widgets.common.layouts import in_column, in_row
from widgets.common.plain import Label

_TEXT, _PLACE, _KEYS, _CONTEXT = range(4)


@dataclass(frozen=True)
class ShortcutRow:
    """An action in the table of shortcuts.

    Attributes
    ----------
    text, place, context : str
        Name of the action, its menu, and the part of the window where its shortcut works; in the editor's language.
    keys, default : str
        Present and default shortcuts: portable text, ``;`` between several.
    """

    id: str
    text: str
    place: str
    context: str
    keys: str
    default: str


class ShortcutsPage(Retranslated, QWidget):
    """The page of the shortcuts.

    Parameters
    ----------
    rows : callable
        Returns the present rows.
    conflicts : callable
        Returns the ids of actions that already have keys, given an action id and these keys.
    menu_of : callable
        Returns the name of the menu that keys open; empty for none.

    Signals
    -------
    chosen(str, object)
        An action gets these keys; None for the default.
    """

    chosen = Signal(str, object)

    def __init__(
        self,
        session: Session,
        rows: Callable[[], tuple[ShortcutRow, ...]],
        conflicts: Callable[[str, str], tuple[str, ...]],
        menu_of: Callable[[str], str],
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setObjectName("shortcuts_page")
        self._session, self._rows_now, self._conflicts = session, rows, conflicts
        self._menu_of = menu_of
        self._rows: dict[str, ShortcutRow] = {}
        self.search = self.texted(named(QLineEdit(), "shortcut_search"), placeholder="shortcuts_page.search_field")
        self.search.setClearButtonEnabled(True)
        self.search.textChanged.connect(self._filter)
        columns = ("shortcuts_page.action", "shortcuts_page.menu", "shortcuts_page.keys", "shortcuts_page.works")
        self.list = ColumnList("shortcut_list", *columns, stretches=(_TEXT,))
        self.list.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.list.currentItemChanged.connect(self._choose)
        self._label = Caption("shortcuts_page.new_keys")
        self.edit = self.texted(named(QKeySequenceEdit(), "shortcut_edit"), name="shortcuts_page.new_keys")
        self.edit.setClearButtonEnabled(True)
        self.edit.setMaximumSequenceLength(1)
        self.edit.keySequenceChanged.connect(self._changed)
        self.all_back = Button("shortcuts_page.all_back_to_default", self._all_back, "shortcuts_all_back")
        self.back = Button("shortcuts_page.default", self._back, "shortcut_back")
        self.take = Button("shortcuts_page.remove_keys", self._take, "shortcut_take")
        self.give = Button("shortcuts_page.assign", self._give, "shortcut_give")
        self.reported = wrapped(named(Label(), "shortcut_status"))
        line = in_row(self._label, (self.edit, 1), self.give, self.take, self.back)
        bottom = in_row((self.reported, 1), self.all_back)
        in_column(self.search, (self.list, 1), line, bottom, of=self)
        self.retranslate()

    def retranslate(self) -> None:
        """Set texts and rows again after a change of language."""
        self._fill()

    def _fill(self) -> None:
        chosen = self._chosen()
        self.list.blockSignals(True)
        self.list.clear()
        self._rows = {row.id: row for row in self._rows_now()}
        current: QTreeWidgetItem | None = None
        items = []
        for row in self._rows.values():
            item = QTreeWidgetItem([row.text, row.place, native(row.keys), row.context])
            item.setData(_TEXT, Qt.ItemDataRole.UserRole, row.id)
            if row.keys != row.default:
                font = item.font(_KEYS)
                font.setBold(True)
                item.setFont(_KEYS, font)
            items.append(item)
            if chosen is not None and row.id == chosen.id:
                current = item
        # Added all at once, because columns are measured after each addition.
        self.list.addTopLevelItems(items)
        if current is not None:
            self.list.setCurrentItem(current)
        self.list.blockSignals(False)
        self._filter(self.search.text())
        self._choose()

    def _filter(self, text: str) -> None:
        requested = text.casefold().split()
        for place in range(self.list.topLevelItemCount()):
            item = self.list.topLevelItem(place)
            if item is not None:
                words = " ".join(item.text(column) for column in range(4)).casefold()
                item.setHidden(not all(word in words for word in requested))

    def choose(self, action_id: str) -> None:
        """Select the row of an action."""
        for place in range(self.list.topLevelItemCount()):
            item = self.list.topLevelItem(place)
            if item is not None and item.data(_TEXT, Qt.ItemDataRole.UserRole) == action_id:
                self.list.setCurrentItem(item)

    def _chosen(self) -> ShortcutRow | None:
        item = self.list.currentItem()
        return None if item is None else self._rows.get(item.data(_TEXT, Qt.ItemDataRole.UserRole))

    def _choose(self, *_: object) -> None:
        row = self._chosen()
        self.edit.blockSignals(True)
        self.edit.clear()
        self.edit.blockSignals(False)
        self.edit.setEnabled(row is not None)
        self.take.setEnabled(row is not None and bool(row.keys))
        self.back.setEnabled(row is not None and row.keys != row.default)
        self.all_back.setEnabled(any(other.keys != other.default for other in self._rows.values()))
        self._changed()

    def _keys(self) -> str:
        return self.edit.keySequence().toString(QKeySequence.SequenceFormat.PortableText)

    def _changed(self, *_: object) -> None:
        row, keys = self._chosen(), self._keys()
        taken = self._conflicts(row.id, keys) if row is not None and keys else ()
        menu = self._menu_of(keys) if keys else ""
        # Keys that open a menu can neither be assigned nor be taken from the menu here.
        self.give.setEnabled(row is not None and bool(keys) and not menu)
        names = ", ".join(self._rows[other].text for other in taken if other in self._rows)
        self.reported.setStyleSheet(f"color: {self._session.tokens.warning};")
        if menu:
            self.reported.setText(self.tr("shortcuts_page.opens_menu").format(menu=menu))
        elif names:
            self.reported.setText(self.tr("shortcuts_page.used_by_assigning_takes_it").format(names=names))
        else:
            self.reported.clear()

    def _give(self) -> None:
        row, keys = self._chosen(), self._keys()
        if row is None or not keys:
            return
        for other in self._conflicts(row.id, keys):
            kept = [part for part in self._rows[other].keys.split(";") if part.strip() != keys]
            self.chosen.emit(other, ";".join(kept))
        self.chosen.emit(row.id, keys)
        self._fill()

    def _take(self) -> None:
        row = self._chosen()
        if row is not None:
            self.chosen.emit(row.id, "")
            self._fill()

    def _back(self) -> None:
        row = self._chosen()
        if row is None:
            return
        for other in self._conflicts(row.id, row.default):
            requested = {part.strip() for part in row.default.split(";")}
            kept = [part for part in self._rows[other].keys.split(";") if part.strip() not in requested]
            self.chosen.emit(other, ";".join(kept))
        self.chosen.emit(row.id, None)
        self._fill()

    def _all_back(self) -> None:
        for row in self._rows.values():
            if row.keys != row.default:
                self.chosen.emit(row.id, None)
        self._fill()


def native(keys: str) -> str:
    """Convert shortcuts from the stored portable text to the system's notation."""
    portable, own = QKeySequence.SequenceFormat.PortableText, QKeySequence.SequenceFormat.NativeText
    parts = (part.strip() for part in keys.split(";"))
    return ", ".join(QKeySequence.fromString(part, portable).toString(own) for part in parts if part)
