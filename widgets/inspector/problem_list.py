"""Problems that the animator should look at, of all players' plans and of dances."""

from __future__ import annotations

from operator import is_

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtWidgets import QWidget

from app.editor.problems import go_to_problem
from app.editor.session import Session
from app.plan.model import Problem
from app.project.performers import Dancer, Player
from app.score.model import Score
from widgets.common.combo import Combo
from widgets.common.controls import Retranslated, named, wrapped
from widgets.common.layouts import in_column, in_row
from widgets.common.plain import Label
from widgets.common.text import sentence
from widgets.inspector.rows import LineList, ListRow

EVERYONE, SELECTED, ALL = "everyone", "selected", "all"
_KINDS = {
    "fingering": "fingering",
    "breath": "breath",
    "note": "note",
    "correction": "correction",
    "contact": "contact",
    "dance": "dance",
    "choreography": "dance",
    "project": "project",
}
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
"""No one reads more; a large score that does not fit its instruments has thousands."""


class ProblemList(Retranslated, QWidget):
    """Problems, by player and kind; a click shows where.

    Signals
    -------
    counted(int)
        So many problems there are in all.
    """

    counted = Signal(int)

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
        filters = in_row((self._who, 1), (self._kind, 1), margins=(6, 6, 6, 4), spacing=4)
        in_column(filters, (self.list, 1), (self._empty, 1), of=self, margins=0, spacing=0)
        self.list.opened.connect(self._open)
        self._who.chosen.connect(lambda _: self.show_problems())
        self._kind.chosen.connect(lambda _: self.show_problems())
        session.performance_changed.connect(self.show_problems)
        session.problems_changed.connect(self.show_problems)
        session.players_changed.connect(self._players_changed)
        session.theme_changed.connect(self._say_anew)
        session.pitch_display.changed.connect(self._say_anew)
        whose = {EVERYONE: "problem_list.all_players", SELECTED: "problem_list.selected_players"}
        self.texted(self._who, explained="problem_list.whose_problems", options=whose)
        self.texted(self._kind, explained="problem_list.problems_of_which_kind", options=_KIND_TEXTS)
        self._who.show_option(EVERYONE)
        self._kind.show_option(ALL)
        self.retranslate()

    def show_problems(self) -> None:
        """Show what the newest plans have."""
        project = self._session.performance.project
        found = [(one, problem) for one in project.performers for problem in self._session.problems(one.id)]
        self.counted.emit(len(found))
        if not self.isVisible():
            return
        chosen = set(self._session.players) if self._who.shown == SELECTED else None
        kind = self._kind.shown
        current = {one.id: one for one in self._session.project.performers}
        requested = [
            (player, problem)
            for player, problem in sorted(found, key=lambda item: item[1].start_s)
            if (chosen is None or player.id in chosen) and kind in (ALL, None, _kind(problem))
        ]
        before, self._known = self._known, {}
        lines = []
        for player, problem in requested[:MOST_LINES]:
            colour = self._session.colour(current[player.id]) if player.id in current else ""
            # What a line says comes from these; the player's notes are among them, which problems name.
            score = project.score
            part = project.part(player) if isinstance(player, Player) else None
            sources = (problem, player, part, score.tempo_map, score.metres, colour)
            known = before.get(id(problem))
            if known is None or not all(map(is_, known[0], sources)):
                known = (sources, self._line(player, problem, colour, score))
            self._known[id(problem)] = known
            lines.append(known[1])
        self.list.lines.show_lines(lines)
        self.list.setVisible(bool(lines))
        more = len(requested) - len(lines)
        self._empty.setVisible(not lines or more > 0)
        if more > 0:
            self._empty.setText(self.tr("problem_list.and_more_choose_players_or").format(count=more))
        else:
            self._empty.setText(
                self.tr("problem_list.no_problems_everything_can_be")
                if not found
                else self.tr("problem_list.none_of_these_choose_other")
            )

    def _line(self, player: Player | Dancer, problem: Problem, colour: str, score: Score) -> ListRow:
        place = score.metre_map.label(round(score.tempo_map.ticks(problem.start_s)))
        text = sentence(problem.message, self._session, player.id)
        return ListRow((player.id, problem), player.name, place, text, colour, "warning")

    def _say_anew(self) -> None:
        """Words or colours are others."""
        self._known = {}
        self.show_problems()

    def _players_changed(self) -> None:
        if self._who.shown == SELECTED:
            self.show_problems()

    def _open(self, key: object) -> None:
        assert isinstance(key, tuple)
        player_id, problem = key
        go_to_problem(self._session, player_id, problem)

    def retranslate(self) -> None:
        self._say_anew()

    # Qt's own names

    def showEvent(self, event: QEvent) -> None:
        self.show_problems()


def _kind(problem: Problem) -> str:
    room = problem.message.id.split(".")[0]
    return _KINDS.get(room, room)
