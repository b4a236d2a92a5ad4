"""List of problems in all players' plans and in dances."""

from __future__ import annotations

from collections.abc import Sequence
from operator import is_
from typing import NamedTuple, TypeAlias

from PySide6.QtCore import QEvent, QItemSelectionModel, QPoint, Qt, Signal
from PySide6.QtWidgets import QCheckBox, QPushButton, QWidget

from app.editor.edit_names import edit_at
from app.editor.problem_filter import ProblemFilter
from app.editor.problem_fixes import ProblemFix, fixed, fixes_of
from app.editor.problems import go_to_problem, show_mended
from app.editor.session import Session
from app.errors import Message
from app.messages import filled
from app.plan.model import Problem
from app.plan.problem_lines import problem_kind, problems_by_kind
from app.project.edit.corrections import ignore, unignore
from app.project.model import Project
from app.project.performers import Dancer, Player
from app.score.model import Score
from widgets.common.clicks import on_click, on_switch
from widgets.common.combo import Combo
from widgets.common.controls import Retranslated, named, wrapped
from widgets.common.layouts import in_column, in_row, panel
from widgets.common.menus import passing_menu
from widgets.common.plain import Label
from widgets.common.text import sentence
from widgets.inspector.rows import LineList, ListRow

RowKey: TypeAlias = tuple[str, tuple[Problem, ...]]
"""Key of a row: the performer's id, and the problems."""
EVERYONE, SELECTED, ALL = "everyone", "selected", ""
_KIND_TEXTS = {
    ALL: "problem_list.all_kinds",
    "fingering": "problem_list.fingerings",
    "breath": "problem_list.breaths",
    "note": "problem_list.notes",
    "correction": "problem_list.corrections",
    "contact": "problem_list.contacts",
    "dance": "problem_list.dances",
    "project": "problem_list.instruments_and_characters",
}
MOST_LINES = 300
"""Greatest number of lines, since a large score that does not fit its instruments may have thousands."""


class ProblemGroup(NamedTuple):
    """Problems of one kind and performer, which form a row of the list."""

    performer: Player | Dancer
    problems: tuple[Problem, ...]
    is_ignored: bool


