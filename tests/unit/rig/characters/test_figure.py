"""Characters converted to the form of other programs are read back unchanged, for any bones, rest pose, unit and
format.
"""

import contextlib
import io
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from PIL import Image
from scipy.spatial.transform import Rotation

from app.errors import FileError
from app.formats.texture_colors import plain_material
from app.formats.textures import NO_TEXTURES
from app.rig import quaternion
from app.rig.characters import figure_build
from app.rig.characters.character_library import character_named
from app.rig.characters.figure_build import at_height, figure_height, has_odd_height, unit_factor
from app.rig.characters.figure_to_character import figure_character
from app.rig.characters.landmarks import found_landmarks
from app.rig.characters.load_character import load_character, read_character
from app.rig.characters.read_figure import read_figure
from app.rig.characters.t_pose import rest_of, turned_figure
from app.rig.figure import Figure
from app.rig.mesh import Mesh
from app.rig.model import Character
from app.rig.skeleton import forward, rest_positions
from app.rig.skinning import patch
from metadata.load import load_skeleton
from metadata.model import REQUIRED_JOINTS
from tests.support.deformed import deform
from tests.support.estranged import Foreign, foreign, still, write_fbx, write_glb

CLOSE_M = 1e-4


@pytest.fixture(scope="module")
def ours() -> Character:
    """Bundled character with few meshes, for speed."""
    whole = character_named("man_adult")
    kept = tuple(mesh for mesh in whole.meshes if mesh.name in ("body", "teeth", "shoes"))
    return replace(whole, meshes=kept)


def mapped(figure: Figure, made: Foreign) -> dict[str, int]:
    return {joint: figure.bone_names.index(made.names[bone]) for joint, bone in made.joints.items()}


def made_again(figure: Figure, made: Foreign) -> Character:
    faces = {name: {name: 1.0} for name in figure.morph_names}
    return figure_character(figure, "again", mapped(figure, made), faces)


def assert_same_body(again: Character, ours: Character, pose: np.ndarray, blended: bool = True) -> None:
    """Check that joints at rest and skin in a pose equal the original's; unless ``blended`` only skin with a single
    joint.
    """
    rest, known = rest_positions(again.skeleton), rest_positions(ours.skeleton)
    for name in ours.skeleton.names:
        off = np.linalg.norm(rest[again.skeleton.index(name)] - known[ours.skeleton.index(name)])
        assert off < CLOSE_M, name
    order = [ours.skeleton.index(name) for name in again.skeleton.names]
    for mesh in ours.meshes:
        other = next(mesh_again for mesh_again in again.meshes if mesh.name in mesh_again.name)
        places = deform(patch(ours, mesh, np.arange(len(mesh.positions_m))), forward(ours.skeleton, pose))[0]
        found = deform(patch(again, other, np.arange(len(other.positions_m))), forward(again.skeleton, pose[:, order]))
        assert len(places) == len(found[0])
        kept = np.ones(len(places), bool) if blended else mesh.weights.max(axis=1) > 1.0 - 1e-6
        assert np.linalg.norm(found[0] - places, axis=1)[kept].max() < CLOSE_M, mesh.name


def some_pose(ours: Character, seed: int = 3, size: float = 0.3) -> np.ndarray:
    generator = np.random.default_rng(seed)
    return quaternion.from_rotation_vector(generator.normal(size=(1, len(ours.skeleton.names), 3)) * size)


