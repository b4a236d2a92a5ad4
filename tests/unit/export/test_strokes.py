"""Strokes of the tongue in exported files: motion of chin, tongue and chest at an onset."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import mido
import msgspec
import numpy as np
import pytest

from app.cli import main
from app.export.playback import ScenePlayback, Surface
from app.export.report import PlayerReport
from app.formats.fbx.read import read_scene
from app.formats.scene import Scene

E8 = 240
SCALE = (0, 2, 4, 5, 7, 5, 4, 2)
BARS: dict[str, tuple[Callable[[int], float], Callable[[int], int]]] = {
    # How long each eighth of a bar sounds, and its velocity.
    "plain": (lambda place: 0.85, lambda place: 80),
    "slurred": (lambda place: 1.08 if place < 7 else 0.75, lambda place: 80),
    "marcato": (lambda place: 0.65 if place % 4 == 0 else 0.85, lambda place: 118 if place % 4 == 0 else 80),
    "double": (lambda place: 0.85, lambda place: 80),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("strokes")
    midi = mido.MidiFile(ticks_per_beat=480)
    for name, program, lowest in (("Trumpet", 56, 67), ("Clarinet", 71, 65)):
        events = []
        for bar, (kind, (gate, velocity)) in enumerate(BARS.items()):
            step = 90 if kind == "double" else E8
            for place in range(16 if kind == "double" else 8):
                at, pitch = 1920 * bar + place * step, lowest + SCALE[place // 2 if kind == "double" else place]
                events += [(at, "note_on", pitch, velocity(place))]
                events += [(at + int(gate(place % 8) * step), "note_off", pitch, 0)]
        track = mido.MidiTrack(
            [mido.MetaMessage("track_name", name=name), mido.Message("program_change", program=program)]
        )
        last = 0
        for at, kind, pitch, velocity_now in sorted(events, key=lambda event: event[0]):
            track.append(mido.Message(kind, note=pitch, velocity=velocity_now, time=at - last))
            last = at
        midi.tracks.append(track)
    midi.save(folder / "strokes.mid")
    assert main(["export", str(folder / "strokes.mid"), "--to", str(folder / "out"), "--format", "fbx"]) == 0
    return folder / "out"


@pytest.fixture(scope="module", params=["Trumpet", "Clarinet"])
def player(request: pytest.FixtureRequest, folder: Path) -> tuple[Scene, PlayerReport]:
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    (found,) = (one for one in report["players"] if one["name"] == request.param)
    return read_scene(folder / found["files"]["character_fbx"]), msgspec.convert(found, PlayerReport)


@pytest.fixture(scope="module")
def first_frame_s(folder: Path) -> float:
    return float(json.loads((folder / "report.json").read_text(encoding="utf-8"))["first_frame_s"])


def moved_mm(scene: Scene, morph: str, first_s: float, bar: str, *places: int) -> float:
    """Median displacement in millimetres relative to the head, at the onsets of a bar, of the lowest vertex that a
    morph moves strongly: chin or tip of the tongue.
    """
    assert scene.clip is not None
    mesh, target = next((mesh, target) for mesh in scene.meshes for target in mesh.morphs if target.name == morph)
    sizes_cm = np.linalg.norm(target.position_deltas_cm, axis=1)
    much = target.vertex_indices[sizes_cm > 0.8 * sizes_cm.max()]
    vertex = much[np.asarray(mesh.vertices_cm)[much, 1].argmin()]
    playback = ScenePlayback(scene, scene.clip)
    world = playback.world(0, scene.clip.frames)
    place_m = Surface(playback, mesh, np.array([vertex])).positions_m(world, 0, scene.clip.frames)[:, 0]
    head = world[:, [bone.name for bone in scene.bones].index("head")]
    seen_m = np.einsum("fji,fj->fi", head[:, :3, :3], place_m - head[:, :3, 3])
    times_s = first_s + np.arange(scene.clip.frames) / float(scene.clip.fps)
    ways = []
    for place in places:
        onset_s = 2.0 * list(BARS).index(bar) + place * (0.09375 if bar == "double" else 0.25)
        first, last = np.searchsorted(times_s, (onset_s - 0.1, onset_s + 0.1))
        ways.append(1000.0 * float(np.linalg.norm(np.ptp(seen_m[first:last], axis=0))))
    return float(np.median(ways))


def test_a_stroke_moves_chin_and_tongue_by_how_it_is_made(
    player: tuple[Scene, PlayerReport], first_frame_s: float
) -> None:
    scene, _ = player
    chin, tongue = (
        {
            "slurred": moved_mm(scene, morph, first_frame_s, "slurred", 2, 3, 4, 5, 6),
            "plain": moved_mm(scene, morph, first_frame_s, "plain", 2, 3, 4, 5, 6),
            "marcato": moved_mm(scene, morph, first_frame_s, "marcato", 4),
        }
        for morph in ("jawOpen", "tongueOut")
    )
    # A chin's motion of a millimetre is visible in a close-up; four millimetres are a beginner's.
    assert chin["slurred"] < 0.5 < 0.9 < chin["plain"] < 0.85 * chin["marcato"] < 3.4
    # From its place in the mouth to the teeth, not between the lips.
    assert tongue["slurred"] < 0.5 < 2.5 < tongue["plain"] < tongue["marcato"] < 6.0


def test_in_double_tonguing_every_other_stroke_is_of_the_tongues_back(
    player: tuple[Scene, PlayerReport], first_frame_s: float
) -> None:
    scene, _ = player
    tip = scene.clip.morph_weights["tongueOut"]
    onsets_s = 6.0 + 0.09375 * np.arange(2, 14)
    at = np.rint((onsets_s - 0.01 - first_frame_s) * float(scene.clip.fps)).astype(int)
    up = np.array([tip[max(frame - 1, 0) : frame + 2].max() for frame in at])
    assert up[::2].min() > 0.1
    assert up[1::2].max() < 0.05


def test_lips_stay_on_the_mouthpiece(player: tuple[Scene, PlayerReport]) -> None:
    _, report = player
    assert report.measures.lips.max_mm < 0.5
    assert report.measures.penetration.kept
    assert report.measures.breaths.shown == report.measures.breaths.planned
