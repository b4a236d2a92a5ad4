"""Controls are judged at the frames of their notes, compared with synthetic values frame by frame."""

from __future__ import annotations

from collections.abc import Set

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from app.arrays import FloatArray
from app.contacts.bounds import in_place
from app.contacts.controls import ControlMeasure, NoteFrames, notes_of
from app.errors import Message
from app.plan.model import FingeringEvent
from instrument_maps.model import Control, ControlMotion

FPS, FIRST_FRAME_S = 10.0, -0.05


def event(start_s: float, end_s: float, value: float) -> FingeringEvent:
    controls = {"c": value} if value else {}
    return FingeringEvent("x", "n", 0, 1, start_s, end_s, "", 1, controls, 0.0, Message("fingering.first_choice"))


def control(**changes: object) -> Control:
    plain = Control("c", "press", "pitch", "right.index", "c", ControlMotion((0.0, -1.0, 0.0), travel_m=0.016))
    return msgspec.structs.replace(plain, **changes)


def measured(
    notes: list[FingeringEvent], control: Control, values: np.ndarray, out_of_reach: Set[str] = frozenset()
) -> ControlMeasure:
    return NoteFrames(FIRST_FRAME_S + np.arange(40) / FPS, notes).measure(control, values, FPS, out_of_reach)


def test_a_note_is_judged_at_the_first_frame_at_or_after_its_onset() -> None:
    # Onset 1.0 s lies between the frames 10 (0.95 s) and 11 (1.05 s).
    values = np.zeros(40)
    values[11:] = 1.0
    assert measured([event(1.0, 2.0, 1.0)], control(), values).right == 1
    values[11] = 0.89
    assert measured([event(1.0, 2.0, 1.0)], control(), values).right == 0
    values[11] = 0.9
    assert measured([event(1.0, 2.0, 1.0)], control(), values).right == 1


def test_short_notes_are_counted_apart() -> None:
    found = measured([event(1.0, 1.1, 1.0), event(1.1, 2.0, 0.0)], control(), np.zeros(40))
    assert (found.judged, found.right, found.short_notes, found.short_right) == (1, 1, 1, 0)


def test_a_slide_is_judged_in_millimetres() -> None:
    slide = control(kind="slide", motion=ControlMotion((0.0, 0.0, 1.0), travel_m=0.6), max_speed_m_s=2.5)
    notes = [event(1.0, 2.0, 0.5)]
    assert measured(notes, slide, np.full(40, 0.5 + 0.0049 / 0.6)).right == 1
    assert measured(notes, slide, np.full(40, 0.5 + 0.0051 / 0.6)).right == 0


def test_what_stops_where_the_hand_ends_is_distinguished_from_what_is_wrong() -> None:
    slide = control(
        kind="slide", finger="right.hand", motion=ControlMotion((0.0, 0.0, 1.0), travel_m=0.6), max_speed_m_s=2.5
    )
    notes, values = [event(1.0, 2.0, 0.9)], np.full(40, 0.8)
    wrong = measured(notes, slide, values)
    assert (wrong.right, wrong.stopped_short, wrong.held_wrong, wrong.held_stopped_short) == (0, 0, 10, 0)
    reported = measured(notes, slide, values, {"n"})
    assert (reported.right, reported.stopped_short, reported.held_wrong, reported.held_stopped_short) == (0, 1, 0, 10)
    assert reported.most_short_mm == pytest.approx(60.0)
    # Beyond its place a control is wrong too, and so is one that no hand moves.
    assert measured(notes, slide, np.ones(40), {"n"}).held_wrong == 10
    pressed = msgspec.structs.replace(slide, finger="right.index")
    assert measured(notes, pressed, values, {"n"}).held_wrong == 10


def test_leaving_too_early_is_found() -> None:
    notes = [event(1.0, 2.0, 1.0), event(2.0, 3.0, 0.0)]
    values = np.zeros(40)
    values[11:20] = 1.0  # the last frame before 1.94 s is 19 (1.85 s)
    assert measured(notes, control(), values).held_wrong == 0
    values[19] = 0.5
    assert measured(notes, control(), values).held_wrong == 1


def test_a_slide_may_leave_the_last_note_of_a_cut_for_the_note_after_it() -> None:
    notes = [event(0.0, 1.0, 0.0), event(1.0, 2.0, 1.0), event(2.0, 3.0, 0.0)]
    assert notes_of(notes, 0.5, 1.9) == notes
    assert notes_of(notes, 1.0, 2.5) == notes[1:]


def test_a_slide_may_leave_as_early_as_an_unhurried_way_needs_but_not_before_half_its_note() -> None:
    slide = control(
        kind="slide",
        motion=ControlMotion((0.0, 0.0, 1.0), travel_m=0.5),
        move_note_share=0.5,
        max_speed_m_s=2.5,
        unhurried_speed_m_s=0.8,
    )
    values = np.full(40, 0.5)  # 0.63 s of way before 2.0 s; half a note is 0.5 s
    values[11:16], values[20:] = 1.0, 0.0
    assert measured([event(1.0, 2.0, 1.0), event(2.0, 3.0, 0.0)], slide, values).held_wrong == 0
    values[15] = 0.5
    assert measured([event(1.0, 2.0, 1.0), event(2.0, 3.0, 0.0)], slide, values).held_wrong == 1


