"""The context menu of a step of a dance."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Protocol

import numpy as np
from PySide6.QtGui import QAction, QColor, QIcon
from PySide6.QtWidgets import QMenu, QWidget

from app.arrays import FloatArray
from app.editor.session import Session
from app.project.dance_corrections import DanceCorrection
from widgets.common.choreography.figures import ICON_PX, figure_icon
from widgets.common.clicks import on_click
from widgets.common.controls import named
from widgets.common.plain import verbatim

if TYPE_CHECKING:
    from app.choreography.performed.dance_steps import DanceSteps

MOST_SEGMENTS = 60
"""Greatest number of segments of a basic motion in the menu: those with figures most similar to the current one."""


class Dances(Protocol):
    """Part of the lane that the menu uses; a protocol, since the lane imports this module."""

    session: Session
    dances: dict[str, DanceSteps]

    def pin(self, dancer_id: str, number: int, state: int) -> None: ...
    def use(self, dancer_id: str, number: int, segment: int) -> None: ...
    def forbid(self, dancer_id: str, number: int, everywhere: bool = False) -> None: ...
    def take_back(self, dancer_id: str, corrections: Sequence[DanceCorrection]) -> None: ...
    def clear(self, dancer_id: str) -> None: ...


class DanceMenu(QMenu):
    """Menu of the segments that can replace a step.

    Parameters
    ----------
    number : int
        Index of the step in its dance.
    """

    def __init__(self, lane: Dances, dancer_id: str, number: int, parent: QWidget) -> None:
        super().__init__(parent)
        from app.choreography.performed.dance_steps import figures

        self.setObjectName("dance_menu")
        self._lane, self._dancer_id, self._number = lane, dancer_id, number
        self._dance = lane.dances[dancer_id]
        assert self._dance.choreographer is not None
        self._figures: FloatArray = figures(self._dance.choreographer)
        step, pinned = self._dance.steps[number], self._dance.pinned[number]
        motion = step.state + 1
        self._add(
            self,
            self.tr("dance_menu.pin_basic_motion_here").format(number=motion),
            lambda: lane.pin(dancer_id, number, step.state),
        ).setEnabled(not pinned)
        self._add_motions()
        self._add_segments()
        self.addSeparator()
        self._add(
            self,
            self.tr("dance_menu.disable_basic_motion").format(number=motion),
            lambda: lane.forbid(dancer_id, number),
        )
        self._add(
            self,
            self.tr("dance_menu.do_not_dance_basic_motion_in_this_piece").format(number=motion),
            lambda: lane.forbid(dancer_id, number, everywhere=True),
        )
        for item in self._dance.barred(number):
            text = self.tr("dance_menu.allow_basic_motion_again").format(number=item.state + 1)
            self._add(self, text, partial(lane.take_back, dancer_id, (item,)))
        self.addSeparator()
        self._add(self, self.tr("dance_menu.revert"), lambda: lane.take_back(dancer_id, pinned)).setEnabled(
            bool(pinned)
        )
        corrections = lane.session.project.dance_corrections.get(dancer_id, ())
        self._add(
            self, self.tr("dance_menu.return_whole_dance_to_generator"), lambda: lane.clear(dancer_id)
        ).setEnabled(bool(corrections))

    def _add_motions(self) -> None:
        from app.choreography.performed.dance_steps import examples

        menu = self._submenu(self.tr("dance_menu.other_basic_motion"), "dance_motions")
        danced = self._dance.steps[self._number].state
        for state, example in enumerate(examples(self._dance.model, self._figures)):
            if example is None:
                continue
            text = self.tr("dance_menu.basic_motion").format(number=state + 1)
            action = self._add(menu, text, partial(self._lane.pin, self._dancer_id, self._number, state))
            action.setIcon(self._icon(example))
            action.setEnabled(state != danced)

    def _add_segments(self) -> None:
        from app.choreography.performed.dance_steps import segments_of

        menu = self._submenu(self.tr("dance_menu.change_segment"), "dance_segments")
        model, step = self._dance.model, self._dance.steps[self._number]
        others = np.array([one for one in segments_of(model, step.state) if one != step.segment], np.int64)
        far = np.linalg.norm(self._figures[others] - self._figures[step.segment], axis=-1).sum(axis=-1)
        for segment in others[np.argsort(far, kind="stable")][:MOST_SEGMENTS].tolist():
            one = model.segments[segment]
            text = self.tr("dance_menu.s").format(
                source=model.sources[one.clip].motion_name, start=one.start / float(model.clips[one.clip].fps)
            )
            self._add(menu, verbatim(text), partial(self._lane.use, self._dancer_id, self._number, segment)).setIcon(
                self._icon(segment)
            )
        menu.setEnabled(bool(len(others)))

    def _submenu(self, title: str, name: str) -> QMenu:
        menu = named(self.addMenu(title), name)
        # Large enough to recognise the figures.
        menu.setStyleSheet(f"QMenu {{ icon-size: {ICON_PX}px; }}")
        return menu

    def _add(self, menu: QMenu, text: str, do: Callable[[], None]) -> QAction:
        action = menu.addAction(text)
        on_click(action, do)
        return action

    def _icon(self, segment: int) -> QIcon:
        drawn = self._figures[segment]
        if self._dance.dancer.mirrored:
            drawn = drawn * (-1.0, 1.0)
        return figure_icon(drawn, QColor(self._lane.session.tokens.text), self.devicePixelRatioF())
