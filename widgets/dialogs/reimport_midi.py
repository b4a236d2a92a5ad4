"""The re-import of a changed MIDI file: what was found again, what is new, what is gone, before it is done."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QHeaderView,
    QListWidget,
    QListWidgetItem,
    QTableWidget,
    QTableWidgetItem,
    QWidget,
)

from app.editor.tokens import LEAST_TARGET_PX, Tokens
from app.plan.by_hand.corrections import Correction
from app.project.found_parts import Conflict
from app.project.model import Project
from app.project.reimport import Reimport
from app.score.model import Note
from widgets.common.controls import Caption, OkCancel, Retranslated, named, selectable, wrapped
from widgets.common.layouts import in_column
from widgets.common.plain import Label
from widgets.common.text import message_text


class ReimportDialog(Retranslated, QDialog):
    """Shows what a re-import would do and asks whether to do it.

    Parameters
    ----------
    before : Project
        The project as it is.
    file : str
        Name of the MIDI file.
    title : callable
        Names a correction.
    note_title : callable
        Names a note of a part, by part id and note.
    """

    def __init__(
        self,
        before: Project,
        outcome: Reimport,
        file: str,
        title: Callable[[Correction], str],
        note_title: Callable[[str, Note], str],
        tokens: Tokens,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setObjectName("reimport_midi")
        self._before, self._outcome, self._file = before, outcome, file
        self._title, self._note_title, self._tokens = title, note_title, tokens
        self._heading = selectable(wrapped(Label()))
        self._table = named(QTableWidget(0, 5), "reimport_parts")
        self._table.verticalHeader().hide()
        self._table.setShowGrid(False)
        self._table.setSelectionMode(QAbstractItemView.SelectionMode.NoSelection)
        self._table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self._table.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        self._table.horizontalHeader().setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        self._table.horizontalHeader().setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        self._players, self._conflict_title = named(wrapped(Label()), "reimport_players"), wrapped(Label())
        self._unplayed_title = wrapped(Caption("reimport_dialog.new_parts_without_player"))
        self._unplayed = named(QListWidget(), "reimport_unplayed")
        self._unplayed.setWordWrap(True)
        self._gone_title = wrapped(Caption("reimport_dialog.players_whose_part_is_gone"))
        self._gone = named(QListWidget(), "reimport_gone")
        self._gone.setMaximumHeight(min(140, LEAST_TARGET_PX * len(outcome.gone_players) + 6))
        names = {player.id: player.name for player in before.players}
        for player_id in outcome.gone_players:
            item = QListWidgetItem(names[player_id])
            item.setData(Qt.ItemDataRole.UserRole, player_id)
            item.setCheckState(Qt.CheckState.Unchecked)
            item.setSizeHint(QSize(0, LEAST_TARGET_PX))
            self._gone.addItem(item)
        self._gone.itemChanged.connect(lambda: self._enable())
        self._replaced = named(wrapped(Label()), "reimport_replaced")
        self._orphan_title = wrapped(Caption("reimport_dialog.these_corrections_have_lost_their"))
        self._conflicts = named(QListWidget(), "reimport_conflicts")
        self._orphans = named(QListWidget(), "reimport_orphans")
        for items in (self._unplayed, self._conflicts, self._orphans):
            items.setSelectionMode(QAbstractItemView.SelectionMode.NoSelection)
            items.setMaximumHeight(140)
        self._buttons = OkCancel("reimport_dialog.re_import", "reimport_dialog.cancel")
        self._buttons.accepted.connect(self.accept)
        self._buttons.rejected.connect(self.reject)
        in_column(
            self._heading,
            (self._table, 1),
            self._players,
            self._unplayed_title,
            self._unplayed,
            self._gone_title,
            self._gone,
            self._replaced,
            self._conflict_title,
            self._conflicts,
            self._orphan_title,
            self._orphans,
            self._buttons,
            of=self,
        )
        self.texted(self, title="reimport_dialog.re_import_midi")
        self.retranslate()

    def retranslate(self) -> None:
        outcome = self._outcome
        if outcome.project is self._before:
            text = self.tr("reimport_dialog.says_nothing_new")
        elif replace(outcome.project, source=self._before.source) == self._before:
            text = self.tr("reimport_dialog.says_nothing_new_but_lies_elsewhere")
        else:
            text = self.tr("reimport_dialog.what_changes_fingerings_breaths_and")
        self._heading.setText(text.format(file=self._file))
        titles = (
            self.tr("reimport_dialog.part"),
            self.tr("reimport_dialog.kept"),
            self.tr("reimport_dialog.new"),
            self.tr("reimport_dialog.gone"),
            self.tr("reimport_dialog.changed_by_hand"),
        )
        for column, title in enumerate(titles):
            heading = QTableWidgetItem(title)
            side = Qt.AlignmentFlag.AlignRight if column else Qt.AlignmentFlag.AlignLeft
            heading.setTextAlignment(side | Qt.AlignmentFlag.AlignVCenter)
            self._table.setHorizontalHeaderItem(column, heading)
        self._table.setRowCount(len(outcome.parts))
        for row, part in enumerate(outcome.parts):
            name = part.name if part.name == part.former_name else f"{part.former_name} → {part.name}"
            self._table.setItem(row, 0, QTableWidgetItem(name))
            for column, (count, colour) in enumerate(
                (
                    (part.kept, self._tokens.text),
                    (part.added, self._tokens.good),
                    (part.removed, self._tokens.warning),
                    (part.by_hand, self._tokens.text),
                ),
                start=1,
            ):
                item = QTableWidgetItem(str(count))
                item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
                item.setForeground(QColor(colour if count else self._tokens.text_dim))
                self._table.setItem(row, column, item)
        kinds = {
            "tempo": self.tr("reimport_dialog.tempo"),
            "metres": self.tr("reimport_dialog.metres"),
            "controllers": self.tr("reimport_dialog.controllers"),
        }
        replaced = ", ".join(kinds[kind] for kind in outcome.replaced)
        self._replaced.setText(self.tr("reimport_dialog.replaced_by_file").format(kinds=replaced))
        self._replaced.setVisible(bool(replaced))
        names = {player.id: player.name for player in outcome.project.players}
        new = ", ".join(names[id_] for id_ in outcome.new_players)
        self._players.setText(self.tr("reimport_dialog.new_players").format(names=new))
        self._players.setVisible(bool(new))
        self._unplayed.clear()
        self._unplayed.addItems(
            [
                self.tr("import_dialog.is_not_played").format(name=part.name, reason=message_text(part.reason))
                for part in outcome.new_unplayed
            ]
        )
        self._unplayed_title.setVisible(bool(outcome.new_unplayed))
        self._unplayed.setVisible(bool(outcome.new_unplayed))
        self._conflict_title.setText(
            self.tr("reimport_dialog.changed_here_and_in_file").format(count=len(outcome.conflicts))
        )
        self._conflicts.clear()
        parts = {part.id: part.name for part in self._before.score.parts}
        for conflict in outcome.conflicts:
            self._conflicts.addItem(f"{parts[conflict.part_id]}: {self._about_note(conflict)}")
        for widget in (self._conflict_title, self._conflicts):
            widget.setVisible(bool(outcome.conflicts))
        self._orphans.clear()
        for orphan in outcome.orphans:
            player = outcome.project.player(orphan.player_id)
            self._orphans.addItem(f"{player.name}: {self._title(orphan.correction)}")
        for widget in (self._orphan_title, self._orphans):
            widget.setVisible(bool(outcome.orphans))
        for widget in (self._gone_title, self._gone):
            widget.setVisible(bool(outcome.gone_players))
        self._enable()

    @property
    def removed(self) -> tuple[str, ...]:
        """Ids of the players whose part is gone and who are to be removed."""
        items = (self._gone.item(row) for row in range(self._gone.count()))
        return tuple(
            item.data(Qt.ItemDataRole.UserRole) for item in items if item.checkState() == Qt.CheckState.Checked
        )

    def _enable(self) -> None:
        """Nothing is to be agreed to where nothing changes."""
        self._buttons.ok.setEnabled(self._outcome.project is not self._before or bool(self.removed))

    def _about_note(self, conflict: Conflict) -> str:
        """What happens to a note: as the user has it → as the file has it."""
        mine, file = conflict.by_hand, conflict.file
        here = self.tr("reimport_dialog.erased") if mine is None else self._note_title(conflict.part_id, mine)
        there = (
            self.tr("reimport_dialog.not_in_file_any_more")
            if file is None
            else self._note_title(conflict.part_id, file)
        )
        return f"{here} → {there}"

    def sizeHint(self) -> QSize:
        return QSize(620, 460)