def rest_pose(ours: Character, down: float, forth: float, elbow: float, curl: float, apart: float) -> np.ndarray:
    """A-pose in degrees: arms lowered and forward, elbows and fingers bent, legs apart on level feet."""
    profile, pose = load_skeleton(), still(ours)

    def bend(name: str, flexion: float, sideways: float = 0.0) -> None:
        axes = profile.joint_axes(name)
        vector = np.radians(flexion) * np.array(axes.flexion) + np.radians(sideways) * np.array(axes.sideways)
        pose[0, ours.skeleton.index(name)] = quaternion.from_rotation_vector(vector)

    for side in ("left", "right"):
        bend(side + "UpperArm", forth, -down)
        bend(side + "LowerArm", elbow)
        for finger in ("Index", "Middle", "Ring", "Little"):
            for phalanx in ("Proximal", "Intermediate", "Distal"):
                bend(side + finger + phalanx, curl)
        for phalanx in ("Proximal", "Distal"):
            bend(f"{side}Thumb{phalanx}", curl / 2)
        bend(side + "UpperLeg", 0.0, apart)
        foot = ours.skeleton.index(side + "Foot")
        pose[0, foot] = quaternion.conjugate(pose[0, ours.skeleton.index(side + "UpperLeg")])
    return pose


@pytest.mark.parametrize("scale", [1.0, 0.01, 100.0])
@pytest.mark.parametrize("vrm", [None, 0, 1])
def test_a_gltf_figure_is_what_it_was_made_from(ours: Character, tmp_path: Path, vrm: int | None, scale: float) -> None:
    made = foreign(ours)
    figure = read_figure(write_glb(tmp_path / "x.glb", made, vrm=vrm, scale=scale))
    assert figure.origin == {None: "gltf", 0: "vrm0", 1: "vrm1"}[vrm]
    assert not figure.notes
    assert set(made.names) <= set(figure.bone_names)
    if vrm is not None:
        assert figure.humanoid == mapped(figure, made)
    again = made_again(figure, made)
    assert_same_body(again, ours, still(ours))
    assert_same_body(again, ours, some_pose(ours))
    assert set(again.landmarks) >= set(ours.landmarks)


def test_an_fbx_figure_is_what_it_was_made_from(ours: Character, tmp_path: Path) -> None:
    made = foreign(ours)
    figure = read_figure(write_fbx(tmp_path / "x.fbx", made))
    assert figure.origin == "fbx"
    again = made_again(figure, made)
    rest, known = rest_positions(again.skeleton), rest_positions(ours.skeleton)
    order = [ours.skeleton.index(name) for name in again.skeleton.names]
    np.testing.assert_allclose(rest, known[order], atol=CLOSE_M)
    # Vertices are split where normals part: each of ours has one in the same place.
    pose = some_pose(ours)
    for mesh in ours.meshes:
        other = next(entry for entry in again.meshes if entry.name == f"{mesh.name}_mesh")
        assert {morph.name for morph in other.morphs} == {morph.name for morph in mesh.morphs}
        places = deform(patch(ours, mesh, np.arange(len(mesh.positions_m))), forward(ours.skeleton, pose))[0]
        found = deform(patch(again, other, np.arange(len(other.positions_m))), forward(again.skeleton, pose[:, order]))[
            0
        ]
        used = np.unique(mesh.triangles)
        off = np.array([np.linalg.norm(found - place, axis=1).min() for place in places[used[::7]]])
        assert off.max() < CLOSE_M


@given(
    down=st.floats(0.0, 85.0),
    forth=st.floats(-10.0, 25.0),
    elbow=st.floats(0.0, 50.0),
    curl=st.floats(0.0, 35.0),
    apart=st.floats(0.0, 15.0),
    seed=st.integers(0, 1000),
)
@settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_any_rest_pose_becomes_the_t_pose(
    ours: Character,
    tmp_path: Path,
    down: float,
    forth: float,
    elbow: float,
    curl: float,
    apart: float,
    seed: int,
) -> None:
    bare = replace(ours, meshes=tuple(replace(mesh, morphs=()) for mesh in ours.meshes))
    made = foreign(bare, rest_pose(ours, down, forth, elbow, curl, apart), seed)
    figure = read_figure(write_glb(tmp_path / "x.glb", made))
    again = made_again(figure, made)
    assert_same_body(again, bare, still(ours), blended=False)
    assert_same_body(again, bare, some_pose(ours, seed), blended=False)


