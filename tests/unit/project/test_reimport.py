"""Content kept, added and removed when a changed MIDI file is read again."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

import mido
import msgspec
import pytest

from app.errors import UsageError
from app.plan.by_hand.corrections import (
    AddGesture,
    ChangeExpression,
    ChangeGesture,
    Correction,
    PinFingering,
    PoseCorrection,
    RemoveEvent,
    SetBreath,
    SetCue,
)
from app.project.casting import StagePosition
from app.project.dance_corrections import ForbidState, PinState, UseSegment
from app.project.edit.corrections import with_corrections
from app.project.edit.length import with_score
from app.project.edit.notes import add_note
from app.project.edit.players import add_player, remove_players, set_parameters
from app.project.edit.tempo import scale_tempo, set_metre, set_tempo
from app.project.file_timing import timing_of
from app.project.midi_out import export_midi
from app.project.model import Project, map_choices, project_from_score
from app.project.orphans import orphaned, reattached
from app.project.performers import Dancer
from app.project.reimport import reimport, reimported
from app.project.storage import load, save
from app.score.assignments import usual_assignments
from app.score.contents import assigned_score
from app.score.metre_map import Metre
from app.score.model import Marker, Note, Part, PercussionHit, Score
from app.score.read import read_contents, read_midi
from app.score.tempo import TempoChange, TempoMap
from instrument_maps.load import bundled_maps
from tests.unit.project.pieces import small_project

MAPS = bundled_maps()
MIDI = Path(__file__).parents[2] / "data" / "midi"
LUTKIN = MIDI / "ensemble" / "brass_quartet_lutkin_2tpt_tbn_tuba.mid"
BAR = 1920


def read(path: Path) -> Project:
    return project_from_score(read_midi(path, maps=map_choices(MAPS.values())), MAPS)


def from_file(score: Score, **changes: object) -> Score:
    """Notes like those of a file, with ids counted from the start."""
    parts = tuple(
        msgspec.structs.replace(
            part,
            id=f"{track}.1.1",
            track=track,
            notes=tuple(
                msgspec.structs.replace(note, id=f"{track}:{number}") for number, note in enumerate(part.notes, 1)
            ),
        )
        for track, part in enumerate(score.parts, 1)
    )
    return msgspec.structs.replace(score, **{"parts": parts, **changes})


def with_notes(score: Score, index: int, notes: list[Note]) -> Score:
    parts = list(score.parts)
    ordered = tuple(sorted(notes, key=lambda note: (note.onset_tick, note.pitch)))
    parts[index] = msgspec.structs.replace(parts[index], notes=ordered)
    return msgspec.structs.replace(score, parts=tuple(parts))


def later(notes: tuple[Note, ...], from_tick: int, by_tick: int) -> list[Note]:
    return [
        msgspec.structs.replace(note, onset_tick=note.onset_tick + by_tick * (note.onset_tick >= from_tick))
        for note in notes
    ]


def corrections_of(project: Project, player: str, kind: type[Correction]) -> list[Correction]:
    return [item for item in project.corrections.get(player, ()) if isinstance(item, kind)]


def test_parts_read_as_written_pitches_are_read_so_again() -> None:
    """The file's trumpet is notated a tone higher than it sounds; then it gets one more note."""
    contents = read_contents(LUTKIN)
    choices = map_choices(MAPS.values())

    def score(written: bool, *more: Note) -> Score:
        assignments = [
            msgspec.structs.replace(assignment, written=written and assignment.channels == (0,))
            for assignment in usual_assignments(contents.channels, choices)
        ]
        found = assigned_score(contents, assignments, choices)
        return with_notes(found, 0, [*found.parts[0].notes, *more])

    project = project_from_score(score(written=True), MAPS)
    assert project.score.parts[0].transposed_semitones == -2
    # Files are read unchanged.
    assert reimport(project, score(written=False), MAPS).project is project
    last = project.score.parts[0].notes[-1]
    new = Note("1:999", last.end_tick + BAR, 480, 70, 80)
    grown = reimport(project, score(False, new), MAPS)
    assert grown.conflicts == ()
    assert len(grown.added) == 1
    part = grown.project.score.parts[0]
    assert part.transposed_semitones == -2
    assert part.notes[:-1] == project.score.parts[0].notes
    assert part.notes[-1].pitch == 68


