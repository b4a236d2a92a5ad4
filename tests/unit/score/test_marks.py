"""Marks stay with their notes: when a staff is shared, a project saved, a player copied and a file read again."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from app.errors import FileError
from app.project.edit.players import duplicate_players
from app.project.model import Project, map_choices, project_from_score
from app.project.reimport import reimport
from app.project.storage import decode, encode, load, save
from app.score.assignments import PartAssignment
from app.score.marks import MARK_KINDS, Mark
from app.score.model import Part, Score
from app.score.parts import assigned_parts
from app.score.tempo import TempoMap
from app.score.track_channel import TrackChannel
from app.score.voices import file_id
from instrument_maps.load import bundled_maps
from tests.unit.project.pieces import small_project

MAPS = bundled_maps()
PIECE = Path("/music/piece.suisou")
Row = tuple[int, int, int]
"""Onset and end in quarters, pitch."""


def stream(rows: list[Row], marks: tuple[Mark, ...], name: str = "Trumpet") -> TrackChannel:
    return TrackChannel(
        track=0,
        channel=0,
        name=name,
        instrument_name="",
        program=None,
        onset_ticks=[480 * row[0] for row in rows],
        end_ticks=[480 * row[1] for row in rows],
        pitches=[row[2] for row in rows],
        velocities=[80] * len(rows),
        numbers=list(range(1, len(rows) + 1)),
        curves=(),
        marks=marks,
        source="score",
    )


def parts_of(one: TrackChannel, split: str = "sustained") -> tuple[Part, ...]:
    assignment = msgspec.convert({"channels": [0], "split": split}, PartAssignment)
    piece = Score("", 480, TempoMap(480))
    return assigned_parts([one], [assignment], map_choices(MAPS.values()), piece)[0]


def marked(project: Project) -> Project:
    """Project whose first part has a mark of every kind."""
    part = project.score.parts[0]
    notes = [note.id for note in part.notes]
    marks = tuple(
        Mark(kind.id, tick=480, end_tick=960 if kind.anchor == "span" else 0, text="mf" if kind.id == "dynamic" else "")
        if kind.anchor in ("place", "span")
        else Mark(
            kind.id,
            notes[0],
            notes[1] if kind.anchor == "notes" else "",
            text="1" if kind.id in ("fingering", "position") else "",
        )
        for kind in MARK_KINDS.values()
    )
    parts = (msgspec.structs.replace(part, marks=marks, source="score"), *project.score.parts[1:])
    return replace(project, score=msgspec.structs.replace(project.score, parts=parts))


def test_a_line_keeps_its_marks() -> None:
    marks = (Mark("slur", "1:1", "1:3"), Mark("staccato", "1:2"), Mark("dynamic", tick=480, text="mf"))
    (part,) = parts_of(stream([(0, 1, 60), (1, 2, 62), (2, 3, 64)], marks))
    assert (part.marks, part.source) == (marks, "score")


def test_players_of_one_staff_have_the_marks_of_their_own_notes() -> None:
    """Four chords and a common note: the slur from the first chord's upper note to the common note belongs to both
    players, since both play that note.
    """
    chords = [(2 * place, 2 * place + 2, pitch) for place in range(4) for pitch in (60, 67)]
    marks = (
        Mark("slur", "1:1", "1:3"),
        Mark("slur", "1:2", "1:4"),
        Mark("accent", "1:8"),
        Mark("slur", "1:7", "1:9"),
        Mark("slur", "1:8", "1:9"),
        Mark("breath", "1:9"),
        Mark("crescendo", tick=0, end_tick=960),
    )
    upper, lower = parts_of(stream([*chords, (8, 10, 62)], marks, "Horn 1.2"))
    said = [
        [(mark.kind, *(file_id(id) for id in (mark.note_id, mark.last_note_id) if id)) for mark in part.marks]
        for part in (upper, lower)
    ]
    everyone = [("slur", "1:7", "1:9"), ("breath", "1:9"), ("crescendo",)]
    assert said[1] == [("slur", "1:1", "1:3"), *everyone]
    assert said[0] == [("slur", "1:2", "1:4"), ("accent", "1:8"), ("slur", "1:8", "1:9"), *everyone[1:]]
    for part in (upper, lower):
        own = {note.id for note in part.notes}
        assert {id for mark in part.marks for id in (mark.note_id, mark.last_note_id) if id} <= own


def test_a_slur_into_the_note_of_another_player_ends_at_the_last_own_note() -> None:
    rows = [(0, 2, 60), (0, 2, 67), (2, 4, 60), (2, 4, 67), (4, 6, 60), (4, 6, 67), (6, 8, 60), (6, 8, 67)]
    upper, lower = parts_of(stream(rows, (Mark("slur", "1:2", "1:7"),), "Horn"))
    assert upper.marks == (Mark("slur", "1:2", "1:8"),)
    assert lower.marks == (Mark("slur", "1:1", "1:7"),)


def test_a_project_keeps_the_marks(tmp_path: Path) -> None:
    project = marked(small_project())
    path = tmp_path / "piece.suisou"
    save(project, path)
    assert load(path).score.parts == project.score.parts


def test_a_file_without_marks_is_one_of_sounds() -> None:
    whole = json.loads(encode(marked(small_project()), PIECE))
    for part in whole["score"]["parts"]:
        del part["marks"], part["source"]
    first, *_ = decode(json.dumps(whole).encode(), PIECE).score.parts
    assert (first.marks, first.source) == ((), "sound")


@pytest.mark.parametrize(
    "mark",
    [
        {"kind": "shout"},
        {"kind": "slur", "note_id": "1" * 501},
        {"kind": "dynamic", "tick": -1},
        {"kind": "crescendo", "tick": 960, "end_tick": 480},
        {"kind": "dynamic", "text": "f" * 201},
    ],
)
def test_impossible_marks_are_refused(mark: dict[str, object]) -> None:
    whole = json.loads(encode(small_project(), PIECE))
    whole["score"]["parts"][0]["marks"] = [mark]
    with pytest.raises(FileError, match="marks"):
        decode(json.dumps(whole).encode(), PIECE)


def test_a_copy_has_marks_on_its_own_notes() -> None:
    project = marked(small_project())
    result, (copy,) = duplicate_players(project, [project.players[0].id])
    part, original = result.part(result.player(copy)), project.score.parts[0]
    places = {note.id: place for place, note in enumerate(part.notes)}
    assert [places.get(mark.note_id) for mark in part.marks] == [
        {note.id: place for place, note in enumerate(original.notes)}.get(mark.note_id) for mark in original.marks
    ]


def test_marks_of_the_file_come_in_and_follow_the_ids_that_notes_have_here() -> None:
    score = small_project().score
    project = project_from_score(score, MAPS)
    part = score.parts[0]
    renamed = tuple(msgspec.structs.replace(note, id=f"9:{place}") for place, note in enumerate(part.notes, 1))
    marks = (Mark("slur", "9:1", "9:2"), Mark("dynamic", tick=960, text="p"))
    changed = msgspec.structs.replace(part, notes=renamed, marks=marks, source="score")
    result = reimport(project, msgspec.structs.replace(score, parts=(changed, *score.parts[1:])), MAPS).project
    now = result.score.parts[0]
    assert now.marks == (Mark("slur", part.notes[0].id, part.notes[1].id), marks[1])
    assert now.source == "score"
