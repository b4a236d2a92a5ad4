"""The list of keyboard shortcuts: searched, changed, given back; a conflict is reported where it is made."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QKeySequence
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHBoxLayout,
    QHeaderView,
    QKeySequenceEdit,
    QLineEdit,
    QPushButton,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.editor.session import Session
from widgets.common.plain import Label

_TEXT, _PLACE, _KEYS, _CONTEXT = range(4)


@dataclass(frozen=True)
class ShortcutRow:
    """An action and its shortcuts.

    Attributes
    ----------
    id : str
    text, place, context : str
        What it does, where it stands in the menus, where its shortcut holds; in the language of the editor.
    keys, default : str
        As they are and as they come: portable text, ``;`` between several.
    """

    id: str
    text: str
    place: str
    context: str
    keys: str
    default: str


class ShortcutsPage(QWidget):
    """The page of the shortcuts.

    Parameters
    ----------
    session : Session
    rows : callable
        Gives the rows as they are now.
    conflicts : callable
        Action id and keys to the ids of actions that have them already.
    menu_of : callable
        Keys to the name of the menu that they open; empty: none.

    Signals
    -------
    chosen(str, object)
        An action should have these keys; None: as it comes.
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
        self.search = QLineEdit()
        self.search.setObjectName("shortcut_search")
        self.search.setClearButtonEnabled(True)
        self.search.textChanged.connect(self._filter)
        self.list = QTreeWidget()
        self.list.setObjectName("shortcut_list")
        self.list.setColumnCount(4)
        self.list.setRootIsDecorated(False)
        self.list.setUniformRowHeights(True)
        self.list.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.list.currentItemChanged.connect(self._choose)
        header = self.list.header()
        header.setStretchLastSection(False)
        header.setSectionResizeMode(_TEXT, QHeaderView.ResizeMode.Stretch)
        for column in (_PLACE, _KEYS, _CONTEXT):
            header.setSectionResizeMode(column, QHeaderView.ResizeMode.ResizeToContents)
        self._label = Label()
        self.edit = QKeySequenceEdit()
        self.edit.setObjectName("shortcut_edit")
        self.edit.setClearButtonEnabled(True)
        self.edit.setMaximumSequenceLength(1)
        self.edit.keySequenceChanged.connect(self._changed)
        self.give, self.take, self.back, self.all_back = (QPushButton() for _ in range(4))
        self.give.setObjectName("shortcut_give")
        self.take.setObjectName("shortcut_take")
        self.back.setObjectName("shortcut_back")
        self.all_back.setObjectName("shortcuts_all_back")
        for button in (self.give, self.take, self.back, self.all_back):
            # Enter in the list or the search is no answer.
            button.setAutoDefault(False)
        self.give.clicked.connect(self._give)
        self.take.clicked.connect(self._take)
        self.back.clicked.connect(self._back)
        self.all_back.clicked.connect(self._all_back)
        self.reported = Label()
        self.reported.setObjectName("shortcut_status")
        self.reported.setWordWrap(True)
        line = QHBoxLayout()
        line.addWidget(self._label)
        line.addWidget(self.edit, 1)
        line.addWidget(self.give)
        line.addWidget(self.take)
        line.addWidget(self.back)
        bottom = QHBoxLayout()
        bottom.addWidget(self.reported, 1)
        bottom.addWidget(self.all_back)
        page = QVBoxLayout(self)
        page.addWidget(self.search)
        page.addWidget(self.list, 1)
        page.addLayout(line)
        page.addLayout(bottom)
        self.retranslate()

    def retranslate(self) -> None:
        """Set the texts and the rows anew."""
        self.search.setPlaceholderText(self.tr("shortcuts_page.search_actions_or_keys"))
        self.list.setHeaderLabels(
            [
                self.tr("shortcuts_page.action"),
                self.tr("shortcuts_page.menu"),
                self.tr("shortcuts_page.keys"),
                self.tr("shortcuts_page.works"),
            ]
        )
        self._label.setText(self.tr("shortcuts_page.new_keys"))
        self.edit.setAccessibleName(self.tr("shortcuts_page.new_keys"))
        self.give.setText(self.tr("shortcuts_page.assign"))
        self.take.setText(self.tr("shortcuts_page.remove_keys"))
        self.back.setText(self.tr("shortcuts_page.default"))
        self.all_back.setText(self.tr("shortcuts_page.all_back_to_default"))
        self._fill()

    def _fill(self) -> None:
        chosen = self._chosen()
        self.list.blockSignals(True)
        self.list.clear()
        self._rows = {row.id: row for row in self._rows_now()}
        for row in self._rows.values():
            item = QTreeWidgetItem([row.text, row.place, native(row.keys), row.context])
            item.setData(_TEXT, Qt.ItemDataRole.UserRole, row.id)
            if row.keys != row.default:
                font = item.font(_KEYS)
                font.setBold(True)
                item.setFont(_KEYS, font)
            self.list.addTopLevelItem(item)
            if chosen is not None and row.id == chosen.id:
                self.list.setCurrentItem(item)
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
        """Go to the row of an action."""
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
        # What opens a menu would do neither: it cannot be given, and no one can take it from the menu here.
        self.give.setEnabled(row is not None and bool(keys) and not menu)
        names = ", ".join(self._rows[other].text for other in taken if other in self._rows)
        self.reported.setStyleSheet(f"color: {self._session.tokens.warning};")
        if menu:
            self.reported.setText(self.tr("shortcuts_page.opens_menu_choose_other_keys").format(menu=menu))
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

    def changeEvent(self, event: QEvent) -> None:
        """Another language."""
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)


def native(keys: str) -> str:
    """Shortcuts as this system writes them."""
    portable, own = QKeySequence.SequenceFormat.PortableText, QKeySequence.SequenceFormat.NativeText
    parts = (part.strip() for part in keys.split(";"))
    return ", ".join(QKeySequence.fromString(part, portable).toString(own) for part in parts if part)
