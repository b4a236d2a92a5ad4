"""Dialog that shows the changes of a re-imported MIDI file before they are applied."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QAbstractItemView, QDialog, QListWidget, QListWidgetItem, QWidget

from app.editor.design_tokens import LEAST_TARGET_PX
from app.editor.session import Session
from app.editor.translated import tr
from app.errors import Message
from app.plan.by_hand.corrections import Correction
from app.project.file_timing import timing_of
from app.project.found_parts import Conflict
from app.project.part_changes import PartChanges
from app.project.performers import Player
from app.project.reimport import Reimport
from widgets.common.controls import Caption, OkCancel, Retranslated, named, said, selectable, wrapped
from widgets.common.help import with_help
from widgets.common.layouts import begin_with_size, in_column
from widgets.common.plain import Label
from widgets.common.text import message_text, note_text
from widgets.dialogs.reimport_changes import ReimportChanges


class ReimportDialog(Retranslated, QDialog):
    """Dialog that shows the changes of a re-import, and asks whether to apply them.

    Parameters
    ----------
    session : Session
        Session with the present project, in which changes are shown.
    file : str
        Name of the MIDI file.
    title : callable
        Returns the title of a correction.
    changes : PartChanges
        Changes by part (`app.project.part_changes.changes_by_part`), computed beforehand since that takes time.
    """

    def __init__(
        self,
        session: Session,
        outcome: Reimport,
        file: str,
        title: Callable[[Correction, str], str],
        changes: PartChanges,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setObjectName("reimport_midi")
        self._session, self._before, self._outcome = session, session.project, outcome
        self._title = title
        self._changes = ReimportChanges(session, outcome, changes)
        self._changes.chosen.connect(lambda: self._chosen())
        self._conflict_count = [len(outcome.conflicts)]
        """Those of the parts that are taken; a list, which the text of the heading reads."""
        self._gone = named(QListWidget(), "reimport_gone")
        self._buttons = OkCancel("reimport_dialog.re_import", "reimport_dialog.cancel")
        self._buttons.accepted.connect(self.accept)
        self._buttons.rejected.connect(self.reject)
        heading = selectable(wrapped(Label()))
        in_column(
            self.texted(heading, text=said(self._heading_id(), file=file)),
            (self._changes, 1),
            *self._timing(),
            *self._new_and_gone(),
            *self._replaced(),
            *self._lost_and_contradicted(),
            with_help(self._buttons),
            of=self,
        )
        self.texted(self, title="reimport_dialog.re_import_midi")
        self._enable()
        begin_with_size(self, QSize(860, 660))
        self._changes.setFocus()

    def _heading_id(self) -> str:
        before, outcome = self._before, self._outcome
        if outcome.project is before:
            return "reimport_dialog.says_nothing_new"
        if replace(outcome.project, source=before.source) == before:
            return "reimport_dialog.no_changes_elsewhere"
        return "reimport_dialog.changes_hint"

    def _new_and_gone(self) -> tuple[QWidget, ...]:
        """Return the widgets about players and parts that only the file or only the project has."""
        outcome = self._outcome
        names = {player.id: player.name for player in (*outcome.project.players, *self._before.players)}
        new = ", ".join(names[id] for id in outcome.new_players)
        players = named(wrapped(Label()), "reimport_players")
        _shown(bool(new), self.texted(players, text=said("reimport_dialog.new_players", names=new)))
        parts = [part for part in outcome.new_unplayed if not part.is_of_played_part]
        left_out = [part for part in outcome.new_unplayed if part.is_of_played_part]
        unplayed = (
            *self._list(
                "reimport_unplayed",
                Caption("reimport_dialog.new_parts_heading"),
                [partial(_said_of, "import_dialog.is_not_played", part.name, part.reason) for part in parts],
            ),
            *self._list(
                "reimport_left_out",
                Caption("reimport_dialog.notes_left_out"),
                [partial(_said_of, "import_dialog.excluded_part", part.name, part.reason) for part in left_out],
            ),
        )
        self._gone.setMaximumHeight(min(140, LEAST_TARGET_PX * len(outcome.gone_players) + 6))
        for player_id in outcome.gone_players:
            item = QListWidgetItem(names[player_id], self._gone)
            item.setData(Qt.ItemDataRole.UserRole, player_id)
            item.setCheckState(Qt.CheckState.Unchecked)
            item.setSizeHint(QSize(0, LEAST_TARGET_PX))
        self._gone.itemChanged.connect(lambda: self._enable())
        gone = wrapped(Caption("reimport_dialog.missing_parts"))
        return (players, *unplayed, *_shown(bool(outcome.gone_players), gone, self._gone))

    def _timing(self) -> tuple[QWidget, ...]:
        """Return the widgets about changes of the whole piece, which are applied regardless of the selected players."""
        before, now = (timing_of(project.score) for project in (self._before, self._outcome.project))
        changed = {
            "tempo": before.tempo_map != now.tempo_map,
            "metres": (before.metres, before.pickup_ticks) != (now.metres, now.pickup_ticks),
        }
        ids = [f"reimport_dialog.{kind}" for kind, is_changed in changed.items() if is_changed]
        label = named(wrapped(Label()), "reimport_timing")
        self.texted(label, text=lambda: tr("reimport_dialog.changes_for_all").format(kinds=", ".join(map(tr, ids))))
        return _shown(bool(ids), label)

    def _replaced(self) -> tuple[QWidget, ...]:
        """Return the widgets about data of the piece that the file replaces completely."""
        ids = [f"reimport_dialog.{kind}" for kind in self._outcome.replaced]
        label = named(wrapped(Label()), "reimport_replaced")
        self.texted(label, text=lambda: tr("reimport_dialog.file_version_used").format(kinds=", ".join(map(tr, ids))))
        return _shown(bool(ids), label)

    def _lost_and_contradicted(self) -> tuple[QWidget, ...]:
        """Return the widgets about notes changed both in the project and in the file, and about corrections whose notes
        no longer exist.
        """
        outcome, title, session = self._outcome, self._title, self._session
        names = {part.id: part.name for part in self._before.score.parts}
        players = {player.part_id: player for player in reversed(self._before.players)}
        names |= {id: player.name for id, player in players.items()}
        counted = self._conflict_count
        conflicts = [
            partial(_conflict, session, names[one.part_id], one, players.get(one.part_id)) for one in outcome.conflicts
        ]
        orphans = [
            partial(_orphan, outcome.project.player(one.player_id), one.correction, title) for one in outcome.orphans
        ]
        lost = Caption("reimport_dialog.these_corrections_have_lost_their")
        self._conflicts = self._list(
            "reimport_conflicts",
            self.texted(Label(), text=lambda: tr("reimport_dialog.both_changed_heading").format(count=counted[0])),
            conflicts,
        )
        return (*self._conflicts, *self._list("reimport_orphans", lost, orphans))

    def _list(self, name: str, heading: Label, items: Sequence[Callable[[], str]]) -> tuple[Label, QListWidget]:
        """Return a list of texts with a heading above it, both hidden if there are none."""
        below = named(QListWidget(), name)
        below.addItems([""] * len(items))
        below.setSelectionMode(QAbstractItemView.SelectionMode.NoSelection)
        below.setMaximumHeight(140)
        below.setWordWrap(True)
        self.texted(below, items=items)
        _shown(bool(items), wrapped(heading), below)
        return heading, below

    @property
    def removed(self) -> tuple[str, ...]:
        """Ids of those players left without a part whom the user chose to remove."""
        items = (self._gone.item(row) for row in range(self._gone.count()))
        return tuple(
            item.data(Qt.ItemDataRole.UserRole) for item in items if item.checkState() == Qt.CheckState.Checked
        )

    @property
    def kept(self) -> frozenset[str]:
        """Ids of the parts that keep their present notes."""
        return self._changes.kept

    @property
    def taken(self) -> Reimport:
        """The re-import with the parts of unchecked players kept unchanged."""
        return self._outcome.keeping(self.kept) if self.kept else self._outcome

    def _chosen(self) -> None:
        """Show only the conflicts of checked players."""
        kept, below = self.kept, self._conflicts[1]
        for row, conflict in enumerate(self._outcome.conflicts):
            below.item(row).setHidden(conflict.part_id in kept)
        self._conflict_count[0] = sum(one.part_id not in kept for one in self._outcome.conflicts)
        for widget in self._conflicts:
            widget.setVisible(self._conflict_count[0] > 0)
        self.word()
        self._enable()

    def _enable(self) -> None:
        """Enable the button that applies the re-import if this changes anything."""
        some = bool(self._changes.changed - self._changes.kept)
        self._buttons.ok.setEnabled(some or bool(self.removed) or self.taken.project is not self._before)


def _shown(shown: bool, *widgets: QWidget) -> tuple[QWidget, ...]:
    """Return the widgets, hidden unless ``shown``."""
    for widget in widgets:
        if not shown:
            widget.hide()
    return widgets


def _said_of(text_id: str, part: str, reason: Message) -> str:
    return tr(text_id).format(name=part, reason=message_text(reason))


def _conflict(session: Session, name: str, conflict: Conflict, player: Player | None) -> str:
    """Return a conflict about a note as text: the user's version, an arrow, the file's version."""
    mine, file = conflict.by_hand, conflict.file
    here = tr("reimport_dialog.erased") if mine is None else note_text(session, mine, player)
    there = tr("reimport_dialog.no_longer_in_file") if file is None else note_text(session, file, player)
    return f"{name}: {here} → {there}"


def _orphan(player: Player, correction: Correction, title: Callable[[Correction, str], str]) -> str:
    return f"{player.name}: {title(correction, player.instrument_id)}"