def test_rotations_of_the_bones_follow_from_those_of_the_joints(ours: Character, tmp_path: Path) -> None:
    made = foreign(ours, rest_pose(ours, 40.0, 5.0, 15.0, 10.0, 8.0))
    again = made_again(read_figure(write_glb(tmp_path / "x.glb", made, scale=0.01)), made)
    own = again.own
    assert own is not None
    pose = some_pose(again)
    world = forward(again.skeleton, pose)
    # Bones turned as their joints say, everything else at rest in its parent, put every bone where its joint is.
    bone_of = {bone: joint for joint, bone in enumerate(own.bone_of_joint) if bone >= 0}
    turns, places = own.figure.rotations.copy(), own.figure.translations_m.copy()
    for bone, parent in enumerate(own.figure.parents):
        above = turns[parent] if parent >= 0 else quaternion.IDENTITY
        before = places[parent] if parent >= 0 else np.zeros(3)
        places[bone] = before + quaternion.rotate(above, own.figure.translations_m[bone])
        turns[bone] = quaternion.multiply(above, own.figure.rotations[bone])
        if bone in bone_of:
            joint = bone_of[bone]
            turns[bone] = quaternion.multiply(world.rotations[0, joint], own.joint_from_bone[joint])
            if again.skeleton.names[joint] == "hips":
                places[bone] = world.positions_m[0, joint]
            assert np.linalg.norm(places[bone] - world.positions_m[0, joint]) < CLOSE_M, again.skeleton.names[joint]


@pytest.mark.parametrize(
    "missing",
    [
        ("upperChest",),
        ("chest", "upperChest"),
        ("chest",),
        ("neck",),
        ("leftShoulder", "rightShoulder"),
        ("leftToes", "rightToes", "leftEye", "rightEye"),
        ("leftIndexIntermediate", "leftThumbMetacarpal", "rightRingProximal"),
        tuple(
            f"{side}{finger}{phalanx}"
            for side in ("left", "right")
            for finger in ("Index", "Middle", "Ring", "Little", "Thumb")
            for phalanx in ("Metacarpal", "Proximal", "Intermediate", "Distal")
        ),
    ],
)
def test_what_is_missing_is_supplied_so_that_the_bones_can_follow_exactly(
    ours: Character, tmp_path: Path, missing: tuple[str, ...]
) -> None:
    made = foreign(ours, extra=False)
    figure = read_figure(write_glb(tmp_path / "x.glb", made))
    bones = {name: bone for name, bone in mapped(figure, made).items() if name not in missing}
    again = figure_character(figure, "again", bones, {})
    skeleton, own = again.skeleton, again.own
    assert own is not None
    profile = [joint.name for joint in load_skeleton().joints if joint.name != "jaw"]
    assert list(skeleton.names) == profile
    assert np.isfinite(skeleton.offsets_m).all()
    assert sorted(bone for bone in own.bone_of_joint if bone >= 0) == sorted(bones.values())
    assert skeleton.parents[skeleton.index("hips")] == 0
    assert [joint for joint, parent in enumerate(skeleton.parents) if parent == 0] == [skeleton.index("hips")]
    # The figure's own bones, turned by the joints, lie where the joints are.
    world = forward(skeleton, some_pose(again))
    bone_of = {bone: joint for joint, bone in enumerate(own.bone_of_joint) if bone >= 0}
    turns, places = figure.rotations.copy(), figure.translations_m.copy()
    for bone, parent in enumerate(figure.parents):
        above = turns[parent] if parent >= 0 else quaternion.IDENTITY
        before = places[parent] if parent >= 0 else np.zeros(3)
        places[bone] = before + quaternion.rotate(above, figure.translations_m[bone])
        turns[bone] = quaternion.multiply(above, figure.rotations[bone])
        joint = bone_of.get(bone)
        if joint is None:
            continue
        turns[bone] = quaternion.multiply(world.rotations[0, joint], own.joint_from_bone[joint])
        if skeleton.names[joint] == "hips":
            places[bone] = world.positions_m[0, joint]
        # A finger's bone whose parent has no name is still a descendant of the hand.
        assert np.linalg.norm(places[bone] - world.positions_m[0, joint]) < CLOSE_M, skeleton.names[joint]
    supplied = rest_positions(skeleton)
    known = rest_positions(ours.skeleton)
    for name in missing:
        if name in skeleton.names and name.endswith(
            ("Proximal", "Intermediate", "Distal", "Metacarpal", "Eye", "Toes")
        ):
            off = supplied[skeleton.index(name)] - known[ours.skeleton.index(name)]
            # The tolerance is the distance to the next joint if the joint is placed there: a thumb's
            # metacarpal of 45 mm.
            assert np.linalg.norm(off) < (0.046 if len(missing) == 3 else 0.02), name
    marks = found_landmarks(skeleton, again.joint_from_mesh, again.meshes)
    assert {"left.index.pad", "left.index.pad_proximal", "left.palm", "left.foot.sole"} <= set(marks) or len(
        missing
    ) > 9


