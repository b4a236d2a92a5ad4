"""A real piece on each skeleton, through files: the measurements are equal on all, and other programs read the same
motion.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import msgspec
import numpy as np
import pytest

from app.errors import FileError
from app.export.character import character_scene
from app.export.instrument import instrument_scene
from app.export.mannequin import mannequin_target
from app.export.measure import PlayerJudge, PlayerMeasures
from app.export.own_skeleton import own_target
from app.export.playback import ScenePlayback
from app.export.request import ExportRequest
from app.export.run import export
from app.export.target import SkeletonChoice, TargetSkeleton, normalised_target
from app.formats.fbx.read import read_scene
from app.formats.fbx.write import write_scene
from app.formats.scene import Scene
from app.messages import text
from app.performance.bodies import character_of, model_of
from app.performance.cast import performer_of
from app.performance.ensemble import Performance
from app.performance.span import cut_span
from app.project.model import map_choices, project_from_score
from app.rig import quaternion
from app.rig.characters.character_library import character_named
from app.rig.model import Character
from app.score.read import read_midi
from instrument_maps.load import bundled_maps
from tests.support import readers
from tests.support.foreign import foreign
from tests.support.performed import player_motion

QUARTET = Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid"
FPS = Fraction(30)
MM = 0.005
"""Tolerance in millimetres between measures of different files."""


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
            # The judge measures bones: those of eyes keep still where shapes turn them.
            "suisou": (self.ours, replace(normalised_target(self.ours.skeleton), eyes="bones")),
            "ue5": (self.ours, replace(mannequin_target(self.ours.skeleton), eyes="bones")),
            "own": (self.foreign, own_target(self.foreign)),
            "lacking": (self.lacking, own_target(self.lacking)),
        }[name]

    def written(self, name: str) -> Scene:
        character, target = self.on(name)
        return self.file(name, character_scene(character, self.motion, "x", "test", target))

    def measured(self, name: str) -> PlayerMeasures:
        return self.judged(name, self.written(name))

    def judged(self, name: str, scene: Scene) -> PlayerMeasures:
        character, target = self.on(name)
        performer = replace(performer_of(self.performance, self.player), character=character)
        judge = PlayerJudge(performer, self.performance.plan(self.player), target)
        return judge.measure(scene, self.held, self.span.first_frame_s).measures


@pytest.fixture(scope="module")
def piece(tmp_path_factory: pytest.TempPathFactory) -> Piece:
    return Piece(tmp_path_factory.mktemp("skeletons"))


@pytest.fixture(scope="module")
def plain(piece: Piece) -> dict[str, object]:
    return msgspec.to_builtins(piece.measured("suisou"))


def differences(plain: object, found: object, path: str = "") -> list[str]:
    if isinstance(plain, dict) and isinstance(found, dict):
        assert plain.keys() == found.keys()
        if plain.get("beyond") == found.get("beyond") == 0:
            # Among joints within their limits any may be named.
            plain, found = ({**one, "joint": ""} for one in (plain, found))
        return [line for key in plain for line in differences(plain[key], found[key], f"{path}/{key}")]
    if isinstance(plain, float) and isinstance(found, float):
        alike = abs(plain - found) <= (MM if "acceleration" not in path else 0.02 * abs(plain) + 1.0)
        return [] if alike else [f"{path}: {plain} and {found}"]
    if path.endswith("/joint"):
        # Both eyes rotate alike.
        plain, found = (str(name).removeprefix("left").removeprefix("right") for name in (plain, found))
    return [] if plain == found else [f"{path}: {plain} and {found}"]


@pytest.mark.parametrize("name", ["own", "lacking", "ue5"])
def test_the_judge_measures_the_same_on_every_skeleton(piece: Piece, plain: dict[str, object], name: str) -> None:
    found = msgspec.to_builtins(piece.measured(name))
    assert differences(plain, found) == []


@pytest.mark.parametrize("name", ["own", "ue5"])
def test_a_spoilt_file_is_found_on_every_skeleton(piece: Piece, name: str) -> None:
    """Measurements use the file: a hand rotated by two degrees misses its key, whatever the bone's name is."""
    character, target = piece.on(name)
    scene = piece.written(name)
    assert scene.clip is not None
    wrist = target.names[target.bone_of_joint[character.skeleton.index("rightHand")]]
    index = [bone.name for bone in scene.bones].index(wrist)
    half = np.radians(1.0)
    turn = np.array([np.sin(half), 0.0, 0.0, np.cos(half)])
    scene.clip.rotations_xyzw[:, index] = quaternion.multiply(scene.clip.rotations_xyzw[:, index], turn)
    found = piece.judged(name, scene)
    assert any(not spread.kept for contact, spread in found.contacts.items() if contact.startswith("right."))


