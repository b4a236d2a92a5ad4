"""The synthesiser: phrases, programs, rendering and cache."""

from __future__ import annotations

import io
from itertools import pairwise

import mido
import msgspec
import numpy as np
import pytest

from app.audio.rendering import soundfont
from app.audio.synth import Synthesiser, phrases, program_of, programs
from app.audio.track import RATE_HZ
from app.score.model import ControllerCurve
from app.score.tempo import TempoChange, TempoMap
from instrument_maps.instrument_names import vocabulary
from instrument_maps.library import find_map
from instrument_maps.load import bundled_maps
from tests.unit.audio.pieces import melody, quartet

TEMPO = TempoMap(480)
SCALE = melody(*((480 * i, 480, 60 + i) for i in range(24)))


def events(midi: bytes) -> list[tuple[int, mido.Message]]:
    at, found = 0, []
    for message in mido.MidiFile(file=io.BytesIO(midi)).tracks[0]:
        at += message.time
        found.append((at, message))
    return found


def test_the_soundfont_has_every_wind_of_the_vocabulary() -> None:
    winds = {p for item in vocabulary().instruments.values() if item.kind == "wind" for p in item.programs}
    assert winds <= programs()
    assert len(soundfont()) < 10e6
    assert len(soundfont(of_drums=True)) < 4e6