@pytest.mark.parametrize("scale", [1.0, 0.01])
def test_parts_that_hang_from_bones_without_a_skin_go_with_them(ours: Character, tmp_path: Path, scale: float) -> None:
    made = foreign(ours, extra=False)
    figure = read_figure(write_glb(tmp_path / "x.glb", made, vrm=1, scale=scale, rigid=True))
    assert len(figure.bone_names) == len(made.names) + 1
    again = figure_character(figure, "again", figure.humanoid, {})
    pose = some_pose(ours)
    order = [ours.skeleton.index(name) for name in again.skeleton.names]
    body = next(mesh for mesh in ours.meshes if mesh.name == "body")
    known = deform(patch(ours, body, np.arange(len(body.positions_m))), forward(ours.skeleton, pose))[0]
    hand = ours.skeleton.index("leftHand")
    piece = next(mesh for mesh in again.meshes if mesh.name == f"body_{hand}")
    held = np.where(body.joints == hand, body.weights, 0.0).sum(axis=1) > 1.0 - 1e-6
    found = deform(patch(again, piece, np.arange(len(piece.positions_m))), forward(again.skeleton, pose[:, order]))[0]
    assert held.sum() > 20
    assert np.linalg.norm(found - known, axis=1)[held].max() < CLOSE_M


