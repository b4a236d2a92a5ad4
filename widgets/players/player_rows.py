"""Rows of the list of players (players, and section headers in a large piece), and their Qt model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

from PySide6.QtCore import QAbstractListModel, QModelIndex, Qt, Signal
from PySide6.QtWidgets import QWidget

from app.project.performers import Player
from widgets.players.ordered_list import ID_ROLE, AnyIndex

ROW_ROLE: Final = Qt.ItemDataRole.UserRole
"""Item role of a row's content, `PlayerRow` or `SectionRow`."""


@dataclass(frozen=True)
class PlayerRow:
    """Contents of a player's row.

    Attributes
    ----------
    instrument : str
        Name of the instrument in the language of the editor.
    problems : int
        Number of problems in the plan; 0 without a plan.
    leads : bool
        Whether the player gives the ensemble's cues.
    unseen : str
        Reason why the player cannot be shown or exported; empty for none.
    """

    player: Player
    colour: str
    instrument: str
    problems: int = 0
    leads: bool = False
    unseen: str = ""

    @property
    def id(self) -> str:
        """The player's id."""
        return self.player.id

    @property
    def name(self) -> str:
        """The player's name."""
        return self.player.name

    def is_found(self, text: str) -> bool:
        """Return whether the name or the instrument contains a text in lower case."""
        return text in self.player.name.casefold() or text in self.instrument.casefold()


@dataclass(frozen=True)
class SectionRow:
    """Contents of a section header.

    Attributes
    ----------
    id : str
        Id under which the session stores that it is folded.
    name : str
        Name of the section in the language of the editor.
    players : tuple of PlayerRow
        Rows of its players.
    """

    id: str
    name: str
    players: tuple[PlayerRow, ...]
    folded: bool = False

    @property
    def player_ids(self) -> tuple[str, ...]:
        """Ids of the players in the section."""
        return tuple(row.id for row in self.players)

    def marked(self, field: str) -> bool | None:
        """Return whether the players of the section are ``muted`` or ``soloed`` (a field's name); None if only some
        are.
        """
        marks = {getattr(row.player, field) for row in self.players}
        return None if len(marks) > 1 else marks.pop()


Row: TypeAlias = PlayerRow | SectionRow


class PlayerModel(QAbstractListModel):
    """Model of players and section headers.

    Signals
    -------
    renamed(str, str)
        The user typed another name for the player of this id.
    """

    renamed = Signal(str, str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._rows: tuple[Row, ...] = ()

    @property
    def rows(self) -> tuple[Row, ...]:
        """All visible rows, sections and players, from top to bottom."""
        return self._rows

    @property
    def players(self) -> tuple[PlayerRow, ...]:
        """Only the rows of players, from top to bottom."""
        return tuple(row for row in self._rows if isinstance(row, PlayerRow))

    def show_rows(self, rows: Sequence[Row]) -> None:
        """Replace the displayed rows of sections and players; the view is reset only if their ids change."""
        if [row.id for row in rows] != [row.id for row in self._rows]:
            self.beginResetModel()
            self._rows = tuple(rows)
            self.endResetModel()
            return
        before, self._rows = self._rows, tuple(rows)
        for number, (old, new) in enumerate(zip(before, rows, strict=True)):
            if old != new:
                self.dataChanged.emit(self.index(number), self.index(number))

    def number(self, id: str) -> int | None:
        """Return the row number of the player or section with an id; None if it is not displayed."""
        return next((number for number, row in enumerate(self._rows) if row.id == id), None)

    def header_of(self, number: int) -> int | None:
        """Return the index of the header above a row (or of the header itself); None without sections."""
        return next((above for above in range(number, -1, -1) if isinstance(self._rows[above], SectionRow)), None)

    def section_at(self, number: int) -> SectionRow | None:
        """Return the section whose header is in a row."""
        row = self._rows[number] if 0 <= number < len(self._rows) else None
        return row if isinstance(row, SectionRow) else None

    # Qt overrides

    def rowCount(self, parent: AnyIndex = QModelIndex()) -> int:  # noqa: B008
        return 0 if parent.isValid() else len(self._rows)

    def data(self, index: AnyIndex, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        if not index.isValid():
            return None
        row = self._rows[index.row()]
        if role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.EditRole):
            return row.name
        if role == Qt.ItemDataRole.AccessibleDescriptionRole:
            return row.instrument if isinstance(row, PlayerRow) else str(len(row.players))
        if role == ID_ROLE:
            return row.id
        return row if role == ROW_ROLE else None

    def setData(self, index: AnyIndex, value: Any, role: int = Qt.ItemDataRole.EditRole) -> bool:
        row = self._rows[index.row()]
        if role != Qt.ItemDataRole.EditRole or not isinstance(value, str) or isinstance(row, SectionRow):
            return False
        if value.strip() and value != row.name:
            self.renamed.emit(row.id, value)
        return True

    def flags(self, index: AnyIndex) -> Qt.ItemFlag:
        flags = Qt.ItemFlag.ItemIsEnabled
        if self.section_at(index.row()) is None:
            flags |= Qt.ItemFlag.ItemIsSelectable | Qt.ItemFlag.ItemIsEditable
        return flags
