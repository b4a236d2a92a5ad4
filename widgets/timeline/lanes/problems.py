"""The problem lane with marks of all problems, and the same marks for other lanes."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.editor.problems import go_to_problem
from app.editor.selection import Selection
from app.editor.session import Session
from app.errors import Message
from app.plan.model import Problem
from widgets.common.controls import named
from widgets.common.plain import Label
from widgets.common.text import sentence
from widgets.timeline.lane import Lane, LaneItem, LaneMouse
from widgets.timeline.model.geometry import TimeSpans
from widgets.timeline.plot.drawing import shade
from widgets.timeline.zoom_and_scroll import TimeAxis

MARK_PX = 11.0
REACH_PX = 8.0


class ProblemMarks(LaneItem[Lane]):
    """Lines below the notes or events that have problems.

    Parameters
    ----------
    rooms : tuple of str
        First parts of the ids of the messages (such as ``"breath"``) that the lane shows.
    """

    def __init__(self, lane: Lane, rooms: tuple[str, ...]) -> None:
        super().__init__(lane, 50.0)
        self._rooms = rooms
        lane.session.problems_changed.connect(lane.update_items)
        self._problems: tuple[Problem, ...] = ()
        self._spans = TimeSpans(np.empty(0), np.empty(0))

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        lane, player = self.lane, self.lane.session.player
        problems = lane.session.problems(player.id) if player is not None else ()
        if problems is not self._problems:
            self._problems = problems
            self._spans = spans_of(problems_in(problems, self._rooms))
        axis, colour = lane.axis, QColor(lane.session.tokens.warning)
        bottom = lane.plot_rect.height()
        for index in self._spans.between(axis.seconds(exposed.left()), axis.seconds(exposed.right())).tolist():
            left = axis.x_px(float(self._spans.start_s[index]))
            right = max(axis.x_px(float(self._spans.end_s[index])), left + 4.0)
            painter.fillRect(QRectF(left, bottom - 2.0, right - left, 2.0), colour)


def problems_in(problems: tuple[Problem, ...], rooms: tuple[str, ...] = ()) -> tuple[Problem, ...]:
    """Return the problems whose message ids begin with one of the given parts; all problems if none are given."""
    return tuple(problem for problem in problems if not rooms or problem.message.id.split(".")[0] in rooms)


def spans_of(problems: tuple[Problem, ...]) -> TimeSpans:
    """Return the time spans of the problems, for searching."""
    return TimeSpans(
        np.array([problem.start_s for problem in problems], np.float64),
        np.array([problem.end_s for problem in problems], np.float64),
    )


class _Marks(LaneItem["ProblemsLane"]):
    """Draws a triangle at the start of every problem, and its extent."""

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        lane = self.lane
        axis, tokens = lane.axis, lane.session.tokens
        middle = lane.plot_rect.height() / 2
        margin_s = MARK_PX / axis.px_per_s
        found = lane.spans.between(axis.seconds(exposed.left()) - margin_s, axis.seconds(exposed.right()) + margin_s)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
        drawn_to = -np.inf
        for index in found.tolist():
            problem = lane.problems[index]
            x, end = axis.x_px(problem.start_s), axis.x_px(problem.end_s)
            if end - x > 2.0:
                painter.fillRect(QRectF(x, middle + MARK_PX / 2 - 1.0, end - x, 2.0), shade(tokens.warning, 130))
            if x < drawn_to + 3.0:
                continue
            drawn_to = x
            chosen = problem.note_id is not None and problem.note_id in lane.session.selection.notes
            painter.setPen(QPen(QColor(tokens.accent if chosen else tokens.warning), 1.2))
            painter.setBrush(QColor(tokens.warning))
            half = MARK_PX / 2
            painter.drawPolygon(
                QPolygonF(
                    [QPointF(x, middle - half), QPointF(x + half, middle + half), QPointF(x - half, middle + half)]
                )
            )
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)


class ProblemsLane(Lane):
    """All problems of the active player. A click on one moves there and shows its text."""

    id = "problems"
    preferred_height_px = 28
    least_height_px = 26

    def __init__(self, session: Session, axis: TimeAxis, parent: QWidget | None = None) -> None:
        super().__init__(session, axis, parent)
        self.problems: tuple[Problem, ...] = ()
        self.spans = spans_of(())
        self._note_ids: frozenset[str] = frozenset()
        self._player_id: str | None = None
        session.problems_changed.connect(self.refresh)
        self.count = named(Label(parent=self.header), "problem_count")
        self.count.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.count.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Preferred)
        self.title_row.addWidget(self.count)
        self.marks = _Marks(self)
        self.refresh()
        self.texted(self.title, text="problems_lane.problems", tip="problems_lane.tip")

    def refresh(self) -> None:
        """Show the problems of the player in front."""
        player = self.session.player
        if player is not None and player.id == self._player_id and self.session.plan is None:
            # Problems of players that are planned again stay until the plans arrive.
            return
        problems = self.session.problems(player.id) if player is not None else ()
        self._player_id = player.id if player is not None else None
        if problems is self.problems:
            return
        self.problems = problems
        self.spans = spans_of(self.problems)
        self._note_ids = frozenset(problem.note_id for problem in problems if problem.note_id is not None)
        self.count.setText(str(len(self.problems)) if self.problems else "")
        self.plot.setToolTip("")
        self.update_items()

    def problem_at(self, mouse: LaneMouse) -> Problem | None:
        """Return the problem nearest to the mouse, within reach; None if there is none."""
        reach_s = REACH_PX / self.axis.px_per_s
        found = self.spans.between(mouse.time_s - reach_s, mouse.time_s + reach_s).tolist()
        # The mark is at the start: the nearest start wins over a long problem that only passes by.
        return min(
            (self.problems[index] for index in found),
            key=lambda problem: abs(problem.start_s - mouse.time_s),
            default=None,
        )

    def selection_changed(self, before: Selection) -> None:
        if not self._note_ids.isdisjoint(before.notes ^ self.session.selection.notes):
            self.update_items()

    def press(self, mouse: LaneMouse) -> None:
        problem = self.problem_at(mouse)
        if problem is None:
            self.session.select(Selection())
            return
        if self.session.player is not None:
            go_to_problem(self.session, self.session.player.id, problem)

    def double_click(self, mouse: LaneMouse) -> None:
        if self.problem_at(mouse) is None:
            self.session.notice(Message("problems.none_here"))

    def hover(self, mouse: LaneMouse | None) -> None:
        problem = self.problem_at(mouse) if mouse is not None else None
        self.plot.setToolTip(sentence(problem.message, self.session) if problem is not None else "")
