"""List of players with selection, folding by section and reordering."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QItemSelection, QItemSelectionModel, QPoint, Qt, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QAbstractItemView, QWidget

from app.editor.session import Session
from widgets.players.ordered_list import OrderedList
from widgets.players.player_delegate import ARROW_PX, PlayerDelegate
from widgets.players.player_rows import PlayerModel, PlayerRow, Row, SectionRow

_FLAGS = QItemSelectionModel.SelectionFlag
_FOLDING = {Qt.Key.Key_Left: True, Qt.Key.Key_Right: False}


class PlayerList(OrderedList):
    """List of players: click, Ctrl and Shift select; drag or Alt with the arrows reorders; F2 or a double click
    renames.

    A section's header represents all its players: a click selects them, a drag moves them before another section. Its
    arrow, a double click, Left and Right fold it; Shift and a click on the arrow fold every section.

    Signals
    -------
    mute_clicked(object), solo_clicked(object)
        The user clicked the button of these players (tuple of str): one, or all of a section.
    arm_clicked(str)
        The user clicked the record-arm mark of the player with this id.
    chosen(object)
        The user selected the players with these ids (tuple of str); the first becomes active.
    ordered(object)
        The user reordered the players of a section (tuple of str, in the new order).
    folded(object, bool)
        The user folded (True) or unfolded the sections with these ids (tuple of str).
    """

    mute_clicked = Signal(object)
    solo_clicked = Signal(object)
    arm_clicked = Signal(str)
    chosen = Signal(object)
    ordered = Signal(object)
    folded = Signal(object, bool)

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(session, parent)
        self.rows = PlayerModel(self)
        self._delegate = PlayerDelegate(session, self)
        self._showing = False
        self._searched = ""
        self._taken_number = -1
        """The row that a drag or a key takes along."""
        self.setModel(self.rows)
        self.setItemDelegate(self._delegate)
        self.setUniformItemSizes(False)
        self.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.selectionModel().selectionChanged.connect(self._selected)
        session.recording.changed.connect(self.viewport().update)

    def height_of_rows(self) -> int:
        """Return the height of the list in pixels at which no row is scrolled out of view."""
        shown = [number for number in range(self.rows.rowCount()) if not self.isRowHidden(number)]
        return sum(max(self.sizeHintForRow(number), 0) for number in shown) + 2 * self.frameWidth()

    def show_rows(self, rows: Sequence[Row]) -> None:
        """Show players and sections as rows, with the selection."""
        section = self.rows.section_at(self.currentIndex().row())
        self._showing = True
        self.rows.show_rows(rows)
        header = None if section is None else self.rows.number(section.id)
        if header is not None:
            # The focus stays on a header that has moved.
            self.selectionModel().setCurrentIndex(self.rows.index(header), _FLAGS.NoUpdate)
        self._showing = False
        self._hide_rows()
        self.show_selection()

    def search(self, text: str) -> None:
        """Show only the players whose name or instrument contains a text, ignoring case and folding."""
        self._searched = text.strip().casefold()
        self._hide_rows()

    @property
    def found(self) -> tuple[str, ...]:
        """Return the ids of the players that the search shows."""
        return tuple(row.id for row in self.rows.players if row.is_found(self._searched))

    def _hide_rows(self) -> None:
        found, folded = {*self.found}, False
        for number, row in enumerate(self.rows.rows):
            if isinstance(row, SectionRow):
                folded = row.folded and not self._searched
                self.setRowHidden(number, found.isdisjoint(row.player_ids))
            else:
                self.setRowHidden(number, folded or row.id not in found)

    def show_selection(self) -> None:
        """Show the session's selected players."""
        numbers = [self.rows.number(player_id) for player_id in self._session.players]
        requested = [number for number in numbers if number is not None]
        self._showing = True
        selection = QItemSelection()
        for number in requested:
            selection.select(self.rows.index(number), self.rows.index(number))
        model = self.selectionModel()
        if requested and self.currentIndex().row() != requested[0] and not self._is_on_header_of_selected():
            model.setCurrentIndex(self.rows.index(requested[0]), _FLAGS.NoUpdate)
        model.select(selection, _FLAGS.ClearAndSelect)
        self._showing = False
        self.viewport().update()

    def rename_current(self) -> None:
        """Open the field for the active player's name, unfolding its section."""
        number = self.rows.number(self._session.players[0]) if self._session.players else None
        if number is None:
            return
        header = self.rows.header_of(number)
        section = None if header is None else self.rows.section_at(header)
        if section is not None and section.folded:
            self._fold(section, False)
        self.selectionModel().setCurrentIndex(self.rows.index(number), _FLAGS.NoUpdate)
        super().rename_current()

    def _is_on_header_of_selected(self) -> bool:
        """Return whether the keyboard focus is on the header of the active player's section."""
        section = self.rows.section_at(self.currentIndex().row())
        return section is not None and not {*self._session.players[:1]}.isdisjoint(section.player_ids)

    def _selected(self) -> None:
        if self._showing:
            return
        rows = self.rows.rows
        numbers = self._selected_numbers()
        current = self.currentIndex().row()
        if current in numbers:
            numbers.remove(current)
            numbers.insert(0, current)
        self.chosen.emit(tuple(rows[number].id for number in numbers))

    def _choose_section(self, section: SectionRow, modifiers: Qt.KeyboardModifier) -> None:
        """Select all players of a section; with Ctrl toggle it, with Shift add it."""
        before, own = self._session.players, section.player_ids
        others = tuple(id for id in before if id not in own)
        if modifiers & Qt.KeyboardModifier.ControlModifier and {*own} <= {*before}:
            self.chosen.emit(others or own)
        elif modifiers & (Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier):
            self.chosen.emit((*before, *(id for id in own if id not in before)))
        else:
            self.chosen.emit(own)

    def _fold(self, section: SectionRow, folded: bool, everyone: bool = False) -> None:
        all_sections = [row for row in self.rows.rows if isinstance(row, SectionRow)]
        self.folded.emit(tuple(row.id for row in (all_sections if everyone else [section])), folded)

    # Order

    def _carried(self) -> list[int]:
        """Return the indices of the dragged rows: those of the dragged section, or the dragged row and all other
        selected ones.
        """
        header = self.rows.header_of(self._taken_number) if self._taken_number >= 0 else None
        if header is None:
            return self._selected_numbers()
        own = range(header + 1, self._end_of_section(header))
        return list(own) if self._taken_number == header else [n for n in self._selected_numbers() if n in own]

    def _end_of_section(self, header: int) -> int:
        count = self.rows.rowCount()
        return next((number for number in range(header + 1, count) if self.rows.section_at(number)), count)

    def _places(self) -> list[int]:
        """Return the indices of the rows before which dragged rows may be dropped; a player stays in its section."""
        count = self.rows.rowCount()
        header = self.rows.header_of(self._taken_number) if self._taken_number >= 0 else None
        if header is None:
            return list(range(count + 1))
        if self._taken_number == header:
            return [number for number in range(count) if self.rows.section_at(number)] + [count]
        return list(range(header + 1, self._end_of_section(header) + 1))

    def _move(self, before: int) -> None:
        rows, taken = self.rows, self._taken_number
        ids = tuple(rows.rows[number].id for number in self._carried())
        header = rows.header_of(taken) if taken >= 0 else None
        if not ids:
            return
        if header is None or header == taken:
            players = [player.id for player in self._session.project.players]
            section = rows.section_at(before)
            first = section.player_ids[0] if section else rows.rows[before].id if before < rows.rowCount() else None
            self.moved.emit(ids, len(players) if first is None else players.index(first))
        else:
            own = [row.id for row in rows.rows[header + 1 : self._end_of_section(header)]]
            place = before - header - 1
            ahead, behind = ([id for id in some if id not in ids] for some in (own[:place], own[place:]))
            self.ordered.emit((*ahead, *ids, *behind))

    def _shift(self, step: int) -> None:
        self._taken_number = self.currentIndex().row()
        carried, places = self._carried(), self._places()
        if not carried:
            return
        header = self.rows.section_at(self._taken_number) is not None
        if step < 0:
            first = self._taken_number if header else carried[0]
            target = next((place for place in reversed(places) if place < first), None)
        else:
            later = [place for place in places if place > carried[-1] + 1]
            target = later[0] if later else None
        if target is not None:
            self._move(target)

    def _drop_row_at(self, y: int) -> int:
        return min(self._places(), key=lambda place: abs(self._edge_px(place) - y))

    # Qt overrides

    def mousePressEvent(self, event: QMouseEvent) -> None:
        position, left = event.position().toPoint(), event.button() == Qt.MouseButton.LeftButton
        index = self.indexAt(position)
        self._taken_number = index.row()
        if not index.isValid():
            super().mousePressEvent(event)
            return
        row = self.rows.rows[index.row()]
        if left and self._press_button(row, position):
            self._let_go()
        elif isinstance(row, SectionRow):
            self._press_header(row, event)
        else:
            super().mousePressEvent(event)

    def _press_button(self, row: Row, position: QPoint) -> bool:
        box = self.visualRect(self.rows.index(self._taken_number))
        mute, solo = self._delegate.buttons(box)
        ids = row.player_ids if isinstance(row, SectionRow) else (row.id,)
        if mute.contains(position):
            self.mute_clicked.emit(ids)
        elif solo.contains(position):
            self.solo_clicked.emit(ids)
        elif isinstance(row, PlayerRow) and self._delegate.arm_button(box).contains(position):
            self.arm_clicked.emit(row.id)
        else:
            return False
        return True

    def _press_header(self, section: SectionRow, event: QMouseEvent) -> None:
        self._let_go()
        self.selectionModel().setCurrentIndex(self.rows.index(self._taken_number), _FLAGS.NoUpdate)
        if event.button() == Qt.MouseButton.RightButton:
            if not {*section.player_ids} <= {*self._session.players}:
                self.chosen.emit(section.player_ids)
        elif event.button() == Qt.MouseButton.LeftButton:
            if event.position().x() < ARROW_PX:
                everyone = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
                self._fold(section, not section.folded, everyone)
            else:
                self._press = event.position().toPoint()
                self._choose_section(section, event.modifiers())

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        position = event.position().toPoint()
        index = self.indexAt(position)
        self._taken_number = index.row()
        if not index.isValid():
            return
        row = self.rows.rows[index.row()]
        on_arrow = isinstance(row, SectionRow) and position.x() < ARROW_PX
        if on_arrow:
            self.mousePressEvent(event)
        elif not self._press_button(row, position):
            if isinstance(row, SectionRow):
                self._fold(row, not row.folded)
            else:
                super().mouseDoubleClickEvent(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        header = self.rows.header_of(self.currentIndex().row()) if self.currentIndex().isValid() else None
        plain = event.modifiers() in (Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.KeypadModifier)
        if header is not None and plain and event.key() in _FOLDING:
            self._step_sideways(header, _FOLDING[Qt.Key(event.key())])
            return
        before = self.currentIndex().row()
        self._showing = True
        super().keyPressEvent(event)
        self._showing = False
        current = self.currentIndex().row()
        section = self.rows.section_at(current)
        if section is not None and current != before:
            self._choose_section(section, event.modifiers())
        elif {self.rows.rows[number].id for number in self._selected_numbers()} != {*self._session.players}:
            self._selected()

    def _step_sideways(self, header: int, left: bool) -> None:
        """Fold or unfold the section; move from a player to the header, or from an unfolded header to its first
        player.
        """
        section, current = self.rows.section_at(header), self.currentIndex().row()
        assert section is not None
        if current == header and section.folded is not left:
            self._fold(section, left)
        elif current != header and left:
            self.selectionModel().setCurrentIndex(self.rows.index(header), _FLAGS.NoUpdate)
            self.chosen.emit(section.player_ids)
        elif current == header and not left:
            self.setCurrentIndex(self.rows.index(header + 1))