def test_the_same_file_changes_nothing() -> None:
    project = with_corrections(read(LUTKIN), read(LUTKIN).players[0].id, [PinFingering("1:1", "1")])
    result = reimport(project, from_file(project.score, parts=project.score.parts), MAPS)
    assert result.project is project
    assert (result.added, result.removed, result.new_players, result.gone_players) == ((), (), (), ())


def test_inserted_bars_carry_everything_along() -> None:
    project = with_corrections(
        small_project(),
        "1.1.1",
        [
            PinFingering("1:4", "1"),
            SetBreath("1:4", -120, -10),
            RemoveEvent("breath:1:3", "1:3"),
            AddGesture("mine", "bell_height", 960, 1440, 0.5),
            ChangeGesture("sway:@960", 960, 1200, 0.5),
            ChangeExpression("expression:strained:1:4", strength=0.5),
            AddGesture("early", "sway", 0, 480, 0.5),
            PoseCorrection("pose", "head", 960, 1440, 5.0, fade_in_ticks=240),
            SetCue("@960", 1.0),
        ],
    )
    score = project.score
    for index in range(2):
        score = with_notes(score, index, later(score.parts[index].notes, 960, BAR))
    result = reimport(project, from_file(score), MAPS)
    assert [part.kept for part in result.parts] == [4, 4]
    assert result.orphans == ()
    assert set(result.project.corrections["1.1.1"]) == {
        PinFingering("1:4", "1"),
        SetBreath("1:4", -120, -10),
        RemoveEvent("breath:1:3", "1:3"),
        AddGesture("mine", "bell_height", 960 + BAR, 1440 + BAR, 0.5),
        ChangeGesture(f"sway:@{960 + BAR}", 960 + BAR, 1200 + BAR, 0.5),
        ChangeExpression("expression:strained:1:4", strength=0.5),
        AddGesture("early", "sway", 0, 480, 0.5),
        PoseCorrection("pose", "head", 960 + BAR, 1440 + BAR, 5.0, fade_in_ticks=240),
        SetCue(f"@{960 + BAR}", 1.0),
    }


def test_a_region_across_inserted_bars_grows_and_across_cut_bars_shrinks() -> None:
    project = with_corrections(small_project(), "1.1.1", [AddGesture("mine", "sway", 480, 1440, 0.5)])
    score = project.score
    notes = later(score.parts[0].notes, 960, BAR)
    grown = reimport(project, from_file(with_notes(score, 0, notes)), MAPS)
    assert corrections_of(grown.project, "1.1.1", AddGesture) == [AddGesture("mine", "sway", 480, 1440 + BAR, 0.5)]
    back = reimport(grown.project, from_file(score), MAPS)
    assert back.project.corrections == project.corrections


