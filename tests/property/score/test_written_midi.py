"""A score written as a MIDI file and read again is the same score."""

from __future__ import annotations

import io
import re
import tempfile
from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import mido
import msgspec
from hypothesis import example, given, settings
from hypothesis import strategies as st

from app.score.assignments import PartAssignment
from app.score.contents import assigned_score
from app.score.limits import MOST_HOURS
from app.score.metre_map import Metre
from app.score.model import ControllerCurve, CurveKind, Marker, Note, Part, Score
from app.score.read import read_contents, read_midi
from app.score.tempo import TempoChange, TempoMap
from app.score.write import midi_file
from instrument_maps.instrument_names import vocabulary
from tests.unit.score.midi_bytes import MAPS

LAST_TICK = 200_000
MOST_NOTES, LONGEST_TICK = 8, 4000
KINDS: Sequence[CurveKind] = ("aftertouch", "bite", "breath", "expression", "pitch_bend", "volume")
# Letters of two bytes that no language of a MIDI file has: a text of few of them may be Chinese (`app.score.texts`).
STRANGE = re.compile("[\u0180-\u036f\u0460-\u058f\u0700-\u07ff]")
# What the user may call a part; the reader drops control characters and spaces around, as it does of any file.
WORDS = st.text(st.characters(exclude_categories=("C", "Z")), min_size=1, max_size=20).filter(
    lambda word: len(word.encode()) > 8 or not STRANGE.search(word)
)


@st.composite
def lines(draw: st.DrawFn, track: int, overlap_tick: int, rest_tick: int) -> tuple[Note, ...]:
    """A line of one player: a note begins when the one before has ended, or in its last tick.

    One of the same pitch does so only in a note that it cuts by less than a quarter: a pitch that is struck again
    earlier ends there, for no instrument sounds it twice (`app.score.channel_notes.end_late`).
    """
    notes: list[Note] = []
    at = draw(st.integers(0, 3000))
    for number in range(draw(st.integers(1, MOST_NOTES))):
        duration, pitch = draw(st.integers(1 + overlap_tick, LONGEST_TICK)), draw(st.integers(55, 69))
        if notes and pitch == notes[-1].pitch and 4 * (notes[-1].end_tick - at) >= notes[-1].duration_tick:
            at = notes[-1].end_tick
        notes.append(Note(f"{track + 1}:{number + 1}", at, duration, pitch, draw(st.integers(1, 127))))
        at += max(duration - draw(st.sampled_from((0, overlap_tick))), 1) + draw(
            st.sampled_from((0, 0, 480, rest_tick))
        )
    return tuple(notes)


@st.composite
def curves(draw: st.DrawFn, kind: CurveKind) -> ControllerCurve:
    """A curve with the values that its controller can have."""
    ticks = sorted(draw(st.sets(st.integers(0, LAST_TICK), min_size=1, max_size=12)))
    if kind == "pitch_bend":
        values = [draw(st.integers(-8192, 8191)) / 8192 for _ in ticks]
    else:
        values = [draw(st.integers(0, 127)) / 127 for _ in ticks]
    return ControllerCurve(kind, tuple(ticks), tuple(values))