def test_what_no_character_has_is_refused(ours: Character, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write_glb(tmp_path / "x.glb", foreign(ours))
    for limit in ("MOST_BONES", "MOST_VERTICES"):
        with monkeypatch.context() as patched:
            patched.setattr(figure_build, limit, 10)
            with pytest.raises(FileError, match="too_large"):
                read_figure(path)
    monkeypatch.setattr("app.formats.gltf.self_contained.MOST_BYTES", 10)
    with pytest.raises(FileError, match="too_large"):
        read_figure(path)


def test_a_reader_that_dies_is_an_error_of_the_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "x.fbx"
    path.write_bytes(b"Kaydara FBX Binary  \0")
    monkeypatch.setattr("app.formats.fbx.foreign.read_by_child", lambda *args: (-11, b""))
    with pytest.raises(FileError, match="foreign_damaged"):
        read_figure(path)


def png(pixels: np.ndarray) -> bytes:
    stream = io.BytesIO()
    Image.fromarray(pixels).save(stream, "PNG")
    return stream.getvalue()


def plain_green(mesh: Mesh) -> float:
    return plain_material(mesh.materials[0], mesh.uvs).base_color[1]


def test_a_textured_surface_keeps_its_texture_and_has_its_mean_colour_without(ours: Character, tmp_path: Path) -> None:
    made = foreign(ours, extra=False)
    green = np.zeros((8, 8, 4), np.uint8)
    green[..., 1] = green[..., 3] = 255
    figure = read_figure(write_glb(tmp_path / "x.glb", made, image=png(green)))
    # The material's own factors, 0.5, 0.4 and 0.3, are multiplied in.
    for mesh in figure.meshes:
        for surface in mesh.materials:
            assert surface.textures.color is not None
            assert surface.textures.color.texture.content.startswith(png(green))
            assert surface.base_color == pytest.approx((0.5, 0.4, 0.3, 1.0))
            assert plain_material(surface, mesh.uvs).base_color == pytest.approx((0.0, 0.4, 0.0, 1.0))
    # sRGB 188 is linear 0.5; transparent pixels have no colour.
    green[:, :, 1] = 188
    half = replace(made, meshes=[replace(mesh, uvs=np.full_like(mesh.uvs, 0.3)) for mesh in made.meshes])
    green[4:] = 0
    figure = read_figure(write_glb(tmp_path / "y.glb", half, image=png(green), alpha="MASK"))
    assert plain_green(figure.meshes[0]) == pytest.approx(0.4 * 0.5, abs=2e-3)


@pytest.mark.parametrize(
    "image", [b"no image", png(np.random.default_rng(1).integers(0, 255, (40, 40, 4), np.uint8))[:-900]]
)
def test_a_texture_that_cannot_be_read_leaves_the_surface_its_own_colour(
    ours: Character, tmp_path: Path, image: bytes
) -> None:
    figure = read_figure(write_glb(tmp_path / "x.glb", foreign(ours, extra=False), image=image))
    surface = figure.meshes[0].materials[0]
    assert surface.textures == NO_TEXTURES
    assert surface.base_color == pytest.approx((0.5, 0.4, 0.3, 1.0))


def test_every_required_joint_is_asked_for_by_name(ours: Character, tmp_path: Path) -> None:
    made = foreign(ours)
    figure = read_figure(write_glb(tmp_path / "x.glb", made))
    bones = mapped(figure, made)
    for name in REQUIRED_JOINTS:
        with pytest.raises(FileError, match=name):
            figure_character(figure, "x", {joint: bone for joint, bone in bones.items() if joint != name}, {})


LEAN, KNEE = (-0.254, 0.12, -0.066, 0.957), (0.5, 0.0, 0.0, 0.866)
"""Rotations of a root joint and a knee in a jump."""


def test_a_figure_whose_file_shows_a_jump_stands_as_it_was_bound(ours: Character, tmp_path: Path) -> None:
    """The root joint leans by 34 degrees in the nodes, and a knee is bent; the skin was bound upright."""
    made = foreign(ours)
    path = write_glb(tmp_path / "x.glb", made)
    bound = rest_of(read_figure(path))
    content = path.read_bytes()
    size = int.from_bytes(content[12:16], "little")
    document = json.loads(content[20 : 20 + size])
    nodes, joints = document["nodes"], document["skins"][0]["joints"]
    below = {child for joint in joints for child in nodes[joint].get("children", ())}
    knee = next(node for node in nodes if node.get("name") == made.names[made.joints["leftLowerLeg"]])
    for node, bend in ((nodes[next(one for one in joints if one not in below)], LEAN), (knee, KNEE)):
        turn = quaternion.multiply(np.array(node.get("rotation", [0.0, 0.0, 0.0, 1.0])), np.array(bend))
        node["rotation"] = (turn / np.linalg.norm(turn)).tolist()
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    whole = content[:8] + (20 + len(text) + len(content) - 20 - size).to_bytes(4, "little")
    path.write_bytes(whole + len(text).to_bytes(4, "little") + b"JSON" + text + content[20 + size :])
    jumping = rest_of(read_figure(path))
    off_m = jumping.positions_m - bound.positions_m
    assert np.ptp(off_m, axis=0).max() < 1e-3


@pytest.mark.parametrize("turn", [(0, 180, 0), (0, 90, 0), (90, 0, 0), (-90, 0, 180), (0, 37, 0)])
def test_a_lying_or_turned_figure_is_stood_up(
    ours: Character, tmp_path: Path, turn: tuple[float, float, float]
) -> None:
    made = foreign(ours)
    figure = read_figure(write_glb(tmp_path / "x.glb", made))
    aside = turned_figure(figure, Rotation.from_euler("xyz", turn, degrees=True).as_matrix())
    again = made_again(aside, made)
    # A figure with a facing other than a right angle is rotated according to its body, exact to a degree.
    if turn[1] % 90 == 0:
        assert_same_body(again, ours, some_pose(ours))
    else:
        off = rest_positions(again.skeleton) - rest_positions(made_again(figure, made).skeleton)
        assert np.abs(off).max() < 0.03


def mixamo(name: str) -> str:
    side = next((side for side in ("left", "right") if name.startswith(side)), "")
    part = name[len(side) :]
    known = {"spine": "Spine", "chest": "Spine1", "upperChest": "Spine2", "UpperArm": "Arm", "LowerArm": "ForeArm"}
    known |= {"UpperLeg": "UpLeg", "LowerLeg": "Leg", "Toes": "ToeBase"}
    if finger := next((f for f in ("Thumb", "Index", "Middle", "Ring", "Little") if part.startswith(f)), ""):
        phalanges = (
            ("Metacarpal", "Proximal", "Distal") if finger == "Thumb" else ("Proximal", "Intermediate", "Distal")
        )
        part = f"Hand{finger.replace('Little', 'Pinky')}{phalanges.index(part[len(finger) :]) + 1}"
    return f"mixamorig:{side.capitalize()}{known.get(part, part[:1].upper() + part[1:])}"


def test_a_figure_that_faces_away_is_turned_and_keeps_its_sides(ours: Character, tmp_path: Path) -> None:
    made = foreign(ours, rename=mixamo)
    about = np.diag([-1.0, 1.0, -1.0, 1.0])
    turned = [
        replace(
            mesh,
            positions_m=(mesh.positions_m * np.float32([-1, 1, -1])),
            morphs=tuple(replace(m, deltas_m=m.deltas_m * np.float32([-1, 1, -1])) for m in mesh.morphs),
        )
        for mesh in made.meshes
    ]
    path = write_glb(tmp_path / "away.glb", replace(made, world=about @ made.world, meshes=turned))
    reading = read_character(path)
    assert reading.figure.bone_names[reading.joints.bones["leftHand"]] == "mixamorig:LeftHand"
    assert not reading.joints.doubtful
    assert_same_body(load_character(path), ours, some_pose(ours))


def test_expressions_of_vrm0_get_the_names_of_vrm1(ours: Character, tmp_path: Path) -> None:
    made = foreign(ours)
    faces = {"a": {"jawOpen": 0.8}, "blink_l": {"eyeBlinkLeft": 1.0}, "joy": {"mouthSmileLeft": 0.5}}
    figure = read_figure(write_glb(tmp_path / "x.glb", made, vrm=0, expressions=faces))
    assert set(figure.expressions) == {"aa", "blinkLeft", "happy"}
    assert figure.expressions["aa"] == pytest.approx({"jawOpen": 0.8})


def test_morphs_are_composed_from_the_figures_own(ours: Character, tmp_path: Path) -> None:
    made = foreign(ours, extra=False)
    figure = read_figure(write_glb(tmp_path / "x.glb", made))
    recipe = {"jawOpen": {"jawOpen": 0.5, "mouthFunnel": 0.25}, "tongueOut": {"no such morph": 1.0}}
    again = figure_character(figure, "again", mapped(figure, made), recipe)
    body = next(mesh for mesh in again.meshes if mesh.name == "body")
    assert [morph.name for morph in body.morphs] == ["jawOpen"]
    whole = np.zeros((len(body.positions_m), 3))
    for name, weight in recipe["jawOpen"].items():
        morph = next(m for mesh in ours.meshes if mesh.name == "body" for m in mesh.morphs if m.name == name)
        whole[morph.vertices] += weight * morph.deltas_m
    found = np.zeros_like(whole)
    found[body.morphs[0].vertices] = body.morphs[0].deltas_m
    np.testing.assert_allclose(found, whole, atol=1e-6)
    assert again.own.morphs == recipe


@pytest.mark.parametrize(
    ("height_m", "factor"),
    [(0.0017, 1e3), (170.0, 0.01), (17.5, 0.1), (68.0, 0.0254), (1700.0, 1e-3), (5.0, None), (0.0, None), (30.0, None)],
)
def test_a_unit_is_corrected_where_only_one_explains_the_height(height_m: float, factor: float | None) -> None:
    assert unit_factor(height_m) == factor


@pytest.mark.parametrize("times", [100.0, 0.001])
def test_a_figure_of_a_wrong_unit_is_reported_and_corrected(ours: Character, tmp_path: Path, times: float) -> None:
    made = foreign(ours)
    world = made.world.copy()
    world[:, :3, 3] *= times
    meshes = [replace(mesh, positions_m=mesh.positions_m * np.float32(times)) for mesh in made.meshes]
    figure = read_figure(write_glb(tmp_path / "x.glb", replace(made, world=world, meshes=meshes)))
    assert [note.id for note in figure.notes] == ["figure.scaled"]
    again = made_again(figure, made)
    order = [ours.skeleton.index(name) for name in again.skeleton.names]
    np.testing.assert_allclose(rest_positions(again.skeleton), rest_positions(ours.skeleton)[order], atol=CLOSE_M)


@pytest.mark.parametrize(("times", "odd"), [(0.5, False), (1.3, False), (1.8, True), (2.8, True)])
def test_a_figure_taller_than_any_person_is_taken_as_it_is_and_that_is_said(
    ours: Character, tmp_path: Path, times: float, odd: bool
) -> None:
    made = foreign(ours)
    world = made.world.copy()
    world[:, :3, 3] *= times
    meshes = [replace(mesh, positions_m=mesh.positions_m * np.float32(times)) for mesh in made.meshes]
    figure = read_figure(write_glb(tmp_path / "x.glb", replace(made, world=world, meshes=meshes)))
    heights = np.concatenate([mesh.positions_m[:, 1] for mesh in made.meshes])
    assert figure_height(figure) == pytest.approx(times * np.ptp(heights), rel=1e-3)
    assert has_odd_height(figure) is odd
    assert figure.notes == () or odd
    assert not has_odd_height(at_height(figure, 1.7))


def test_weights_that_are_no_numbers_are_none_and_that_is_said(ours: Character, tmp_path: Path) -> None:
    """Some exporters divide 0 by 0 for vertices without bones; the character is accepted with a warning."""
    made = foreign(ours)
    name, weights = made.meshes[0].name, made.meshes[0].weights.copy()
    weights[:5] = np.nan
    figure = read_figure(
        write_glb(tmp_path / "x.glb", replace(made, meshes=[replace(made.meshes[0], weights=weights)]))
    )
    (note,) = figure.notes
    assert (note.id, note.arguments["mesh"], note.arguments["count"]) == ("figure.unheld", name, 5)
    (mesh,) = figure.meshes
    assert np.isfinite(mesh.positions_m).all()
    np.testing.assert_allclose(mesh.weights.sum(axis=1), 1.0, atol=1e-3)
    assert {int(bone) for bone in mesh.joints[:5, 0]} == {int(mesh.joints.min())}


@pytest.mark.parametrize("kind", ["glb", "fbx"])
def test_damage_is_a_file_error(ours: Character, tmp_path: Path, kind: str) -> None:
    small = replace(ours, meshes=tuple(replace(mesh, morphs=()) for mesh in ours.meshes if mesh.name == "teeth"))
    path = tmp_path / f"x.{kind}"
    (write_fbx if kind == "fbx" else write_glb)(path, foreign(small))
    whole = path.read_bytes()
    generator = np.random.default_rng(5)
    for number in range(12 if kind == "fbx" else 80):
        data = bytearray(whole if number % 3 else whole[: int(generator.integers(0, len(whole)))])
        for place in generator.integers(0, max(min(len(data), 4000), 1), size=6):
            if data:
                data[place] = int(generator.integers(0, 256))
        path.write_bytes(data)
        with contextlib.suppress(FileError):
            read_figure(path)
    with pytest.raises(FileError):
        read_figure(tmp_path / f"absent.{kind}")
    path.write_bytes(b"")
    with pytest.raises(FileError):
        read_figure(path)
    (tmp_path / "x.txt").write_text("nothing")
    with pytest.raises(FileError):
        read_figure(tmp_path / "x.txt")