def test_a_hurried_slide_may_take_two_thirds_of_its_note_but_not_more() -> None:
    slide = control(
        kind="slide",
        motion=ControlMotion((0.0, 0.0, 1.0), travel_m=0.8),
        move_note_share=0.5,
        max_speed_m_s=2.5,
        unhurried_speed_m_s=0.9,
    )
    values = np.full(40, 0.5)  # at its calmest, 0.67 s of way before 2.0 s; two thirds of the note are 0.65 s
    values[11:14], values[20:] = 1.0, 0.0
    assert measured([event(1.0, 2.0, 1.0), event(2.0, 3.0, 0.0)], slide, values).held_wrong == 0
    values[13] = 0.5
    assert measured([event(1.0, 2.0, 1.0), event(2.0, 3.0, 0.0)], slide, values).held_wrong == 1


@given(
    notes=st.lists(st.tuples(st.floats(-1.0, 5.0), st.floats(0.0, 2.0), st.sampled_from((0.0, 0.5, 1.0))), max_size=8),
    values=arrays(np.float64, 40, elements=st.sampled_from((0.0, 0.05, 0.45, 0.5, 0.95, 1.0))),
)
def test_what_works_is_what_is_found_note_by_note(notes: list[tuple[float, float, float]], values: FloatArray) -> None:
    events = [event(start_s, start_s + length_s, value) for start_s, length_s, value in sorted(notes)]
    times_s, press = FIRST_FRAME_S + np.arange(40) / FPS, control()
    expected = {True: np.zeros(40, dtype=np.bool_), False: np.zeros(40, dtype=np.bool_)}
    for one in events:
        value = one.controls.get("c", 0.0)
        sounds = (times_s >= one.start_s - 1e-9) & (times_s < one.end_s - 1e-9)
        expected[value != 0.0] |= sounds & in_place(press, values, np.full(40, value))
    pressed, released = NoteFrames(times_s, events).working(press, values)
    np.testing.assert_array_equal(pressed, expected[True])
    np.testing.assert_array_equal(released, expected[False])


def _kept_slowly(times_s: FloatArray, notes: list[FingeringEvent], asked: list[bool], moved: Control) -> list[bool]:
    """Frames of given notes until the control may move for the next one, calculated note by note."""
    frames = [False] * len(times_s)

    def within(start_s: float, end_s: float) -> list[int]:
        return [index for index, time_s in enumerate(times_s) if start_s - 1e-9 <= time_s < end_s - 1e-9]

    for index, note in enumerate(notes):
        following = notes[index + 1] if index + 1 < len(notes) else None
        end_s = note.end_s if following is None else min(note.end_s, following.start_s)
        if not asked[index]:
            continue
        for frame in within(note.start_s, end_s):
            frames[frame] = True
        way = 0.0 if following is None else abs(following.controls.get("c", 0.0) - note.controls.get("c", 0.0))
        if following is not None and way:
            needed_s = way * 0.6 / 2.5
            shared_s = max(following.start_s - end_s, moved.move_note_share * (end_s - note.start_s))
            window_s = max(needed_s, min(moved.move_window_s, shared_s))
            for frame in within(min(end_s, following.start_s - window_s), end_s):
                frames[frame] = False
    return frames


@given(
    st.lists(
        st.tuples(st.floats(0.0, 0.6), st.floats(0.01, 1.5), st.sampled_from([0.0, 0.5, 1.0]), st.booleans()),
        max_size=12,
    )
)
def test_frames_of_notes_are_those_of_one_note_after_another(rows: list[tuple[float, float, float, bool]]) -> None:
    slide = control(kind="slide", motion=ControlMotion((0.0, 0.0, 1.0), travel_m=0.6), max_speed_m_s=2.5)
    times_s = FIRST_FRAME_S + np.arange(40) / FPS
    starts_s = np.cumsum([row[0] for row in rows]).tolist()
    notes = [event(start_s, start_s + row[1], row[2]) for start_s, row in zip(starts_s, rows, strict=True)]
    asked = [row[3] for row in rows]
    frames = NoteFrames(times_s, notes)
    worked = np.where(asked, 1, 0) if rows else np.zeros(0, np.intp)
    assert frames.kept(1, worked, [slide]).tolist() == _kept_slowly(times_s, notes, asked, slide)
    sounding = [any(note.start_s - 1e-9 <= time_s < note.end_s - 1e-9 for note in notes) for time_s in times_s]
    assert frames.sounding.tolist() == sounding
    last = [max((i for i, note in enumerate(notes) if note.start_s - 1e-9 <= t), default=-1) for t in times_s]
    owned = [i if i >= 0 and t < notes[i].end_s - 1e-9 else -1 for i, t in zip(last, times_s, strict=True)]
    assert frames.asked(asked).tolist() == [i >= 0 and asked[i] for i in owned]
    targets = frames.targets_at_frames(slide)
    assert np.array_equal(targets, [rows[i][2] if i >= 0 else np.nan for i in owned], equal_nan=True)
