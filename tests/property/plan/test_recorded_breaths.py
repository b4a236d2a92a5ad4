"""Plans are valid for any values of a breath sensor."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from hypothesis import example, given, settings
from hypothesis import strategies as st

from app.performance.loudness import controller_input, note_loudness, sounding_curve
from app.plan.generate import MonophonicPart
from app.plan.music.breath_controller import GASP_S
from app.plan.parameters import PlayerParameters
from app.score.model import ControllerCurve, Note, Part
from instrument_maps.load import bundled_maps
from tests.support.blown import TEMPO
from tests.support.plan import make_plans, piece_of, time_frame

TRUMPET = bundled_maps()["trumpet_Bb"]
LEFT_OUT = {"breath.catch_dropped": 1, "breath.catch_dropped_two": 2}
"""Number of omitted notes by the kind of breath."""
LEVELS = (0.0, 0.0, 0.01, 0.03, 0.4, 0.8, 1.0)


@st.composite
def parts(draw: st.DrawFn) -> Part:
    """Lines with rests and legato overlaps, under curves that may be unrelated to them."""
    notes: list[Note] = []
    at = draw(st.integers(0, 900))
    for number in range(draw(st.integers(1, 12))):
        length = draw(st.integers(1, 2000))
        notes.append(Note(f"1:{number + 1}", at, length + draw(st.sampled_from((0, 20))), 60 + number, 80))
        at += length + draw(st.sampled_from((0, 0, 100, 400, 2000)))
    curves = []
    for kind in draw(st.sets(st.sampled_from(("breath", "pitch_bend", "bite")), min_size=1)):
        ticks = sorted(draw(st.sets(st.integers(0, at + 500), min_size=1, max_size=40)))
        values = tuple(draw(st.sampled_from(LEVELS)) for _ in ticks)
        curves.append(ControllerCurve(kind, tuple(ticks), values))
    return Part("1.1.1", "x", 0, 0, 0, 56, "trumpet", "trumpet_Bb", tuple(notes), tuple(curves))


SHORT_NOTES = (*((tick, 1) for tick in range(6)), (6, 1355), (1361, 119), (1480, 985))
"""Notes for whose last one the lungs are too small: one breath comes before the preceding note, and another one
replaces that note.
"""
OVERLAPPING = Part(
    "1.1.1", "x", 0, 0, 0, 56, "trumpet", "trumpet_Bb",
    tuple(Note(f"1:{number + 1}", *note, 60 + number, 80) for number, note in enumerate(SHORT_NOTES)),
    (ControllerCurve("breath", (0, 1), (0.0, 1.0)),),
)  # fmt: skip


@settings(deadline=None, max_examples=120)
@example(OVERLAPPING, 2.0)
@given(parts(), st.sampled_from((2.0, 9.0)))
def test_breaths_are_in_order_and_end_before_what_they_serve(part: Part, lung_s: float) -> None:
    line = MonophonicPart(
        "p", part.notes, TRUMPET, PlayerParameters(lung_s=lung_s), (), note_loudness(part), controller_input(part)
    )
    frame = time_frame((line,), TEMPO)
    plan = make_plans(piece_of(TEMPO), (line,), frame)["p"]
    onset_s = {f"breath:{note.id}": TEMPO.seconds(float(note.onset_tick)) for note in part.notes}
    onsets_s = [-np.inf, -np.inf, -np.inf, *onset_s.values()]
    index = {event_id: place for place, event_id in enumerate(onset_s, 3)}
    end_s = {f"within:{note.id}": TEMPO.seconds(float(note.onset_tick + note.duration_tick)) for note in part.notes}
    breaths = [event for event in plan.breaths if event.kind == "breath"]
    for event in breaths:
        if event.id in end_s:
            assert onset_s[event.id.replace("within", "breath")] < event.start_s < event.end_s < end_s[event.id]
            continue
        assert event.start_s < event.end_s <= onset_s[event.id] + 0.002
        left_out = LEFT_OUT.get(event.reason.id, 0)
        assert event.start_s >= onsets_s[index[event.id] - 1 - left_out], "no other note is lost altogether"
        assert event.start_tick <= event.end_tick
        assert 0.0 < event.depth <= 1.0
        if event.reason.id.startswith("breath.blown"):
            assert event.end_s - event.start_s >= GASP_S - 0.002
    for one, following in pairwise(plan.breaths):
        assert one.end_s <= following.start_s + 1e-6
    if plan.traces is not None:
        for values in (plan.traces.tension, plan.traces.air, plan.traces.effort):
            if values is not None:
                assert np.isfinite(values).all()
                assert values.min() >= -1e-9
                assert values.max() <= 1.0 + 1e-9


@settings(deadline=None, max_examples=100)
@given(parts())
def test_every_note_is_audible(part: Part) -> None:
    curve = sounding_curve(part)
    if curve is None:
        return
    assert list(curve.ticks) == sorted(set(curve.ticks))
    loudness = note_loudness(part)
    assert min(loudness) > 0.0
