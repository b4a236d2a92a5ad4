"""Properties of every plan for any notes, tempi and parameters."""

from __future__ import annotations

import dataclasses

from hypothesis import given, settings
from hypothesis import strategies as st

from app.plan.breath.catch_breath_lengths import CATCH_MIN_S, CATCH_NOTE_SHARE, LEAST_PLAYED_S
from app.plan.breath.lungs import FULL_BREATH_S
from app.plan.generate import MonophonicPart, Piece
from app.plan.model import BreathEvent, PlayerPlan
from app.plan.parameters import PlayerParameters
from app.score.metre_map import Metre
from instrument_maps.load import bundled_maps
from tests.support.plan import PlainClock, PlainNote, make_plans, piece_of, time_frame, valves

TUPLES = ("fingerings", "breaths", "tongues", "embouchures", "cues", "gestures", "expressions")
MAPS = (valves(), *bundled_maps().values())

lengths = st.sampled_from([1, 30, 60, 120, 240, 240, 480, 480, 960, 1920, 9600])
rests = st.sampled_from([-30, -1, 0, 0, 0, 0, 1, 119, 120, 240, 480, 959, 960, 1000, 3000, 20000])


@st.composite
def tunes(draw: st.DrawFn, track: int = 1) -> tuple[PlainNote, ...]:
    tick = draw(st.integers(0, 4000))
    notes = []
    for index in range(draw(st.integers(1, 40))):
        length = draw(lengths)
        notes.append(
            PlainNote(f"{track}:{index + 1}", tick, length, draw(st.integers(30, 95)), draw(st.integers(1, 127)))
        )
        tick = max(tick + length + draw(rests), tick + 1)
    return tuple(notes)


clocks = st.builds(
    lambda first, changes: PlainClock(((0, first), *sorted(dict(changes).items()))),
    st.floats(30, 240),
    st.lists(st.tuples(st.integers(1, 40000), st.floats(30, 240)), max_size=4),
)
parameters = st.builds(
    PlayerParameters,
    breath_min_beats=st.sampled_from([0.25, 0.5, 0.75]),
    breath_last_beat_beats=st.sampled_from([1.0, 1.5]),
    breath_prepare_beats=st.sampled_from([1.5, 2.0, 3.0]),
    lung_s=st.sampled_from([3.0, 9.0, 20.0]),
    seed=st.integers(0, 3),
)
felt_beats = st.sampled_from([None, None, 720, 240])


@st.composite
def pieces(draw: st.DrawFn) -> tuple[Piece, tuple[MonophonicPart, ...]]:
    metre = Metre(0, draw(st.integers(2, 7)), draw(st.sampled_from([4, 8])))
    piece = piece_of(draw(clocks), (metre,), draw(felt_beats))
    lines = tuple(
        MonophonicPart(f"p{track}", draw(tunes(track)), draw(st.sampled_from(MAPS)), draw(parameters))
        for track in range(1, draw(st.integers(1, 3)) + 1)
    )
    return piece, lines


def made(piece: Piece, lines: tuple[MonophonicPart, ...]) -> dict[str, PlayerPlan]:
    return make_plans(piece, lines, time_frame(lines, piece.clock, beat_ticks=piece.metre_map.felt_ticks_at(0)))


@given(pieces())
@settings(max_examples=75, deadline=None)
def test_breaths_end_at_onsets_and_never_lie_in_a_sounding_note(
    drawn: tuple[Piece, tuple[MonophonicPart, ...]],
) -> None:
    piece, lines = drawn
    for line, plan in zip(lines, made(piece, lines).values(), strict=True):
        onsets_s = {note.id: piece.clock.seconds(float(note.onset_tick)) for note in line.notes}
        for breath in plan.breaths:
            assert breath.start_s < breath.end_s
            assert breath.start_s >= plan.time_frame.first_frame_s - 1e-6
            assert 0.0 < breath.depth <= 1.0
            if breath.reason.id == "breath.staggered":
                (note,) = (note for note in line.notes if note.id == breath.id.split(":", 1)[1])
                end_s = piece.clock.seconds(float(note.onset_tick + note.duration_tick))
                assert onsets_s[note.id] < breath.start_s < breath.end_s < end_s
                assert any(other.notes for other in lines if other is not line)
                continue
            if breath.kind == "breath":
                assert 0.0 <= onsets_s[breath.id.split(":", 1)[1]] - breath.end_s <= 0.05
            catch = breath.reason.id in ("breath.catch", "breath.phrase_end", "breath.after_hold")
            left_out = _left_out(breath)
            catch |= bool(left_out)
            if catch:
                assert CATCH_MIN_S - 1e-9 <= breath.end_s - breath.start_s <= FULL_BREATH_S + 1e-9
            for index, note in enumerate(line.notes):
                end_tick = note.onset_tick + note.duration_tick
                if index + 1 < len(line.notes):
                    end_tick = min(end_tick, line.notes[index + 1].onset_tick)
                start_s, end_s = onsets_s[note.id], piece.clock.seconds(float(end_tick))
                inside_s = min(end_s, breath.end_s) - max(start_s, breath.start_s)
                whole_s = end_s - start_s
                tail_s = max(CATCH_NOTE_SHARE * whole_s, min(whole_s - LEAST_PLAYED_S, CATCH_MIN_S)) if catch else 0.0
                assert inside_s <= (whole_s if note.id in left_out else tail_s) + 1e-6


