"""What a person wants of a file's tracks."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.project.model import map_choices
from app.score.parts import PartWish, usual_wishes
from app.score.read import read_contents, read_midi, wished_score
from instrument_maps.load import bundled_maps

MIDI = Path(__file__).parents[2] / "data" / "midi" / "ensemble"
MAPS = map_choices(bundled_maps().values())


@pytest.mark.parametrize("path", sorted(MIDI.glob("*.mid")), ids=lambda path: path.stem)
def test_usual_wishes_are_what_the_reader_does(path: Path) -> None:
    contents = read_contents(path)
    wished = wished_score(contents, usual_wishes(contents.streams, MAPS), MAPS)
    assert wished == read_midi(path, maps=MAPS)


def test_a_track_nobody_would_play_can_be_given_to_somebody() -> None:
    contents = read_contents(MIDI / "brass_quartet_lutkin_2tpt_tbn_tuba.mid")
    trombone = next(choice.map_id for choice in MAPS if "trombone" in choice.plays)
    score = wished_score(contents, [PartWish((3,), trombone, name="Bass")], MAPS)
    assert [part.name for part in score.parts] == ["Bass"]
    assert {part.map_id for part in score.parts} == {trombone}
    assert len(score.unplayed) == 3
    assert {part.reason.id for part in score.unplayed} == {"score.left_out"}
    assert score.warnings == ()
    assert sum(len(part.notes) for part in score.parts) == len(contents.streams[3].pitches)


def test_merged_tracks_are_one_line_and_lose_no_note() -> None:
    contents = read_contents(MIDI / "brass_quartet_lutkin_2tpt_tbn_tuba.mid")
    score = wished_score(contents, [PartWish((0, 1), split=False), PartWish((2,))], MAPS)
    assert len(score.parts) == 2
    notes = score.parts[0].notes
    assert len(notes) == len(contents.streams[0].pitches) + len(contents.streams[1].pitches)
    assert len({note.id for note in notes}) == len(notes)
    assert [(note.onset_tick, note.pitch) for note in notes] == sorted((note.onset_tick, note.pitch) for note in notes)


def test_merged_tracks_are_split_again_where_wanted() -> None:
    contents = read_contents(MIDI / "brass_quartet_lutkin_2tpt_tbn_tuba.mid")
    score = wished_score(contents, [PartWish((0, 1))], MAPS)
    assert len(score.parts) == 2
    assert len({part.id for part in score.parts}) == 2