def test_another_resolution_scales_ticks_and_lengths() -> None:
    project = with_corrections(
        small_project(), "1.1.1", [SetBreath("1:2", -120, -24), AddGesture("mine", "sway", 0, 480, 0.5)]
    )
    score = project.score
    parts = tuple(
        msgspec.structs.replace(
            part,
            notes=tuple(
                msgspec.structs.replace(note, onset_tick=note.onset_tick // 5, duration_tick=note.duration_tick // 5)
                for note in part.notes
            ),
        )
        for part in score.parts
    )
    smaller = msgspec.structs.replace(score, ticks_per_quarter=96, tempo_map=TempoMap(96), parts=parts)
    result = reimport(project, from_file(smaller), MAPS)
    assert result.removed == ()
    assert result.project.corrections["1.1.1"] == (SetBreath("1:2", -24, -5), AddGesture("mine", "sway", 0, 96, 0.5))


def test_a_note_that_is_gone_leaves_its_corrections_and_they_find_another() -> None:
    project = with_corrections(
        small_project(), "1.1.1", [SetBreath("1:2", -100, -10), RemoveEvent("breath:1:2", "1:2"), SetCue("1:1")]
    )
    gone = with_notes(project.score, 0, [note for note in project.score.parts[0].notes if note.id != "1:2"])
    result = reimport(project, from_file(gone), MAPS)
    assert result.removed == ("1:2",)
    assert {orphan.correction for orphan in result.orphans} == {
        SetBreath("1:2", -100, -10),
        RemoveEvent("breath:1:2", "1:2"),
    }
    assert result.project.corrections == project.corrections
    after = reattached(result.project, "1.1.1", SetBreath("1:2", -100, -10), "1:3")
    after = reattached(after, "1.1.1", RemoveEvent("breath:1:2", "1:2"), "1:4")
    assert orphaned(after) == ()
    assert set(after.corrections["1.1.1"]) == {
        SetBreath("1:3", -100, -10),
        RemoveEvent("breath:1:4", "1:4"),
        SetCue("1:1"),
    }
    with pytest.raises(UsageError, match=r"reimport\.not_played"):
        reattached(after, "1.1.1", SetCue("1:1"), "2:1")
    with pytest.raises(UsageError, match=r"reimport\.no_note"):
        reattached(after, "1.1.1", AddGesture("x", "sway", 0, 1, 1.0), "1:1")


def test_new_notes_never_take_an_id_that_something_waits_for() -> None:
    project = with_corrections(small_project(), "1.1.1", [PinFingering("1:2", "1"), PinFingering("f:7", "1")])
    notes = [note for note in project.score.parts[0].notes if note.id != "1:2"]
    notes.append(Note("x", 3000, 480, 100, 80))
    result = reimport(project, from_file(with_notes(project.score, 0, notes)), MAPS)
    assert result.added == ("f:8",)
    assert "1:2" not in {note.id for part in result.project.score.parts for note in part.notes}


def test_parts_are_known_by_what_they_play_not_by_where_they_stand() -> None:
    project = read(LUTKIN)
    project = set_parameters(project, [project.players[0].id], amplitude=0.9)
    turned = msgspec.structs.replace(project.score, parts=tuple(reversed(project.score.parts)))
    renamed = from_file(
        msgspec.structs.replace(
            turned,
            parts=tuple(msgspec.structs.replace(part, name=f"Stimme {n}") for n, part in enumerate(turned.parts)),
        )
    )
    result = reimport(project, renamed, MAPS)
    assert result.new_players == result.gone_players == ()
    assert {player.id: player.part_id for player in result.project.players} == {
        player.id: player.part_id for player in project.players
    }
    for part in project.score.parts:
        after = next(other for other in result.project.score.parts if other.id == part.id)
        assert after.notes == part.notes
    assert result.project.player(project.players[0].id).parameters.amplitude == 0.9


def test_parts_that_play_the_same_are_known_by_their_names() -> None:
    small = small_project()
    first = small.score.parts[0]
    twin = msgspec.structs.replace(
        first,
        id="3.1.1",
        name="cornet",
        track=3,
        notes=tuple(msgspec.structs.replace(note, id=f"3{note.id[1:]}") for note in first.notes),
    )
    project = project_from_score(msgspec.structs.replace(small.score, parts=(first, twin)), MAPS)
    turned = msgspec.structs.replace(project.score, parts=(twin, first))
    result = reimport(project, from_file(turned), MAPS)
    assert [(part.id, part.name) for part in result.project.score.parts] == [("3.1.1", "cornet"), ("1.1.1", "trumpet")]


def test_a_new_part_gets_a_player_and_players_whose_part_is_gone_can_be_removed() -> None:
    project = with_corrections(small_project(), "2.1.1", [PinFingering("2:1", "1")])
    melody = tuple(Note(f"9:{n}", n * 240, 240, 80 - 3 * n, 90) for n in range(1, 9))
    new = Part("9.1.1", "Trumpet", 9, 0, 9, None, "Flugelhorn", "trumpet_Bb", melody)
    result = reimport(project, from_file(msgspec.structs.replace(project.score, parts=(new,))), MAPS)
    (fresh,) = result.new_players
    assert result.gone_players == ("1.1.1", "2.1.1")
    after = result.project
    assert [player.id for player in after.players] == ["1.1.1", "2.1.1", fresh]
    for player in project.players:
        assert after.part(after.player(player.id)).notes == project.part(player).notes
    assert after.player(fresh).instrument_id == "trumpet_Bb"
    assert after.player(fresh).name == "Trumpet 2"
    assert [note.pitch for note in after.part(after.player(fresh)).notes] == [note.pitch for note in melody]
    assert after.corrections == project.corrections
    assert result.orphans == ()
    # They are the animator's now: the file, read once more, is no reason to ask again.
    again = reimport(after, from_file(msgspec.structs.replace(project.score, parts=(new,))), MAPS)
    assert again.gone_players == ()
    assert again.project is after
    removed = remove_players(after, result.gone_players)
    assert [player.id for player in removed.players] == [fresh]
    assert [part.id for part in removed.score.parts] == [after.player(fresh).part_id]


def test_who_was_sent_away_stays_away() -> None:
    project = remove_players(small_project(), ["2.1.1"])
    result = reimport(project, from_file(small_project().score), MAPS)
    assert [player.id for player in result.project.players] == ["1.1.1"]


def test_what_was_drawn_here_stays_where_there_is_room() -> None:
    project, kept = add_note(small_project(), "1.1.1", 1920, 480, 70, 80)
    project, covered = add_note(project, "1.1.1", 2400, 480, 71, 80)
    project, player = add_player(project, MAPS["trumpet_Bb"], MAPS, "Mine")
    part = project.player(player).part_id
    project, own = add_note(project, part, 960, 480, 72, 80)
    project = with_corrections(project, "1.1.1", [PinFingering(kept, "1")])
    score = small_project().score
    trumpet = [*later(score.parts[0].notes, 0, BAR), Note("x", 2700 + BAR, 500, 60, 80)]
    trombone = later(score.parts[1].notes, 0, BAR)
    result = reimport(project, from_file(with_notes(with_notes(score, 0, trumpet), 1, trombone)), MAPS)
    onsets = {note.id: note.onset_tick for part in result.project.score.parts for note in part.notes}
    assert onsets[kept] == 1920 + BAR
    assert onsets[own] == 960 + BAR
    assert covered not in onsets
    assert result.removed == (covered,)
    assert result.project.player(player).name == "Mine"
    assert result.orphans == ()


def test_title_source_and_tempo() -> None:
    small = small_project()
    project = replace(small, read_timing=timing_of(small.score))
    score = from_file(
        msgspec.structs.replace(project.score, title="other", tempo_map=TempoMap(480, (TempoChange(0, 400_000),)))
    )
    result = reimport(project, score, MAPS, source="/music/new.mid")
    assert result.project.score.title == project.score.title
    assert result.project.source == "/music/new.mid"
    assert result.project.score.tempo_map is score.tempo_map
    # Without a stored version of the file, the original notes show that the tempo was changed by the user.
    assert reimport(small, score, MAPS).project is small


def test_twenty_thousand_notes() -> None:
    long = read(MIDI / "awkward" / "long_14662notes_rossini_overture.mid")
    end = -(-long.score.end_tick // BAR) * BAR
    times = -(-20_000 // sum(len(part.notes) for part in long.score.parts))
    parts = tuple(
        msgspec.structs.replace(
            part,
            notes=tuple(
                msgspec.structs.replace(note, id=f"{note.id}{time:02}", onset_tick=note.onset_tick + time * end)
                for time in range(times)
                for note in part.notes
            ),
        )
        for part in long.score.parts
    )
    project = replace(long, score=msgspec.structs.replace(long.score, parts=parts), read_notes={})
    edited = tuple(
        msgspec.structs.replace(
            part, notes=tuple(later(tuple(n for i, n in enumerate(part.notes) if i % 50), 7 * end // 2, BAR))
        )
        for part in parts
    )
    new = from_file(msgspec.structs.replace(long.score, parts=edited))
    begin = time.process_time()
    result = reimport(project, new, MAPS)
    print(f"{sum(len(part.notes) for part in parts)} notes in {time.process_time() - begin:.2f} s")
    survivors = {note.id for part in edited for note in part.notes}
    kept = {note.id for part in result.project.score.parts for note in part.notes}
    assert survivors <= kept


# Notes changed by the user


def by_hand(project: Project, index: int, change: dict[int, dict[str, int] | None]) -> Project:
    """Notes of a part changed by number (None: deleted) as by the user."""
    part = project.score.parts[index]
    notes = []
    for number, note in enumerate(part.notes):
        fields = change.get(number, {})
        if fields is not None:
            notes.append(msgspec.structs.replace(note, **fields))
    notes.sort(key=lambda note: (note.onset_tick, note.pitch))
    parts = list(project.score.parts)
    parts[index] = msgspec.structs.replace(part, notes=tuple(notes))
    return replace(project, score=msgspec.structs.replace(project.score, parts=tuple(parts)))


def file_with(project: Project, index: int, change: dict[int, dict[str, int] | None], shift: int = 0) -> Score:
    changed = by_hand(project, index, change).score
    parts = tuple(
        msgspec.structs.replace(
            part,
            notes=tuple(msgspec.structs.replace(note, onset_tick=note.onset_tick + shift) for note in part.notes),
        )
        for part in changed.parts
    )
    return from_file(msgspec.structs.replace(changed, parts=parts))


def notes_of(project: Project, index: int = 0) -> dict[str, Note]:
    return {note.id: note for note in project.score.parts[index].notes}


def test_what_a_hand_did_to_notes_stays_where_the_file_did_not_touch_them() -> None:
    project = read(LUTKIN)
    first = project.score.parts[0].notes
    edited = by_hand(
        project,
        0,
        {3: {"onset_tick": first[3].onset_tick + 60}, 7: {"pitch": first[7].pitch + 1}, 11: None, 20: {"velocity": 3}},
    )
    unchanged = reimport(edited, from_file(project.score), MAPS)
    assert unchanged.project is edited
    assert unchanged.conflicts == ()
    assert unchanged.parts[0].by_hand == 4
    # The file brings a bar before everything and changes another note.
    result = reimport(edited, file_with(project, 0, {15: {"pitch": first[15].pitch - 2}}, BAR), MAPS)
    after = notes_of(result.project)
    assert after[first[3].id].onset_tick == first[3].onset_tick + 60 + BAR
    assert after[first[7].id].pitch == first[7].pitch + 1
    assert first[11].id not in after
    assert after[first[20].id].velocity == 3
    assert after[first[15].id].pitch == first[15].pitch - 2
    assert result.conflicts == ()
    assert (result.added, result.removed) == ((), ())
    # Again: the file's previous version is the one read last.
    again = reimport(result.project, file_with(project, 0, {15: {"pitch": first[15].pitch - 2}}, BAR), MAPS)
    assert again.project is result.project


def test_an_edit_of_the_only_note_of_a_line_moves_with_it() -> None:
    """A second player may have only one chord note in a line; no other note reveals that the file moved the line."""
    project = small_project()
    score = with_notes(project.score, 1, [project.score.parts[1].notes[0]])
    only = score.parts[1].notes[0]
    held = {part.id: {note.id: note for note in part.notes} for part in score.parts}
    edited = by_hand(replace(project, score=score, read_notes=held), 1, {0: {"velocity": 9}})
    result = reimport(edited, file_with(replace(project, score=score), 1, {}, BAR), MAPS)
    assert result.conflicts == ()
    assert notes_of(result.project, 1)[only.id] == msgspec.structs.replace(only, onset_tick=BAR, velocity=9)
    # Another pitch is a change.
    changed = file_with(replace(project, score=score), 1, {0: {"pitch": only.pitch + 1}}, BAR)
    assert [conflict.note_id for conflict in reimport(edited, changed, MAPS).conflicts] == [only.id]


def test_where_both_changed_a_note_the_files_version_is_taken_and_reported() -> None:
    project = read(LUTKIN)
    first = project.score.parts[0].notes
    edited = by_hand(
        project,
        0,
        {3: {"pitch": first[3].pitch + 1}, 7: {"velocity": 5}, 11: None, 20: {"onset_tick": first[20].onset_tick + 30}},
    )
    new = file_with(
        project,
        0,
        {
            3: {"pitch": first[3].pitch + 3},
            7: None,
            11: {"velocity": 9},
            20: {"onset_tick": first[20].onset_tick - 30},
        },
    )
    result = reimport(edited, new, MAPS)
    after = notes_of(result.project)
    assert after[first[3].id].pitch == first[3].pitch + 3
    assert first[7].id not in after
    assert after[first[11].id].velocity == 9
    assert after[first[20].id].onset_tick == first[20].onset_tick - 30
    reported = {conflict.note_id: (conflict.by_hand, conflict.file) for conflict in result.conflicts}
    mine = notes_of(edited)
    assert reported == {
        id: (mine.get(id), after.get(id)) for id in (first[3].id, first[7].id, first[11].id, first[20].id)
    }
    assert result.parts[0].by_hand == 0


def test_what_the_file_held_is_kept_in_the_projects_file(tmp_path: Path) -> None:
    project = read(LUTKIN)
    first = project.score.parts[0].notes
    edited = by_hand(project, 0, {3: {"pitch": first[3].pitch + 1}, 11: None})
    path = tmp_path / "piece.suisou"
    save(edited, path)
    loaded = load(path)
    assert loaded == edited
    assert loaded.read_notes == project.read_notes
    # No second copy of every note.
    assert path.read_text(encoding="utf-8").count(f'"{first[5].id}"') == 1
    assert reimport(loaded, from_file(project.score), MAPS).project is loaded


def test_a_new_note_never_takes_the_id_of_one_that_was_erased() -> None:
    project = read(LUTKIN)
    more = list(project.score.parts[0].notes)
    more.append(Note("1:9000", more[-1].end_tick + 960, 240, 70, 80))
    parts = (msgspec.structs.replace(project.score.parts[0], notes=tuple(more)), *project.score.parts[1:])
    longer = from_file(msgspec.structs.replace(project.score, parts=parts))
    grown = reimport(project, longer, MAPS)
    (added,) = grown.added
    erased = by_hand(grown.project, 0, {len(more) - 1: None})
    more.append(Note("1:9001", more[-1].end_tick + 960, 240, 72, 80))
    parts = (msgspec.structs.replace(project.score.parts[0], notes=tuple(more)), *project.score.parts[1:])
    result = reimport(erased, from_file(msgspec.structs.replace(project.score, parts=parts)), MAPS)
    (newer,) = result.added
    assert newer != added
    assert added not in notes_of(result.project)


def test_markers_are_those_of_the_file_and_edits_of_tempo_and_metre_leave_them(tmp_path: Path) -> None:
    project = small_project()
    came = reimport(project, from_file(project.score, markers=(Marker(0, "A"), Marker(BAR, "B"))), MAPS).project
    assert came.score.markers == (Marker(0, "A"), Marker(BAR, "B"))
    edited = set_metre(scale_tempo(set_tempo(came, 480, 90.0), 1.1), BAR, 3, 4)
    assert edited.score.markers == came.score.markers
    save(edited, tmp_path / "piece.suisou")
    assert load(tmp_path / "piece.suisou").score.markers == came.score.markers
    export_midi(edited, tmp_path / "piece.mid", MAPS)
    assert read(tmp_path / "piece.mid").score.markers == came.score.markers
    changed = reimport(edited, from_file(came.score, markers=(Marker(BAR, "C"),)), MAPS).project
    assert changed.score.markers == (Marker(BAR, "C"),)


def test_metres_that_a_file_does_not_state_stay_as_they_were_read_and_edited(tmp_path: Path) -> None:
    """A minuet without a time signature, in a project from before metres were guessed, and in one with an
    edited metre.
    """
    path = tmp_path / "minuet.mid"
    file = mido.MidiFile(MIDI / "ensemble" / "trumpet_duet_bach_minuet.mid")
    for track in file.tracks:
        track[:] = [message for message in track if message.type != "time_signature"]
    file.save(path)
    project = read(path)
    assert [(metre.numerator, metre.denominator) for metre in project.score.metres] == [(3, 4)]
    again = reimported(project, path, MAPS).project
    assert again.score.metres == project.score.metres
    edited = set_metre(project, 0, 3, 8)
    kept = reimported(edited, path, MAPS)
    assert (kept.project.score.metres, kept.replaced) == (edited.score.metres, ())
    save(kept.project, tmp_path / "minuet.suisou")
    assert reimported(load(tmp_path / "minuet.suisou"), path, MAPS).project.score.metres == edited.score.metres
    common = (Metre(0, 4, 4),)
    old = replace(
        with_score(project, msgspec.structs.replace(project.score, metres=common)),
        read_timing=msgspec.structs.replace(timing_of(project.score), metres=common),
    )
    assert reimported(old, path, MAPS).project.score.metres == common


def test_dancers_stay_and_their_corrections_move_with_the_music() -> None:
    project = small_project()
    dancer = Dancer("dancer:1", "Flute", "salsa", "man_adult", StagePosition(0.0, 2.0, 0.0))
    corrections = (PinState(480, 2), ForbidState(0, 960, 1), UseSegment(960, 7))
    project = replace(project, dancers=(dancer,), dance_corrections={"dancer:1": corrections})
    # A bar is put before the piece, and a flute comes in; the file has percussion now.
    parts = tuple(
        msgspec.structs.replace(
            part,
            notes=tuple(msgspec.structs.replace(note, onset_tick=note.onset_tick + BAR) for note in part.notes),
        )
        for part in project.score.parts
    )
    flute = Part("3.1.1", "Flute", 3, 0, 3, 73, "flute", "flute", (Note("3:1", 20_000, 480, 80, 80),))
    hits = (PercussionHit(BAR, 36, 90),)
    found = reimport(project, from_file(project.score, parts=(*parts, flute), percussion=hits), MAPS)
    assert found.project.score.percussion == hits
    assert found.project.dancers == (dancer,)
    assert found.project.dance_corrections["dancer:1"] == (
        PinState(BAR + 480, 2), ForbidState(BAR, BAR + 960, 1), UseSegment(BAR + 960, 7),
    )  # fmt: skip
    assert [player.name for player in found.project.players] == ["trumpet", "trombone", "Flute 2"]
    assert reimport(found.project, found.project.score, MAPS).project is found.project
