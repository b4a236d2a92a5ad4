"""Names and parts of the curves of faces in exported files, against the makers' lists."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from app.cli import main
from app.cli.export import face_parts
from app.export.character import character_scene
from app.export.eyes import looking_ahead
from app.export.face_curves import (
    CURVE_NAMES,
    FACE_PARTS,
    CurveNames,
    curve_names,
    part_of,
    with_curve_names,
    written_weights,
)
from app.export.humanoid import humanoid_scene, humanoid_target
from app.export.target import normalised_target
from app.formats.gltf.read import read_glb
from app.formats.gltf.vrma import write_vrma
from app.formats.scene import MorphTarget, Scene
from app.performance.bodies import character_of
from app.performance.ensemble import Performance
from app.performance.span import bars_span
from metadata.model import ARKIT_MORPHS
from tests.gui.conftest import quartet_project
from tests.support.performed import player_motion
from tests.unit.formats import scenes

LISTS = Path(__file__).parents[2] / "data" / "face_curves"


def _list(name: str) -> set[str]:
    """Names of a maker's list.

    ``metahuman``: the 251 raw controls of a MetaHuman's face, by which Epic's own plug-in verifies one (GetFdsCurves in
    VerifyMetaHumanCharacter.cpp of its MetaHuman SDK). ``audio2face``: the first 52 of NVIDIA's Audio2Face-3D
    (ARKIT_FACE_EXPRESSIONS in names.cpp of NVIDIA/Maya-ACE), in the order of Unreal's EARFaceBlendShape.
    """
    return set((LISTS / f"{name}.txt").read_text(encoding="utf-8").split())


@pytest.mark.parametrize("names", CURVE_NAMES)
def test_every_shape_of_arkit_has_curves_from_which_it_can_be_made_again(names: CurveNames) -> None:
    table = curve_names(names)
    assert table.keys() == set(ARKIT_MORPHS)
    assert all(0.0 < share <= 1.0 for curves in table.values() for share in curves.values())
    curves = sorted({curve for shares in table.values() for curve in shares})
    weights = [[shares.get(curve, 0.0) for curve in curves] for shares in table.values()]
    assert np.linalg.matrix_rank(np.array(weights)) == len(table)


def test_curves_are_in_the_makers_lists() -> None:
    assert {curve for curves in curve_names("audio2face").values() for curve in curves} == _list("audio2face")
    raw = _list("metahuman")
    assert len(raw) == 251
    assert {curve for curves in curve_names("metahuman").values() for curve in curves} <= raw


def test_eyes_look_to_the_sides_that_a_metahuman_means() -> None:
    """ARKit's shapes look in and out, a MetaHuman's to its own left and right."""
    table = curve_names("metahuman")
    assert [*table["eyeLookInLeft"], *table["eyeLookOutLeft"]] == [
        "CTRL_expressions_eyeLookRightL",
        "CTRL_expressions_eyeLookLeftL",
    ]
    assert [*table["eyeLookInRight"], *table["eyeLookOutRight"]] == [
        "CTRL_expressions_eyeLookLeftR",
        "CTRL_expressions_eyeLookRightR",
    ]


def _deformed(scene: Scene, frame: int) -> np.ndarray:
    """Vertices of all meshes, deformed by the morphs only."""
    assert scene.clip is not None
    parts = []
    for mesh in scene.meshes:
        places = np.array(mesh.vertices_cm, float)
        for morph in mesh.morphs:
            weight = scene.clip.morph_weights.get(morph.name, np.zeros(scene.clip.frames))[frame]
            places[morph.vertex_indices] += weight * morph.position_deltas_cm
        parts.append(places)
    return np.concatenate(parts)


@pytest.mark.parametrize("names", CURVE_NAMES)
def test_a_mesh_shows_the_same_by_other_names(names: CurveNames) -> None:
    made = scenes.character(Fraction(30))
    assert made.clip is not None
    chance = np.random.default_rng(3)
    funnel = MorphTarget("mouthFunnel", np.arange(9), chance.normal(size=(9, 3)))
    # On a MetaHuman, it shares curves with the funnel.
    pucker = MorphTarget("mouthPucker", np.arange(4, 12), chance.normal(size=(8, 3)))
    body = replace(made.meshes[0], morphs=(*made.meshes[0].morphs, funnel, pucker))
    shown = {
        name: np.linspace(*ends, made.clip.frames)
        for name, ends in {"mouthFunnel": (0.85, 0.1), "mouthPucker": (0.1, 0.85)}.items()
    }
    weights = {**made.clip.morph_weights, **shown}
    given = replace(made, meshes=(body, *made.meshes[1:]), clip=replace(made.clip, morph_weights=weights))
    found = with_curve_names(given, names)
    assert found.clip is not None
    table = curve_names(names)
    assert found.clip.morph_weights.keys() == {curve for shape in weights for curve in table[shape]}
    for frame in (0, 20, made.clip.frames - 1):
        np.testing.assert_allclose(_deformed(found, frame), _deformed(given, frame), atol=1e-9)


def test_curves_that_serve_several_shapes_stay_within_their_range() -> None:
    """Raised brows, inner and outer, drive one control of a MetaHuman, which ends at 1."""
    made = scenes.character(Fraction(30))
    assert made.clip is not None
    raised = np.linspace(0.0, 0.9, made.clip.frames, dtype=np.float32)
    clip = replace(made.clip, morph_weights={"browInnerUp": raised, "browOuterUpLeft": raised})
    found = with_curve_names(replace(made, clip=clip), "metahuman").clip
    assert found is not None
    shared = found.morph_weights["CTRL_expressions_browRaiseInL"]
    np.testing.assert_array_equal(shared, np.minimum(2.0 * raised, 1.0))
    assert max(float(weights.max()) for weights in found.morph_weights.values()) == 1.0


def test_all_shapes_belong_to_one_part_and_others_to_none() -> None:
    assert {part_of(shape) for shape in ARKIT_MORPHS} == set(FACE_PARTS)
    assert part_of("cheekPuff") == part_of("jawOpen") == part_of("tongueOut") == "mouth"
    assert part_of("eyeLookInLeft") == "gaze"
    assert part_of("chestExpand") is None


def test_parts_that_are_not_asked_for_have_no_curves_and_keep_their_shapes() -> None:
    performance = Performance(quartet_project())
    player = performance.project.players[0]
    span = bars_span(performance, Fraction(30), (1, 2), 1)
    motion, character = player_motion(performance, player, span), character_of(player)
    whole, lips = (character_scene(character, motion, "p", "t", face_parts=parts) for parts in (FACE_PARTS, ("mouth",)))
    assert whole.clip is not None
    assert lips.clip is not None
    assert {part_of(name) for name in lips.clip.morph_weights} == {"mouth", None}
    for name, weights in lips.clip.morph_weights.items():
        np.testing.assert_array_equal(weights, whole.clip.morph_weights[name])
    assert any(name.startswith("brow") for name in whole.clip.morph_weights)
    assert [morph.name for morph in lips.meshes[0].morphs] == [morph.name for morph in whole.meshes[0].morphs]
    others = [at for at, bone in enumerate(lips.bones) if not bone.name.endswith("Eye")]
    np.testing.assert_array_equal(lips.clip.rotations_xyzw[:, others], whole.clip.rotations_xyzw[:, others])
    assert set(written_weights(whole.clip.morph_weights, ())) == {"chestExpand", "bellyExpand"}


@pytest.mark.parametrize("kind", ["bones", "shapes", "vrm"])
def test_a_gaze_left_to_a_capture_turns_no_bone(kind: str, tmp_path: Path) -> None:
    performance = Performance(quartet_project())
    player = performance.project.players[0]
    span = bars_span(performance, Fraction(30), (1, 2), 1)
    motion, character = player_motion(performance, player, span), character_of(player)
    if kind == "vrm":
        for part, keyed in (("gaze", True), ("mouth", False)):
            seen = motion if part == "gaze" else looking_ahead(character, motion)
            scene = humanoid_scene(character, seen, "p", "t", humanoid_target(character))
            write_vrma(tmp_path / "p.vrma", scene)
            model = read_glb(tmp_path / "p.vrma", animated=True)
            node = int(model.extensions["VRMC_vrm_animation"]["lookAt"]["node"])
            assert (node in {channel.node for channel in model.animations[0].channels}) == keyed
        return
    target = replace(normalised_target(character.skeleton), eyes=kind)
    for parts, still in ((FACE_PARTS, kind == "shapes"), (("mouth",), True)):
        scene = character_scene(character, motion, "p", "t", target, face_parts=parts)
        assert scene.clip is not None
        eyes = [at for at, bone in enumerate(scene.bones) if bone.name.endswith("Eye")]
        assert len(eyes) == 2
        assert (np.abs(scene.clip.rotations_xyzw[:, eyes, 3]) > 1.0 - 1e-6).all() == still


def test_the_command_reads_parts_and_says_which_there_are(capsys: pytest.CaptureFixture[str]) -> None:
    assert face_parts("Mouth, gaze") == ("gaze", "mouth")
    assert main(["export", "x.mid", "--to", "out", "--face-parts", "ears"]) == 2
    assert "brows, eyes, gaze, cheeks, nose, mouth" in capsys.readouterr().err


@pytest.mark.parametrize("kind", ["vrma", "bvh", "bvh,vrma"])
def test_names_for_formats_that_have_none_are_refused(kind: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", "x.mid", "--to", "out", "--format", kind, "--face-names", "metahuman"]) == 2
    assert "fbx, glb, usd" in capsys.readouterr().err
