"""Instruments chosen at the import of a MIDI file are kept when the file is read again with changed tracks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import mido
import msgspec
import pytest

from app.plan.by_hand.corrections import AddGesture, Correction, PinFingering, SetBreath, SetCue
from app.project.edit.corrections import with_corrections
from app.project.edit.dynamics import set_dynamics
from app.project.edit.players import remove_players, set_parameters
from app.project.edit.tempo import set_metre, set_tempo
from app.project.importing import ImportRow, import_project, merged, usual_rows
from app.project.model import Project
from app.project.reimport import Reimport, reimported
from app.project.storage import load, save
from app.score.assignments import PartAssignment
from app.score.model import ControllerCurve
from app.score.read import read_contents
from instrument_maps.load import bundled_maps

MAPS = bundled_maps()
QUINTET = ("trumpet_Bb", "trumpet_Bb", "horn_double_F_Bb", "trombone_tenor_F_attachment", "tuba_F")
NAMES = ("Voice A", "Voice B", "Lead", "Low", "Bottom")
BAR = 4 * 480


def tracks(names: Sequence[str] = NAMES, shift_ticks: int = 0) -> list[mido.MidiTrack]:
    """Five different melodies in tracks without programs."""
    result = []
    for number, (name, lowest) in enumerate(zip(names, (74, 69, 60, 52, 40), strict=True)):
        track = mido.MidiTrack()
        if name:
            track.append(mido.MetaMessage("track_name", name=name))
        for place in range(24):
            pitch = lowest + (0, 2, 4, 5, 7, 5, 4, 2)[(place * (number + 1) + number) % 8]
            track.append(mido.Message("note_on", note=pitch, velocity=80, time=0 if place else shift_ticks))
            track.append(mido.Message("note_off", note=pitch, time=480 if (place + number) % 3 else 240))
        result.append(track)
    return result


def written(path: Path, content: Sequence[mido.MidiTrack]) -> Path:
    mido.MidiFile(type=1, ticks_per_beat=480, tracks=list(content)).save(path)
    return path


def quintet(path: Path) -> Project:
    """The file imported with an instrument chosen in each row."""
    contents = read_contents(path)
    rows = [ImportRow(PartAssignment((place,), map_id)) for place, map_id in enumerate(QUINTET)]
    return import_project(contents, rows, MAPS, str(path))


def assert_nothing_lost(before: Project, outcome: Reimport) -> None:
    after = outcome.project
    assert (outcome.new_players, outcome.gone_players, outcome.orphans) == ((), (), ())
    assert after.players == before.players
    assert after.corrections.keys() == before.corrections.keys()
    for player in before.players:
        former, now = before.part(player), after.part(after.player(player.id))
        assert [(note.id, note.pitch, note.duration_tick) for note in former.notes] == [
            (note.id, note.pitch, note.duration_tick) for note in now.notes
        ]


@pytest.fixture(params=["kept", "an older program's"])
def project(request: pytest.FixtureRequest, tmp_path: Path) -> Project:
    """A quintet with corrections, whose decisions at its import may be missing."""
    result = quintet(written(tmp_path / "quintet.mid", tracks()))
    for player in result.players:
        note = result.part(player).notes[4]
        pinned: tuple[Correction, ...] = (SetBreath(note.id, -60, -10), SetCue(note.id, 1.0))
        result = with_corrections(result, player.id, pinned)
    result = set_parameters(result, [result.players[2].id], amplitude=0.9)
    if request.param != "kept":
        result = replace(result, imported=None, read_timing=None)
    return result


def test_the_same_file_is_no_change(project: Project) -> None:
    assert len(project.players) == 5
    outcome = reimported(project, Path(project.source), MAPS)
    assert outcome.project is project


@pytest.mark.parametrize("order", [(4, 3, 2, 1, 0), (1, 0, 3, 2, 4), (2, 4, 0, 1, 3)])
@pytest.mark.parametrize("names", [NAMES, ("", "", "", "", ""), ("Piano", "Drums", "x", "Violin", "Voice A")])
@pytest.mark.parametrize("bars", [0, 2])
def test_a_shifted_reordered_and_renamed_file_costs_nothing(
    project: Project, order: Sequence[int], names: Sequence[str], bars: int, tmp_path: Path
) -> None:
    content = tracks(names, bars * BAR)
    path = written(tmp_path / "newer.mid", [content[place] for place in order])
    outcome = reimported(project, path, MAPS)
    assert_nothing_lost(project, outcome)
    for player in project.players:
        former, now = project.part(player).notes, outcome.project.part(player).notes
        assert [note.onset_tick + bars * BAR for note in former] == [note.onset_tick for note in now]
    # The file reports nothing new once it was imported.
    assert reimported(outcome.project, path, MAPS).project is outcome.project


def test_a_part_that_is_gone_is_offered_for_removal_and_one_that_came_gets_a_player(
    project: Project, tmp_path: Path
) -> None:
    content = tracks()
    flute = mido.MidiTrack([mido.MetaMessage("track_name", name="Flute")])
    for place in range(12):
        flute.append(mido.Message("note_on", note=72 + 5 * place % 12, velocity=80, time=0))
        flute.append(mido.Message("note_off", note=72 + 5 * place % 12, time=240))
    path = written(tmp_path / "newer.mid", [*content[:3], content[4], flute])
    outcome = reimported(project, path, MAPS)
    trombone = project.players[3]
    assert outcome.gone_players == (trombone.id,)
    (flutist,) = outcome.new_players
    after = outcome.project
    assert after.player(flutist).instrument_id == "flute"
    assert [player.id for player in after.players] == [*(player.id for player in project.players), flutist]
    assert after.part(after.player(trombone.id)).notes == project.part(trombone).notes
    assert after.corrections == project.corrections
    assert reimported(after, path, MAPS).project is after
    # The track comes back: its player has it again.
    again = reimported(after, Path(project.source), MAPS)
    assert again.new_players == ()
    assert again.gone_players == (flutist,)
    removed = remove_players(again.project, again.gone_players)
    assert {player.id for player in removed.players} == {player.id for player in project.players}
    assert removed.corrections == project.corrections
    for player in project.players:
        assert removed.part(removed.player(player.id)).notes == project.part(player).notes


@pytest.mark.parametrize("program", [None, 0])
def test_a_part_that_came_gets_a_player_though_its_name_tells_no_instrument(
    project: Project, program: int | None, tmp_path: Path
) -> None:
    melody = []
    for place in range(24):
        pitch = 62 + place * place % 13
        melody.append(mido.Message("note_on", note=pitch, velocity=80, time=0))
        melody.append(mido.Message("note_off", note=pitch, time=240))
    chosen = [] if program is None else [mido.Message("program_change", program=program)]
    other, strings = (
        mido.MidiTrack([mido.MetaMessage("track_name", name=name), *chosen, *melody])
        for name in ("Melody F", "Violins")
    )
    path = written(tmp_path / "newer.mid", [*tracks(), strings, other])
    outcome = reimported(project, path, MAPS)
    (added,) = outcome.new_players
    after = outcome.project
    assert after.player(added).name == "Melody F"
    assert len(after.part(after.player(added)).notes) == 24
    assert [part.name for part in after.score.unplayed] == ["Violins"]
    assert reimported(after, path, MAPS).project is after


def test_merged_and_left_out_tracks_stay_so(tmp_path: Path) -> None:
    path = written(tmp_path / "quintet.mid", tracks())
    contents = read_contents(path)
    rows = merged([ImportRow(PartAssignment((place,), map_id)) for place, map_id in enumerate(QUINTET)], (1, 2))
    rows = tuple(
        msgspec.structs.replace(row, requested=row.assignment.channels != (4,), character_id="woman_adult")
        for row in rows
    )
    project = import_project(contents, rows, MAPS, str(path))
    project = with_corrections(project, project.players[1].id, [PinFingering(project.score.parts[1].notes[3].id, "1")])
    for known in (project, replace(project, imported=None, read_timing=None)):
        assert reimported(known, path, MAPS).project is known
        content = tracks(("a", "b", "c", "d", "e"), BAR)
        newer = written(tmp_path / "newer.mid", [content[place] for place in (3, 2, 1, 0, 4)])
        outcome = reimported(known, newer, MAPS)
        assert_nothing_lost(project, outcome)
        assert len(outcome.project.score.parts) == len(project.score.parts)


def test_written_pitches_a_split_and_a_name_are_read_so_again(tmp_path: Path) -> None:
    chords = mido.MidiTrack([mido.MetaMessage("track_name", name="Pad")])
    for place in range(16):
        chord = (60 + place % 5, 67 + place % 4)
        for pitch in chord:
            chords.append(mido.Message("note_on", note=pitch, velocity=80))
        chords.append(mido.Message("note_off", note=chord[0], time=240 if place % 3 else 480))
        chords.append(mido.Message("note_off", note=chord[1]))
    path = written(tmp_path / "pad.mid", [chords, tracks()[0]])
    contents = read_contents(path)
    for split in ("sustained", "every", "never"):
        row = ImportRow(PartAssignment((0,), "trumpet_Bb", "Anna", split, written=True))
        project = import_project(contents, [row, ImportRow(PartAssignment((1,)), requested=False)], MAPS, str(path))
        assert project.score.parts[0].transposed_semitones == -2
        for known in (project, replace(project, imported=None, read_timing=None)):
            assert reimported(known, path, MAPS).project is known
        save(project, tmp_path / "kept.suisou")
        kept = load(tmp_path / "kept.suisou")
        assert kept == project
        assert reimported(kept, path, MAPS).project is kept


def test_tempo_metre_and_dynamics_edited_here_stay_while_the_file_has_its_own(tmp_path: Path) -> None:
    path = written(tmp_path / "quintet.mid", tracks())
    project = quintet(path)
    edited = set_tempo(project, BAR, 90.0)
    edited = set_metre(edited, 2 * BAR, 3, 4)
    drawn = ControllerCurve("expression", (480, 960), (0.25, 0.75))
    edited = set_dynamics(edited, {edited.score.parts[0].id: drawn})
    assert edited.score.parts[0] != project.score.parts[0]
    assert reimported(edited, path, MAPS).project is edited
    shifted = written(tmp_path / "newer.mid", tracks(shift_ticks=BAR))
    outcome = reimported(edited, shifted, MAPS)
    after = outcome.project.score
    assert outcome.replaced == ()
    assert [change.tick for change in after.tempo_map.changes] == [
        change.tick + BAR * (change.tick > 0) for change in edited.score.tempo_map.changes
    ]
    assert [(metre.tick, metre.numerator) for metre in after.metres] == [(0, 4), (3 * BAR, 3)]
    # If the file also changed its tempo, the new one is used and reported.
    content = tracks()
    content[0].insert(0, mido.MetaMessage("set_tempo", tempo=400_000))
    outcome = reimported(edited, written(tmp_path / "faster.mid", content), MAPS)
    assert outcome.replaced == ("tempo",)
    assert outcome.project.score.tempo_map.changes[0].microseconds_per_quarter == 400_000
    assert outcome.project.score.metres == edited.score.metres


def test_usual_decisions_are_kept_too(tmp_path: Path) -> None:
    """A gesture at a tick and one player of each row with default choices, after the file's name changed
    silent tracks.
    """
    path = written(tmp_path / "brass quintet.mid", tracks(("", "", "", "", "")))
    contents = read_contents(path)
    project = import_project(contents, usual_rows(contents, MAPS), MAPS, str(path))
    assert len(project.players) == 5
    project = with_corrections(project, project.players[0].id, [AddGesture("mine", "sway", BAR, 2 * BAR, 0.5)])
    assert reimported(project, path, MAPS).project is project
    renamed = tmp_path / "final_v2.mid"
    renamed.write_bytes(path.read_bytes())
    outcome = reimported(project, renamed, MAPS)
    assert outcome.project == replace(project, source=str(renamed))


CASES = Path(__file__, "../../../data/import_cases").resolve()


@pytest.mark.parametrize("kept", [True, False], ids=["kept", "an older program's"])
@pytest.mark.parametrize(
    ("stem", "apart", "maps"),
    [
        ("09", [(0, 0), (0, 1)], ["trumpet_Bb", "trumpet_Bb"]),
        ("10", [], ["sax_alto_Eb", "sax_alto_Eb", "sax_alto_Eb", "baritone_Bb"]),
        ("12", [], ["english_horn"]),
        ("14", [], ["flute", "oboe", "trumpet_Bb", "sax_tenor_Bb", "sax_baritone_Eb"]),
        ("25", [], ["clarinet_Bb"]),
        ("27", [], ["tuba_BBb"]),
        ("28", [], ["horn_double_F_Bb"]),
    ],
)
def test_a_project_of_an_earlier_version_keeps_its_players(
    stem: str, apart: list[tuple[int, int]], maps: list[str], kept: bool
) -> None:
    """Earlier versions chose other players by default; the test chooses them explicitly and removes the choice from the
    stored project.
    """
    (path,) = CASES.glob(f"{stem}_*.mid")
    contents = read_contents(path, apart=apart)
    rows = [ImportRow(PartAssignment((place,), map_id, solos=False)) for place, map_id in enumerate(maps)]
    project = import_project(contents, rows, MAPS, str(path))
    assert project.imported is not None
    older = tuple(
        msgspec.structs.replace(
            row, map_id=None, tracks=tuple(msgspec.structs.replace(mark, reported=()) for mark in row.tracks)
        )
        for row in project.imported.rows
    )
    decisions = msgspec.structs.replace(project.imported, rows=older) if kept else None
    project = replace(project, imported=decisions)
    outcome = reimported(project, path, MAPS)
    assert_nothing_lost(project, outcome)
    assert [part.map_id for part in outcome.project.score.parts] == [part.map_id for part in project.score.parts]
    again = reimported(outcome.project, path, MAPS)
    assert [part.map_id for part in again.project.score.parts] == [part.map_id for part in project.score.parts]


def test_words_about_players_are_followed_again(tmp_path: Path) -> None:
    (path,) = CASES.glob("28_*.mid")
    contents = read_contents(path)
    project = import_project(contents, usual_rows(contents, MAPS), MAPS, str(path))
    first, second = project.score.parts
    assert len(second.notes) < len(first.notes)
    save(project, tmp_path / "horns.suisou")
    assert_nothing_lost(project, reimported(load(tmp_path / "horns.suisou"), path, MAPS))
