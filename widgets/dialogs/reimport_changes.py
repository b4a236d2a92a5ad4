"""Changes of a re-import by player and bar, for stepping through and for selecting players."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtGui import QBrush, QColor, QKeySequence, QShortcut, QShowEvent
from PySide6.QtWidgets import QHeaderView, QStyle, QTreeWidgetItem, QWidget

from app.editor.selection import Selection
from app.editor.session import Session
from app.editor.translated import tr
from app.messages import filled
from app.project.found_parts import PartMatch
from app.project.part_changes import KINDS, PartChange, PartChanges
from app.project.performers import Player
from app.project.reimport import Reimport
from app.score.marks import Mark
from app.score.metre_map import MetreMap
from app.score.model import Note, Part
from widgets.common.combo import Combo
from widgets.common.controls import Button, ColumnList, Retranslated, named
from widgets.common.event_names import mark_name
from widgets.common.layouts import in_column, in_row
from widgets.common.text import player_pitch

_ALL = "all"
_SIDE = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
_COUNTS = slice(2, 6)
MARGIN_PX = 16
"""Total horizontal margin of the first column in pixels."""


class _Row:
    """A part of the re-import, or the changes of the whole piece, with its tree item.

    Attributes
    ----------
    shown : tuple of PartChange
        Changes that pass the filter.
    """

    def __init__(self, part_id: str, name: str, player: Player | None, changes: tuple[PartChange, ...]) -> None:
        self.part_id, self.name, self.player = part_id, name, player
        self.changes = self.shown = changes
        self.item = QTreeWidgetItem()


class ReimportChanges(Retranslated, QWidget):
    """Tree of players with their changes in score order; rows are made when a player is unfolded.

    Signals
    -------
    chosen()
        The user checked or unchecked a player.
    """

    chosen = Signal()

    def __init__(
        self,
        session: Session,
        outcome: Reimport,
        changes: PartChanges,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._session, self._before, self._outcome, self._found = session, session.project, outcome, changes
        former, now = self._before.score, outcome.project.score
        self._scale = Fraction(now.ticks_per_quarter, former.ticks_per_quarter)
        self._tree = ColumnList(
            "reimport_parts",
            *(f"reimport_dialog.{column}" for column in ("player", "change", "kept", "new", "gone", "changed_by_hand")),
            stretches=(1,),
        )
        self._tree.setRootIsDecorated(True)
        self._tree.setAllColumnsShowFocus(True)
        self._filter = named(Combo(), "reimport_filter")
        options = {_ALL: "reimport_dialog.all_changes"} | {kind: f"reimport_dialog.only_{kind}" for kind in KINDS}
        self._filter.setSizeAdjustPolicy(Combo.SizeAdjustPolicy.AdjustToContents)
        self.texted(self._filter, options=options)
        self._filter.show_option(_ALL)
        self._filter.chosen.connect(self._apply_filter)
        self._rows = self._rows_of(outcome)
        steps = (("previous", -1, "Shift+F8"), ("next", 1, "F8"))
        buttons = []
        for name, step, key in steps:
            go = self._step(step)
            buttons.append(
                Button(f"reimport_dialog.{name}", go, f"reimport_{name}", f"reimport_dialog.{name}_change_tip")
            )
            QShortcut(QKeySequence(key), self).activated.connect(go)
        QShortcut(QKeySequence(Qt.Key.Key_Space), self._tree, self._toggle, context=Qt.ShortcutContext.WidgetShortcut)
        in_column(in_row(self._filter, None, *buttons), (self._tree, 1), of=self, margins=0)
        self._tree.itemExpanded.connect(self._fill)
        self._tree.itemChanged.connect(lambda: self.chosen.emit())
        self._tree.currentItemChanged.connect(lambda item: self._show(item))
        self.setFocusProxy(self._tree)
        self._tree.addTopLevelItems([row.item for row in self._rows])
        # The width follows from all names, not only from visible rows.
        self._tree.header().setSectionResizeMode(0, QHeaderView.ResizeMode.Interactive)
        self._apply_filter(_ALL)
        self._begun = False

    def _rows_of(self, outcome: Reimport) -> list[_Row]:
        """Return the rows of the file's parts, each with player, number of changes and check box."""
        former = {part.id: part for part in self._before.score.parts}
        matches = {match.part_id: match for match in outcome.parts}
        gone = {outcome.project.player(id).part_id for id in outcome.gone_players}
        players = {player.part_id: player for player in reversed(outcome.project.players)}
        rows = []
        for part in outcome.project.score.parts:
            if part.id in gone or (part.id in former and part.id not in matches):
                continue
            player = players.get(part.id)
            row = _Row(
                part.id,
                part.name if player is None else player.name,
                player,
                self._found[part.id],
            )
            self._fill_counts(row, matches.get(part.id), part)
            rows.append(row)
        return rows

    def _fill_counts(self, row: _Row, match: PartMatch | None, part: Part) -> None:
        counts = (
            (0, len(part.notes), 0, 0) if match is None else (match.kept, match.added, match.removed, match.by_hand)
        )
        tokens = self._session.tokens
        colours = tokens.text, tokens.good, tokens.warning, tokens.text
        for column, count, colour in zip(range(*_COUNTS.indices(6)), counts, colours, strict=True):
            row.item.setText(column, str(count))
            row.item.setTextAlignment(column, _SIDE)
            row.item.setForeground(column, QBrush(QColor(colour if count else tokens.text_dim)))
        row.item.setText(0, row.name)
        if match is not None and match.former_name != match.name:
            row.item.setToolTip(0, f"{match.former_name} → {match.name}")
        if row.changes:
            row.item.setFlags(row.item.flags() | Qt.ItemFlag.ItemIsUserCheckable)
            row.item.setCheckState(0, Qt.CheckState.Checked)

    @property
    def kept(self) -> frozenset[str]:
        """Return the ids of the parts of unchecked players, which keep their present notes."""
        return frozenset(
            row.part_id for row in self._rows if row.changes and row.item.checkState(0) == Qt.CheckState.Unchecked
        )

    @property
    def changed(self) -> frozenset[str]:
        """Ids of the parts that the file changes."""
        return frozenset(row.part_id for row in self._rows if row.changes)

    def _apply_filter(self, kind: str) -> None:
        """Show the changes of one kind or all; players without any are hidden, unless all are shown."""
        blocker = QSignalBlocker(self._tree)
        current = self._current_row()
        opened = {row.part_id for row in self._rows if row.item.isExpanded()}
        for row in self._rows:
            row.item.setExpanded(False)
            row.item.takeChildren()
            row.shown = tuple(change for change in row.changes if kind in (_ALL, change.kind))
            row.item.setHidden(kind != _ALL and not row.shown)
            policy = QTreeWidgetItem.ChildIndicatorPolicy
            row.item.setChildIndicatorPolicy(policy.ShowIndicator if row.shown else policy.DontShowIndicator)
            row.item.setText(1, self._summary(row))
            if row.part_id in opened:
                self._fill(row.item)
                row.item.setExpanded(True)
        blocker.unblock()
        if current is not None and not current.item.isHidden():
            self._tree.setCurrentItem(current.item)

    def _current_row(self) -> _Row | None:
        item = self._tree.currentItem()
        return None if item is None else self._row_of(item)

    def _row_of(self, item: QTreeWidgetItem) -> _Row:
        return self._rows[self._tree.indexOfTopLevelItem(item.parent() or item)]

    def _place_of(self, item: QTreeWidgetItem) -> tuple[_Row, int]:
        """Return the row of the player to which a tree item belongs, and the index of the change; -1 for the player's
        own item.
        """
        parent = item.parent()
        return self._row_of(item), -1 if parent is None else parent.indexOfChild(item)

    def _fill(self, item: QTreeWidgetItem) -> None:
        """Make the rows of a player when it is unfolded."""
        if item.childCount():
            return
        row = self._row_of(item)
        texts = [self._texts(row, change) for change in row.shown]
        item.addChildren([QTreeWidgetItem(list(both)) for both in texts])
        self._widen([place for place, _ in texts])

    def _widen(self, texts: Sequence[str]) -> None:
        """Widen the first column to fit texts behind a check box; it does not shrink."""
        style, metrics = self._tree.style(), self._tree.fontMetrics()
        box_px = style.pixelMetric(QStyle.PixelMetric.PM_IndicatorWidth, None, self._tree)
        text_px = max(map(metrics.horizontalAdvance, texts), default=0)
        needed = 2 * self._tree.indentation() + box_px + text_px + MARGIN_PX
        self._tree.setColumnWidth(0, max(self._tree.columnWidth(0), needed))

    def _begin(self) -> None:
        """Unfold the first player with changes, if the other players stay visible."""
        first = next((row for row in self._rows if row.shown), None)
        if first is not None:
            row_px = max(self._tree.visualItemRect(first.item).height(), 1)
            if row_px * (len(self._rows) + len(first.shown)) <= self._tree.viewport().height():
                first.item.setExpanded(True)

    def _step(self, step: int) -> Callable[[], None]:
        """Return a function that selects the next change (1) or the previous one (-1) over all players."""

        def go() -> None:
            places = [(row, place) for row in self._rows for place in range(len(row.shown))]
            if not places:
                return
            item = self._tree.currentItem()
            at = -1 if step > 0 else len(places)
            if item is not None:
                row, place = self._place_of(item)
                at = sum(len(one.shown) for one in self._rows[: self._rows.index(row)]) + max(place, 0)
                if place < 0 < step:
                    at -= 1
            row, place = places[min(max(at + step, 0), len(places) - 1)]
            row.item.setExpanded(True)
            child = row.item.child(place)
            if child is not None:
                self._tree.setCurrentItem(child)

        return go

    def _toggle(self) -> None:
        """Check or uncheck the player of the current row."""
        row = self._current_row()
        if row is not None and row.changes:
            checked = row.item.checkState(0) == Qt.CheckState.Checked
            row.item.setCheckState(0, Qt.CheckState.Unchecked if checked else Qt.CheckState.Checked)

    def _show(self, item: QTreeWidgetItem | None) -> None:
        """Show a change in the main window: make its player active, select its note, and move the playhead there."""
        row, place = (None, -1) if item is None else self._place_of(item)
        if row is None or place < 0:
            return
        session, change = self._session, row.shown[place]
        player = row.player
        if player is not None and any(one.id == player.id for one in session.project.players):
            others = tuple(id for id in session.players if id != player.id)
            session.set_players((player.id, *others) if player.id in session.players else (player.id,))
        ids = frozenset({change.before.id}) if isinstance(change.before, Note) else frozenset[str]()
        session.select(Selection(notes=ids).within(session.project))
        time_s = session.project.score.tempo_map.seconds(change.tick)
        if not session.playing:
            session.set_playhead(time_s)
        session.reveal(time_s)

    def _summary(self, row: _Row) -> str:
        """Return the number of a player's changes by kind."""
        if not row.changes:
            return tr("reimport_dialog.no_changes")
        found = []
        for kind in KINDS:
            count = sum(change.count for change in row.shown if change.kind == kind)
            if count:
                found.append(tr(f"reimport_dialog.count.{kind}").format(count=count))
        return tr("reimport_dialog.and").join(found)

    def _texts(self, row: _Row, change: PartChange) -> tuple[str, str]:
        """Return the texts of two columns for a change: its place in the score, and its description."""
        former, now = self._before.metre_map, self._outcome.project.metre_map
        there, here = former.label(change.tick), now.label(change.tick_now)
        before, after = change.before, change.now
        if change.kind == "controllers":
            return "", tr("reimport_dialog.controllers_changed")
        place = there if after is None else here if before is None or there == here else f"{there} → {here}"
        if change.kind == "marks":
            return place, _mark_text(before, after)
        pitch, pitch_now = (
            player_pitch(self._session, note.pitch, row.player) if isinstance(note, Note) else ""
            for note in (before, after)
        )
        if before is None or after is None:
            return place, tr(f"reimport_dialog.note.{change.kind}").format(pitch=pitch or pitch_now)
        if change.kind == "moved":
            several = "notes" if change.count > 1 else "note"
            distance = _distance(change, former, now, self._scale)
            return place, tr(f"reimport_dialog.{several}_moved").format(
                count=change.count, pitch=pitch_now, distance=distance
            )
        assert isinstance(before, Note)
        assert isinstance(after, Note)
        return place, self._note_text(before, after, pitch, pitch_now)

    def _note_text(self, before: Note, now: Note, pitch: str, pitch_now: str) -> str:
        """Return the change of a note as text: of pitch, or else of length and velocity."""
        length = max(round(before.duration_tick * self._scale), 1)
        parts = [pitch if before.pitch == now.pitch else f"{pitch} → {pitch_now}"]
        if length != now.duration_tick:
            whole = 4 * self._outcome.project.score.ticks_per_quarter
            texts = [_value(ticks, whole) for ticks in (length, now.duration_tick)]
            parts.append(tr("reimport_dialog.length_changed").format(before=texts[0], now=texts[1]))
        if before.velocity != now.velocity:
            parts.append(tr("reimport_dialog.velocity_changed").format(before=before.velocity, now=now.velocity))
        return tr("reimport_dialog.and").join(parts)

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self._widen([row.name for row in self._rows])
        if not self._begun:
            self._begun = True
            self._begin()

    def retranslate(self) -> None:
        """Set the texts of all rows again after a change of language."""
        self._apply_filter(self._filter.currentData() or _ALL)


