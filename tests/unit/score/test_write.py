"""Values that a MIDI file cannot contain are reported, and limits are respected."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.errors import AppError
from app.messages import error_text
from app.score.metre_map import Metre
from app.score.model import ControllerCurve, Note, Part, Score
from app.score.read import read_midi
from app.score.tempo import TempoChange, TempoMap
from app.score.write import PartPlayer, midi_file, write_midi
from instrument_maps.instrument_names import vocabulary
from tests.unit.score.midi_bytes import MAPS, TROMBONE, TRUMPET


def part(name: str = "Trumpet", *, channel: int = 0, notes: tuple[Note, ...] | None = None, **fields: object) -> Part:
    given = (Note("2:1", 0, 96, 60, 64),) if notes is None else notes
    values = {"program": 56, "instrument": "trumpet", "map_id": "trumpet", "curves": ()} | fields
    return Part("p", name, 1, 0, channel, notes=given, **values)


def score(*parts: Part, division: int = 96, tempo: float = 500_000.0) -> Score:
    return Score("Piece", division, TempoMap(division, (TempoChange(0, tempo),)), parts=parts)


def again(written: Score, folder: Path, performers: dict[str, PartPlayer] | None = None) -> Score:
    path = folder / "written.mid"
    write_midi(written, path, performers)
    return read_midi(path, maps=MAPS)


@pytest.mark.parametrize("tempo", [9_000.0, 0xFFFFFF + 1.0])
def test_a_tempo_beyond_the_files_bits_is_refused_with_its_place(tempo: float, tmp_path: Path) -> None:
    piece = score(part())
    changes = (TempoChange(0, 500_000.0), TempoChange(2 * 384, tempo))
    slow = Score(piece.title, 96, TempoMap(96, changes), parts=piece.parts)
    with pytest.raises(AppError, match=r"midi\.tempo_unwritable") as refused:
        write_midi(slow, tmp_path / "slow.mid")
    assert error_text(refused.value).startswith("3.1.000: ")
    assert list(tmp_path.iterdir()) == []


def test_the_slowest_and_the_finest_are_held(tmp_path: Path) -> None:
    read = again(score(part(), division=32767, tempo=float(0xFFFFFF)), tmp_path)
    assert (read.ticks_per_quarter, read.tempo_map.changes) == (32767, (TempoChange(0, float(0xFFFFFF)),))


def test_a_rest_longer_than_a_delta_time(tmp_path: Path) -> None:
    far = Note("2:1", 2**31 - 200, 100, 60, 64)
    [read] = again(score(part(notes=(far,)), division=32767), tmp_path).parts
    assert read.notes == (far,)


def test_texts_beyond_ascii(tmp_path: Path) -> None:
    read = again(Score("祝典序曲 Flöte", 96, TempoMap(96), parts=(part("トランペット 一"),)), tmp_path)
    assert (read.title, read.parts[0].name) == ("祝典序曲 Flöte", "トランペット 一")
    assert read.parts[0].instrument == "trumpet"


def test_a_part_that_says_nothing_is_read_for_who_plays_it(tmp_path: Path) -> None:
    silent = part("Anna", program=None, instrument=None, map_id="trombone")
    read = again(score(silent), tmp_path, {"p": PartPlayer("Anna", TROMBONE)})
    assert [(one.name, one.map_id, one.program) for one in read.parts] == [("Anna", "trombone", 57)]
    assert read.warnings == ()


def test_a_name_that_says_another_instrument_is_reported() -> None:
    given = midi_file(score(part("Violin 1", instrument="violin")), {"p": PartPlayer("Violin 1", TRUMPET)})
    assert [warning.id for warning in given.warnings] == ["midi.name_says_other"]
    assert midi_file(score(part()), {"p": PartPlayer("Trumpet 2", TRUMPET)}).warnings == ()


def test_notes_together_are_reported() -> None:
    both = (Note("2:1", 0, 96, 60, 64), Note("2:2", 0, 96, 64, 64))
    assert [warning.id for warning in midi_file(score(part(notes=both))).warnings] == ["midi.shared_again"]


def test_sixteen_parts_and_the_percussions_channel(tmp_path: Path) -> None:
    names = [part(f"Trumpet {number}", channel=channel) for number, channel in enumerate([9, 0, 0, *range(15), 3])]
    parts = tuple(Part(f"p{n}", *[getattr(p, f) for f in Part.__struct_fields__[1:]]) for n, p in enumerate(names))
    read = again(score(*parts), tmp_path)
    assert [one.name for one in read.parts] == [one.name for one in parts]
    channels = [one.channel for one in read.parts]
    assert set(channels) == set(range(16)) - {9}
    assert channels[1] == 0, "the first that has a channel keeps it"


def test_every_curve_comes_back_within_a_step(tmp_path: Path) -> None:
    ticks, values = tuple(range(0, 100, 10)), tuple(number / 9 for number in range(10))
    kinds = ("aftertouch", "bite", "breath", "expression", "pitch_bend", "volume")
    given = tuple(ControllerCurve(kind, ticks, values) for kind in kinds)
    [read] = again(score(part(curves=given)), tmp_path).parts
    assert [curve.kind for curve in read.curves] == list(kinds)
    for curve in read.curves:
        step = 1 / 8192 if curve.kind == "pitch_bend" else 0.5 / 127
        assert curve.ticks == ticks
        assert max(abs(a - b) for a, b in zip(curve.values, values, strict=True)) <= step + 1e-12


@pytest.mark.parametrize("widest", [1.0, 1.5, 6.0, 24.0, 63.5])
def test_wide_bends_are_written_with_their_range(widest: float, tmp_path: Path) -> None:
    """Two parts on one channel have different ranges."""
    values = tuple(widest * (number / 10 - 1.0) for number in range(20))
    wide = ControllerCurve("pitch_bend", tuple(range(20)), values)
    usual = ControllerCurve("pitch_bend", (0, 5), (0.5, -1.0))
    parts = [part(curves=(wide if place == 0 else usual,)) for place in range(16)]
    read = again(score(*parts), tmp_path).parts
    # The highest step of a wheel lies below its range, which has whole semitones.
    assert read[0].curves[0].values == pytest.approx(values, abs=(widest + 0.5) / 8192)
    assert [one.curves[0].values for one in read[1:]] == [usual.values] * 15


def test_every_instrument_is_known_again_by_the_name_that_is_written() -> None:
    for id, instrument in vocabulary().instruments.items():
        found = vocabulary().by_name(instrument.names[0])
        assert getattr(found, "id", None) == id


def test_an_empty_score_and_an_odd_metre(tmp_path: Path) -> None:
    empty = Score("Nothing", 480, TempoMap(480), metres=(Metre(0, 255, 64),))
    read = again(empty, tmp_path)
    assert (read.title, read.metres, read.parts) == ("Nothing", empty.metres, ())
