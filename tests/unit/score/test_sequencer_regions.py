"""Consecutive tracks are regions of one player's track."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path

import pytest

from app.project.importing import import_project, separated, usual_rows
from app.score.model import Score
from app.score.read import read_contents
from instrument_maps.load import bundled_maps
from tests.unit.score.midi_bytes import END, chunk, header, ids, meta, note, score_of

PITCHES = (60, 62, 64, 65)


def region(bar: int, name: str = "Trumpet", channel: int = 0, program: int = 56, more: bytes = b"") -> bytes:
    """Four quarters of 96 ticks in a bar of their own; ``more`` precedes them."""
    bars = meta(1, b"", 127) * 3 * bar + meta(1, b"", 3) * bar
    played = b"".join(
        note(pitch, ticks=90, channel=channel, delta=6 if index else 0) for index, pitch in enumerate(PITCHES)
    )
    return meta(3, name.encode()) + bytes([0, 0xC0 | channel, program]) + bars + more + played + END


def tracks(*regions: bytes) -> bytes:
    return header(1, len(regions)) + b"".join(chunk(b"MTrk", one) for one in regions)


def players(score: Score) -> list[int]:
    return [len(part.notes) for part in score.parts]


@pytest.mark.parametrize(
    "names", [("Trumpet",) * 3, ("Trumpet", "Trumpet.1", "Trumpet.2"), ("Trumpet", "trumpet copy", "Trumpet #02")]
)
@pytest.mark.parametrize("order", [(0, 1, 2), (2, 0, 1)])
def test_regions_of_one_track_are_one_player(names: Sequence[str], order: Sequence[int]) -> None:
    score = score_of(tracks(*(region(bar, name) for bar, name in zip(order, names, strict=True))))
    (part,) = score.parts
    assert [note.onset_tick for note in part.notes] == [
        384 * bar + 96 * place for bar in range(3) for place in range(4)
    ]
    assert len(part.note_ids) == 12
    assert ids(score) == ["score.regions"]


@pytest.mark.parametrize(
    "other",
    [
        region(1, "Trumpet 2"),
        region(1, channel=1),
        region(1, program=59),
        # Together, and in part.
        region(0),
        region(0, more=meta(1, b"", 96)),
    ],
)
def test_tracks_of_another_name_channel_or_program_or_that_overlap_are_other_players(other: bytes) -> None:
    score = score_of(tracks(region(0), other))
    assert players(score) == [4, 4]
    assert "score.regions" not in ids(score)


def test_players_who_alternate_are_several() -> None:
    gap = meta(1, b"", 127) * 3 + meta(1, b"", 3)
    one, other = (region(bar)[: -len(END)] + gap + region(0)[len(meta(3, b"Trumpet")) + 3 :] for bar in (0, 1))
    assert players(score_of(tracks(one, other))) == [8, 8]


def test_unnamed_tracks_stay_apart() -> None:
    assert players(score_of(tracks(region(0, ""), region(1, "")))) == [4, 4]
    assert players(score_of(tracks(region(0, "Track 1"), region(1, "Track 1")))) == [4, 4]


def test_each_region_has_its_own_curves() -> None:
    swell = [bytes([0, 0xB0, 11, level, 0, 0xE0, 0, 0x40 + level]) for level in (20, 40)]
    (part,) = score_of(tracks(region(0, more=swell[0]), region(1, more=swell[1]), region(2))).parts
    curves = {curve.kind: dict(zip(curve.ticks, curve.values, strict=True)) for curve in part.curves}
    assert {tick: round(127 * value) for tick, value in curves["expression"].items()} == {0: 20, 384: 40}
    assert {tick: round(64 * value) for tick, value in curves["pitch_bend"].items()} == {0: 20, 384: 40, 762: 0}


def test_the_user_can_take_regions_apart() -> None:
    maps = bundled_maps()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "regions.mid"
        path.write_bytes(tracks(region(0), region(0, "Oboe", 1, 68), region(1)))
        contents = read_contents(path)
    rows = usual_rows(contents, maps)
    assert [row.assignment.channels for row in rows] == [(0, 2), (1,)]
    assert len(import_project(contents, rows, maps).players) == 2
    assert len(import_project(contents, separated(rows, 0), maps).players) == 3
