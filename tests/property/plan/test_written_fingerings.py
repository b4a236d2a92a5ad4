"""Fingerings in a score are played wherever the instrument's map has them, unless a correction says otherwise."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.plan.by_hand.corrections import PinFingering
from app.plan.generate import MonophonicPart
from app.score.marks import Mark
from app.score.metre_map import Metre
from instrument_maps.load import bundled_maps
from instrument_maps.model import InstrumentMap
from tests.support.plan import PlainClock, PlainNote, make_plans, piece_of, time_frame

MAPS = bundled_maps()
CLOCK = PlainClock(((0, 120.0),))
BETWEEN = ("", "-", "+", ", ", " ")
"""Separators between the valves of a fingering in scores."""


def spelt(label: str, instrument: InstrumentMap, between: str) -> tuple[str, str]:
    """A fingering as a score may have it: the kind of the mark, and its text."""
    controls = [control for control in instrument.controls if control.role == "pitch"]
    if " " in label or any(control.kind in ("key", "hole") for control in controls):
        return "fingering", label
    if any(control.kind == "slide" for control in controls):
        return ("position" if label.isdigit() and between else "fingering"), label
    return "fingering", between.join(label)


@settings(deadline=None, max_examples=120)
@given(st.data(), st.sampled_from(sorted(MAPS)), st.sampled_from(BETWEEN), st.sampled_from((60, 120, 480, 1920)))
def test_every_fingering_in_the_score_that_the_map_has_is_played(
    data: st.DataObject, name: str, between: str, step: int
) -> None:
    instrument = MAPS[name]
    pitches = data.draw(st.lists(st.integers(instrument.range.low, instrument.range.high), min_size=1, max_size=12))
    notes = tuple(PlainNote(f"1:{at + 1}", at * step, step, pitch) for at, pitch in enumerate(pitches))
    labels, marks, pins = {}, [], {}
    for note in notes:
        known = [one.label for one in instrument.fingerings_for(note.pitch) if not one.is_obsolete]
        what = data.draw(st.sampled_from(("none", "written", "written", "unknown", "pinned")))
        if what in ("written", "pinned"):
            labels[note.id] = data.draw(st.sampled_from(known))
            kind, text = spelt(labels[note.id], instrument, between)
            marks.append(Mark(kind, note.id, text=text))
        elif what == "unknown":
            marks.append(Mark("fingering", note.id, text="8-9"))
        if what == "pinned":
            pins[note.id] = data.draw(st.sampled_from(known))
    corrections = tuple(PinFingering(id, label) for id, label in pins.items())
    line = MonophonicPart("p", notes, instrument, corrections=corrections, marks=tuple(marks), source="score")
    plan = make_plans(piece_of(CLOCK, (Metre(0, 4, 4),)), (line,), time_frame((line,), CLOCK))["p"]
    reasons = {event.note_id: (event.label, event.reason.id, event.corrected) for event in plan.fingerings}
    for id, label in labels.items():
        if id in pins:
            assert reasons[id] == (pins[id], "fingering.by_hand", True)
        else:
            assert reasons[id] == (label, "fingering.written", False)
    others = {id for id, (_, reason, _) in reasons.items() if reason == "fingering.written"} - set(labels)
    assert not others
    reported = {problem.note_id for problem in plan.problems if problem.message.id == "fingering.not_in_map"}
    assert reported == {mark.note_id for mark in marks if mark.text == "8-9"}


@pytest.mark.parametrize(
    ("name", "pitch", "text", "label"),
    [
        # Written C sharp 4 and E 4 of a trumpet, the latter on its third valve.
        ("trumpet_Bb", 59, "1-2-3", "123"),
        ("trumpet_Bb", 62, "3", "3"),
        ("trumpet_Bb", 58, "○", "0"),
        ("trombone_tenor_F_attachment", 53, "VI", "6"),
        ("trombone_tenor_F_attachment", 53, "V1", "T1"),
        ("trombone_tenor_F_attachment", 57, "b2", "2"),
        # Only the B flat side of the horn has this pitch on these valves.
        ("horn_double_F_Bb", 67, "12", "T12"),
        ("horn_double_F_Bb", 67, "0", "0"),
    ],
)
def test_fingerings_are_spelt_in_several_ways(name: str, pitch: int, text: str, label: str) -> None:
    notes = (PlainNote("1:1", 0, 480, pitch),)
    line = MonophonicPart("p", notes, MAPS[name], marks=(Mark("fingering", "1:1", text=text),), source="score")
    plan = make_plans(piece_of(CLOCK, (Metre(0, 4, 4),)), (line,), time_frame((line,), CLOCK))["p"]
    assert (plan.fingerings[0].label, plan.fingerings[0].reason.id) == (label, "fingering.written")
