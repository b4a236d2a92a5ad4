"""A stopped horn, exported and read back: the palm closes the bell, and the fingers stay on its wall."""

from __future__ import annotations

import json
from pathlib import Path

import mido
import msgspec
import numpy as np
import pytest

from app.cli import main
from app.export.playback import ScenePlayback
from app.export.report import PlayerReport, failures
from app.formats.fbx.read import read_scene
from app.motion.contacts.hand_in_bell import CLOSES_S, READY_S


@pytest.fixture(scope="module", params=["horn_F_single", "horn_double_F_Bb"])
def folder(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three open notes, three stopped, three open: half a second each, with a second of silence between."""
    folder = tmp_path_factory.mktemp("stopped")
    track = mido.MidiTrack(
        [mido.MetaMessage("track_name", name="Horn in F"), mido.Message("program_change", program=60)]
    )
    for number, said in enumerate(("", "gestopft", "offen")):
        wait = 960 if number else 0
        if said:
            track.append(mido.MetaMessage("text", text=said, time=wait - 120))
            wait = 120
        for pitch in (60, 64, 62):
            track += [
                mido.Message("note_on", note=pitch, velocity=80, time=wait),
                mido.Message("note_off", note=pitch, time=480),
            ]
            wait = 0
    midi = mido.MidiFile(ticks_per_beat=480)
    midi.tracks.append(track)
    midi.save(folder / "stopped.mid")
    arguments = ("--to", str(folder / "out"), "--format", "fbx", "--assign", f"*={request.param}")
    assert main(["export", str(folder / "stopped.mid"), *arguments]) == 0
    return folder / "out"


def test_the_palm_closes_the_bell_for_the_stopped_notes_and_comes_back(folder: Path) -> None:
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    (player,) = report["players"]
    (mute,) = player["mutes"]
    assert (mute["kind"], mute["start_s"], mute["end_s"]) == ("stopped", 2.5, 4.0)
    body, held = (read_scene(folder / player["files"][f"{name}_fbx"]) for name in ("character", "instrument"))
    assert body.clip is not None
    assert held.clip is not None
    worlds = [ScenePlayback(scene, scene.clip).world(0, scene.clip.frames) for scene in (body, held)]
    names = [bone.name for bone in body.bones]
    horn = worlds[1][:, 0]

    def in_horn_m(bone: str) -> np.ndarray:
        return np.einsum("fji,fj->fi", horn[:, :3, :3], worlds[0][:, names.index(bone), :3, 3] - horn[:, :3, 3])

    times_s = report["first_frame_s"] + np.arange(body.clip.frames) / float(body.clip.fps)
    wrist_m, tip_m = in_horn_m("rightHand"), in_horn_m("rightIndexDistal")
    open_m = wrist_m[np.searchsorted(times_s, 0.5)]
    way_mm = 1000.0 * np.linalg.norm(wrist_m - open_m, axis=1)
    at_rest = (times_s < 2.5 - READY_S - CLOSES_S - 0.02) | (times_s > 4.0 + CLOSES_S + 0.02)
    assert way_mm[at_rest].max() < 1.0
    stopped = (times_s >= 2.5 - READY_S) & (times_s <= 4.0)
    assert way_mm[stopped].min() > 45.0
    assert np.ptp(way_mm[stopped]) < 1.0
    # The forefinger stays where the map has it touch.
    assert 1000.0 * np.linalg.norm(tip_m - tip_m[0], axis=1).max() < 2.0


def test_every_bound_is_kept_and_nothing_is_reported_of_the_hand(folder: Path) -> None:
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    player = msgspec.convert(report["players"][0], PlayerReport)
    assert failures(player) == ()
    contacts = player.measures.contacts
    assert contacts["right.index.side_middle on root"].frames > 1.3 * contacts["right.thumb.side on root"].frames
    assert not any("right hand" in remark for remark in report["warnings"])
