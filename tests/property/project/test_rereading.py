"""Reading a file again keeps all assignments and edits made since its import."""

from __future__ import annotations

import random
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import mido
import msgspec
from hypothesis import given, settings
from hypothesis import strategies as st

from app.plan.by_hand.corrections import AddGesture, Correction, PinFingering, SetBreath, SetCue
from app.project.edit.corrections import with_corrections
from app.project.edit.dynamics import set_dynamics
from app.project.edit.notes import add_note, erase, set_velocity
from app.project.edit.players import change, set_parameters
from app.project.edit.tempo import set_tempo
from app.project.import_decisions import ImportDecisions
from app.project.importing import ImportRow, import_project, usual_rows
from app.project.model import Project
from app.project.reimport import reimported
from app.project.storage import decode, encode
from app.score.assignments import PartAssignment
from app.score.model import ControllerCurve
from app.score.read import read_contents
from instrument_maps.load import bundled_maps
from tests.support.projects import decisions

MAPS = bundled_maps()
QUARTER = 480
BAR = 4 * QUARTER
INSTRUMENTS = ("trumpet_Bb", "horn_double_F_Bb", "trombone_tenor_F_attachment", "clarinet_Bb", "oboe", "tuba_F")
CHARACTERS = (None, "woman_adult", "man_adult")
NAMES = ("", "Lead", "Flute", "Horn in F", "Voice", "Piano", "トランペット", "xyz", "Drums")
UNKNOWN = ("", "Lead", "Stimme 3", "Piano", "Strings", "xyz")


@dataclass(frozen=True)
class Track:
    """A track of a made-up file: its notes as (onset, length, pitch)."""

    name: str
    channel: int
    program: int | None
    notes: tuple[tuple[int, int, int], ...]


@st.composite
def melodies(draw: st.DrawFn, number: int) -> tuple[tuple[int, int, int], ...]:
    """A melody, sometimes with two notes at a time; all differ, since tracks with equal notes are indistinguishable."""
    chance = random.Random(8 * draw(st.integers(0, 2**32)) + number)
    chords = draw(st.sampled_from([0.0, 0.0, 0.3, 1.0]))
    tick, pitch, notes = QUARTER * chance.randrange(8), chance.randrange(45, 80), []
    for _ in range(draw(st.integers(5, 30))):
        length = chance.choice([120, 240, 240, 480, 720])
        notes.append((tick, length, pitch))
        if chance.random() < chords:
            notes.append((tick, length, pitch - chance.choice([3, 4, 7])))
        tick += length + chance.choice([0, 0, 0, 240, 1920])
        pitch = min(max(pitch + chance.randrange(-5, 6), 40), 84)
    return tuple(notes)


@st.composite
def pieces(draw: st.DrawFn) -> list[Track]:
    count = draw(st.integers(1, 5))
    return [
        Track(
            draw(st.sampled_from(NAMES)),
            draw(st.sampled_from([channel, 0])),
            draw(st.sampled_from([None, None, 0, 56, 73])),
            draw(melodies(channel)),
        )
        for channel in range(count)
    ]


@st.composite
def rows_of(draw: st.DrawFn, count: int) -> list[ImportRow]:
    """Every stream in one row; the rows in any order."""
    streams = draw(st.permutations(range(count)))
    rows = []
    while streams:
        size = draw(st.sampled_from([1, 1, 1, 2, 3]))
        own, streams = tuple(streams[:size]), streams[size:]
        assignment = PartAssignment(
            own,
            draw(st.sampled_from([None, *INSTRUMENTS])),
            draw(st.sampled_from(["", "", "Anna"])),
            draw(st.sampled_from(["sustained", "every", "never"])),
            draw(st.booleans()),
        )
        rows.append(ImportRow(assignment, draw(st.integers(0, 4)) > 0, draw(st.sampled_from(CHARACTERS))))
    return rows


def edited(draw: st.DrawFn, project: Project) -> Project:
    """The project with various edits."""
    for player in project.players:
        notes = project.part(player).notes
        chosen = draw(st.lists(st.sampled_from(notes), max_size=3, unique_by=lambda note: note.id))
        items: list[Correction] = [
            draw(st.sampled_from([SetBreath(note.id, -60, -10), SetCue(note.id, 1.0), PinFingering(note.id, "1")]))
            for note in chosen
        ]
        items.append(AddGesture(f"own-{player.id}", "sway", draw(st.integers(0, 16)) * BAR, 17 * BAR, 0.5))
        project = with_corrections(project, player.id, items)
        if draw(st.booleans()):
            project = set_parameters(project, [player.id], amplitude=draw(st.sampled_from([0.25, 0.75])))
        if draw(st.booleans()):
            project = change(project, [player.id], character_id="man_adult")
        touched = {note.id for note in chosen}
        free = [note for note in project.part(player).notes if note.id not in touched]
        if free and draw(st.booleans()):
            note = draw(st.sampled_from(free))
            project = erase(project, [note.id]) if draw(st.booleans()) else set_velocity(project, [note.id], 9)
        if draw(st.booleans()):
            end = project.part(player).end_tick
            project, _ = add_note(project, project.part(player).id, end + BAR, 240, 60, 80)
        if draw(st.booleans()):
            drawn = ControllerCurve("expression", (0, BAR), (0.25, 0.5))
            project = set_dynamics(project, {project.part(player).id: drawn})
    return set_tempo(project, 0, 90.0) if draw(st.booleans()) else project


