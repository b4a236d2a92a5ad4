"""``suisou inspect --json`` of random music, judged by an independent reading of the same file."""

from __future__ import annotations

import io
import json
import re
import tempfile
from contextlib import redirect_stdout
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

import mido
from hypothesis import example, given, settings
from hypothesis import strategies as st

from app.cli import main
from tests.support.judge import faults

QUARTERS = [Fraction(length, 24) for length in (1, 2, 3, 4, 6, 8, 12, 12, 24, 24, 24, 36, 48, 72, 96)]
RESTS = [Fraction(length, 48) for length in (0, 0, 0, 0, 0, 0, 1, 12, 23, 24, 25, 47, 48, 72, 95, 96, 97, 192, 500)]


def inspected(path: Path, *arguments: str) -> dict[str, Any]:
    out = io.StringIO()
    with redirect_stdout(out):
        assert main(["inspect", str(path), "--json", "--no-contacts", *arguments]) == 0
    found: dict[str, Any] = json.loads(out.getvalue())
    return found


@st.composite
def lines(draw: st.DrawFn, quarter: int, low: int, high: int) -> list[tuple[int, int, int]]:
    """Notes (onset, end, pitch) of one player: legato overlaps of a tick, repeated notes, rests of every length."""
    tick = draw(st.sampled_from([0, 0, quarter // 2, quarter, 5 * quarter, 13 * quarter]))
    notes = []
    pitch = draw(st.integers(low, high))
    for _ in range(draw(st.integers(1, 30))):
        length = max(round(draw(st.sampled_from(QUARTERS)) * quarter), 1)
        overlap = draw(st.sampled_from([0, 0, 0, 1])) if length > 1 and quarter >= 96 else 0
        notes.append((tick, tick + length + overlap, pitch))
        tick += length + round(draw(st.sampled_from(RESTS)) * quarter)
        pitch = min(max(pitch + draw(st.integers(-5, 5)), low), high)
    return [
        (onset, min(end, following[0]) if following and pitch == following[2] else end, pitch)
        for (onset, end, pitch), following in zip(notes, [*notes[1:], None], strict=True)
    ]


def track_of(
    notes: list[tuple[int, int, int]], channel: int, name: str, program: int | None, off: str, velocity: int
) -> mido.MidiTrack:
    """Events in order of time; at one tick note-offs come first."""
    events = [(onset, 1, pitch) for onset, _, pitch in notes] + [(end, 0, pitch) for _, end, pitch in notes]
    track = mido.MidiTrack([mido.MetaMessage("track_name", name=name)] if name else [])
    if program is not None:
        track.append(mido.Message("program_change", channel=channel, program=program))
    tick = 0
    for at, on, pitch in sorted(events):
        kind = "note_on" if on or off == "velocity" else "note_off"
        strength = velocity if on else 0
        track.append(mido.Message(kind, channel=channel, note=pitch, velocity=strength, time=at - tick))
        tick = at
    return track


PLAYERS = [
    ("Trumpet", None, 52, 87),
    ("", 56, 55, 82),
    ("Posaune", 0, 40, 72),
    ("Trombone", 57, 36, 77),
    ("トロンボーン", None, 40, 70),
    ("Cornet in B", None, 54, 80),
]


@st.composite
def files(draw: st.DrawFn) -> mido.MidiFile:
    quarter = draw(st.sampled_from([24, 96, 120, 384, 480, 1024]))
    file = mido.MidiFile(type=1, ticks_per_beat=quarter, charset="utf-8")
    conductor = mido.MidiTrack()
    tick = 0
    for _ in range(draw(st.integers(0, 6))):
        wait = draw(st.sampled_from([0, 1, quarter // 3, quarter, 7 * quarter, 30 * quarter]))
        tick += wait
        if draw(st.booleans()):
            conductor.append(mido.MetaMessage("set_tempo", tempo=draw(st.integers(200_000, 2_000_000)), time=wait))
        else:
            metre = draw(st.sampled_from([(3, 4), (4, 4), (6, 8), (7, 8), (2, 2), (5, 16)]))
            conductor.append(mido.MetaMessage("time_signature", numerator=metre[0], denominator=metre[1], time=wait))
    file.tracks.append(conductor)
    for channel in range(draw(st.integers(1, 4))):
        name, program, low, high = draw(st.sampled_from(PLAYERS))
        off = draw(st.sampled_from(["velocity", "off"]))
        notes = draw(lines(quarter, low, high))
        file.tracks.append(track_of(notes, channel, name, program, off, draw(st.integers(1, 127))))
    return file


def released_early() -> mido.MidiFile:
    """Notes off the grid that end a tenth to a fifth of their steps early; after the last but two it is a felt beat."""
    lengths = [(1024, 256), (2048, 512), (1024, 205), (512, 90), (1024, 51), (512, 77)] * 2
    onset, notes = 7, []
    for index, (length, silence) in enumerate([*lengths, (2048, 512), (44, -1), (171, 0)]):
        notes.append((onset, onset + length, 69 + index % 2))
        onset += length + silence
    file = mido.MidiFile(type=1, ticks_per_beat=1024)
    file.tracks += [mido.MidiTrack(), track_of(notes, 0, "Trombone", 57, "off", 80)]
    return file


@given(
    files(),
    st.sampled_from([(0.5, 1.0, 2.0), (0.5, 1.0, 2.0), (0.25, 1.5, 3.0), (1.0, 1.0, 2.0), (0.5, 2.0, 4.0)]),
    st.sampled_from(["1", "1", "1.5", "2", "1/2"]),
    st.sampled_from(["4", "4", "2", "8.5"]),
)
@example(released_early(), (0.5, 1.0, 2.0), "1/2", "4")
@settings(max_examples=30, deadline=None)
def test_everything_printed_is_true(
    file: mido.MidiFile, thresholds: tuple[float, float, float], felt_beat: str, preroll: str
) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "piece.mid"
        file.save(path)
        names = ("breath_min_beats", "breath_last_beat_beats", "breath_prepare_beats")
        sets = [f"--set=*.{name}={value}" for name, value in zip(names, thresholds, strict=True)]
        sets.append("--set=*.breath_need=0")
        found = inspected(path, *sets, "--felt-beat", felt_beat, "--preroll", preroll)
        beat = float(Fraction(felt_beat))
        assert faults(path, found, thresholds=thresholds, felt_beat=beat, preroll=float(preroll)) == []
        assert len(found["players"]) == len(file.tracks) - 1


@given(
    st.lists(st.sampled_from([60, 120, 240, 480, 960, 1920]), min_size=20, max_size=120),
    st.sampled_from([1.0, 3.0, 9.0, 20.0]),
    st.integers(300_000, 1_500_000),
)
@settings(max_examples=30, deadline=None)
def test_no_stretch_outlasts_the_lungs_without_a_word(durations: list[int], lung_s: float, tempo: int) -> None:
    notes = []
    tick = 0
    for index, duration in enumerate(durations):
        notes.append((tick, tick + duration, 62 + index % 7))
        tick += duration
    track = track_of(notes, 0, "Trumpet", None, "off", 80)
    track.insert(0, mido.MetaMessage("set_tempo", tempo=tempo))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "piece.mid"
        mido.MidiFile(type=0, ticks_per_beat=480, tracks=[track]).save(path)
        found = inspected(path, f"--set=Trumpet.lung_s={lung_s}", "--felt-beat", "1")
        assert faults(path, found) == []
    (player,) = found["players"]
    ends = [breath["end_s"] for breath in player["breaths"] if breath["kind"] == "breath"]
    stretches = [later - earlier for earlier, later in pairwise([*ends, found["duration_s"]])]
    flagged = [warning for warning in found["warnings"] if "must be played in one breath" in warning]
    # A lungful lasts 12 s on a trumpet for lungs of 9.
    if max(stretches) > lung_s * 12.0 / 9.0 + 1e-6:
        assert flagged
    # Where every note is long enough to breathe out of, nothing has to be flagged but a note that is too long itself.
    longest_s, shortest_s = (pick(durations) * tempo / 480e6 for pick in (max, min))
    if shortest_s >= 0.6 and longest_s <= lung_s * 0.4:
        assert not flagged
    for breath in player["breaths"]:
        if breath["start_s"] >= 0.0:
            said = breath["reason"]
            assert re.search(
                r"catch breath after note .*; the note is shortened by "
                r"|short breath at the end of a phrase, after note .*, which is shortened by "
                r"|catch breath in place of note \S+ \(\S+\), which is excluded: "
                r"|catch breath in place of notes \S+ \(\S+\) and \S+ \(\S+\), which are excluded: ",
                said,
            ), said