class ProblemList(Retranslated, QWidget):
    """List of problems, grouped by player and kind; a click moves to a problem.

    Signals
    -------
    counted(int)
        The total number of problems has changed.
    listed()
        The displayed rows have changed, and with them possibly `height_px`.
    """

    counted = Signal(int)
    listed = Signal()

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._known: dict[int, tuple[tuple[object, ...], ListRow]] = {}
        """Lines by the identity of their problem, with what they were made from: most stay when plans change."""
        self._who, self._kind = Combo(), Combo()
        self._who.setObjectName("problems_who")
        self._kind.setObjectName("problems_kind")
        self.list = named(LineList(session), "problem_list")
        self._empty = wrapped(Label())
        self._empty.setContentsMargins(12, 4, 12, 4)
        self._empty.setAlignment(Qt.AlignmentFlag.AlignTop)
        self._filters = panel(in_row((self._who, 1), (self._kind, 1), margins=(6, 3, 6, 2), spacing=4))
        self._gone_to: tuple[object, int] | None = None
        self._is_opening = False
        self._fix, self._ignore = named(QPushButton(), "fix_problems"), named(QPushButton(), "ignore_problems")
        self._ignored = named(QCheckBox(), "show_ignored_problems")
        for button, run in ((self._fix, self._fix_first), (self._ignore, self._ignore_chosen)):
            on_click(button, run)
        on_switch(self._ignored, lambda _: self.show_problems())
        self._deeds = panel(in_row((self._fix, 1), self._ignore, margins=(6, 3, 6, 3), spacing=4))
        shown = in_row(self._ignored, margins=(6, 4, 6, 0))
        self._column = in_column(
            self._filters, (self.list, 1), (self._empty, 1), shown, self._deeds, of=self, margins=0, spacing=0
        )
        self.list.opened.connect(self._open)
        self.list.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        self.list.customContextMenuRequested.connect(self._offer)
        self.list.selectionModel().selectionChanged.connect(self._show_buttons)
        self._who.chosen.connect(lambda _: self.show_problems())
        self._kind.chosen.connect(lambda _: self.show_problems())
        session.performance_changed.connect(self.show_problems)
        session.problems_changed.connect(self.show_problems)
        session.problem_changed.connect(self._select_gone_to)
        session.players_changed.connect(self._players_changed)
        session.theme_changed.connect(self._say_anew)
        session.pitch_display.changed.connect(self._say_anew)
        whose = {EVERYONE: "problem_list.all_players", SELECTED: "problem_list.selected_players"}
        self.texted(self._who, explained="problem_list.whose_problems", options=whose)
        self.texted(self._kind, explained="problem_list.kind_filter_tip", options=_KIND_TEXTS)
        self.texted(self._fix, explained="problem_list.mend_selected")
        self.texted(self._ignore, explained="problem_list.ignore_selected")
        self.texted(self._ignored, explained="problem_list.show_ignored_tip")
        self._who.show_option(EVERYONE)
        self._kind.show_option(ALL)
        self.retranslate()

    @property
    def _filter(self) -> ProblemFilter:
        return ProblemFilter(self._kind.shown or ALL, self._who.shown == SELECTED)

    def show_problems(self) -> None:
        """Show the problems of the latest plans."""
        session, project = self._session, self._session.performance.project
        by_player = [(one, session.problems(one.id)) for one in project.performers]
        ignored = [(one, session.ignored_problems(one.id)) for one in project.performers]
        found, left = (sum(len(problems) for _, problems in each) for each in (by_player, ignored))
        self.counted.emit(found)
        if not self.isVisible():
            return
        self._session.problem_filter = self._filter
        self._ignored.setVisible(bool(left))
        self._ignored.setText(self.tr("problem_list.show_ignored").format(count=left))
        shows_ignored = self._ignored.isChecked() and bool(left)
        for controls in (self._filters, self._deeds):
            controls.setVisible(bool(found) or shows_ignored)
        requested = self._requested(by_player, False) + (self._requested(ignored, True) if shows_ignored else [])
        requested.sort(key=lambda group: group.problems[0].start_s)
        current = {one.id: one for one in session.project.performers}
        before, self._known = self._known, {}
        lines = []
        for group in requested[:MOST_LINES]:
            player = group.performer
            colour = session.colour(current[player.id]) if player.id in current else ""
            # The text of a row depends on these, including the player's notes, which problems name.
            score = project.score
            part = project.part(player) if isinstance(player, Player) else None
            sources = (*group.problems, player, part, score.tempo_map, score.metres, colour, group.is_ignored)
            known = before.get(id(group.problems[0]))
            if known is None or len(known[0]) != len(sources) or not all(map(is_, known[0], sources)):
                known = (sources, self._line(group, colour, score))
            self._known[id(group.problems[0])] = known
            lines.append(known[1])
        self._show_lines(lines)
        self.list.setVisible(bool(lines))
        more = len(requested) - len(lines)
        self._empty.setVisible(not lines or more > 0)
        if more > 0:
            self._empty.setText(self.tr("problem_list.and_more_choose_players_or").format(count=more))
        else:
            self._empty.setText(self.tr("problem_list.empty") if not found else self.tr("problem_list.no_match"))
        self._show_buttons()
        self.listed.emit()

    def height_px(self, most_rows: int | None = None) -> int:
        """Return the height in pixels at which all rows, or a number of them, are visible."""
        layout = self._column
        layout.invalidate()
        width_px = self.width()
        has_wrapped = layout.hasHeightForWidth()
        whole_px = layout.totalHeightForWidth(width_px) if has_wrapped else layout.totalSizeHint().height()
        if self.list.isHidden():
            return whole_px
        return whole_px - self.list.sizeHint().height() + self.list.height_px(most_rows)

    def _show_lines(self, lines: list[ListRow]) -> None:
        """Show rows; the selection is kept for players that still have problems of the kind."""
        chosen = {(player_id, problem_kind(problems[0])) for player_id, problems in self._chosen()}
        self.list.lines.show_lines(lines)
        if chosen and not self._chosen():
            rows = [row for row, (id, problems) in enumerate(self._keys()) if (id, problem_kind(problems[0])) in chosen]
            for row in rows:
                self.list.selectionModel().select(self.list.lines.index(row), QItemSelectionModel.SelectionFlag.Select)

    def _select_gone_to(self) -> None:
        """Select the row of the problem to which another part of the editor has moved."""
        gone_to = self._session.problem
        if gone_to is None or self._is_opening:
            return
        if not self._filter.takes(*gone_to, self._session.players):
            # None of the requested players has problems.
            self._who.show_option(EVERYONE)
            self._kind.show_option(ALL)
            self.show_problems()
        row = next((row for row, key in enumerate(self._keys()) if key[0] == gone_to[0] and gone_to[1] in key[1]), None)
        if row is None:
            self.list.clearSelection()
            return
        key, index = self._keys()[row], self.list.lines.index(row)
        self._gone_to = key, key[1].index(gone_to[1])
        self.list.selectionModel().setCurrentIndex(index, QItemSelectionModel.SelectionFlag.ClearAndSelect)
        self.list.scrollTo(index)

    def _keys(self) -> list[RowKey]:
        """Return the key of each row: the player and the row's problems."""
        return [line.key for line in self.list.lines.lines if isinstance(line.key, tuple)]

    def _requested(
        self, by_player: list[tuple[Player | Dancer, tuple[Problem, ...]]], is_ignored: bool
    ) -> list[ProblemGroup]:
        """Return the groups of problems that pass the filter of players and kinds."""
        chosen, selected = self._filter, self._session.players
        return [
            ProblemGroup(player, tuple(problems), is_ignored)
            for player, every in by_player
            for problems in problems_by_kind(every)
            if chosen.takes(player.id, problems[0], selected)
        ]

    def _line(self, group: ProblemGroup, colour: str, score: Score) -> ListRow:
        first = group.problems[0]
        place = score.metre_map.label(round(score.tempo_map.ticks(first.start_s)))
        if len(group.problems) > 1:
            place = f"{place}  ×{len(group.problems)}"
        text = sentence(first.message, self._session, group.performer.id)
        tone = "faint" if group.is_ignored else "warning"
        return ListRow((group.performer.id, group.problems), group.performer.name, place, text, colour, tone)

    def _say_anew(self) -> None:
        """Refresh texts and colours of all rows after the language or the theme has changed."""
        self._known = {}
        self.show_problems()

    def _players_changed(self) -> None:
        if self._who.shown == SELECTED:
            self.show_problems()

    def _open(self, key: object) -> None:
        """Move to the first problem of a row; further clicks move to the next ones."""
        assert isinstance(key, tuple)
        player_id, problems = key
        step = self._gone_to[1] + 1 if self._gone_to is not None and self._gone_to[0] == key else 0
        self._gone_to = key, step % len(problems)
        self._is_opening = True
        try:
            go_to_problem(self._session, player_id, problems[self._gone_to[1]])
        finally:
            self._is_opening = False

    # Fixes

    def _chosen(self) -> list[RowKey]:
        """Return the keys of the selected rows: the player and the row's problems."""
        return [key for key in self.list.selected_keys() if isinstance(key, tuple)]

    def _show_buttons(self) -> None:
        chosen = self._chosen()
        fixes = self._fixes(chosen[0]) if len(chosen) == 1 else ()
        self._fix.setEnabled(bool(fixes))
        self._fix.setToolTip(self.tr(self._fix_tip(chosen, bool(fixes))))
        self._fix.setText(self._fix_text(fixes[0], chosen[0][1]) if fixes else self.tr("problem_list.fix"))
        self._ignore.setEnabled(bool(chosen))
        self._ignore.setText(self.tr(self._ignore_text(chosen)))

    def _fix_tip(self, chosen: list[RowKey], has_fix: bool) -> str:
        """Return the tool tip of the button: its effect, or why it is disabled."""
        if has_fix:
            return "problem_list.mend_selected"
        if len(chosen) != 1:
            return "problem_list.fix_needs_a_row"
        is_planned = self._session.performance.project is self._session.project
        return "problem_list.has_no_fix" if is_planned else "problem_list.fix_waits"

    def _ignore_text(self, rows: list[RowKey]) -> str:
        return "problem_list.count_again" if rows and self._are_ignored(rows) else "problem_list.ignore"

    def _are_ignored(self, rows: list[RowKey]) -> bool:
        return all(problems[0] in self._session.ignored_problems(player_id) for player_id, problems in rows)

    def _fixes(self, row: RowKey) -> tuple[ProblemFix, ...]:
        project = self._session.project
        # While a project is planned, the notes of old problems may have changed.
        return fixes_of(project, *row) if self._session.performance.project is project else ()

    def _fix_text(self, fix: ProblemFix, problems: tuple[Problem, ...]) -> str:
        return filled(self.tr(fix.text_id), {"count": len(problems)})

    def _fix_first(self) -> None:
        chosen = self._chosen()
        fixes = self._fixes(chosen[0]) if len(chosen) == 1 else ()
        if fixes:
            self._mend(fixes[0], chosen)

    def _mend(self, fix: ProblemFix, rows: list[RowKey]) -> None:
        name = _edit_of(self._session.project, "edit.fix_problems", rows)
        if self._session.attempt(name, lambda project: fixed(project, fix, rows)):
            show_mended(self._session, *rows[0])

    def _ignore_chosen(self) -> None:
        self._set_ignored(self._chosen())

    def _set_ignored(self, rows: list[RowKey]) -> None:
        """Ignore the problems of rows; if all of them are ignored already, stop ignoring them."""
        if not rows:
            return
        again = self._are_ignored(rows)
        project = self._session.project
        for player_id, problems in rows:
            project = (unignore if again else ignore)(project, player_id, problems)
        name = _edit_of(self._session.project, "edit.count_problems" if again else "edit.ignore_problems", rows)
        self._session.apply(name, project)

    def _offer(self, at: QPoint) -> None:
        """Open the menu of the row under the pointer."""
        index = self.list.indexAt(at)
        if not index.isValid():
            return
        key = self.list.lines.lines[index.row()].key
        assert isinstance(key, tuple)
        rows = self._chosen() if key in self._chosen() else [key]
        menu = passing_menu(self, "problem_menu")
        on_click(menu.addAction(self.tr("problem_list.go_to")), self._open, key)
        menu.addSeparator()
        kind = key[1][0].message.id
        others = [
            line.key
            for line in self.list.lines.lines
            if isinstance(line.key, tuple) and line.key[1][0].message.id == kind and not self._are_ignored([line.key])
        ]
        for fix in self._fixes(key):
            text = self._fix_text(fix, key[1])
            on_click(menu.addAction(text), self._mend, fix, [key])
            if len(others) > 1:
                of_all = self._fix_text(fix, tuple(problem for _, problems in others for problem in problems))
                all_text = self.tr("problem_list.fix_all_players").format(fix=of_all)
                on_click(menu.addAction(all_text), self._mend, fix, others)
        menu.addSeparator()
        on_click(menu.addAction(self.tr(self._ignore_text(rows))), self._set_ignored, rows)
        menu.popup(self.list.viewport().mapToGlobal(at))

    def retranslate(self) -> None:
        self._say_anew()

    # Qt overrides

    def showEvent(self, event: QEvent) -> None:
        self.show_problems()
        self._select_gone_to()

    def hideEvent(self, event: QEvent) -> None:
        self._session.problem_filter = ProblemFilter()


def _edit_of(project: Project, name: str, rows: Sequence[RowKey]) -> Message:
    """Return the name, for the undo history, of an edit of problems: their number, players and range."""
    problems = [problem for _, of_row in rows for problem in of_row]
    ticks = [round(project.score.tempo_map.ticks(problem.start_s)) for problem in problems]
    return edit_at(project, name, len(problems), {player_id for player_id, _ in rows}, ticks)
