"""Several figures in one file, each at its place, as read by the program's reader and by other programs."""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pygltflib
import pytest
from scipy.spatial.transform import Rotation

from app.errors import FileError
from app.formats.fbx.read import read_scene, read_scenes
from app.formats.fbx.write import write_scenes
from app.formats.gltf.read import read_glb
from app.formats.gltf.write import write_glbs
from app.formats.scene import Material, NodePlace, Scene
from app.formats.usd import write_usds
from tests.support.readers import QUICK_FBX, QUICK_GLB, QUICK_USD, SLOW_FBX, SLOW_GLB, Expected, installed, judge
from tests.unit.export.scenes import slow_positions_m
from tests.unit.formats import scenes

pytestmark = pytest.mark.slow

FPS = Fraction(30)
FRAMES = 13
WRITERS: dict[str, Callable[[Path, tuple[Scene, ...]], None]] = {
    "fbx": write_scenes,
    "glb": write_glbs,
    "usdc": write_usds,
}
BRASS = Material("brass", (0.83, 0.56, 0.19, 1.0), 1.0, 0.2)
SKIN = Material("skin", (0.6, 0.3, 0.2, 1.0), 0.0, 0.55)


def stage() -> tuple[Scene, ...]:
    """A character and its instrument at one place and another character elsewhere. Bones have different names, so that
    readers which know names only can say where each is; all have one clip and share a material."""
    here, there = _place(-148.5, -39.8, 37.5), _place(65.0, -139.4, -100.0)
    player, held = scenes.character(FPS, FRAMES), scenes.instrument(FPS, FRAMES)
    meshes = tuple(replace(mesh, materials=(SKIN, BRASS)) for mesh in player.meshes)
    return (
        _figure(replace(player, meshes=meshes), "Ana 1", "", here),
        _figure(replace(held, meshes=(replace(held.meshes[0], materials=(BRASS,)),)), "Ana 1_horn", "held_", here),
        _figure(replace(player, meshes=meshes[:1]), "Beat", "other_", there),
    )


def _place(x_cm: float, z_cm: float, turn_deg: float) -> NodePlace:
    return NodePlace(np.array([x_cm, 0.0, z_cm]), Rotation.from_euler("y", turn_deg, degrees=True).as_quat())


def _figure(scene: Scene, name: str, prefix: str, place: NodePlace) -> Scene:
    bones = tuple(replace(bone, name=prefix + bone.name) for bone in scene.bones)
    meshes = tuple(replace(mesh, name=f"{name}_{mesh.name}") for mesh in scene.meshes)
    clip = scene.clip
    assert clip is not None
    if prefix:  # a morph's name comes once: readers say weights by name only
        meshes = tuple(replace(mesh, morphs=()) for mesh in meshes)
        clip = replace(clip, morph_weights={})
    return replace(scene, name=name, place=place, bones=bones, meshes=meshes, clip=clip)


def _expected(figures: tuple[Scene, ...]) -> Expected:
    joints: dict[str, np.ndarray] = {}
    parents: dict[str, str | None] = {}
    found = [scenes.expected(figure) for figure in figures]
    for figure, one in zip(figures, found, strict=True):
        turn = Rotation.from_quat(figure.place.rotation_xyzw)
        joints |= {name: turn.apply(at) + figure.place.translation_cm for name, at in one.joints_cm.items()}
        parents |= one.parents
    return replace(found[0], joints_cm=joints, parents=parents)


def _needed(*readers: str) -> None:
    for reader in readers:
        if not installed(reader):
            pytest.skip(f"the reader {reader} is not installed")


def test_our_reader_finds_every_figure_as_it_was(tmp_path: Path) -> None:
    figures = stage()
    write_scenes(tmp_path / "stage.fbx", iter(figures))
    found = read_scenes(tmp_path / "stage.fbx")
    assert [figure.name for figure in found] == [figure.name for figure in figures]
    for given, read in zip(figures, found, strict=True):
        assert given.clip is not None
        assert read.clip is not None
        np.testing.assert_allclose(read.place.matrix, given.place.matrix, atol=1e-12)
        assert [bone.name for bone in read.bones] == [bone.name for bone in given.bones]
        assert [mesh.name for mesh in read.meshes] == [mesh.name for mesh in given.meshes]
        for mesh, meant in zip(read.meshes, given.meshes, strict=True):
            assert {material.name for material in mesh.materials} == {material.name for material in meant.materials}
            np.testing.assert_allclose(mesh.world_from_bone_bind, meant.world_from_bone_bind, atol=2e-3)
        # Bones keep their length: where a bone is below its parent is as it was.
        assert set(read.clip.translations_cm) == set(given.clip.translations_cm)
        turned = Rotation.from_quat(read.clip.rotations_xyzw.reshape(-1, 4)).inv()
        turned *= Rotation.from_quat(given.clip.rotations_xyzw.reshape(-1, 4))
        assert turned.magnitude().max() < 1e-5
        assert set(read.clip.morph_weights) == set(given.clip.morph_weights)
    with pytest.raises(FileError):
        read_scene(tmp_path / "stage.fbx")


