"""Models of the timeline without a display: positions, objects under the mouse, effects of drags."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.editor.selection import Selection
from app.errors import Message
from app.performance.ensemble import Performance
from app.plan.parameters import PlayerParameters
from app.project.casting import StagePosition
from app.project.edit import notes
from app.project.model import Project
from app.project.performers import Player
from app.project.snap_grid import Grid
from app.project.undoable_document import Document
from app.score.model import Note, Part, Score
from app.score.tempo import TempoMap
from widgets.timeline.model.gestures import Band, LiveEdit, either, moved_edge
from widgets.timeline.model.lane_mouse import LaneMouse, PixelRect, spanned
from widgets.timeline.model.regions.shown_event import Region
from widgets.timeline.model.regions.shown_regions import RegionTable, region_box
from widgets.timeline.model.roll.shown_notes import edge_of, zoomed_pitches
from widgets.timeline.model.visible_time import LEAST_SPAN_S, TimeView

TPQ = 480
VIEW = TimeView((0.0, 100.0), 10.0, 20.0, 1000)
Change = Callable[[TimeView, float, float], TimeView]


class Desk:
    """The part of the session that mouse gestures need."""

    def __init__(self) -> None:
        part = Part("1.1.1", "One", 0, 0, 0, None, None, "trumpet_Bb", (Note("1:0", 0, TPQ, 60, 80),))
        player = Player("p", "One", part.id, "trumpet_Bb", "maria", PlayerParameters(), StagePosition(0, 0, 0))
        self.document = Document(Project(Score("One", TPQ, TempoMap(TPQ), parts=(part,)), (player,)))
        self.selection, self.grid = Selection(), Grid()
        self.performance = Performance(self.project)

    @property
    def project(self) -> Project:
        return self.document.project

    def select(self, selection: Selection) -> None:
        self.selection = selection

    def apply(
        self, name: Message, project: Project, gesture: object | None = None, origin: object | None = None
    ) -> bool:
        self.document.apply(name, project, gesture, origin)
        return True

    def attempt(
        self,
        name: Message,
        edit: Callable[[Project], Project],
        gesture: object | None = None,
        origin: object | None = None,
    ) -> bool:
        self.apply(name, edit(self.project), gesture, origin)
        return True


def mouse(x_px: float, y_px: float = 0.0, view: TimeView = VIEW) -> LaneMouse:
    return LaneMouse(x_px, y_px, view.seconds(x_px), y_px, 0.0, 0)


def onset(desk: Desk) -> int:
    return desk.project.score.parts[0].notes[0].onset_tick


def moved_by(ticks: int) -> Callable[[Project], Project]:
    return lambda project: notes.move(project, {"1:0"}, ticks, 0)


@given(
    st.sampled_from(
        [TimeView.showing, TimeView.zoomed, lambda view, by, _: view.panned(by), TimeView.revealing, TimeView.within]
    ),
    st.floats(0.01, 300.0),
    st.floats(-50.0, 300.0),
)
def test_a_view_never_leaves_its_limits(change: Change, first: float, second: float) -> None:
    view = change(VIEW, first, second)
    assert view.limits_s[0] - 1e-9 <= view.start_s < view.end_s <= view.limits_s[1] + 1e-9
    assert view.span_s >= LEAST_SPAN_S * (1 - 1e-6)


@given(st.floats(0.5, 4.0), st.floats(0.0, 1000.0))
def test_zooming_leaves_the_time_under_the_mouse_where_it_is(factor: float, x_px: float) -> None:
    view = VIEW._replace(limits_s=(-1000.0, 1000.0))
    at_s = view.seconds(x_px)
    assert view.zoomed(factor, at_s).x_px(at_s) == pytest.approx(x_px, abs=1e-6)


def test_widening_keeps_the_zoom() -> None:
    assert VIEW.widened(1500).px_per_s == pytest.approx(VIEW.px_per_s)


@given(st.integers(-50, 50), st.booleans())
def test_an_edge_stops_before_the_other(tick: int, at_start: bool) -> None:
    start, end = moved_edge(0, 10, at_start, tick)
    assert end - start >= 1
    kept, requested = (end, start) if at_start else (start, end)
    assert kept == (10 if at_start else 0)
    assert requested == tick or end - start == 1


def test_a_drag_is_one_step_and_can_be_taken_back() -> None:
    desk = Desk()
    before = desk.project
    step = LiveEdit(desk, desk)
    for ticks in (10, 20, 30):
        assert step.edit(Message("edit.move_notes", {"count": 1, "of": ""}), moved_by(ticks))
    assert (onset(desk), len(desk.document.done)) == (30, 1)
    step.take_back()
    assert desk.project is before
    assert not desk.document.done


def test_a_step_that_was_undone_in_the_middle_does_nothing_more() -> None:
    desk = Desk()
    step = LiveEdit(desk, desk)
    step.edit(Message("edit.move_notes", {"count": 1, "of": ""}), moved_by(10))
    desk.document.undo()
    assert not step.edit(Message("edit.move_notes", {"count": 1, "of": ""}), moved_by(20))
    step.take_back()
    assert onset(desk) == 0


class Plane:
    """Plot whose values are pixels."""

    def __init__(self) -> None:
        self.axis = VIEW

    def y_px(self, value: float) -> float:
        return value


def test_a_rubber_band_begins_late_and_stays_with_the_picture() -> None:
    plane, boxes = Plane(), list[PixelRect]()
    band = Band(plane, mouse(100.0, 10.0), either(3.0), lambda box, _: boxes.append(box))
    band.drag(mouse(102.0, 12.0))
    assert not boxes
    band.drag(mouse(110.0, 5.0))
    plane.axis = VIEW.panned(1.0)
    band.drag(mouse(110.0, 5.0, plane.axis))
    assert [tuple(round(side) for side in box) for box in boxes] == [(100, 5, 110, 10), (0, 5, 110, 10)]
    band.release(mouse(110.0, 5.0))
    assert band.box is None


@given(st.lists(st.integers(0, 6), min_size=8, max_size=8))
def test_boxes_meet_where_they_have_pixels_in_common(places: list[int]) -> None:
    one, other = (spanned(*places[at : at + 4]) for at in (0, 4))

    def cells(box: PixelRect) -> set[tuple[int, int]]:
        return {(x, y) for x in range(int(box.left), int(box.right)) for y in range(int(box.top), int(box.bottom))}

    assert one.meets(other) is bool(cells(one) & cells(other))


def region(number: int, start_s: float, end_s: float, **said: object) -> Region:
    made = Region("p", f"gesture:{number}", "gesture", 0, 1, start_s, end_s)
    for name, value in said.items():
        setattr(made, name, value)
    return made


def test_the_shorter_region_is_on_top_and_the_selected_above_all() -> None:
    long, short = region(1, 10.0, 18.0), region(2, 12.0, 14.0)
    table = RegionTable([short, long])
    place = lambda one: region_box(one, VIEW, (0.0, 20.0))  # noqa: E731
    at = mouse(300.0, 10.0)
    assert table.at(at, VIEW, place, ()) == (short, "body")
    assert table.at(at, VIEW, place, {long.key}) == (long, "body")
    assert table.at(mouse(201.0, 10.0), VIEW, place, ()) == (short, "start")
    assert table.at(mouse(399.0, 10.0), VIEW, place, ()) == (short, "end")
    assert table.at(replace(at, y_px=50.0), VIEW, place, ()) == (None, "")


def test_of_a_crowd_the_strongest_and_all_by_hand_are_drawn() -> None:
    far = TimeView((0.0, 1000.0), 0.0, 1000.0, 1000)
    crowd = [region(at, at * 0.01, at * 0.01 + 0.001, amount=at / 200, by_hand=at == 7) for at in range(100)]
    drawn = RegionTable(crowd).visible(far, 0.0, 1000.0, (), {}, ())
    assert {one.event_id for one in drawn} == {"gesture:7", "gesture:99"}


@given(st.floats(6.0, 200.0), st.floats(0.0, 1.0))
def test_every_note_has_a_middle_to_move_it_by(width: float, share: float) -> None:
    held = edge_of(0.0, width, share * width)
    if share < 0.7:
        assert held is not False
    if 0.3 < share < 0.7 or (held is True and width < 24.0):
        assert held is None
    assert edge_of(0.0, width, width) is False


@given(st.floats(0.3, 3.0), st.floats(0.0, 1.0))
def test_pitches_stay_between_0_and_128(factor: float, share: float) -> None:
    bottom, top = zoomed_pitches((40.0, 80.0), factor, 40.0 + 40.0 * share)
    assert 0.0 <= bottom < top <= 128.0
    assert np.isclose(top - bottom, np.clip(40.0 / factor, 10.0, 128.0))
