"""The dance lane: the basic motions of each dancer over time, which can be changed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Final

from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QMenu, QWidget

from app.editor.session import Session, Severity
from app.errors import Message, Progress, StopRequested
from app.performance.ensemble import Performance
from app.project import limits
from app.project.dance_corrections import DanceCorrection
from app.project.edit import dance_corrections as edit
from app.project.model import Project
from app.project.performers import Dancer
from app.project.undoable_document import Change
from widgets.common.text import sentence
from widgets.timeline.lane import LaneMouse
from widgets.timeline.lanes.choreography.dance_drawing import DancesItem
from widgets.timeline.lanes.choreography.dance_menu import DanceMenu
from widgets.timeline.lanes.choreography.dragged_step import MoveStep, state_beside
from widgets.timeline.lanes.row_lane import RowLane
from widgets.timeline.lanes.row_names import RowNames
from widgets.timeline.zoom_and_scroll import TimeAxis

if TYPE_CHECKING:
    # Modules of dances are loaded only for pieces with dancers.
    from app.choreography.performed.dance_steps import DanceSteps

ROW_PX, LEAST_ROW_PX, MOST_ROW_PX = 46, 26, 90
SHOWN_ROWS, LEAST_SHOWN_ROWS = 4, 2
"""Preferred and least number of visible rows; the wheel scrolls to the others."""
EMPTY_PX = 46


class DanceLane(RowLane):
    """Dancers below one another with their basic motions: a click selects one, a drag moves it to other beats, its
    context menu and the arrow keys replace it. The dance before and after it is generated again.
    """

    id = "dance"
    preferred_height_px = EMPTY_PX
    least_height_px = EMPTY_PX
    folded_at_first = True
    hides_empty = True
    row_limits_px = (LEAST_ROW_PX, MOST_ROW_PX)

    def __init__(self, session: Session, axis: TimeAxis, parent: QWidget | None = None) -> None:
        super().__init__(session, axis, parent)
        self.dances: dict[str, DanceSteps] = {}
        """Known steps by dancer; current once the task is done."""
        self._selected_at: tuple[str, int] | None = None
        self.moving: MoveStep | None = None
        self._shown_of: Performance | None = None
        self._names = RowNames(
            self, lambda: [(dancer.name, self.row_rect(at).center().y()) for at, dancer in enumerate(self.dancers)]
        )
        DancesItem(self)
        self.texted(self.title, text="dance_lane.dance", tip="dance_lane.what_each_dancer_dances_click")
        self.retranslate()
        self._rows_changed()
        self.performance_changed()

    def retranslate(self) -> None:
        self.update_items()

    @property
    def is_empty(self) -> bool:
        return not self.session.project.dancers

    def empty_text(self) -> str:
        """Return the text of an empty lane: how to add a dancer."""
        return "" if self.dancers else self.tr("dance_lane.no_dancers_yet_add_one")

    def reason(self, dance: DanceSteps) -> str:
        """Return the reason why a dancer does not dance; empty otherwise."""
        if dance.error is not None:
            return sentence(dance.error, self.session, dance.dancer.id)
        return "" if dance.steps else self.tr("dance_lane.no_beat_of_music_is")

    # Display

    @property
    def dancers(self) -> tuple[Dancer, ...]:
        """Dancers in the order of their rows, from top to bottom."""
        return self.session.project.dancers

    @property
    def selected_step(self) -> tuple[str, int] | None:
        """Dancer's id and number of the selected step; None if none is selected."""
        if self._selected_at is None:
            return None
        dancer_id, tick = self._selected_at
        dance = self.dances.get(dancer_id)
        if dance is None or not dance.steps:
            return None
        # The step begins after its accent: at the accent the previous step is danced instead of the chosen one.
        if tick in dance.ticks:
            return dancer_id, dance.ticks.index(tick)
        number = next((at for at, (start, end) in enumerate(dance.spans) if start <= tick < end), None)
        return None if number is None else (dancer_id, number)

    def project_changed(self, change: Change) -> None:
        before, after = change.before.dancers, change.after.dancers
        if change.opened:
            self.dances, self._selected_at = {}, None
        if change.opened or before is not after:
            if after and (change.opened or not before):
                self.set_folded(False)
            elif change.opened and not after:
                self.set_folded(True)
            self._rows_changed()

    def performance_changed(self) -> None:
        """Compute the dances of a changed performance in the background."""
        performance = self.session.performance
        if performance.project.dancers and performance is not self._shown_of:
            self._shown_of = performance
            self.session.tasks.run(Message("work.dances"), _finder(performance), self._show, key="dances")

    def _show(self, dances: dict[str, DanceSteps]) -> None:
        self.dances = dances
        self.update_items()

    def _rows_changed(self) -> None:
        count = len(self.dancers)
        if count:
            self.ask_height(min(count, SHOWN_ROWS) * ROW_PX, min(count, LEAST_SHOWN_ROWS) * LEAST_ROW_PX)
        else:
            self.ask_height(EMPTY_PX, EMPTY_PX)
        self._scroll_to(self._scrolled_px)
        self._names.update()
        self.update_items()

    # Layout of rows

    def count_rows(self) -> int:
        return len(self.dancers)

    def rows_scrolled(self) -> None:
        self._names.update()

    def _dance_at(self, mouse: LaneMouse) -> DanceSteps | None:
        row = self.row_number_at(mouse.y_px)
        return None if row is None else self.dances.get(self.dancers[row].id)

    def step_at(self, mouse: LaneMouse) -> tuple[str, int] | None:
        """Return the dancer's id and the number of the step under the mouse; None if there is none."""
        dance = self._dance_at(mouse)
        number = dance.step_at(mouse.time_s) if dance is not None and dance.steps else None
        return None if dance is None or number is None else (dance.dancer.id, number)

    # Selecting

    def select_step(self, step: tuple[str, int] | None) -> None:
        """Select a step; the position stays selected when the dance changes."""
        self._selected_at = None if step is None else (step[0], self.dances[step[0]].ticks[step[1]])
        if step is not None:
            self.session.set_dancer(step[0])
        self.update_items()

    def press(self, mouse: LaneMouse) -> None:
        step = self.step_at(mouse)
        self.select_step(step)
        clock = self.session.project.score.tempo_map
        self.moving = None if step is None else MoveStep(mouse, self.dances[step[0]], step[1], self.axis, clock)

    def drag(self, mouse: LaneMouse) -> None:
        if self.moving is not None:
            self.moving.drag(mouse)
            self.update_items()

    def release(self, mouse: LaneMouse) -> None:
        moving, self.moving = self.moving, None
        if moving is not None and moving.tick is not None:
            self.move_step(moving.dancer_id, moving.number, moving.tick)
        self.update_items()

    def cancel(self) -> None:
        self.moving = None
        self.update_items()

    def double_click(self, mouse: LaneMouse) -> None:
        """Open the context menu of the step under the mouse."""
        self.moving = None
        menu = self.context_menu(mouse)
        if menu is None:
            self.session.notice(Message("dance.no_step_here"), Severity.WARNING)
        else:
            menu.popup(self.plot.mapToGlobal(QPoint(round(mouse.x_px), round(mouse.y_px))))

    def hover(self, mouse: LaneMouse | None) -> None:
        step, dance = (self.step_at(mouse), self._dance_at(mouse)) if mouse is not None else (None, None)
        text = self.tip(*step) if step is not None else self.reason(dance) if dance is not None else ""
        self.plot.setToolTip(text)

    def tip(self, dancer_id: str, number: int) -> str:
        """Return the description of a step and its dancer."""
        dance = self.dances[dancer_id]
        step = dance.steps[number]
        segment = dance.model.segments[step.segment]
        start_s = segment.start / float(dance.model.clips[segment.clip].fps)
        lines = [
            self.tr("dance_lane.basic_motion_s").format(number=step.state + 1, seconds=step.end_s - step.start_s),
            self.tr("dance_lane.from_s").format(source=dance.model.sources[segment.clip].motion_name, start=start_s),
        ]
        if dance.pinned[number]:
            lines.append(self.tr("dance_lane.pinned_backspace_returns_it_to"))
        for item in dance.barred(number):
            lines.append(self.tr("dance_lane.basic_motion_disabled").format(number=item.state + 1))
        return "\n".join(lines)

    def context_menu(self, mouse: LaneMouse) -> QMenu | None:
        step = self.step_at(mouse)
        self.select_step(step)
        return None if step is None else DanceMenu(self, *step, self)

    # Edits

    def pin(self, dancer_id: str, number: int, state: int) -> None:
        """Pin a basic motion (``state``) in place of a step of the dance, as one undo step."""
        tick = self.dances[dancer_id].ticks[number]
        self._attempt(
            Message("edit.pin_dance", {"number": state + 1, "dancer": self._name(dancer_id)}),
            lambda project: edit.pin_state(self._freed(project, dancer_id, number), dancer_id, tick, state),
        )

    def use(self, dancer_id: str, number: int, segment: int) -> None:
        """Replace a step by a segment (by index) of the motion capture."""
        tick = self.dances[dancer_id].ticks[number]
        self._attempt(
            Message("edit.use_dance_segment", {"dancer": self._name(dancer_id)}),
            lambda project: edit.use_segment(self._freed(project, dancer_id, number), dancer_id, tick, segment),
        )

    def move_step(self, dancer_id: str, number: int, tick: int) -> None:
        """Move the accent of a step to a tick by pinning the step's segment there."""
        dance = self.dances[dancer_id]
        if tick == dance.ticks[number]:
            return
        segment = dance.steps[number].segment
        self._attempt(
            Message("edit.move_dance_motion", {"dancer": self._name(dancer_id)}),
            lambda project: edit.use_segment(self._freed(project, dancer_id, number), dancer_id, tick, segment),
        )
        self._selected_at = dancer_id, tick
        self.update_items()

    def forbid(self, dancer_id: str, number: int, everywhere: bool = False) -> None:
        """Forbid the basic motion of a step at its place, or with ``everywhere`` in the whole piece; removes a pin on
        it.
        """
        dance = self.dances[dancer_id]
        state = dance.steps[number].state
        start, end = (-limits.LAST_TICK, limits.LAST_TICK) if everywhere else dance.spans[number]
        self._attempt(
            Message("edit.forbid_dance", {"number": state + 1, "dancer": self._name(dancer_id)}),
            lambda project: edit.forbid_state(self._freed(project, dancer_id, number), dancer_id, start, end, state),
        )

    def take_back(self, dancer_id: str, corrections: Sequence[DanceCorrection]) -> None:
        """Remove corrections of a dance as one undoable step, so that the generated motion returns."""
        self._attempt(
            Message("edit.release_dance", {"dancer": self._name(dancer_id)}),
            lambda project: edit.take_back(project, dancer_id, corrections),
        )

    def clear(self, dancer_id: str) -> None:
        """Remove all corrections of a dancer's dance, so that it is generated again."""
        self._attempt(
            Message("edit.release_dance", {"dancer": self._name(dancer_id)}),
            lambda project: edit.clear(project, dancer_id),
        )

    def _freed(self, project: Project, dancer_id: str, number: int) -> Project:
        return edit.take_back(project, dancer_id, self.dances[dancer_id].pinned[number])

    def _name(self, dancer_id: str) -> str:
        return self.session.project.dancer(dancer_id).name

    def _attempt(self, name: Message, change: Callable[[Project], Project]) -> None:
        self.session.attempt(name, change)

    # Keys

    def key(self, event: QKeyEvent) -> bool:
        """Handle keys: Left and Right select adjacent steps, with Shift they move the step, Up and Down replace the
        basic motion, Backspace and Delete remove corrections of the step, Escape deselects.
        """
        modifiers = event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier
        selected, key = self.selected_step, event.key()
        if selected is None:
            return False
        dancer_id, number = selected
        dance = self.dances[dancer_id]
        if modifiers == Qt.KeyboardModifier.ShiftModifier and key in (Qt.Key.Key_Left, Qt.Key.Key_Right):
            place = dance.steps[number].place + (1 if key == Qt.Key.Key_Right else -1)
            self.move_step(dancer_id, number, dance.places[min(max(place, 0), len(dance.places) - 1)])
        elif modifiers != Qt.KeyboardModifier.NoModifier:
            return False
        elif key in (Qt.Key.Key_Left, Qt.Key.Key_Right):
            by = 1 if key == Qt.Key.Key_Right else -1
            self.select_step((dancer_id, min(max(number + by, 0), len(dance.steps) - 1)))
        elif key in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            by = 1 if key == Qt.Key.Key_Down else -1
            self.pin(dancer_id, number, state_beside(dance, dance.steps[number].state, by))
        elif key in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace):
            self.take_back(dancer_id, (*dance.pinned[number], *dance.barred(number)))
        elif key == Qt.Key.Key_Escape:
            self.select_step(None)
        else:
            return False
        return True


def _finder(performance: Performance) -> Callable[[Progress, StopRequested], dict[str, DanceSteps]]:
    def work(progress: Progress, stop_requested: StopRequested) -> dict[str, DanceSteps]:
        from app.choreography.performed.dance_steps import dances_of

        return dances_of(performance, stop_requested, progress)

    return work


LANES: Final = (DanceLane,)
"""Lanes that the table of features adds to the timeline."""
