"""Fingerings set by users in older versions are played unchanged, although tables have changed."""

from __future__ import annotations

import json
from pathlib import Path

from app.performance.ensemble import Performance
from app.project.storage import load
from instrument_maps.load import bundled_maps

SAMPLE = Path(__file__).parents[2] / "data" / "projects" / "version_5.suisou"
RELEASED = Path(__file__).parents[2] / "data" / "fingerings" / "released.txt"
"""Every label of a released version: map, written pitch, labels separated by ``|``. Lines are only added."""


def test_a_fingering_of_an_old_project_is_played_though_no_one_would_choose_it(tmp_path: Path) -> None:
    raw = json.loads(SAMPLE.read_bytes())
    raw["players"][0]["instrument_id"] = "clarinet_Bb"
    for note in raw["score"]["parts"][0]["notes"]:
        note["pitch"] = 81
    raw["corrections"]["1.1.1"][0]["label"] = "R S3 S4 T"
    path = tmp_path / "old.suisou"
    path.write_text(json.dumps(raw), encoding="utf-8")
    project = load(path)
    plan = Performance(project).plan(project.players[0])
    assert [(event.label, event.corrected) for event in plan.fingerings] == [
        ("R S3 S4 T", True), *[("L1 R T", False)] * 3
    ]  # fmt: skip
    assert "correction.no_such_fingering" not in {problem.message.id for problem in plan.problems}


def test_no_label_that_was_ever_released_is_missing() -> None:
    maps = bundled_maps()
    now = {(one.id, item.written_pitch, item.label) for one in maps.values() for item in one.fingerings}
    for line in RELEASED.read_text(encoding="utf-8").splitlines():
        map_id, pitch, labels = line.split(" ", 2)
        missing = {label for label in labels.split("|") if (map_id, int(pitch), label) not in now}
        assert not missing, f"{map_id} {pitch}: mark removed rows obsolete"
