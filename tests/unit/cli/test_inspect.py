"""Text output of `suisou inspect`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from app.cli.inspect import inspection
from app.cli.inspect_tables import tables
from app.performance.ensemble import Performance
from app.performance.fact_sources import FACTS
from app.plan.by_hand.corrections import PinFingering
from app.project.edit.corrections import with_corrections
from app.project.edit.marks import set_marks
from app.project.importing import import_project, usual_rows
from app.project.model import Project
from app.score.marks import Mark
from app.score.read import read_contents
from instrument_maps.load import bundled_maps
from tests.unit.score.musicxml.documents import articulation, document, dynamic, note, slur

EXAMPLE = Path("resources/examples/quartet.mid")


def opened(path: Path) -> Project:
    contents = read_contents(path)
    return import_project(contents, usual_rows(contents, bundled_maps()), bundled_maps(), source=str(path))


def found(*labels: str) -> dict[str, Any]:
    sources = dict.fromkeys(FACTS, "guess")
    notes = [{"pitch": 60 + index, "fingering_keys": label, "sources": sources} for index, label in enumerate(labels)]
    # fmt: off
    player = {
        "name": "One",
        "instrument": "thing",
        "character": "woman_adult", "character_title": "Woman", "outfit": None, "outfit_colours": {},
        "transposition_semitones": 0,
        "notes": notes,
        "breaths": [],
        "cues": [],
    }
    # fmt: on
    return {
        "duration_s": 1.0,
        "players": [player],
        "unplayed": [],
        "dancers": [],
        "left_out": [],
        "warnings": [],
        "ignored_problems": 0,
        "ticks_per_beat": 480,
        "tempo": [{"bpm": 120.0}],
    }  # fmt: skip


def test_valves_stand_side_by_side() -> None:
    assert any(line.endswith("0 13 T2") for line in tables("x.mid", found("0", "13", "T2")))


def test_fingerings_of_several_keys_are_distinguished() -> None:
    lines = tables("x.mid", found("open", "thumb hole + L1", "thumb hole + L1·2"))
    assert any(line.endswith("open, thumb hole + L1") for line in lines)


TECHNIQUE = "<technical>{}</technical>"


def test_each_fact_says_where_it_is_from(tmp_path: Path) -> None:
    first = (
        note("D4", 4, notations=slur("start"))
        + dynamic("f")
        + note("E4", 4, notations=slur("stop") + articulation("breath-mark"))
        + note("F4", 4, notations=TECHNIQUE.format("<fingering>1-3</fingering><triple-tongue/>"))
        + note("A4", 4, notations=TECHNIQUE.format("<fingering>2</fingering>"))
    )
    path = tmp_path / "piece.musicxml"
    path.write_text(document(first), "utf-8")
    project = opened(path)
    [player] = project.players
    pinned = PinFingering("1:4", "13")
    by_hand = [Mark("staccato", "1:3"), Mark("fingering", "1:1", text="3")]
    project = set_marks(with_corrections(project, player.id, [pinned]), player.id, by_hand)
    found = inspection(Performance(project), contacts=False)
    rows = {row["id"]: row["sources"] for row in found["players"][0]["notes"]}
    assert {fact: [rows[f"1:{number}"][fact] for number in (1, 2, 3, 4)] for fact in FACTS} == {
        # Before the first mark a score has no dynamic.
        "dynamic": ["guess", "score", "score", "score"],
        "slur": ["score"] * 4,
        "articulation": ["score", "score", "hand", "score"],
        "tonguing": ["guess", "score", "score", "guess"],
        "fingering": ["hand", "guess", "score", "hand"],
        "mute": ["score"] * 4,
    }
    assert [row["dynamic"] for row in found["players"][0]["notes"]] == ["mf", "f", "f", "f"]
    assert [breath["source"] for breath in found["players"][0]["breaths"] if breath["kind"] == "breath"] == [
        "guess",
        "score",
    ]
    marks = {(mark["kind"], mark.get("note")): mark["source"] for mark in found["players"][0]["marks"]}
    assert (marks["slur", "1:1"], marks["dynamic", None], marks["staccato", "1:3"]) == ("score", "score", "hand")
    assert any("score 3, guess 1" in line for line in tables("x.musicxml", found))


def test_of_midi_nothing_is_from_the_score() -> None:
    found = inspection(Performance(opened(EXAMPLE)), contacts=False)
    said = {source for player in found["players"] for row in player["notes"] for source in row["sources"].values()}
    assert said == {"sound", "guess"}
    assert {breath["source"] for player in found["players"] for breath in player["breaths"]} == {"guess"}
    assert found["tempo_source"] == "sound"
