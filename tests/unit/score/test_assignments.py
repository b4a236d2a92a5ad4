"""Assignment of a file's tracks to instruments."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

from app.project.model import map_choices
from app.score.assignments import PartAssignment, usual_assignments
from app.score.contents import assigned_score
from app.score.parts import stream_name
from app.score.read import read_contents, read_midi
from instrument_maps.load import bundled_maps

MIDI = Path(__file__).parents[2] / "data" / "midi" / "ensemble"
MAPS = map_choices(bundled_maps().values())


@pytest.mark.parametrize("path", sorted(MIDI.glob("*.mid")), ids=lambda path: path.stem)
def test_usual_assignments_are_what_the_reader_does(path: Path) -> None:
    contents = read_contents(path)
    requested = assigned_score(contents, usual_assignments(contents.channels, MAPS), MAPS)
    assert requested == read_midi(path, maps=MAPS)


def test_a_track_no_one_would_play_can_be_given_to_a_user() -> None:
    contents = read_contents(MIDI / "brass_quartet_lutkin_2tpt_tbn_tuba.mid")
    trombone = next(choice.map_id for choice in MAPS if "trombone" in choice.plays)
    score = assigned_score(contents, [PartAssignment((3,), trombone, name="Bass")], MAPS)
    assert [part.name for part in score.parts] == ["Bass"]
    assert {part.map_id for part in score.parts} == {trombone}
    assert len(score.unplayed) == 3
    assert {part.reason.id for part in score.unplayed} == {"score.left_out"}
    assert score.warnings == ()
    assert sum(len(part.notes) for part in score.parts) == len(contents.channels[3].pitches)


def test_merged_tracks_are_one_line_and_lose_no_note() -> None:
    contents = read_contents(MIDI / "brass_quartet_lutkin_2tpt_tbn_tuba.mid")
    score = assigned_score(contents, [PartAssignment((0, 1), split="never"), PartAssignment((2,))], MAPS)
    assert len(score.parts) == 2
    notes = score.parts[0].notes
    assert len(notes) == len(contents.channels[0].pitches) + len(contents.channels[1].pitches)
    assert len({note.id for note in notes}) == len(notes)
    assert [(note.onset_tick, note.pitch) for note in notes] == sorted((note.onset_tick, note.pitch) for note in notes)


def test_merged_tracks_are_split_again_where_requested() -> None:
    contents = read_contents(MIDI / "brass_quartet_lutkin_2tpt_tbn_tuba.mid")
    score = assigned_score(contents, [PartAssignment((0, 1))], MAPS)
    assert len(score.parts) == 2
    assert len({part.id for part in score.parts}) == 2


BAND = MIDI / "concert_band_hall_tenth_regiment_march.mid"
SAXOPHONES = {"alto sax": -9, "tenor sax": -14, "baritone sax": -21}


def test_written_parts_of_a_real_band_are_read_so_and_reported() -> None:
    contents = read_contents(BAND)
    usual = usual_assignments(contents.channels, MAPS)
    assert {stream_name(contents.channels[one.channels[0]]) for one in usual if one.written} == set(SAXOPHONES)
    sounding = [msgspec.structs.replace(assignment, written=False) for assignment in usual]
    score = assigned_score(contents, sounding, MAPS)
    read = assigned_score(contents, usual, MAPS)
    # The alto and the tenor are only unusually high as they sound, and follow the baritone.
    reported = {warning.arguments["part"]: warning.id for warning in read.warnings}
    assert reported == {
        "alto sax": "score.written",
        "tenor sax": "score.written",
        "baritone sax": "score.read_as_written",
    }
    for before, now in zip(score.parts, read.parts, strict=True):
        shift = SAXOPHONES.get(now.name, 0)
        assert now.transposed_semitones == shift
        assert [note.pitch for note in now.notes] == [note.pitch + shift for note in before.notes]
        if shift:
            instrument = bundled_maps()[now.map_id]
            assert all(instrument.range.low <= note.pitch <= instrument.range.high for note in now.notes)