@pytest.mark.parametrize(("suffix", "readers"), [("fbx", QUICK_FBX), ("glb", QUICK_GLB), ("usdc", QUICK_USD)])
def test_everyone_stands_and_moves_at_the_own_place(suffix: str, readers: tuple[str, ...], tmp_path: Path) -> None:
    _needed(*readers)
    figures = stage()
    WRITERS[suffix](tmp_path / f"stage.{suffix}", figures)
    judge(tmp_path / f"stage.{suffix}", _expected(figures), readers)


def test_players_of_one_body_share_its_mesh(tmp_path: Path) -> None:
    first = stage()[0]
    write_glbs(tmp_path / "one.glb", (first,))
    second = replace(first, name="Ana 2", place=_place(65.0, -139.4, -100.0))
    write_glbs(tmp_path / "two.glb", (first, second))
    models = [read_glb(tmp_path / name) for name in ("one.glb", "two.glb")]
    shown = [[part.positions for mesh in model.meshes for part in mesh.primitives] for model in models]
    for given, found in zip(2 * shown[0], shown[1], strict=True):
        np.testing.assert_array_equal(found, given)
    # The names and nodes of the second, but none of its vertices.
    sizes = [pygltflib.GLTF2().load(str(tmp_path / name)).buffers[0].byteLength for name in ("one.glb", "two.glb")]
    assert sizes[0] == sizes[1]


@pytest.mark.readers
@pytest.mark.parametrize(
    ("suffix", "reader"), [("fbx", reader) for reader in SLOW_FBX] + [("glb", reader) for reader in SLOW_GLB]
)
def test_everyone_stands_at_the_own_place_by(suffix: str, reader: str, tmp_path: Path) -> None:
    _needed(reader)
    figures = stage()
    WRITERS[suffix](tmp_path / f"stage.{suffix}", figures)
    judge(tmp_path / f"stage.{suffix}", _expected(figures), [reader])


def test_a_file_of_several_figures_needs_names_places_and_one_clip(tmp_path: Path) -> None:
    first, second, _ = stage()
    assert second.clip is not None
    odd: dict[str, Scene] = {
        "place": replace(second, place=None),
        "name": replace(second, name=first.name),
        "clip": replace(second, clip=replace(second.clip, fps=Fraction(24))),
    }
    for scene in odd.values():
        with pytest.raises(ValueError, match="scene"):
            write_scenes(tmp_path / "odd.fbx", (first, scene))
    assert not list(tmp_path.iterdir())


# ---------------------------------------------------------------------------------------------------------- Blender

_BLENDER = """
import json, sys, bpy
path, importer, frame = sys.argv[1], sys.argv[2], int(sys.argv[3])
bpy.ops.wm.read_factory_settings(use_empty=True)
if importer == 'glb':
    bpy.context.scene.render.fps = 30
    bpy.ops.import_scene.gltf(filepath=path)
elif importer == 'fbx, Python':
    bpy.ops.import_scene.fbx(filepath=path, anim_offset=0.0)
elif importer == 'fbx, C++':
    bpy.ops.wm.fbx_import(filepath=path, anim_offset=0.0)
else:
    bpy.ops.wm.usd_import(filepath=path)
scene = bpy.context.scene
scene.frame_set(frame)
depsgraph = bpy.context.evaluated_depsgraph_get()
figures = {}
for o in bpy.data.objects:
    if o.type == 'MESH' and o.find_armature() is not None:
        shown = o.evaluated_get(depsgraph)
        points = [tuple(shown.matrix_world @ v.co) for v in shown.data.vertices]
        figures[o.name] = {'armature': o.find_armature().name, 'points': points}
surfaces = {}
for m in bpy.data.materials:
    for n in m.node_tree.nodes:
        if n.type == 'BSDF_PRINCIPLED':
            of = lambda name: n.inputs[name].default_value
            surfaces[m.name] = [*of('Base Color'), of('Metallic'), of('Roughness')]
fps = scene.render.fps / scene.render.fps_base
empties = [o.name for o in bpy.data.objects if o.type == 'EMPTY' and not o.children]
print('FOUND', json.dumps({'fps': fps, 'empties': empties, 'figures': figures, 'surfaces': surfaces,
                           'range': [scene.frame_start, scene.frame_end]}))
"""