@contextmanager
def file_of(tracks: Sequence[Track], flat: bool = False) -> Iterator[Path]:
    """A MIDI file of these tracks; ``flat``: of one track with all of them."""
    made = []
    for track in tracks:
        events: list[tuple[int, int, mido.Message]] = []
        for onset, length, pitch in track.notes:
            events.append((onset, 1, mido.Message("note_on", note=pitch, velocity=80, channel=track.channel)))
            events.append((onset + length, 0, mido.Message("note_off", note=pitch, channel=track.channel)))
        if track.program is not None:
            events.append((0, 0, mido.Message("program_change", program=track.program, channel=track.channel)))
        made.append((track.name, events))
    if flat:
        made = [("", [event for _, events in made for event in events])]
    content = []
    for name, events in made:
        messages = mido.MidiTrack([mido.MetaMessage("track_name", name=name)] if name else [])
        before = 0
        for tick, _, message in sorted(events, key=lambda event: event[:2]):
            messages.append(message.copy(time=tick - before))
            before = tick
        content.append(messages)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "piece.mid"
        mido.MidiFile(type=0 if flat else 1, ticks_per_beat=QUARTER, tracks=content, charset="utf-8").save(path)
        yield path


@given(st.data())
@settings(max_examples=20, deadline=None)
def test_what_was_decided_and_edited_stays(data: st.DataObject) -> None:
    tracks = data.draw(pieces())
    with file_of(tracks) as path:
        contents = read_contents(path)
        rows = data.draw(rows_of(len(contents.channels)))
        imported = import_project(contents, rows, MAPS, str(path))
        project = edited(data.draw, imported)
        assert reimported(project, path, MAPS).project is project
        kept = decode(encode(project, path), path)
        assert reimported(kept, path, MAPS).project is kept
        # A project of an older program tells most of it by its parts.
        older = replace(imported, imported=None, read_timing=None, read_curves={})
        outcome = reimported(older, path, MAPS)
        assert (outcome.gone_players, outcome.orphans) == ((), ())
    bars = data.draw(st.sampled_from([0, 2]))
    changed = [
        replace(
            track,
            name=data.draw(st.sampled_from([track.name, *UNKNOWN])),
            notes=tuple((onset + bars * BAR, length, pitch) for onset, length, pitch in track.notes),
        )
        for track in data.draw(st.permutations(tracks))
    ]
    alone = len({track.channel for track in tracks}) == len(tracks)
    with file_of(changed, flat=alone and data.draw(st.booleans())) as path:
        outcome = reimported(project, path, MAPS)
        assert (outcome.new_players, outcome.gone_players, outcome.conflicts) == ((), (), ())
        after = outcome.project
        assert after.players == project.players
        assert {id_: len(items) for id_, items in after.corrections.items()} == {
            id_: len(items) for id_, items in project.corrections.items()
        }
        assert outcome.orphans == reimported(project, path, MAPS).orphans == ()
        for player in project.players:
            before, now = project.part(player).notes, after.part(player).notes
            assert [(note.id, note.pitch, note.velocity) for note in before] == [
                (note.id, note.pitch, note.velocity) for note in now
            ]
        assert reimported(after, path, MAPS).project is after
        outcome = reimported(older, path, MAPS)
        assert outcome.gone_players == ()
        # It does not tell which tracks were left out: those come, and may move the others on the stage.
        for player in older.players:
            assert msgspec.structs.replace(outcome.project.player(player.id), stage=player.stage) == player


@given(decisions, st.integers(0, 2**32))
@settings(max_examples=20, deadline=None)
def test_any_decisions_that_can_be_stored_can_be_read_by(kept: ImportDecisions, number: int) -> None:
    """A project's file is data: one that someone made up is read by, too, and what comes of it can be saved."""
    chance = random.Random(number)
    notes = tuple((place * 240, 240, chance.randrange(50, 80)) for place in range(12))
    with file_of([Track("Trumpet", 0, 56, notes), Track("Piano", 1, 0, notes[3:])]) as path:
        contents = read_contents(path)
        project = import_project(contents, usual_rows(contents, MAPS), MAPS, str(path))
        marks = [mark for row in (project.imported or ImportDecisions()).rows for mark in row.tracks]
        # Some that recognise the tracks.
        rows = tuple(
            msgspec.structs.replace(row, tracks=(*row.tracks, chance.choice(marks))) if chance.random() < 0.5 else row
            for row in kept.rows
        )
        project = replace(project, imported=msgspec.structs.replace(kept, rows=rows))
        after = reimported(project, path, MAPS).project
        assert [player.id for player in project.players] == [player.id for player in after.players][:1]
        assert decode(encode(after, path), path) == after
        assert reimported(after, path, MAPS).project is after