def _left_out(breath: BreathEvent) -> set[object]:
    """Notes omitted for a breath."""
    arguments = breath.reason.arguments
    if breath.reason.id == "breath.catch_dropped_two":
        return {arguments["first_note"], arguments["after_note"]}
    return {arguments["after_note"]} if breath.reason.id == "breath.catch_dropped" else set()


@given(pieces())
@settings(max_examples=30, deadline=None)
def test_events_are_unique_ordered_reasoned_and_repeatable(drawn: tuple[Piece, tuple[MonophonicPart, ...]]) -> None:
    piece, lines = drawn
    plans = made(piece, lines)
    assert made(piece, lines) == plans
    for line, plan in zip(lines, plans.values(), strict=True):
        events = [event for name in TUPLES for event in getattr(plan, name)]
        assert len({event.id for event in events}) == len(events)
        for name in TUPLES:
            starts = [event.start_s for event in getattr(plan, name)]
            assert starts == sorted(starts)
            if name != "tongues":
                assert all(event.reason.id for event in getattr(plan, name))
        # What begins together is in the order of its ids; what rules add comes after it.
        played = [(event.start_s, event.id) for event in plan.gestures if ":rule:" not in event.id]
        assert played == sorted(played)
        assert len(plan.fingerings) == len(plan.embouchures) == len(line.notes)
        for lips in plan.embouchures:
            assert all(0.0 <= value <= 1.0 for value in (lips.tension, lips.effort, lips.air))
        for fingering in plan.fingerings:
            assert all(0.0 <= value <= 1.0 for value in fingering.controls.values())
        for gesture in plan.gestures:
            assert -1.0 <= gesture.amount <= 1.0
            assert gesture.start_s < gesture.end_s
        for face in plan.expressions:
            assert 0.0 <= face.strength <= 1.0


@given(pieces(), st.integers(1, 5))
@settings(max_examples=30, deadline=None)
def test_the_same_notes_a_bar_later_are_fingered_and_breathed_alike(
    drawn: tuple[Piece, tuple[MonophonicPart, ...]], bars: int
) -> None:
    piece, lines = drawn
    steady = Piece(PlainClock(piece.clock.changes[:1]), piece.metre_map)
    metre = piece.metre_map.metres[0]
    shift = bars * 1920 * metre.numerator // metre.denominator
    moved = tuple(
        MonophonicPart(
            line.player_id,
            tuple(dataclasses.replace(note, onset_tick=note.onset_tick + shift) for note in line.notes),
            line.instrument_map,
            line.parameters,
        )
        for line in lines
    )
    for here, later in zip(made(steady, lines).values(), made(steady, moved).values(), strict=True):
        assert [(e.id, e.label, e.controls) for e in here.fingerings] == [
            (e.id, e.label, e.controls) for e in later.fingerings
        ]
        rests, shifted = (_in_needed_rests(plan) for plan in (here, later))
        assert [(id, start_tick + shift, end_tick + shift) for id, start_tick, end_tick in rests] == shifted


def _in_needed_rests(plan: PlayerPlan) -> list[tuple[str, int, int]]:
    """Breaths that depend on the notes alone. Where else a player breathes varies with the place in the score where
    several are as good, and within a held note with milliseconds that differ by rounding."""
    varied = {
        breath.id.split(":", 1)[1]
        for breath in plan.breaths
        if any(kind in breath.reason.id for kind in ("catch", "phrase_end", "staggered"))
        or breath.reason.arguments.get("why") == "breath.why_short"
    }
    found = [(breath.id, breath.start_tick, breath.end_tick) for breath in plan.breaths]
    return [event for event in found if event[0].split(":", 1)[1] not in varied]
