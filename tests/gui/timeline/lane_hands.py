"""Helpers for tests of lanes: a panel whose plans follow the project, and mouse actions."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

from app.editor.session import Session
from app.performance.ensemble import Performance
from app.plan.model import PlayerPlan
from app.project.undoable_document import Change
from tests.support.windows import show
from widgets.timeline.lane import Lane
from widgets.timeline.lanes.regions import RegionLane
from widgets.timeline.model.regions.shown_event import Region
from widgets.timeline.panel import TimelinePanel

LEFT = Qt.MouseButton.LeftButton
NONE = Qt.KeyboardModifier.NoModifier
SHIFT = Qt.KeyboardModifier.ShiftModifier
CTRL = Qt.KeyboardModifier.ControlModifier
ALT = Qt.KeyboardModifier.AltModifier


def planned(session: Session) -> None:
    """Update plans immediately after each edit."""

    def follow(change: Change) -> None:
        performance = Performance(change.after, session.performance)
        assert performance.plans is not None
        session.set_performance(performance)

    assert session.performance.plans is not None
    session.changed.connect(follow)


def shown_panel(session: Session, width: int = 1400, height: int = 1000) -> TimelinePanel:
    """Timeline with space for all lanes."""
    planned(session)
    panel = TimelinePanel(session)
    panel.resize(width, height)
    show(panel)
    return panel


def front_plan(session: Session) -> PlayerPlan:
    """Plan of the first selected player."""
    assert session.player is not None
    return session.performance.plan(session.player)


def region_of(lane: RegionLane, event_id: str) -> Region:
    """Region that shows an event in a lane."""
    return next(region for region in lane.regions if region.event_id == event_id)


def middle(lane: RegionLane, event_id: str) -> QPoint:
    """Centre of a region."""
    return lane.box(region_of(lane, event_id)).center().toPoint()


def viewport(lane: Lane) -> QWidget:
    """Widget that receives the lane's mouse events."""
    return lane.plot


def click(lane: Lane, place: QPoint | QPointF, modifiers: Qt.KeyboardModifier = NONE) -> None:
    """Press and release."""
    QTest.mouseClick(viewport(lane), LEFT, modifiers, _point(place))


def double_click(lane: Lane, place: QPoint | QPointF) -> None:
    """Double-click by the events of Qt: press, release, double press, release."""
    QTest.mouseClick(viewport(lane), LEFT, NONE, _point(place))
    QTest.mouseDClick(viewport(lane), LEFT, NONE, _point(place))


def drag(
    lane: Lane,
    place: QPoint | QPointF,
    dx: float = 0.0,
    dy: float = 0.0,
    modifiers: Qt.KeyboardModifier = NONE,
    release: bool = True,
) -> None:
    """Press, move in steps, release."""
    start = _point(place)
    widget = viewport(lane)
    QTest.mousePress(widget, LEFT, modifiers, start)
    steps = 6
    for step in range(1, steps + 1):
        move_to(widget, start + QPoint(round(dx * step / steps), round(dy * step / steps)), modifiers)
    if release:
        QTest.mouseRelease(widget, LEFT, modifiers, start + QPoint(round(dx), round(dy)))


def move_to(widget: QWidget, place: QPoint, modifiers: Qt.KeyboardModifier) -> None:
    """Move with the left button pressed; `QTest.mouseMove` supports neither buttons nor modifiers."""
    event = QMouseEvent(
        QEvent.Type.MouseMove, QPointF(place), QPointF(widget.mapToGlobal(place)), Qt.MouseButton.NoButton, LEFT,
        modifiers,
    )  # fmt: skip
    QApplication.sendEvent(widget, event)


def _point(place: QPoint | QPointF) -> QPoint:
    return place.toPoint() if isinstance(place, QPointF) else place