def test_every_program_sounds_in_tune_with_itself() -> None:
    synthesiser = Synthesiser()
    for program in sorted(programs()):
        (phrase,) = phrases(melody((0, 960, 69)), TEMPO, program)
        sound = synthesiser.render(phrase).samples.astype(float)
        part = sound[RATE_HZ // 4 : RATE_HZ * 3 // 4]
        assert np.sqrt((part**2).mean()) > 100, program
        spectrum = np.abs(np.fft.rfft(part * np.hanning(len(part)), 1 << 18))
        frequencies = np.fft.rfftfreq(1 << 18, 1 / RATE_HZ)
        # The strongest partial near a whole multiple of 440 Hz (ocarina-like tones have no others).
        band = (frequencies > 200) & (frequencies < 4000)
        strongest = frequencies[band][spectrum[band].argmax()]
        cents = 1200 * np.log2(strongest / (440 * max(round(strongest / 440), 1)))
        assert abs(cents) < 40, (program, strongest)


def test_tones_begin_when_they_are_played() -> None:
    synthesiser = Synthesiser()
    late = {}
    for program in sorted(programs()):
        (phrase,) = phrases(melody((0, 960, 67)), TEMPO, program)
        sound = synthesiser.render(phrase).samples.astype(float)
        level = np.sqrt(np.convolve(sound[: RATE_HZ // 2] ** 2, np.ones(240) / 240, "valid"))
        late[program] = np.flatnonzero(level > 0.25 * np.median(level[RATE_HZ // 5 :]))[0] / RATE_HZ
    print("latest", max(late.items(), key=lambda item: item[1]))
    assert max(late.values()) < 0.03


def test_phrases_hold_every_note_at_its_sample() -> None:
    tempo = TempoMap.of_changes(480, [TempoChange(0, 700_000.0), TempoChange(1000, 431_234.5)])
    found = []
    for phrase in phrases(SCALE, tempo, 56):
        assert phrase.start % 64 == 0
        sounding = {}
        for at, message in events(phrase.midi):
            if message.type == "note_on" and message.velocity:
                sounding[message.note] = at
            elif message.type in ("note_off", "note_on"):
                begin = sounding.pop(message.note)
                found.append((phrase.start + begin, phrase.start + at, message.note))
        assert not sounding
    expected = [
        (tempo.seconds(note.onset_tick) * RATE_HZ, tempo.seconds(note.end_tick) * RATE_HZ, note.pitch)
        for note in SCALE.notes
    ]
    assert np.array(sorted(found)) == pytest.approx(np.array(sorted(expected)), abs=0.51)


def test_an_edit_changes_the_phrase_it_is_in_and_no_other() -> None:
    before = phrases(SCALE, TEMPO, 56)
    moved = msgspec.structs.replace(SCALE.notes[9], pitch=40)
    after = phrases(msgspec.structs.replace(SCALE, notes=(*SCALE.notes[:9], moved, *SCALE.notes[10:])), TEMPO, 56)
    assert len(before) == len(after) == 3
    assert [one == other for one, other in zip(before, after, strict=True)] == [True, False, True]
    without = phrases(msgspec.structs.replace(SCALE, notes=SCALE.notes[1:]), TEMPO, 56)
    assert [one == other for one, other in zip(before[1:], without[1:], strict=True)] == [True, True]


def test_a_note_sounds_once_however_the_part_is_cut() -> None:
    """Phrases overlap by their tails; their sum has neither gaps nor doubled notes at the boundaries."""
    synthesiser = Synthesiser()
    part = melody(*((480 * i, 480, 67) for i in range(24)))
    pieces = [synthesiser.render(phrase) for phrase in phrases(part, TEMPO, 56)]
    assert len(pieces) == 3
    total = np.zeros(max(piece.start + len(piece.samples) for piece in pieces))
    for piece in pieces:
        total[piece.start : piece.start + len(piece.samples)] += piece.samples
    # The same tone is repeated every half second.
    levels = np.sqrt((total[: 12 * RATE_HZ] ** 2).reshape(24, -1).mean(axis=1))
    assert levels[1:] == pytest.approx(levels[1:].mean(), rel=0.05)


def test_the_tail_dies_away() -> None:
    piece = Synthesiser().render(phrases(melody((0, 480, 69)), TEMPO, 56)[0])
    assert 0.55 * RATE_HZ < len(piece.samples) < 2.05 * RATE_HZ
    assert np.abs(piece.samples[-200:]).max() < 40


def test_what_was_rendered_is_remembered() -> None:
    synthesiser = Synthesiser()
    (phrase,) = phrases(melody((0, 480, 69)), TEMPO, 56)
    assert synthesiser.ready(phrase) is None
    piece = synthesiser.render(phrase)
    assert synthesiser.render(phrase).samples is piece.samples
    (later,) = phrases(melody((1920, 480, 69)), TEMPO, 56)
    ready = synthesiser.ready(later)
    assert ready.samples is piece.samples
    assert ready.start == RATE_HZ * 2


def test_memory_has_a_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("app.audio.synth._MOST_CACHED_BYTES", 300_000)
    synthesiser = Synthesiser()
    made = [phrases(melody((0, 480, pitch)), TEMPO, 56)[0] for pitch in range(60, 66)]
    for phrase in made:
        synthesiser.render(phrase)
    synthesiser.forget(made[:1])
    assert synthesiser.ready(made[0]) is not None
    assert synthesiser.ready(made[1]) is None
    assert sum(synthesiser.ready(phrase) is not None for phrase in made) < 4


def test_breath_shapes_the_sound_and_a_mixers_level_is_constant() -> None:
    swell = ControllerCurve("breath", (0, 480, 960), (0.2, 0.6, 1.0))
    part = melody((0, 480, 69), (480, 480, 69), (960, 480, 69), curves=(swell,))
    sound = Synthesiser().render(phrases(part, TEMPO, 56)[0]).samples.astype(float)
    levels = [np.sqrt((sound[int(at * RATE_HZ) :][: RATE_HZ // 4] ** 2).mean()) for at in (0.15, 0.65, 1.15)]
    assert levels[0] < 0.5 * levels[1] < 0.5 * levels[2]


@pytest.mark.parametrize("semitones", [2.0, 1.0, -3.0, 5.0, -12.0, 24.0])
def test_bends_sound_as_many_semitones_as_they_are_wide(semitones: float) -> None:
    # The widest one sets the range; it comes while the note no longer sounds.
    bend = ControllerCurve("pitch_bend", (0, 940), (semitones / 2.0, 1.3 * semitones / 2.0))
    bent = Synthesiser().render(phrases(melody((0, 960, 69), curves=(bend,)), TEMPO, 56)[0]).samples
    spectrum = np.abs(np.fft.rfft(bent[RATE_HZ // 4 : RATE_HZ * 3 // 4].astype(float), 1 << 18))
    frequencies = np.fft.rfftfreq(1 << 18, 1 / RATE_HZ)
    expected = 440 * 2 ** (semitones / 12)
    near = (frequencies > 0.92 * expected) & (frequencies < 1.08 * expected)
    assert frequencies[near][spectrum[near].argmax()] == pytest.approx(expected, rel=0.004)
    around = (frequencies > 0.6 * expected) & (frequencies < 1.6 * expected)
    assert spectrum[around].max() == spectrum[near].max()


def test_programs_come_from_the_map_and_the_vocabulary() -> None:
    for instrument in bundled_maps().values():
        own = {p for name in instrument.plays for p in vocabulary().instruments[name].programs}
        assert program_of(melody(program=None), instrument) in own or not own
        for program in own:
            assert program_of(melody(program=program), instrument) == program
        assert program_of(melody(program=0), instrument) in own or not own
    for player in quartet().players:
        part = quartet().part(player)
        assert program_of(part, find_map(player.instrument_id)) == part.program


def test_controllers_come_before_notes_and_ends_before_beginnings() -> None:
    part = melody((0, 480, 69), (480, 480, 69), curves=(ControllerCurve("volume", (0, 480), (0.5, 1.0)),))
    kinds = [(at, message.type) for at, message in events(phrases(part, TEMPO, 56)[0].midi)]
    assert kinds[0] == (0, "program_change")
    at = RATE_HZ // 2
    assert [kind for when, kind in kinds if when == at] == ["control_change", "note_off", "note_on"]
    assert all(before[0] <= after[0] for before, after in pairwise(kinds))


def test_an_empty_part_is_no_phrase() -> None:
    assert phrases(melody(), TEMPO, 56) == ()
