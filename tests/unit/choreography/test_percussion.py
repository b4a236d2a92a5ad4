"""The rhythm that dancers hear in a piece: beats and percussion."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import mido
import numpy as np
import pytest

from app.choreography.accent_grid import grid_of
from app.choreography.percussion import score_rhythm
from app.choreography.rhythm import SYMBOLS, Rhythm
from app.score.contents import uncast_score
from app.score.read import read_contents

QUARTER = 480
DRUMS = Path(__file__).parents[4] / "shared" / "data" / "midi" / "drums"


def rhythm_of(
    tmp_path: Path,
    hits: Sequence[tuple[int, int, int]],
    *,
    metres: Sequence[tuple[int, int, int]] = ((0, 4, 4),),
    bpm: float = 120.0,
    channel: int = 9,
    name: str = "",
    program: int | None = None,
) -> Rhythm:
    """Rhythm of hits (tick, note, velocity), each 10 ticks long."""
    events = [(tick, mido.MetaMessage("time_signature", numerator=n, denominator=d)) for tick, n, d in metres]
    events.append((0, mido.MetaMessage("set_tempo", tempo=mido.bpm2tempo(bpm))))
    if name:
        events.append((0, mido.MetaMessage("track_name", name=name.encode().decode("latin1"))))
    if program is not None:
        events.append((0, mido.Message("program_change", channel=channel, program=program)))
    for tick, note, velocity in hits:
        events.append((tick, mido.Message("note_on", channel=channel, note=note, velocity=velocity)))
        events.append((tick + 10, mido.Message("note_off", channel=channel, note=note)))
    track = mido.MidiTrack()
    now = 0
    for tick, message in sorted(events, key=lambda event: event[0]):
        track.append(message.copy(time=tick - now))
        now = tick
    path = tmp_path / "piece.mid"
    mido.MidiFile(type=0, ticks_per_beat=QUARTER, tracks=[track]).save(path)
    return score_rhythm(uncast_score(read_contents(path)))


def notes(rhythm: Rhythm) -> list[int]:
    return [SYMBOLS[symbol] for symbol in rhythm.symbols]


def test_hits_are_the_notes_of_the_drums_in_seconds(tmp_path: Path) -> None:
    rhythm = rhythm_of(tmp_path, [(0, 36, 127), (480, 38, 64), (720, 81, 1)])
    assert notes(rhythm) == [36, 38, 81]
    np.testing.assert_allclose(rhythm.hits_s, [0.0, 0.5, 0.75])
    np.testing.assert_allclose(rhythm.strengths, np.array([127, 64, 1]) / 127)
    assert not rhythm.derived


def test_edges_of_the_hi_hat_are_the_hi_hat_and_unknown_sounds_are_left_out(tmp_path: Path) -> None:
    rhythm = rhythm_of(tmp_path, [(0, 22, 90), (480, 26, 90), (960, 34, 90), (1440, 82, 90), (1920, 0, 90)])
    assert notes(rhythm) == [42, 46]


def test_hits_at_one_time_are_kept_and_a_doubled_sound_counts_once(tmp_path: Path) -> None:
    rhythm = rhythm_of(tmp_path, [(480, 49, 80), (480, 22, 100), (480, 42, 40), (480, 36, 60)])
    assert notes(rhythm) == [36, 42, 49]
    np.testing.assert_allclose(rhythm.strengths * 127, [60, 100, 80])


LATIN, TUNE = (60, 61, 64, 69, 75, 81), (60, 62, 64, 65, 67, 69, 71, 72)


@pytest.mark.parametrize(
    ("name", "program", "pitches", "heard"),
    [
        *((name, None, LATIN, LATIN) for name in ("Drum Kit", "Drums", "ドラムセット", "パーカッション", "Schlagzeug")),
        ("Drum Kit", 0, LATIN, LATIN),
        ("Drum Kit", 118, LATIN, LATIN),
        ("Drum Kit", None, TUNE, TUNE),
        ("Drum Kit", 56, (36, 42, 38, 42), (36, 42, 38, 42)),
        ("Congas", None, (62, 63, 64), (62, 63, 64)),
        ("スネア", None, (60, 60), (38, 38)),
        ("Bass Drum", 0, (60,), (36,)),
        ("Kick", None, (35,), (35,)),
        ("Snare Drum", None, (38, 40), (38, 40)),
        ("", 116, (41, 43), (41, 43)),
    ],
)
@pytest.mark.parametrize("channel", [0, 4])
def test_untuned_percussion_is_heard_on_any_channel(
    tmp_path: Path, channel: int, name: str, program: int | None, pitches: tuple[int, ...], heard: tuple[int, ...]
) -> None:
    hits = [(QUARTER * at, pitch, 90) for at, pitch in enumerate(pitches)]
    rhythm = rhythm_of(tmp_path, hits, channel=channel, name=name, program=program)
    assert tuple(notes(rhythm)) == heard


@pytest.mark.parametrize(
    ("channel", "name", "program", "pitches"),
    [
        (0, "", None, LATIN),
        (0, "", 0, (36, 38, 42)),
        (9, "Trumpet", None, LATIN),
        (0, "Trumpet", None, (36, 38, 42)),
        (0, "Tuba", 58, (36, 38, 42)),
        (0, "Rhythm Guitar", 29, (40, 47, 52)),
        (0, "The Little Drummer Boy", 56, TUNE),
        (0, "Glockenspiel", None, TUNE),
        (0, "マリンバ", 12, (48, 52)),
        (0, "Timpani", 47, (41, 48)),
        (0, "Steel Drums", 114, TUNE),
    ],
)
def test_other_tracks_are_no_percussion(
    tmp_path: Path, channel: int, name: str, program: int | None, pitches: tuple[int, ...]
) -> None:
    hits = [(QUARTER * at, pitch, 90) for at, pitch in enumerate(pitches)]
    assert not len(rhythm_of(tmp_path, hits, channel=channel, name=name, program=program).hits_s)


@pytest.mark.parametrize(
    ("metre", "bpm", "places", "beat_s", "parts"),
    [
        ((4, 4), 120.0, [0, 1, 2, 3], 0.5, 2),
        ((6, 8), 120.0, [0, 1], 0.75, 3),
        ((6, 8), 50.0, [0, 1, 2, 3, 4, 5], 0.6, 2),
        ((12, 8), 150.0, [0, 1, 2, 3], 0.6, 3),
        ((3, 4), 200.0, [0], 0.9, 3),
        ((2, 2), 160.0, [0, 1], 0.75, 2),
        ((5, 4), 110.0, [0, 1, 2, 3, 4], 60 / 110, 2),
    ],
)
def test_beats_are_those_felt_and_each_bar_begins_with_one(
    tmp_path: Path, metre: tuple[int, int], bpm: float, places: list[float], beat_s: float, parts: int
) -> None:
    bar = QUARTER * 4 * metre[0] // metre[1]
    rhythm = rhythm_of(tmp_path, [(0, 36, 90), (2 * bar - 10, 36, 90)], metres=[(0, *metre)], bpm=bpm)
    assert rhythm.bar_beats.tolist() == 2 * places
    np.testing.assert_allclose(np.diff(rhythm.beats_s), beat_s, atol=1e-5)
    assert rhythm.beats_s[0] == 0.0
    # Between beats are the places that the metre counts.
    grid = grid_of(rhythm)
    assert np.flatnonzero(grid.on_beat).tolist() == (parts * np.arange(len(rhythm.beats_s))).tolist()
    np.testing.assert_allclose(np.diff(grid.times_s), beat_s / parts, atol=1e-5)


def test_a_pickup_has_the_last_beats_of_its_bar(tmp_path: Path) -> None:
    rhythm = rhythm_of(tmp_path, [(0, 36, 90), (480, 36, 90)], metres=[(0, 1, 4), (480, 4, 4)])
    assert rhythm.bar_beats.tolist() == [3, 0, 1, 2, 3]
    np.testing.assert_allclose(rhythm.beats_s, 0.5 * np.arange(5))


@pytest.mark.skipif(not DRUMS.is_dir(), reason="no drum recordings here")
def test_recorded_drums_are_used_whole() -> None:
    """Every note of these recordings is a sound of General MIDI or an edge of the hi-hat."""
    files = sorted(DRUMS.glob("*.mid"), key=lambda path: path.stat().st_size)[:3]
    assert files
    for path in files:
        contents = read_contents(path)
        rhythm = score_rhythm(uncast_score(contents))
        tick, struck = 0, set()
        for message in mido.merge_tracks(mido.MidiFile(path).tracks):
            tick += message.time
            if message.type == "note_on" and message.velocity:
                struck.add((tick, {22: 42, 26: 46}.get(message.note, message.note)))
        ticks = np.round(contents.tempo_map.ticks(rhythm.hits_s)).astype(int).tolist()
        assert list(zip(ticks, notes(rhythm), strict=True)) == sorted(struck), path.name
        assert np.all(np.diff(rhythm.beats_s) > 0.0)
        assert rhythm.beats_s[0] <= rhythm.hits_s[0] < rhythm.hits_s[-1]
