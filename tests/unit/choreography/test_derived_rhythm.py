"""The rhythm that dancers hear in a piece without percussion, with symbols verified by hand."""

from __future__ import annotations

from pathlib import Path

import mido
import numpy as np
import pytest

from app.choreography.derived_rhythm import audible_rhythm, derived_rhythm
from app.choreography.rhythm import SYMBOLS
from app.score.contents import uncast_score
from app.score.model import Score
from app.score.read import read_contents

QUARTER = 480
ENSEMBLE = Path(__file__).parents[4] / "shared" / "data" / "midi" / "ensemble"


def piece(tmp_path: Path, *voices: list[tuple[float, float, int, int]], drums: tuple[float, ...] = ()) -> Score:
    """Piece of voices with notes (onset and length in quarters, pitch, velocity) in 4/4 at 120 quarters a minute."""
    tracks = []
    for channel, notes in enumerate([*voices, [(onset, 0.1, 38, 90) for onset in drums]]):
        place = 9 if channel == len(voices) else channel
        events = []
        for onset, length, pitch, velocity in notes:
            start, end = round(onset * QUARTER), round((onset + length) * QUARTER)
            events.append((start, mido.Message("note_on", channel=place, note=pitch, velocity=velocity)))
            events.append((end, mido.Message("note_off", channel=place, note=pitch)))
        track, now = mido.MidiTrack(), 0
        for tick, message in sorted(events, key=lambda event: (event[0], event[1].type)):
            track.append(message.copy(time=tick - now))
            now = tick
        tracks.append(track)
    path = tmp_path / "piece.mid"
    mido.MidiFile(type=1, ticks_per_beat=QUARTER, tracks=tracks).save(path)
    return uncast_score(read_contents(path))


def rhythm_of(score: Score) -> list[tuple[float, int]]:
    rhythm = derived_rhythm(score)
    assert rhythm.derived
    return [(2.0 * time_s, SYMBOLS[symbol]) for time_s, symbol in zip(rhythm.hits_s, rhythm.symbols, strict=True)]


def test_melody_bass_and_leaps_have_their_sounds(tmp_path: Path) -> None:
    melody = [(0, 0.5, 72, 80), (0.5, 0.5, 74, 80), (1, 1, 79, 80), (2, 1, 77, 80), (3, 1, 70, 80)]
    bass = [(0, 2, 48, 80), (2, 2, 50, 80)]
    found = rhythm_of(piece(tmp_path, melody, bass))
    assert [hit for hit in found if hit[1] not in (38, 49)] == [
        *[(0.0, 36), (0.0, 42), (0.5, 42), (1.0, 50), (2.0, 36), (2.0, 46), (3.0, 45)],
    ]
    assert [hit for hit in found if hit[1] == 49] == [(0.0, 49)]


def test_a_middle_voice_gives_no_rhythm(tmp_path: Path) -> None:
    outer = [(0, 4, 76, 80)], [(0, 4, 48, 80)]
    inner = [(1, 1, 60, 80), (2, 1, 62, 80), (3, 1, 64, 80)]
    assert {time for time, _ in rhythm_of(piece(tmp_path, *outer, inner))} == {0.0}


@pytest.mark.parametrize(
    "accented",
    [
        pytest.param([(4, 0.5, 72, 110)], id="louder"),
        pytest.param([(4, 0.5, pitch, 80) for pitch in (72, 68, 65, 62)], id="fuller"),
        pytest.param([(4, 2.0, 74, 80)], id="longer"),
    ],
)
def test_what_is_louder_fuller_or_longer_is_an_accent(
    tmp_path: Path, accented: list[tuple[float, float, int, int]]
) -> None:
    even = [(at, 0.5, 72, 80) for at in range(8) if at != 4]
    found = rhythm_of(piece(tmp_path, [*even, *accented]))
    assert [time for time, sound in found if sound == 38] == [4.0]
    assert not [sound for _, sound in rhythm_of(piece(tmp_path, [*even, (4, 0.5, 72, 80)])) if sound == 38]


def test_a_phrase_begins_after_a_beat_of_silence(tmp_path: Path) -> None:
    notes = [(at, 0.5, 72, 80) for at in (0, 1, 3, 4, 4.5, 6)]
    assert [time for time, sound in rhythm_of(piece(tmp_path, notes)) if sound == 49] == [0.0, 3.0, 6.0]


def test_a_low_note_of_one_voice_is_its_bass(tmp_path: Path) -> None:
    notes = [(at, 0.5, pitch, 80) for at, pitch in zip(np.arange(8) / 2.0, [60, 67, 72, 67] * 2, strict=True)]
    assert [time for time, sound in rhythm_of(piece(tmp_path, notes)) if sound == 36] == [0.0, 2.0]


def test_notes_of_a_chord_that_is_not_quite_together_are_one_moment(tmp_path: Path) -> None:
    found = rhythm_of(piece(tmp_path, [(0, 1, 60, 60), (0.03, 1, 64, 100), (0.05, 1, 72, 50)]))
    assert found == [(0.0, 36), (0.0, 46), (0.0, 49)]
    rhythm = derived_rhythm(uncast_score(read_contents(tmp_path / "piece.mid")))
    assert rhythm.strengths == pytest.approx([100 / 127] * 3)


def test_percussion_is_used_where_there_is_any(tmp_path: Path) -> None:
    notes = [(0, 1, 60, 80)]
    with_drums = audible_rhythm(piece(tmp_path, notes, drums=(1.0,)))
    assert not with_drums.derived
    assert with_drums.hits_s.tolist() == [0.5]
    # The melody counts too, by an amount.
    assert with_drums.melody is not None
    assert with_drums.melody.hits_s.tolist() == [0.0, 0.0]
    assert audible_rhythm(piece(tmp_path, drums=(1.0,))).melody is None
    assert audible_rhythm(piece(tmp_path, notes)).derived
    assert len(derived_rhythm(piece(tmp_path, drums=(1.0,))).hits_s) == 0


@pytest.mark.skipif(not ENSEMBLE.is_dir(), reason="needs the shared pieces")
@pytest.mark.parametrize("file", ["brass_quartet_lutkin_2tpt_tbn_tuba.mid", "solo_flute_bach_partita_corrente.mid"])
def test_real_pieces_have_a_pulse_and_several_sounds(file: str) -> None:
    rhythm = derived_rhythm(uncast_score(read_contents(ENSEMBLE / file)))
    assert (np.diff(rhythm.hits_s) >= 0.0).all()
    assert 0.5 < len(rhythm.hits_s) / len(rhythm.beats_s) < 6.0
    assert len(np.unique(rhythm.symbols)) >= 5
