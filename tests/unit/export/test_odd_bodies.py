"""Unusual bodies are exported and measured: reachable contacts are within the bounds of adults, unreachable ones are
reported and counted separately.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import mido
import msgspec

from app.cli import main
from app.contacts.bounds import Spread
from app.export.measure import PlayerMeasures
from app.export.report import PlaceReport, PlayerReport, failures
from instrument_maps.load import bundled_maps
from tests.support.bodies import playing


def exported(folder: Path, instrument_id: str, character_id: str) -> dict[str, Any]:
    """Report on a short study played by a body."""
    limits = bundled_maps()[instrument_id].range
    track = mido.MidiTrack([mido.MetaMessage("set_tempo", tempo=500_000), mido.MetaMessage("track_name", name="x")])
    wait = 1920
    for pitch in range(limits.easy_low, limits.easy_low + 14):
        track.append(mido.Message("note_on", note=pitch, velocity=80, time=wait))
        track.append(mido.Message("note_off", note=pitch, velocity=0, time=240))
        wait = 0
    mido.MidiFile(ticks_per_beat=480, tracks=[track]).save(folder / "x.mid")
    settings = ("--assign", f"x={instrument_id}", "--set", f"*.character={character_id}")
    with playing():
        main(["export", str(folder / "x.mid"), "--to", str(folder / "out"), "--fps", "24", *settings])
    report: dict[str, Any] = msgspec.json.decode((folder / "out" / "report.json").read_bytes())
    return report


def off(measures: dict[str, Any]) -> list[str]:
    return [name for name, spread in measures["contacts"].items() if spread["max_mm"] > spread["bound_mm"]]


def test_a_child_plays_within_the_bounds_of_grown_ups(tmp_path: Path) -> None:
    report = exported(tmp_path, "tuba_F", "child")
    (player,) = report["players"]
    measures = player["measures"]
    assert 0.6 < player["size"] < 0.8
    assert player["missed"] == {}
    assert any(f"{round(100 * player['size'])} %" in warning for warning in report["warnings"])
    assert off(measures) == []
    assert measures["lips"]["max_mm"] < 0.1
    assert max(spread["max_mm"] for spread in measures["feet"].values()) < 1.0
    assert measures["penetration"]["max_mm"] <= 3.0
    assert all(control["right"] == control["judged"] for control in measures["controls"].values())


def test_a_mitten_plays_with_what_it_has(tmp_path: Path) -> None:
    report = exported(tmp_path, "trumpet_Bb", "mitten")
    (player,) = report["players"]
    measures = player["measures"]
    assert player["size"] == 1.0
    assert measures["contacts"] == {}
    assert measures["guides"]
    assert sum("hand do not bend" in warning for warning in report["warnings"]) == 2
    assert measures["lips"]["max_mm"] < 0.1
    # Valves go down by themselves.
    assert all(control["right"] == control["judged"] > 0 for control in measures["controls"].values())


def test_a_face_that_does_not_move_breathes_with_the_torso(tmp_path: Path) -> None:
    report = exported(tmp_path, "trumpet_Bb", "still_face")
    (player,) = report["players"]
    breaths = player["measures"]["breaths"]
    assert breaths["planned"] > 0
    assert breaths["jaw_open"] == 0
    assert breaths["shown"] == breaths["planned"]
    assert any("no morph opens the mouth" in warning for warning in report["warnings"])


def test_what_a_hold_misses_is_reported_and_no_more_than_that_is_forgiven() -> None:
    def judged(max_mm: float, missed_mm: float) -> tuple[str, ...]:
        spread = Spread(max_mm, max_mm, 2.0, 10)
        measures = msgspec.convert(
            {
                "sounding_frames": 10,
                "contacts": {"right.index.pad on key": msgspec.to_builtins(spread)},
                "lips": msgspec.to_builtins(Spread(0.0, 0.0, 2.0, 0)),
                "upper_lip_in_breaths": msgspec.to_builtins(Spread(0.0, 0.0, 2.0, 0)),
                "feet": {},
                "bones": msgspec.to_builtins(Spread(0.0, 0.0, 2.0, 0)),
                "penetration": msgspec.to_builtins(Spread(0.0, 0.0, 3.0, 0)),
                "controls": {},
                "limits": {"joint": "", "value": 0.0, "bound": 0.0, "beyond": 0},
                "acceleration": {"joint": "", "value": 0.0, "bound": 0.0, "beyond": 0},
                "breaths": {"planned": 0, "jaw_open": 0, "torso_back": 0, "shown": 0},
            },
            PlayerMeasures,
        )
        missed = {"right.index.pad on key": missed_mm} if missed_mm else {}
        place = PlaceReport(0.0, 0.0, 0.0)
        return failures(
            PlayerReport("p", "p", "i", "c", "standing", {}, place, 1, measures, None, None, size=0.6, missed=missed)
        )

    assert judged(1.9, 0.0) == ()
    assert judged(6.0, 0.0) == ("right.index.pad on key",)
    assert judged(6.0, 5.0) == ()
    assert judged(7.5, 5.0) == ("right.index.pad on key",)