def what_it_holds(scene: Scene) -> readers.Expected:
    frames = [0, 40, scene.clip.frames - 1]
    playback = ScenePlayback(scene, scene.clip)
    world_cm = playback.world(0, scene.clip.frames)[frames][..., :3, 3] * 100.0
    names = playback.bone_names
    return readers.Expected(
        fps=FPS,
        frames=scene.clip.frames,
        sampled=frames,
        joints_cm={bone: world_cm[:, index] for index, bone in enumerate(names)},
        parents={
            bone: None if parent < 0 else names[parent] for bone, parent in zip(names, playback.parents, strict=True)
        },
        weights={morph: np.asarray(curve)[frames] for morph, curve in scene.clip.morph_weights.items()},
    )


def without_morphs(scene: Scene) -> Scene:
    """Scene without morphs, which no option changes and which take readers longest."""
    assert scene.clip is not None
    meshes = tuple(replace(mesh, morphs=()) for mesh in scene.meshes)
    return replace(scene, meshes=meshes, clip=replace(scene.clip, morph_weights={}))


@pytest.mark.parametrize("name", ["own", "ue5"])
def test_other_programs_read_the_same(piece: Piece, name: str) -> None:
    asked = [reader for reader in readers.QUICK_FBX if readers.installed(reader)]
    assert asked
    readers.judge(piece.folder / f"{name}.fbx", what_it_holds(piece.written(name)), asked)


@pytest.mark.readers
@pytest.mark.parametrize("reader", readers.SLOW_FBX)
def test_slow_readers_read_the_same(piece: Piece, reader: str) -> None:
    """Unreal's skeleton; test_run lets them read whole exports on the default one."""
    if not readers.installed(reader):
        pytest.skip(f"{reader} is not installed")
    scene = piece.file("still_face", without_morphs(piece.written("ue5")))
    readers.judge(piece.folder / "still_face.fbx", what_it_holds(scene), [reader])


def request(piece: Piece, folder: Path, skeleton: SkeletonChoice, asset: Path | None) -> ExportRequest:
    return ExportRequest(
        performance=piece.performance,
        players=(piece.player,),
        folder=folder,
        formats=frozenset(("bvh",)),
        span=cut_span(piece.performance.time_frame, FPS, 0.0, 0.5),
        bars=None,
        source="quartet.mid",
        creator="test",
        skeleton=skeleton,
        asset=asset,
    )


def test_an_asset_that_would_lose_the_animation_stops_the_export(piece: Piece, tmp_path: Path) -> None:
    piece.written("ue5")
    with pytest.raises(FileError) as caught:
        export(request(piece, tmp_path / "out", "own", piece.folder / "ue5.fbx"), text)
    said = text(caught.value.message)
    assert "ue5.fbx" in said
    assert piece.player.name in said
    assert "53 animated bones are not in the asset" in said
    assert not (tmp_path / "out").exists()


def test_what_differs_is_in_the_report(piece: Piece, tmp_path: Path) -> None:
    """A mannequin with bones of other lengths plays the animation, with the differences in the report."""
    other = mannequin_target(character_named("man_adult").skeleton)
    assert piece.ours.id != "man_adult"
    scene = character_scene(character_named("man_adult"), replace(piece.motion), "x", "test", other)
    write_scene(tmp_path / "other.fbx", scene)
    report = export(request(piece, tmp_path / "out", "ue5", tmp_path / "other.fbx"), text)
    skeleton = report.players[0].skeleton
    assert (skeleton.choice, skeleton.asset) == ("ue5", "other.fbx")
    assert {difference.kind for difference in skeleton.differences} == {"position"}
    assert any("different rest position from the asset" in warning for warning in report.warnings)
    kept = msgspec.json.decode((tmp_path / "out" / "report.json").read_bytes())["players"][0]["skeleton"]
    assert kept["differences"][0]["kind"] == "position"