def _mark_text(before: Note | Mark | None, now: Note | Mark | None) -> str:
    """Return the name of a mark and the kind of its change."""
    mark = now if before is None else before
    assert isinstance(mark, Mark)
    name = mark_name(mark.kind)
    named_so = f"{name} {mark.text}".rstrip()
    if before is None or now is None:
        return filled(tr(f"reimport_dialog.mark.{'added' if before is None else 'removed'}"), {"mark": named_so})
    assert isinstance(now, Mark)
    if now.text != mark.text:
        return f"{named_so} → {now.text}"
    return filled(tr("reimport_dialog.mark.changed"), {"mark": named_so})


def _distance(change: PartChange, former: MetreMap, now: MetreMap, scale: Fraction) -> str:
    """Return the distance by which notes moved as text: in bars if exact, else as a note value.

    Parameters
    ----------
    former, now : MetreMap
        Metres of the project and of the file.
    scale : Fraction
        Ticks of the file per tick of the project.
    """
    (bar, *rest), (bar_now, *rest_now) = former.place_of_tick(change.tick), now.place_of_tick(change.tick_now)
    ticks = change.tick_now - round(change.tick * scale)
    sign = "+" if ticks > 0 else "−"
    if scale == 1 and rest == rest_now and bar != bar_now:
        bars = abs(bar_now - bar)
        return tr(f"reimport_dialog.{'bar' if bars == 1 else 'bars'}").format(count=f"{sign}{bars}")
    return sign + _value(abs(ticks), 4 * now.ticks_per_quarter)


def _value(ticks: int, whole: int) -> str:
    """Return a length in ticks as text: a fraction of a whole note (``whole`` ticks), or ticks if that is
    complicated.
    """
    value = Fraction(ticks, whole)
    if value.denominator > 64:
        return tr("reimport_dialog.ticks").format(count=ticks)
    return f"{4 * value}/4" if value.denominator < 4 else str(value)
