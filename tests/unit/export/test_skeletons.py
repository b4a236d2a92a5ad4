"""A real piece on each skeleton, through files: our judge measures the same on all, other programs read what we do."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import msgspec
import numpy as np
import pytest

from app.export.character import character_scene
from app.export.instrument import instrument_scene
from app.export.mannequin import mannequin_target
from app.export.measure import PlayerMeasures, measure_player
from app.export.own_skeleton import own_target
from app.export.playback import Playback
from app.export.target import TargetSkeleton, normalised_target
from app.formats.fbx.read import read_scene
from app.formats.fbx.write import write_scene
from app.formats.scene import Scene
from app.performance.bodies import body_of, character_of, model_of
from app.performance.ensemble import Performance
from app.performance.motion import player_motion
from app.performance.span import cut_span
from app.project.model import map_choices, project_from_score
from app.rig import quaternion
from app.rig.model import Character
from app.score.read import read_midi
from instrument_maps.load import bundled_maps
from metadata.load import load_skeleton
from tests.support import readers
from tests.support.foreign import foreign

QUARTET = Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid"
FPS = Fraction(30)
MM = 0.005
"""Measures may differ by as much from file to file."""


class Piece:
    """A few seconds of a trumpeter, written and read on any skeleton."""

    def __init__(self, folder: Path) -> None:
        maps = bundled_maps()
        project = project_from_score(read_midi(QUARTET, maps=map_choices(maps.values())), maps)
        self.folder = folder
        self.performance = Performance(project)
        self.player = project.players[0]
        self.span = cut_span(self.performance.time_frame, FPS, -1.5, 4.0)
        self.motion = player_motion(self.performance, self.player, self.span)
        self.instrument = self.performance.instrument(self.player)
        self.ours = character_of(self.player)
        self.foreign = foreign(self.ours, roots=2)
        self.lacking = foreign(self.ours, seed=3, lacking=("leftToes", "rightToes"), in_chain="leftHand")
        held = instrument_scene(self.instrument, model_of(self.instrument), self.motion, "x", "test")
        self.held = self.file("held", held)

    def file(self, name: str, scene: Scene) -> Scene:
        write_scene(self.folder / f"{name}.fbx", scene)
        return read_scene(self.folder / f"{name}.fbx")

    def on(self, name: str) -> tuple[Character, TargetSkeleton]:
        return {
            "suisou": (self.ours, normalised_target(self.ours.skeleton)),
            "ue5": (self.ours, mannequin_target(self.ours.skeleton)),
            "own": (self.foreign, own_target(self.foreign)),
            "lacking": (self.lacking, own_target(self.lacking)),
        }[name]

    def written(self, name: str) -> Scene:
        character, target = self.on(name)
        return self.file(name, character_scene(character, self.motion, "x", "test", target))

    def measured(self, name: str) -> PlayerMeasures:
        character, target = self.on(name)
        body = body_of(self.player)
        return measure_player(
            self.written(name),
            self.held,
            character,
            self.instrument,
            self.performance.plan(self.player),
            body,
            load_skeleton(body.skeleton),
            self.span.first_frame_s,
            target=target,
        ).measures


@pytest.fixture(scope="module")
def piece(tmp_path_factory: pytest.TempPathFactory) -> Piece:
    return Piece(tmp_path_factory.mktemp("skeletons"))


@pytest.fixture(scope="module")
def plain(piece: Piece) -> dict[str, object]:
    return msgspec.to_builtins(piece.measured("suisou"))


def differences(plain: object, found: object, path: str = "") -> list[str]:
    if isinstance(plain, dict) and isinstance(found, dict):
        assert plain.keys() == found.keys()
        return [line for key in plain for line in differences(plain[key], found[key], f"{path}/{key}")]
    if isinstance(plain, float) and isinstance(found, float):
        alike = abs(plain - found) <= (MM if "acceleration" not in path else 0.02 * abs(plain) + 1.0)
        return [] if alike else [f"{path}: {plain} and {found}"]
    return [] if plain == found else [f"{path}: {plain} and {found}"]


@pytest.mark.parametrize("name", ["own", "lacking", "ue5"])
def test_the_judge_measures_the_same_on_every_skeleton(piece: Piece, plain: dict[str, object], name: str) -> None:
    found = msgspec.to_builtins(piece.measured(name))
    if name == "ue5":  # it has no eyes to turn
        found["acceleration"] = plain["acceleration"]
    assert differences(plain, found) == []


@pytest.mark.parametrize("name", ["own", "ue5"])
def test_a_spoilt_file_is_found_on_every_skeleton(piece: Piece, name: str) -> None:
    """The judge looks at the file: a hand turned by two degrees is off its key, whatever the bone is called."""
    character, target = piece.on(name)
    scene = piece.written(name)
    assert scene.clip is not None
    wrist = target.names[target.bone_of_joint[character.skeleton.index("rightHand")]]
    index = [bone.name for bone in scene.bones].index(wrist)
    half = np.radians(1.0)
    turn = np.array([np.sin(half), 0.0, 0.0, np.cos(half)])
    scene.clip.rotations_xyzw[:, index] = quaternion.multiply(scene.clip.rotations_xyzw[:, index], turn)
    body = body_of(piece.player)
    found = measure_player(
        scene,
        piece.held,
        character,
        piece.instrument,
        piece.performance.plan(piece.player),
        body,
        load_skeleton(body.skeleton),
        piece.span.first_frame_s,
        target=target,
    ).measures
    assert any(not spread.kept for contact, spread in found.contacts.items() if contact.startswith("right."))


@pytest.mark.parametrize("name", ["own", "ue5"])
def test_other_programs_read_the_same(piece: Piece, name: str) -> None:
    scene = piece.written(name)
    assert scene.clip is not None
    frames = [0, 40, scene.clip.frames - 1]
    playback = Playback(scene, scene.clip)
    world_cm = playback.world(0, scene.clip.frames)[frames][..., :3, 3] * 100.0
    names = playback.bone_names
    expected = readers.Expected(
        fps=FPS,
        frames=scene.clip.frames,
        sampled=frames,
        joints_cm={bone: world_cm[:, index] for index, bone in enumerate(names)},
        parents={
            bone: None if parent < 0 else names[parent] for bone, parent in zip(names, playback.parents, strict=True)
        },
        weights={morph: np.asarray(curve)[frames] for morph, curve in scene.clip.morph_weights.items()},
    )
    asked = [reader for reader in readers.QUICK_FBX if readers.installed(reader)]
    assert asked
    readers.judge(piece.folder / f"{name}.fbx", expected, asked)
