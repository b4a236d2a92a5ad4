"""A score that is read again: notes are recognised, corrections stay, and marks are updated."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from app.performance.ensemble import Performance
from app.plan.by_hand.corrections import PinFingering
from app.project.edit.marks import player_marks, set_marks
from app.project.importing import import_project, usual_rows
from app.project.midi_out import export_midi
from app.project.model import Project
from app.project.reimport import reimported
from app.project.storage import load, save
from app.score.marks import Mark
from app.score.read import read_contents
from instrument_maps.load import bundled_maps
from tests.unit.score.musicxml.documents import articulation, document, note, slur

MAPS = bundled_maps()
FIRST = "".join(note(name, 4) for name in ("C5", "D5", "E5", "F5"))
SECOND = "".join(note(name, 4) for name in ("G5", "F5", "D5", "B4"))


@pytest.fixture
def path(tmp_path: Path) -> Path:
    path = tmp_path / "piece.musicxml"
    path.write_text(document(FIRST, SECOND), encoding="utf-8")
    return path


def imported(path: Path) -> Project:
    contents = read_contents(path)
    return import_project(contents, usual_rows(contents, MAPS), MAPS, str(path))


def test_an_unchanged_score_changes_nothing(path: Path) -> None:
    project = imported(path)
    assert reimported(project, path, MAPS).project is project
    kept = path.with_suffix(".suisou")
    save(project, kept)
    assert load(kept).score == project.score


def test_a_bar_and_marks_come_in_and_what_was_done_by_hand_stays(path: Path) -> None:
    project = imported(path)
    (player,) = project.players
    pinned = project.score.parts[0].notes[4]
    project = replace(project, corrections={player.id: (PinFingering(pinned.id, "1·3"),)})
    marked = (
        note("G5", 4, notations=slur("start"))
        + note("F5", 4, notations=slur("stop") + articulation("breath-mark"))
        + note("D5", 4)
        + note("B4", 4)
    )
    path.write_text(document(note("A4", 16), FIRST, marked), encoding="utf-8")
    again = reimported(project, path, MAPS)
    (part,) = again.project.score.parts
    known = {note.id: note for note in part.notes}
    assert known[pinned.id].onset_tick == pinned.onset_tick + 4 * 480
    assert again.project.corrections == project.corrections
    assert (len(again.added), again.removed) == (1, ())
    following = next(note.id for note in part.notes if note.onset_tick == known[pinned.id].end_tick)
    assert set(part.marks) == {Mark("slur", pinned.id, following), Mark("breath", following)}


def test_marks_by_hand_stay_when_the_score_of_a_midi_piece_comes(path: Path, tmp_path: Path) -> None:
    """A slur, a breath mark and a dynamic were added to the MIDI; the score has other marks, and one more bar at the
    beginning.
    """
    played = imported(path)
    midi = tmp_path / "piece.mid"
    export_midi(played, midi, MAPS)
    project = imported(midi)
    (player,) = project.players
    (part,) = project.score.parts
    assert part.source == "sound"
    ids = [note.id for note in part.notes]
    breath, piano = Mark("breath", ids[5]), Mark("dynamic", tick=part.notes[4].onset_tick, text="p")
    slur_by_hand = Mark("slur", ids[4], ids[7])
    project = set_marks(project, player.id, [slur_by_hand, breath, piano])
    marked = note("C5", 4, notations=articulation("staccato")) + FIRST[len(note("C5", 4)) :]
    path.write_text(document(note("A4", 16), marked, SECOND), encoding="utf-8")
    again = reimported(project, path, MAPS)
    assert not again.orphans
    (part,) = again.project.score.parts
    onsets = {note.id: note.onset_tick for note in part.notes}
    assert part.source == "score"
    moved = Mark("dynamic", tick=onsets[ids[4]], text="p")
    assert player_marks(again.project, player.id) == {
        Mark("staccato", ids[0]): "score", slur_by_hand: "hand", breath: "hand", moved: "hand"
    }  # fmt: skip
    assert onsets[ids[4]] == 8 * again.project.score.ticks_per_quarter
    breaths = Performance(again.project).plan(again.project.players[0]).breaths
    assert f"breath:{ids[6]}" in {event.id for event in breaths}