def _blender(path: Path, importer: str, frame: int) -> dict[str, Any]:
    _needed("blender")
    pythons = [os.environ.get("SUISOU_BLENDER_PYTHON", ""), *os.environ.get("CHECK_ANIM_PYTHONS", "").split(":")]
    for python in dict.fromkeys(pythons):
        if Path(python).is_file():
            command = [python, "-c", _BLENDER, str(path), importer, str(frame)]
            said = subprocess.run(command, capture_output=True, text=True, check=False).stdout
            for line in said.splitlines():
                if line.startswith("FOUND"):
                    found: dict[str, Any] = json.loads(line.removeprefix("FOUND"))
                    return found
    raise AssertionError("Blender read nothing")


@pytest.mark.readers
@pytest.mark.parametrize("importer", ["fbx, Python", "fbx, C++", "glb", "usdc"])
def test_blender_shows_names_surfaces_and_skin(importer: str, tmp_path: Path) -> None:
    figures, frame, suffix = stage(), 5, importer.split(",")[0]
    path = tmp_path / f"stage.{suffix}"
    WRITERS[suffix](path, figures)
    found = _blender(path, importer, frame)
    if suffix == "fbx":
        assert found["fps"] == 30.0
    # An empty is left of a second mesh that has keys, as our characters have none. USD groups its materials.
    assert found["empties"] == {"glb": ["Ana 1_Teeth.001"], "usdc": ["Materials"]}.get(suffix, [])
    if suffix == "usdc":  # the importers of the others leave the range alone
        assert found["range"] == [0, FRAMES - 1]
    for figure in figures:
        for number, mesh in enumerate(figure.meshes):
            name, armature = mesh.name, figure.name
            if suffix == "usdc":
                name, armature = name.replace(" ", "_"), f"{armature.replace(' ', '_')}_skeleton"
            assert found["figures"][name]["armature"] == armature
            if number == 0:
                _assert_same_points(found["figures"][name]["points"], figure, frame)
    for surface in (BRASS, SKIN):
        *color, metallic, roughness = found["surfaces"][surface.name]
        assert color == pytest.approx(surface.base_color, abs=1e-5)
        assert roughness == pytest.approx(surface.roughness, abs=1e-5)
        assert metallic == pytest.approx(surface.metallic, abs=1e-5)


@pytest.mark.readers
@pytest.mark.parametrize("suffix", ["fbx", "glb"])
def test_assimp_finds_the_surfaces(suffix: str, tmp_path: Path) -> None:
    _needed("assimp")
    WRITERS[suffix](tmp_path / f"stage.{suffix}", stage())
    command = ["assimp", "export", str(tmp_path / f"stage.{suffix}"), str(tmp_path / "out.json"), "-fassjson"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    read = json.loads((tmp_path / "out.json").read_text())["materials"]
    rows = [{row["key"]: row["value"] for row in material["properties"]} for material in read]
    found = {row["?mat.name"]: row for row in rows if "?mat.name" in row}
    for surface in (BRASS, SKIN):
        row = found[surface.name]
        keys = ("$mat.metallicFactor", "$clr.base")
        if suffix == "fbx":  # what a Phong surface of a metal reflects is its colour
            keys = ("$mat.reflectivity", "$clr.specular" if surface.metallic else "$clr.diffuse")
        metallic, color = (row[key] for key in keys)
        assert metallic == pytest.approx(surface.metallic, abs=1e-5)
        assert row["$mat.roughnessFactor"] == pytest.approx(surface.roughness, abs=1e-5)
        assert color[:3] == pytest.approx(surface.base_color[:3], abs=1e-5)


@pytest.mark.readers
def test_the_sdk_finds_the_surfaces(tmp_path: Path) -> None:
    """FBX2glTF converts a Physical Material of 3ds Max to a metallic-roughness material."""
    _needed("fbxsdk")
    write_scenes(tmp_path / "stage.fbx", stage())
    program = Path(os.environ["CHECK_ANIM_NODE_MODULES"]) / "fbx2gltf" / "bin" / "Linux" / "FBX2glTF"
    command = [str(program), "--binary", "-i", str(tmp_path / "stage.fbx"), "-o", str(tmp_path / "out.glb")]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    read = {material.name: material for material in read_glb(tmp_path / "out.glb").materials}
    for surface in (BRASS, SKIN):
        found = read[surface.name]
        assert found.base_color_rgba == pytest.approx(surface.base_color, abs=1e-5)
        assert (found.metallic, found.roughness) == pytest.approx((surface.metallic, surface.roughness), abs=1e-5)


def _assert_same_points(found: list[list[float]], figure: Scene, frame: int) -> None:
    """Compare deformed vertices in Blender's space (Z up); glTF's importer may duplicate vertices."""
    turn = Rotation.from_quat(figure.place.rotation_xyzw)
    points = turn.apply(100.0 * slow_positions_m(figure, frame)) + figure.place.translation_cm
    x, y, z = 100.0 * np.array(found).T
    there = np.column_stack([x, z, -y])
    distance = np.linalg.norm(points[:, None] - there[None], axis=2)
    assert distance.min(axis=1).max() < 0.02
    assert distance.min(axis=0).max() < 0.02
