"""An instrument added as map and model in the user's folder, used through the command line to exported files."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import mido
import pytest

import instrument_maps.library as library
from app.cli import main
from app.formats.cache import CACHE_VARIABLE
from app.performance.bodies import character_of, hold_of, is_strained, suited_to
from app.plan.parameters import PlayerParameters
from app.project.casting import StagePosition
from app.project.performers import Player
from app.rig.grip.fitting.fitted_instrument import FittedInstrument
from instrument_maps.load import bundled_maps

EXAMPLE = Path(__file__).parents[3] / "docs" / "tin-whistle"
# D E F sharp G A B C sharp D, then a cross fingering and a half hole, as in common tutors.
TUNE = {
    74: "L1 L2 L3 R1 R2 R3", 76: "L1 L2 L3 R1 R2", 78: "L1 L2 L3 R1", 79: "L1 L2 L3", 81: "L1 L2", 83: "L1",
    85: "(open)", 86: "L2 L3 R1 R2 R3", 84: "L2 L3", 80: "L1 L2 L3h",
}  # fmt: skip


@pytest.fixture
def piece(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    own = tmp_path / "instruments"
    own.mkdir()
    for name in ("tin_whistle_D.toml", "tin_whistle_D.glb"):
        shutil.copy(EXAMPLE / name, own)
    monkeypatch.setenv(library.FOLDER_VARIABLE, str(own))
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))
    monkeypatch.setattr(library.LIBRARY, "last", None)
    track = mido.MidiTrack([mido.MetaMessage("track_name", name="Tin Whistle")])
    for pitch in TUNE:
        track.append(mido.Message("note_on", note=pitch, velocity=80))
        track.append(mido.Message("note_off", note=pitch, time=480))
    path = tmp_path / "tune.mid"
    mido.MidiFile(type=1, tracks=[mido.MidiTrack(), track]).save(path)
    return path


def test_the_guides_whistle_plays_without_a_line_of_code(
    piece: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert "tin_whistle_D" not in bundled_maps()
    assert main(["instruments", "check", str(tmp_path / "instruments" / "tin_whistle_D.toml")]) == 0
    assert main(["instruments"]) == 0
    assert "tin_whistle_D*" in capsys.readouterr().out
    assert main(["inspect", str(piece), "--json"]) == 0
    (player,) = json.loads(capsys.readouterr().out)["players"]
    assert player["instrument"] == "tin_whistle_D"
    assert {note["pitch"]: note["fingering"] for note in player["notes"]} == TUNE
    assert main(["export", str(piece), "--to", str(tmp_path / "out"), "--fps", "30"]) == 0
    report = json.loads((tmp_path / "out" / "report.json").read_text("utf-8"))
    measures = report["players"][0]["measures"]
    assert all(control["right"] == control["judged"] > 0 for control in measures["controls"].values())
    assert set(measures["controls"]) == {f"hole_{hand}{place}" for hand in "LR" for place in "123"}
    assert measures["penetration"]["max_mm"] <= 3.0
    assert all(contact["max_mm"] <= contact["bound_mm"] for contact in measures["contacts"].values())


def test_a_child_holds_the_whistle_as_it_is(piece: Path) -> None:
    """No grip for this pair is bundled; one is fitted to the child's hands."""
    player = Player("p", "P", "p", "tin_whistle_D", "child_hina", PlayerParameters(), StagePosition(0.0, 0.0, 0.0))
    whistle = library.find_map("tin_whistle_D")
    assert suited_to(player, whistle) == FittedInstrument(whistle, ())
    for hand in hold_of(player, whistle).hands:
        assert hand.penetration_m <= 0.0035
        for fit in hand.contacts:
            assert fit.distance_m <= 0.002, fit
            assert fit.control is None or fit.waits_m >= 0.004, fit
    assert not is_strained(character_of(player), whistle)


def test_the_example_is_what_its_script_makes(tmp_path: Path) -> None:
    import runpy

    shutil.copy(EXAMPLE / "tin_whistle_D.toml", tmp_path)
    runpy.run_path(str(EXAMPLE / "model.py"))["main"](tmp_path)
    for name in ("tin_whistle_D.toml", "tin_whistle_D.glb"):
        assert (tmp_path / name).read_bytes() == (EXAMPLE / name).read_bytes()
