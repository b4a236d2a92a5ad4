"""An instrument with an endpin stands on the floor: exported and read back for every body."""

from __future__ import annotations

import json
from pathlib import Path

import mido
import numpy as np
import pytest

from app.cli import main
from app.export.playback import ScenePlayback, Surface
from app.formats.fbx.read import read_scene
from app.rig.characters.character_library import bundled_characters
from instrument_maps.load import bundled_maps

STANDING = [instrument.id for instrument in bundled_maps().values() if instrument.endpin is not None]
BEAT_S, REST_BEATS = 0.5, 24
TOUCHES_M = 0.002


def line(path: Path, low: int) -> None:
    """Scale with swells, a long rest, and a few more notes; a beat is half a second."""
    track = mido.MidiTrack([mido.MetaMessage("track_name", name="x"), mido.MetaMessage("set_tempo", tempo=500_000)])
    rest = 0
    for step in [*range(16), None, *range(4)]:
        if step is None:
            rest = REST_BEATS * 480
            continue
        pitch = low + 2 * (step % 8) + 5 * (step % 3)
        track += [
            mido.Message("note_on", note=pitch, velocity=50 + 5 * step, time=rest),
            mido.Message("note_off", note=pitch, velocity=0, time=480),
        ]
        rest = 0
    mido.MidiFile(tracks=[track], ticks_per_beat=480).save(path)


@pytest.mark.parametrize("character", bundled_characters())
@pytest.mark.parametrize("instrument", STANDING)
def test_the_tip_is_on_the_floor_as_long_as_a_user_plays(instrument: str, character: str, tmp_path: Path) -> None:
    map = bundled_maps()[instrument]
    assert map.endpin is not None
    line(tmp_path / "x.mid", map.range.easy_low)
    settings = {"posture": "seated", "character": character, "amplitude": "1"}
    reported = [word for name, value in settings.items() for word in ("--set", f"*.{name}={value}")]
    assert (
        main(
            [
                "export",
                str(tmp_path / "x.mid"),
                "--to",
                str(tmp_path),
                "--fps",
                "24",
                "--assign",
                f"x={instrument}",
                *reported,
            ]
        )
        == 0
    )
    report = json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))
    scene = read_scene(tmp_path / f"x_{instrument}.fbx")
    assert scene.clip is not None
    played, mesh = ScenePlayback(scene, scene.clip), scene.meshes[0]
    pin = played.bone_names.index(map.endpin.node)
    owner = np.asarray(mesh.joint_indices)[np.arange(len(mesh.vertices_cm)), np.argmax(mesh.weights, axis=1)]
    frames = scene.clip.frames
    world = played.world(0, frames)
    lowest_m = Surface(played, mesh, np.flatnonzero(owner == pin)).positions_m(world, 0, frames)[..., 1].min(axis=1)
    times_s = report["first_frame_s"] + np.arange(frames) / 24.0
    end_s = 16 * BEAT_S
    sounding = ((times_s >= 0.0) & (times_s < end_s)) | (times_s >= end_s + REST_BEATS * BEAT_S)
    assert np.abs(lowest_m[sounding]).max() < TOUCHES_M
    assert np.ptp(world[sounding][:, pin, :3, 3], axis=0)[[0, 2]].max() < TOUCHES_M
    # In the rest it stays there, and nothing of the instrument above it goes into the floor.
    assert np.abs(lowest_m).max() < TOUCHES_M
    others = np.flatnonzero(owner != pin)[::7]
    assert Surface(played, mesh, others).positions_m(world, 0, frames)[..., 1].min() > 0.0
