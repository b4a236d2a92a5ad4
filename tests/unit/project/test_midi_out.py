"""The piece as a MIDI file with its players' names."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from app.errors import FileError, Message
from app.project.edit.players import add_player, rename
from app.project.midi_out import export_midi
from app.project.model import map_choices, project_from_score
from app.score.model import UnplayedPart
from app.score.read import read_midi
from instrument_maps.load import bundled_maps
from tests.unit.score.midi_bytes import END, chunk, header, meta, note


def test_players_names_and_instruments_and_no_more_than_is_there(tmp_path: Path) -> None:
    maps = bundled_maps()
    source, target = tmp_path / "source.mid", tmp_path / "target.mid"
    source.write_bytes(header() + chunk(b"MTrk", meta(3, b"Trumpet") + note(60) + END))
    score = read_midi(source, maps=map_choices(maps.values()))
    project = replace(project_from_score(score, maps), source=str(source))
    project = rename(project, project.players[0].id, "アンナ")
    project, _ = add_player(project, maps["tuba_CC"], maps, "No notes yet")
    assert export_midi(project, target, maps) == ()
    [read] = read_midi(target, maps=map_choices(maps.values())).parts
    assert (read.name, read.instrument, read.map_id) == ("アンナ", "trumpet", score.parts[0].map_id)
    assert export_midi(project, source, maps) == (), "everything in it is in the project"


def test_a_source_that_holds_more_is_not_replaced(tmp_path: Path) -> None:
    maps = bundled_maps()
    source = tmp_path / "source.mid"
    source.write_bytes(header() + chunk(b"MTrk", meta(3, b"Trumpet") + note(60) + END))
    score = read_midi(source, maps=map_choices(maps.values()))
    score = msgspec.structs.replace(score, unplayed=(UnplayedPart("Violin", Message("score.left_out"), 3),))
    project = replace(project_from_score(score, maps), source=str(source))
    held = source.read_bytes()
    with pytest.raises(FileError, match=r"midi\.onto_source"):
        export_midi(project, source, maps)
    assert source.read_bytes() == held