@st.composite
def scores(draw: st.DrawFn) -> Score:
    """Scores as the reader makes them, of up to seventeen players."""
    division = draw(st.sampled_from((1, 24, 96, 480, 960, 32767)))
    rest_tick = min(20_000 * division, 100_000)
    # No piece lasts longer than may be.
    slowest = min(MOST_HOURS * 3_600_000_000 * division // (3000 + MOST_NOTES * (LONGEST_TICK + rest_tick)), 0xFFFFFF)
    tempi = draw(st.dictionaries(st.integers(1, LAST_TICK), st.integers(10_000, slowest), max_size=6))
    tempi[0] = draw(st.integers(10_000, slowest))
    tempo_map = TempoMap.of_changes(division, [TempoChange(*row) for row in tempi.items()])
    # Notes overlap by less than makes two voices of them.
    overlap_tick = int(max(tempi.values()) / division < 30_000)
    parts = []
    count = draw(st.sampled_from((1, 1, 2, 3, 17)))
    for track in range(1, 1 + count):
        # The first of many are alike and short: they fill the channels, and a failure is soon made small.
        various = track > count - 3
        trumpet = various and draw(st.booleans())
        word = draw(st.one_of(st.just(""), WORDS)) if various else ""
        # Channels repeat from the sixteenth part on; tracks of one name and channel may be regions of one.
        # A word in quotes is no key or size of the instrument, but for "C" or "Bass".
        known, kind = vocabulary(), "Trumpet" if trumpet else "Trombone"
        quoted = f"“{word}”" if word and known.by_name(f"{kind} “{word}”") == known.by_name(kind) else ""
        name = f"{kind} {quoted}{track if track > 15 else ''}".strip()
        notes = draw(lines(track, overlap_tick, rest_tick)) if various else (Note(f"{track + 1}:1", 0, 2, 55, 1),)
        kinds = draw(st.sets(st.sampled_from(KINDS), max_size=3)) if various else set[CurveKind]()
        channel = draw(st.sampled_from([channel for channel in range(16) if channel != 9]))
        parts.append(
            Part(
                id=f"{track + 1}.{channel + 1}.1",
                name=name,
                track=track,
                voice=0,
                channel=channel,
                program=56 if trumpet else 57,
                instrument="trumpet" if trumpet else "trombone",
                map_id="trumpet" if trumpet else "trombone",
                notes=notes,
                curves=tuple(draw(curves(kind)) for kind in sorted(kinds)),
            )
        )
    pickup, metres = draw(st.sampled_from(((0, 1), (1, 1), (0, 2)))) if division % 2 == 0 else (0, 1)
    numerator, denominator = draw(st.tuples(st.integers(2, 12), st.sampled_from((1, 2, 4, 8))))
    bar = Fraction(4 * division * numerator, denominator)
    meter = [Metre(0, numerator, denominator)]
    if pickup:
        meter.append(Metre(max(int(bar) // 3, 1), numerator, denominator))
    elif metres == 2:
        meter.append(Metre(int(4 * bar), numerator + 1, denominator))
    called = draw(st.lists(st.builds(Marker, st.integers(0, 2 * LAST_TICK), WORDS), max_size=5, unique=True))
    return Score(
        title=draw(st.one_of(st.just("piece"), WORDS)),
        ticks_per_quarter=division,
        tempo_map=tempo_map,
        metres=tuple(meter),
        pickup_ticks=meter[1].tick if pickup else 0,
        parts=tuple(parts),
        markers=tuple(sorted(called, key=lambda marker: marker.tick)),
    )


def read_again(score: Score) -> Score:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "piece.mid"
        path.write_bytes(midi_file(score).data)
        return read_midi(path, maps=MAPS)


def plain(part: Part) -> tuple[object, ...]:
    """A part but for its channel and what counts tracks."""
    notes = [(note.onset_tick, note.duration_tick, note.pitch, note.velocity) for note in part.notes]
    return part.name, part.program, part.instrument, part.map_id, notes, part.curves


LEGATO_OF_A_TICK = Score(
    title="piece",
    ticks_per_quarter=480,
    tempo_map=TempoMap.of_changes(480, [TempoChange(0, 35_121)]),
    metres=(Metre(0, 2, 2),),
    parts=(
        Part(
            id="2.1.1",
            name="Trombone",
            track=1,
            voice=0,
            channel=0,
            program=57,
            instrument="trombone",
            map_id="trombone",
            notes=(Note("2:1", 252, 2, 56, 1), Note("2:2", 253, 2, 55, 1)),
        ),
    ),
)


@settings(deadline=None, max_examples=60)
@given(scores())
@example(LEGATO_OF_A_TICK)
def test_a_written_score_is_read_as_it_was(score: Score) -> None:
    again = read_again(score)
    assert (again.warnings, again.unplayed) == ((), ())
    assert [plain(part) for part in again.parts] == [plain(part) for part in score.parts]
    for field in ("title", "ticks_per_quarter", "tempo_map", "metres", "pickup_ticks", "markers"):
        assert getattr(again, field) == getattr(score, field), field
    channels = [part.channel for part in again.parts]
    if len(channels) <= 15:
        assert len({*channels} - {9}) == len(channels)
    if len({part.channel for part in score.parts}) == len(score.parts):
        assert channels == [part.channel for part in score.parts]
        # Written by us once, a score keeps everything, ids too.
        assert read_again(again) == again


@settings(deadline=None, max_examples=25)
@given(scores())
def test_another_program_reads_the_same_notes(score: Score) -> None:
    file = mido.MidiFile(file=io.BytesIO(midi_file(score).data), charset="utf-8")
    assert (file.type, file.ticks_per_beat, len(file.tracks)) == (1, score.ticks_per_quarter, 1 + len(score.parts))
    for part, track in zip(score.parts, file.tracks[1:], strict=True):
        tick, on, bends, names = 0, [], [], []
        for message in track:
            tick += message.time
            if message.type == "note_on":
                on.append((tick, message.note, message.velocity))
            elif message.type == "pitchwheel":
                bends.append((tick, message.pitch))
            elif message.type == "track_name":
                names.append(message.name)
        assert names == [part.name]
        assert on == [(note.onset_tick, note.pitch, note.velocity) for note in part.notes]
        drawn = [curve for curve in part.curves if curve.kind == "pitch_bend"]
        assert bends == [
            (at, round(8192 * value)) for curve in drawn for at, value in zip(curve.ticks, curve.values, strict=True)
        ]


def are_ended_where_struck_again(again: Sequence[Note], notes: Sequence[Note]) -> bool:
    """Return whether each note ends where one of its pitch ended or began, and lasts into the next by a legato at most.

    Notes struck together are a unison of two players.
    """
    bounds = {(tick, note.pitch) for note in notes for tick in (note.onset_tick, note.end_tick)}
    ordered = sorted(again, key=lambda note: (note.pitch, note.onset_tick))
    overlaps = [
        4 * (note.end_tick - following.onset_tick) < note.duration_tick
        for note, following in pairwise(ordered)
        if note.pitch == following.pitch and note.onset_tick < following.onset_tick
    ]
    return {(note.end_tick, note.pitch) for note in again} <= bounds and all(overlaps)


@settings(deadline=None, max_examples=150)
@given(
    st.lists(
        st.tuples(st.integers(0, 60), st.integers(1, 60), st.integers(60, 62), st.integers(1, 127)),
        min_size=1,
        max_size=14,
    )
)
def test_notes_of_one_pitch_that_overlap_sound_as_long_as_they_did(rows: list[tuple[int, int, int, int]]) -> None:
    rows.sort(key=lambda row: (row[0], row[2]))
    notes = tuple(Note(f"2:{number}", *row) for number, row in enumerate(rows, 1))
    part = Part("2.1.1", "Trumpet", 1, 0, 0, 56, "trumpet", "trumpet", notes)
    made = midi_file(Score("piece", 96, TempoMap(96), parts=(part,)))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "piece.mid"
        path.write_bytes(made.data)
        # As one player's: what cannot be one player's would be shortened or shared.
        assignment = PartAssignment((0,), "trumpet", split="never")
        again = [note for part in assigned_score(read_contents(path), [assignment], MAPS).parts for note in part.notes]
    # Every onset with its pitch and velocity, every end with its pitch; only whose end it is may change, and is
    # reported.
    assert sorted((n.onset_tick, n.pitch, n.velocity) for n in again) == sorted((r[0], r[2], r[3]) for r in rows)
    cut = False
    for pitch in {note.pitch for note in notes}:
        written, found = ([note for note in some if note.pitch == pitch] for some in (notes, again))
        if sorted(note.end_tick for note in found) != sorted(note.end_tick for note in written):
            # Notes of a melody that are struck again (`app.score.tracks`).
            cut = True
            assert are_ended_where_struck_again(found, written)
    if cut:
        return
    nested = any(
        a.pitch == b.pitch and a.onset_tick < b.onset_tick and b.end_tick < a.end_tick for a in notes for b in notes
    )
    assert nested == ("midi.nested_notes" in [warning.id for warning in made.warnings])
    if not nested:
        spans = sorted((n.onset_tick, n.end_tick, n.pitch) for n in again)
        assert spans == sorted((n.onset_tick, n.end_tick, n.pitch) for n in notes)
    assert msgspec.structs.astuple(notes[0])[1:] == rows[0]
