"""Single notes off their beats: clear ones are found and written into the piece."""

from __future__ import annotations

from dataclasses import replace

import msgspec
import numpy as np

from app.audio.mix import mixdown
from app.audio.note_onsets import note_onsets
from app.audio.track import RATE_HZ
from app.project.edit.note_times import shift_onsets
from app.project.model import Project
from tests.unit.audio.pieces import melody, piece, quartet
from tests.unit.audio.test_offset import as_samples

SPREAD_S = 0.025


def alone(project: Project) -> Project:
    """The first player."""
    first = project.players[0]
    parts = tuple(part for part in project.score.parts if part.id == first.part_id)
    return replace(project, players=(first,), score=msgspec.structs.replace(project.score, parts=parts))


def test_clear_notes_are_found_beside_their_beats() -> None:
    project = alone(quartet())
    rng = np.random.default_rng(4)
    notes = project.score.parts[0].notes
    true = {note.id: float(np.clip(SPREAD_S * rng.normal(), -0.06, 0.06)) for note in notes}
    played = shift_onsets(project, true)
    clock = project.score.tempo_map
    before = {note.id: clock.seconds(float(note.onset_tick)) for note in notes}
    true = {note.id: clock.seconds(float(note.onset_tick)) - before[note.id] for note in played.score.parts[0].notes}
    samples = as_samples(mixdown(played, -1.0, 60.0))
    found = note_onsets(samples, RATE_HZ, project.score, -1.0)
    clear = [note_id for note_id in found if before[note_id] < 58.0]
    errors_s = np.abs([true[note_id] - found[note_id] for note_id in clear])
    apart_s = np.abs([true[note_id] for note_id in clear])
    print(f"{len(clear)} clear, {1000 * np.median(apart_s):.1f} ms before, {1000 * np.median(errors_s):.1f} ms after")
    assert len(clear) > 30
    assert np.median(errors_s) < 0.5 * np.median(apart_s)
    assert np.percentile(errors_s, 90) < np.percentile(apart_s, 90)


def test_noise_moves_nothing() -> None:
    project = alone(quartet())
    noise = np.random.default_rng(0).normal(scale=0.1, size=(60 * RATE_HZ, 2))
    assert len(note_onsets(as_samples(noise), RATE_HZ, project.score, 0.0)) < 0.1 * len(project.score.parts[0].notes)


def test_moved_notes_keep_their_ids_ends_and_neighbours() -> None:
    project = piece(melody((0, 480, 60), (480, 480, 62), (960, 240, 64), (1440, 480, 65)))
    first, second, third, fourth = project.score.parts[0].notes
    s_per_tick = project.score.tempo_map.seconds(1.0)
    after = shift_onsets(project, {first.id: -1.0, second.id: 20 * s_per_tick, fourth.id: -300 * s_per_tick})
    notes = after.score.parts[0].notes
    assert [note.id for note in notes] == [note.id for note in (first, second, third, fourth)]
    assert [(note.onset_tick, note.end_tick) for note in notes] == [(0, 500), (500, 960), (960, 1140), (1140, 1920)]
    far = shift_onsets(project, {second.id: -9.0, third.id: 9.0}).score.parts[0].notes
    onsets = [note.onset_tick for note in far]
    assert onsets == sorted(onsets)
    assert all(note.duration_tick > 0 for note in far)
    assert shift_onsets(project, {"none": 1.0}) is project


def test_what_is_not_in_the_recording_stays() -> None:
    project = alone(quartet())
    assert not note_onsets(np.zeros((RATE_HZ, 2), np.int16), RATE_HZ, project.score, 0.0)
