"""Scenes are equal after writing and reading a file; contradictory ones are refused before anything is written."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from msgspec import structs

from app.errors import FileError
from app.formats.fbx.decode import read_elements
from app.formats.fbx.encode import Element, Property
from app.formats.fbx.read import decode_scene, read_scene
from app.formats.fbx.write import scene_elements, write_scene
from app.formats.joined_meshes import join_meshes
from app.formats.scene import Material, MorphTarget, Scene, SkinnedMesh
from tests.support.encoded import encode_elements, encode_scene
from tests.unit.formats import scenes


def _dense(mesh: SkinnedMesh, bones: int) -> np.ndarray:
    weights = np.zeros((len(mesh.vertices_cm), bones))
    for slot in range(mesh.weights.shape[1]):
        np.add.at(weights, (np.arange(len(weights)), mesh.joint_indices[:, slot]), mesh.weights[:, slot])
    return weights


def _surface(material: Material) -> np.ndarray:
    """Properties of a material that a Phong material can express: all except double-sidedness."""
    return np.array([*material.base_color, material.metallic, material.roughness])


def _assert_same_mesh(given: SkinnedMesh, found: SkinnedMesh, bones: int) -> None:
    corners = given.faces.ravel()
    np.testing.assert_array_equal(found.vertices_cm, given.vertices_cm)
    np.testing.assert_array_equal(found.faces, given.faces)
    np.testing.assert_array_equal(found.normals, given.normals[corners])
    if given.uvs is None:
        assert found.uvs is None
    else:
        assert found.uvs is not None
        np.testing.assert_array_equal(found.uvs, given.uvs[corners])
    for given_surface, found_surface in zip(given.materials, found.materials, strict=True):
        assert found_surface.name == given_surface.name
        np.testing.assert_allclose(_surface(found_surface), _surface(given_surface), atol=1e-9)
    face_materials = np.zeros(len(given.faces)) if given.face_materials is None else given.face_materials
    np.testing.assert_array_equal(found.face_materials, face_materials)
    np.testing.assert_allclose(_dense(found, bones), _dense(given, bones), atol=1e-15)
    assert np.abs(found.world_from_bone_bind - given.world_from_bone_bind).max() < 2e-3
    assert [morph.name for morph in found.morphs] == [morph.name for morph in given.morphs]
    for mine, theirs in zip(given.morphs, found.morphs, strict=True):
        np.testing.assert_array_equal(theirs.vertex_indices, mine.vertex_indices)
        np.testing.assert_array_equal(theirs.position_deltas_cm, mine.position_deltas_cm)


@pytest.mark.parametrize("make", [scenes.character, scenes.instrument])
@pytest.mark.parametrize("fps", [Fraction(60), Fraction(30000, 1001), Fraction(37, 2)], ids=str)
def test_a_scene_comes_back(make: object, fps: Fraction, tmp_path: Path) -> None:
    scene = make(fps)
    write_scene(tmp_path / "scene.fbx", scene)
    found = read_scene(tmp_path / "scene.fbx")
    assert found.creator == scene.creator
    assert [(bone.name, bone.parent) for bone in found.bones] == [(bone.name, bone.parent) for bone in scene.bones]
    for mine, theirs in zip(scene.bones, found.bones, strict=True):
        np.testing.assert_array_equal(theirs.translation_cm, mine.translation_cm)
        assert abs(abs(theirs.rotation_xyzw @ mine.rotation_xyzw) - 1) < 1e-14
    assert (found.clip.name, found.clip.fps, found.clip.frames) == (scene.clip.name, fps, scene.clip.frames)
    dots = np.einsum("fji,fji->fj", found.clip.rotations_xyzw, scene.clip.rotations_xyzw.astype(float))
    assert np.abs(np.abs(dots) - 1).max() < 1e-6
    assert found.clip.translations_cm.keys() == scene.clip.translations_cm.keys()
    for bone, values in scene.clip.translations_cm.items():
        np.testing.assert_allclose(found.clip.translations_cm[bone], values, rtol=1e-7, atol=1e-7)
    assert found.clip.morph_weights.keys() == scene.clip.morph_weights.keys()
    for name, weights in scene.clip.morph_weights.items():
        np.testing.assert_allclose(found.clip.morph_weights[name], weights, atol=1e-7)
    assert [mesh.name for mesh in found.meshes] == [mesh.name for mesh in scene.meshes]
    for mine_mesh, their_mesh in zip(scene.meshes, found.meshes, strict=True):
        _assert_same_mesh(mine_mesh, their_mesh, len(scene.bones))


def test_a_scene_without_mesh_or_clip_comes_back(tmp_path: Path) -> None:
    scene = Scene(scenes.character(Fraction(24)).bones)
    write_scene(tmp_path / "bones.fbx", scene)
    found = read_scene(tmp_path / "bones.fbx")
    assert [bone.name for bone in found.bones] == [bone.name for bone in scene.bones]
    assert found.clip is None
    assert found.meshes == ()


def test_the_same_scene_is_the_same_bytes() -> None:
    assert encode_scene(scenes.character(Fraction(25))) == encode_scene(scenes.character(Fraction(25)))


def test_weights_that_count_nothing_are_not_written_and_doubles_add_up() -> None:
    scene = scenes.instrument(Fraction(24))
    mesh = scene.meshes[0]
    joints = np.column_stack([mesh.joint_indices, mesh.joint_indices, (mesh.joint_indices + 1) % 5])
    weights = np.column_stack([0.25 * mesh.weights, 0.75 * mesh.weights, 0 * mesh.weights])
    found = decode_scene(
        encode_scene(replace(scene, meshes=(replace(mesh, joint_indices=joints, weights=weights),))), "x"
    )
    np.testing.assert_array_equal(found.meshes[0].joint_indices, mesh.joint_indices)
    np.testing.assert_array_equal(found.meshes[0].weights, mesh.weights)


def test_moving_bones_are_bound_beside_their_parents_axis_and_others_stay() -> None:
    scene = scenes.character(Fraction(24))
    given = scene.meshes[0].world_from_bone_bind
    found = decode_scene(encode_scene(scene), "x").meshes[0].world_from_bone_bind
    hips = [bone.name for bone in scene.bones].index("hips")
    moved = np.flatnonzero(np.abs(found - given).max(axis=(1, 2)) > 1e-12)
    assert moved.tolist() == [hips]
    assert 5e-4 <= np.linalg.norm(found[hips, :3, 3] - given[hips, :3, 3]) <= 2e-3


def _mesh(scene: Scene, **changes: object) -> Scene:
    return replace(scene, meshes=(replace(scene.meshes[0], **changes),))


def _clip(scene: Scene, **changes: object) -> Scene:
    assert scene.clip is not None
    return replace(scene, clip=replace(scene.clip, **changes))


GOOD = scenes.instrument(Fraction(24), frames=4)
MORPH = MorphTarget("a", np.array([0]), np.zeros((1, 3)))
CONTRADICTIONS = {
    "no bone": replace(GOOD, bones=()),
    "two roots": replace(GOOD, bones=(*GOOD.bones[:-1], replace(GOOD.bones[-1], parent=-1))),
    "a parent after its child": replace(GOOD, bones=(GOOD.bones[0], replace(GOOD.bones[1], parent=3), *GOOD.bones[2:])),
    "two bones of a name": replace(GOOD, bones=(*GOOD.bones[:-1], replace(GOOD.bones[-1], name="slide"))),
    "a mesh called like a bone": _mesh(GOOD, name="slide"),
    "faces beyond the vertices": _mesh(GOOD, faces=GOOD.meshes[0].faces + 1),
    "joints beyond the bones": _mesh(GOOD, joint_indices=GOOD.meshes[0].joint_indices + 1),
    "weights of another shape": _mesh(GOOD, weights=GOOD.meshes[0].weights[:-1]),
    "vertices without joints": _mesh(GOOD, weights=np.ones((1, 1)), joint_indices=np.zeros((1, 1), int)),
    "normals of another count": _mesh(GOOD, normals=GOOD.meshes[0].normals[:-1]),
    "a vertex nowhere": _mesh(GOOD, vertices_cm=GOOD.meshes[0].vertices_cm * np.nan),
    "no material": _mesh(GOOD, materials=()),
    "a material twice": _mesh(GOOD, materials=GOOD.meshes[0].materials * 2),
    "materials beyond the list": _mesh(GOOD, face_materials=np.ones(len(GOOD.meshes[0].faces), int)),
    "binds of other bones": _mesh(GOOD, world_from_bone_bind=np.zeros((2, 4, 4))),
    "two morphs of a name": _mesh(GOOD, morphs=(MORPH, MORPH)),
    "morphs beyond the vertices": _mesh(GOOD, morphs=(replace(MORPH, vertex_indices=np.array([999])),)),
    "deltas of another count": _mesh(GOOD, morphs=(replace(MORPH, position_deltas_cm=np.zeros((2, 3))),)),
    "no frame": _clip(GOOD, frames=0),
    "rotations of other bones": _clip(GOOD, rotations_xyzw=np.zeros((4, 2, 4))),
    "translations of no bone": _clip(GOOD, translations_cm={9: np.zeros((4, 3))}),
    "rotations without end": _clip(GOOD, rotations_xyzw=np.full((4, 5, 4), np.inf)),
    "weights of no morph": _clip(GOOD, morph_weights={"jawOpen": np.zeros(4)}),
    "time that stands still": _clip(GOOD, fps=Fraction(0)),
}


@pytest.mark.parametrize("name", CONTRADICTIONS)
def test_a_contradiction_is_refused_before_writing(name: str, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"."):
        write_scene(tmp_path / "scene.fbx", CONTRADICTIONS[name])
    assert not list(tmp_path.iterdir())


def test_two_bind_poses_are_refused() -> None:
    mesh = GOOD.meshes[0]
    other = replace(mesh, name="Other", world_from_bone_bind=mesh.world_from_bone_bind + 1)
    with pytest.raises(ValueError, match="another pose"):
        encode_scene(replace(GOOD, meshes=(mesh, other)))


# -------------------------------------------------------------------------------- what the reader would misunderstand


Change = Callable[[Element], Element]


def _changed(elements: Sequence[Element], path: Sequence[str], change: Change) -> tuple[Element, ...] | None:
    """Tree with `change` applied to the first record at a path; None if there is none."""
    for number, element in enumerate(elements):
        if element.name != path[0]:
            continue
        if len(path) == 1:
            return (*elements[:number], change(element), *elements[number + 1 :])
        children = _changed(element.children or (), path[1:], change)
        if children is not None:
            return (*elements[:number], structs.replace(element, children=children), *elements[number + 1 :])
    return None


def _with(*values: Property) -> Change:
    return lambda element: structs.replace(element, properties=values)


def _with_p(*rows: tuple[Property, ...]) -> Change:
    return lambda block: structs.replace(
        block, children=(*(block.children or ()), *(Element("P", values) for values in rows))
    )


MODEL = "Objects/Model/Properties70"
ROOT_ID, FIRST_CHILD_ID = np.int64(1000002), np.int64(1000004)
FRAME_TICKS = 1_924_423_250  # at 24 frames/s
TWO_SIZES = np.array([0, 1, -3, 0, 1, 2, -4], dtype=np.int32)
NOT_IN_FORCE = ("RotationActive", "bool", "", "", np.int32(0))
TURNED = ("PreRotation", "Vector3D", "Vector", "", 0.0, 90.0, 0.0)
ODD = {
    "a post-rotation": (MODEL, _with_p(("PostRotation", "V", "", "", 0.0, 90.0, 0.0)), "unsupported"),
    "a pre-rotation of two numbers": (MODEL, _with_p(("PreRotation", "V", "", "", 0.0, 90.0)), "unsupported"),
    "a pre-rotation that is not in force": (MODEL, _with_p(NOT_IN_FORCE, TURNED), "unsupported"),
    "an unknown rotation order": (MODEL, _with_p(("RotationOrder", "enum", "", "", np.int32(6))), "unsupported"),
    "a scale": (MODEL, _with_p(("Lcl Scaling", "L", "", "", 1.0, 2.0, 1.0)), "unsupported"),
    "a place of two numbers": (MODEL, _with_p(("Lcl Translation", "L", "", "", 1.0, 2.0)), "missing"),
    "too few vertices": ("Objects/Geometry/Vertices", _with(np.zeros(3)), "contradiction"),
    "a third of a vertex": ("Objects/Geometry/Vertices", _with(np.zeros(4)), "contradiction"),
    "vertices of text": ("Objects/Geometry/Vertices", _with("text"), "missing"),
    "polygons of two sizes": ("Objects/Geometry/PolygonVertexIndex", _with(TWO_SIZES), "unsupported"),
    "an object without a name": ("Objects/Geometry", _with(np.int64(1)), "missing"),
    "keys between frames": ("Objects/AnimationCurve/KeyTime", _with(np.arange(4)), "unsupported"),
    "keys beyond the end": ("Objects/AnimationCurve/KeyTime", _with(np.arange(4) * 2 * FRAME_TICKS), "unsupported"),
    "keys in disorder": ("Objects/AnimationCurve/KeyTime", _with(FRAME_TICKS * np.array([0, 2, 1, 3])), "unsupported"),
    "keys that are steps": ("Objects/AnimationCurve/KeyAttrFlags", _with(np.array([2], np.int32)), "unsupported"),
    "a missing key": ("Objects/AnimationCurve/KeyValueFloat", _with(np.zeros(3, np.float32)), "contradiction"),
    "a bone that is its own grandchild": ("Connections/C", _with("OO", ROOT_ID, FIRST_CHILD_ID), "contradiction"),
    "a connection without ends": ("Connections/C", _with("OO"), "missing"),
    "no objects": ("Objects", lambda element: structs.replace(element, name="Other"), "missing"),
    "no frame rate": ("GlobalSettings/Properties70", lambda element: structs.replace(element, children=()), "missing"),
}


@pytest.mark.parametrize("name", ODD)
def test_what_the_reader_does_not_understand_it_refuses(name: str) -> None:
    path, change, problem = ODD[name]
    elements = read_elements(encode_elements(scene_elements((GOOD,))), "x").children or ()
    odd = _changed(elements, path.split("/"), change)
    assert odd is not None
    with pytest.raises(FileError) as raised:
        decode_scene(encode_elements(odd), "odd.fbx")
    assert raised.value.message.id == f"fbx.{problem}"
    assert raised.value.message.arguments["file"] == "odd.fbx"


def test_a_missing_file_is_an_error_a_user_can_act_on(tmp_path: Path) -> None:
    with pytest.raises(FileError) as raised:
        read_scene(tmp_path / "missing.fbx")
    assert raised.value.message.id == "file.cannot_read"


# ------------------------------------------------------------------------------------------------------------ joining


def test_joined_meshes_are_the_meshes() -> None:
    scene = scenes.character(Fraction(24))
    joined = join_meshes(scene.meshes, "All")
    both = decode_scene(encode_scene(replace(scene, meshes=(joined,))), "x").meshes[0]
    _assert_same_mesh(joined, both, len(scene.bones))
    start, face = 0, 0
    dense = _dense(joined, len(scene.bones))
    for mesh in scene.meshes:
        rows = slice(start, start + len(mesh.vertices_cm))
        faces = slice(face, face + len(mesh.faces))
        np.testing.assert_array_equal(joined.vertices_cm[rows], mesh.vertices_cm)
        np.testing.assert_array_equal(joined.normals[rows], mesh.normals)
        np.testing.assert_array_equal(joined.faces[faces] - start, mesh.faces)
        np.testing.assert_allclose(dense[rows], _dense(mesh, len(scene.bones)), atol=1e-15)
        assert mesh.face_materials is not None
        assert [joined.materials[m] for m in joined.face_materials[faces]] == [
            mesh.materials[m] for m in mesh.face_materials
        ]
        moved = {morph.name: np.zeros_like(joined.vertices_cm) for morph in joined.morphs}
        for morph in joined.morphs:
            moved[morph.name][morph.vertex_indices] = morph.position_deltas_cm
        for morph in mesh.morphs:
            np.testing.assert_array_equal(moved[morph.name][start + morph.vertex_indices], morph.position_deltas_cm)
        start, face = rows.stop, faces.stop
    assert sorted(morph.name for morph in joined.morphs) == ["browInnerUp", "jawOpen"]


def test_joining_shares_materials_and_fills_in_uvs_and_normals() -> None:
    mesh = scenes.character(Fraction(24)).meshes[1]
    assert mesh.uvs is not None
    corners = mesh.faces.ravel()
    plain = replace(mesh, name="plain", uvs=None, normals=mesh.normals[corners], face_materials=None,
                    materials=(mesh.materials[1],))  # fmt: skip
    joined = join_meshes([mesh, plain], "Both")
    assert joined.materials == mesh.materials
    assert set(joined.face_materials[len(mesh.faces) :].tolist()) == {1}
    np.testing.assert_array_equal(joined.normals, np.concatenate([mesh.normals[corners]] * 2))
    assert joined.uvs is not None
    np.testing.assert_array_equal(joined.uvs, np.concatenate([mesh.uvs, np.zeros_like(mesh.uvs)]))
    none = join_meshes([plain, replace(plain, materials=(Material("b", (0, 0, 0, 1)),))], "None")
    assert none.uvs is None


def test_few_keys_may_not_claim_to_be_a_clip_of_days() -> None:
    elements = scene_elements((GOOD,))

    def later(element: Element) -> Element:
        if element.name == "P" and element.properties[0] == "LocalStop":
            return structs.replace(element, properties=(*element.properties[:4], np.int64(2**62)))
        children = element.children
        changed = tuple(later(child) for child in children or ())
        return element if children is None else structs.replace(element, children=changed)

    with pytest.raises(FileError) as raised:
        decode_scene(encode_elements(tuple(later(element) for element in elements)), "odd.fbx")
    assert raised.value.message.id == "fbx.unsupported"
