"""Reduced levels of detail consist of a mesh's own vertices with all attributes, without cracks, in every format."""

from __future__ import annotations

import json
import tracemalloc
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import trimesh
from pygltflib import GLTF2
from scipy.spatial import cKDTree

from app.export.character import skinned_mesh
from app.formats.fbx.foreign import read_foreign_fbx
from app.formats.fbx.read import read_scene
from app.formats.fbx.write import write_scene
from app.formats.gltf.write import write_glb
from app.formats.joined_meshes import join_meshes
from app.formats.levels_of_detail import MOST_LEVELS, TRIANGLE_SHARES, lower_levels, with_levels
from app.formats.scene import Material, MorphTarget, Scene, SkinnedMesh
from app.formats.textures import MaterialTextures, TextureUse, texture_of
from app.formats.usd import LEVELS, write_usd
from app.formats.usd_package import usd_installed
from app.performance.bodies import model_of
from instrument_maps.load import bundled_maps
from tests.support import readers
from tests.support.textured import encoded, letter
from tests.unit.formats import scenes

COLUMNS, ROWS = 48, 24
RADIUS_CM = 10.0


@pytest.fixture(scope="module")
def globe() -> SkinnedMesh:
    """Ball with a UV seam between the poles, a dent as morph target, and two materials."""
    turn, height = np.meshgrid(np.linspace(0, 1, COLUMNS + 1), np.linspace(0, 1, ROWS + 1), indexing="ij")
    longitude, latitude = 2 * np.pi * turn.ravel(), np.pi * (height.ravel() - 0.5)
    around = np.where(turn.ravel() == 1, 0.0, longitude)
    normals = np.stack([np.cos(latitude) * np.sin(around), np.sin(latitude), np.cos(latitude) * np.cos(around)], axis=1)
    corner = np.arange((COLUMNS + 1) * (ROWS + 1)).reshape(COLUMNS + 1, ROWS + 1)
    first, right, up, both = corner[:-1, :-1], corner[1:, :-1], corner[:-1, 1:], corner[1:, 1:]
    faces = np.concatenate([np.stack(three, -1).reshape(-1, 3) for three in ((first, right, both), (first, both, up))])
    low = height.ravel()[faces].max(axis=1) <= 0.5
    dented = np.flatnonzero(normals[:, 2] > 0.7)
    count = len(normals)
    return SkinnedMesh(
        name="globe",
        vertices_cm=RADIUS_CM * normals,
        faces=faces,
        normals=normals,
        uvs=np.stack([turn.ravel(), height.ravel()], axis=1),
        materials=(Material("north", (1.0, 0.0, 0.0, 1.0)), Material("south", (0.0, 0.0, 1.0, 1.0))),
        face_materials=low.astype(np.int64),
        joint_indices=np.tile([0, 1], (count, 1)),
        weights=np.stack([height.ravel(), 1 - height.ravel()], axis=1),
        world_from_bone_bind=np.tile(np.eye(4), (len(scenes.BONES), 1, 1)),
        morphs=(MorphTarget("dent", dented, -2.0 * normals[dented], -normals[dented]),),
    )


def _closed(mesh: SkinnedMesh) -> trimesh.Trimesh:
    """Surface in which vertices at the same place are merged."""
    result = trimesh.Trimesh(mesh.vertices_cm, mesh.faces, process=False)
    result.merge_vertices(merge_tex=True, merge_norm=True)
    result.update_faces(result.nondegenerate_faces())
    return result


def test_levels_have_their_shares_of_triangles_and_no_cracks(globe: SkinnedMesh) -> None:
    whole = _closed(globe)
    assert whole.is_watertight
    for level, share in zip(lower_levels(globe, MOST_LEVELS - 1), TRIANGLE_SHARES, strict=True):
        assert 0.8 * share < len(level.faces) / len(globe.faces) <= share + 0.01
        assert _closed(level).is_watertight
        assert _closed(level).volume == pytest.approx(whole.volume, rel=0.1)


def test_a_vertex_keeps_all_that_belongs_to_it(globe: SkinnedMesh) -> None:
    every = np.concatenate([globe.vertices_cm, globe.normals, globe.uvs, globe.weights], axis=1)
    dents = np.zeros_like(globe.vertices_cm)
    dents[globe.morphs[0].vertex_indices] = globe.morphs[0].position_deltas_cm
    for level in lower_levels(globe, MOST_LEVELS - 1):
        own = np.concatenate([level.vertices_cm, level.normals, level.uvs, level.weights], axis=1)
        far, vertex = cKDTree(every).query(own)
        assert far.max() == 0
        left = np.zeros_like(level.vertices_cm)
        left[level.morphs[0].vertex_indices] = level.morphs[0].position_deltas_cm
        assert (left == dents[vertex]).all()
        assert len(level.morphs[0].vertex_indices) > 0


def test_no_triangle_reaches_over_a_seam_of_a_texture_or_into_another_material(globe: SkinnedMesh) -> None:
    picture = MaterialTextures(color=TextureUse(texture_of("letter", encoded(letter()))))
    painted = replace(globe, materials=tuple(replace(one, textures=picture) for one in globe.materials))
    for level in lower_levels(painted, MOST_LEVELS - 1):
        assert level.uvs is not None
        assert level.face_materials is not None
        spans = np.ptp(level.uvs[level.faces], axis=1)
        # Near the poles a triangle may be as wide as it likes: all longitudes meet there.
        away = np.abs(level.uvs[level.faces][:, :, 1] - 0.5).max(axis=1) < 0.4
        assert spans[away, 0].max() < 0.3
        middle = level.vertices_cm[level.faces].mean(axis=1)[:, 1]
        south = np.array([material.name == "south" for material in level.materials])[level.face_materials]
        assert (middle[south] < 1.0).all()
        assert (middle[~south] > -1.0).all()


def test_hard_edges_stay_hard_in_levels_without_cracks(globe: SkinnedMesh) -> None:
    box = trimesh.creation.box((4.0, 6.0, 8.0)).subdivide().subdivide().subdivide()
    corners = box.faces.ravel()
    count = len(corners)
    hard = replace(
        globe,
        vertices_cm=np.asarray(box.vertices)[corners],
        faces=np.arange(count).reshape(-1, 3),
        normals=np.repeat(box.face_normals, 3, axis=0),
        uvs=np.random.default_rng(0).uniform(size=(count, 2)),
        materials=globe.materials[:1],
        face_materials=None,
        joint_indices=np.zeros((count, 1), dtype=np.int64),
        weights=np.ones((count, 1)),
        morphs=(),
    )
    for level, share in zip(lower_levels(hard, MOST_LEVELS - 1), TRIANGLE_SHARES, strict=True):
        assert len(level.faces) <= 1.05 * share * len(hard.faces)
        closed = trimesh.Trimesh(level.vertices_cm, level.faces, process=False)
        closed.merge_vertices(merge_tex=True, merge_norm=True)
        _, sides = np.unique(np.sort(closed.edges, axis=1), axis=0, return_counts=True)
        assert (sides % 2 == 0).all(), "there is a crack"
        assert closed.volume == pytest.approx(4.0 * 6.0 * 8.0, rel=0.02)
        across = np.cross(*(np.diff(level.vertices_cm[level.faces], axis=1).transpose(1, 0, 2)))
        area = np.linalg.norm(across, axis=1)
        across /= np.maximum(area, 1e-9)[:, None]
        flat = np.einsum("fc,fkc->fk", across, level.normals[level.faces]).min(axis=1) > 0.999
        assert area[flat].sum() > 0.9 * area.sum()


def test_what_moves_with_another_bone_is_not_joined(globe: SkinnedMesh) -> None:
    apart = np.where(np.arange(len(globe.vertices_cm)) < len(globe.vertices_cm) // 2, 0, 1)[:, None]
    twice = replace(globe, joint_indices=apart, weights=np.ones((len(apart), 1)))
    for level in lower_levels(twice, MOST_LEVELS - 1):
        every = np.concatenate([twice.vertices_cm, twice.joint_indices], axis=1)
        own = np.concatenate([level.vertices_cm, level.joint_indices], axis=1)
        assert cKDTree(every).query(own)[0].max() == 0


@pytest.mark.parametrize("id", ["flute", "sax_alto_Eb", "bassoon"])
def test_instruments_of_many_hard_edges_have_all_levels(id: str) -> None:
    instrument = bundled_maps()[id]
    model = model_of(instrument)
    binds = np.tile(np.eye(4), (len(model.node_names), 1, 1))
    joined = join_meshes([skinned_mesh(one, one.name, one.joints, one.weights, binds) for one in model.meshes], id)
    levels = lower_levels(joined, MOST_LEVELS - 1)
    assert [len(level.faces) / len(joined.faces) for level in levels] == pytest.approx(TRIANGLE_SHARES, abs=0.03)
    for level in levels:
        surface = trimesh.Trimesh(level.vertices_cm, level.faces, process=False)
        points, _ = trimesh.sample.sample_surface(surface, 100_000, seed=0)
        assert np.percentile(cKDTree(points).query(joined.vertices_cm)[0], 99.0) < 0.5


def test_polygons_become_triangles_of_their_material(globe: SkinnedMesh) -> None:
    half = len(globe.faces) // 2
    quads = np.concatenate([globe.faces[:half], globe.faces[half:, 2:]], axis=1)
    assert globe.face_materials is not None
    level = lower_levels(replace(globe, faces=quads, face_materials=globe.face_materials[:half]), 1)[0]
    assert level.faces.shape[1] == 3
    assert _closed(level).is_watertight


def test_a_mesh_of_few_triangles_has_no_lower_levels(globe: SkinnedMesh) -> None:
    few = replace(globe, faces=globe.faces[:60], face_materials=None, materials=globe.materials[:1])
    assert lower_levels(few, 2) == ()


def test_vertices_all_at_one_place_cost_little(globe: SkinnedMesh) -> None:
    count = 9999
    faces = np.arange(count).reshape(-1, 3)
    one_place = replace(
        globe,
        vertices_cm=np.zeros((count, 3)),
        faces=faces,
        normals=np.tile([0.0, 1.0, 0.0], (count, 1)),
        uvs=np.zeros((count, 2)),
        face_materials=None,
        joint_indices=np.zeros((count, 1), dtype=np.int64),
        weights=np.ones((count, 1)),
        morphs=(),
    )
    tracemalloc.start()
    try:
        assert lower_levels(one_place, MOST_LEVELS - 1) == ()
        assert tracemalloc.get_traced_memory()[1] < 50e6
    finally:
        tracemalloc.stop()


@pytest.fixture(scope="module")
def scene(globe: SkinnedMesh) -> Scene:
    """Moving figure with a globe of three levels, and a mesh with one level."""
    made = scenes.character(Fraction(30), frames=4)
    binds = made.meshes[0].world_from_bone_bind
    small = replace(made.meshes[0], name="small", faces=made.meshes[0].faces[:40], face_materials=None)
    both = (replace(small, materials=small.materials[:1], morphs=()), replace(globe, world_from_bone_bind=binds))
    clip = made.clip
    assert clip is not None
    dent = {"dent": np.linspace(0, 1, clip.frames)}
    return with_levels(replace(made, meshes=both, clip=replace(clip, morph_weights=dent)), MOST_LEVELS)


def test_fbx_keeps_levels_and_ufbx_finds_them(scene: Scene, tmp_path: Path) -> None:
    write_scene(tmp_path / "levels.fbx", scene)
    read = read_scene(tmp_path / "levels.fbx")
    assert [mesh.name for mesh in read.meshes] == ["small", "globe"]
    for written, found in zip(scene.meshes[1].levels, read.meshes[1].levels, strict=True):
        assert written.name == found.name
        assert (written.vertices_cm == found.vertices_cm).all()
        assert (written.faces == found.faces).all()
        assert [morph.name for morph in found.morphs] == ["dent"]
    content = read_foreign_fbx(tmp_path / "levels.fbx")
    (group,) = [index for index, node in enumerate(content.nodes) if node.kind == "LOD_GROUP"]
    assert [node.name for node in content.nodes if node.parent == group] == ["globe", "globe_LOD1", "globe_LOD2"]
    counts = {mesh.name: len(mesh.faces) for mesh in content.meshes}
    assert all(counts[mesh.name] == len(mesh.faces) for mesh in (scene.meshes[1], *scene.meshes[1].levels))


@pytest.mark.parametrize("reader", ["fbxsdk", "blender"])
def test_other_programs_read_the_same_motion(scene: Scene, tmp_path: Path, reader: str) -> None:
    if not readers.installed(reader):
        pytest.skip(f"{reader} is not installed")
    write_scene(tmp_path / "levels.fbx", scene)
    readers.judge(tmp_path / "levels.fbx", scenes.expected(scene), [reader])


def test_glb_names_levels_that_other_readers_pass_over(scene: Scene, tmp_path: Path) -> None:
    write_glb(tmp_path / "levels.glb", scene)
    found = json.loads(GLTF2.load(str(tmp_path / "levels.glb")).gltf_to_json())
    nodes = found["nodes"]
    (node,) = [one for one in nodes if "MSFT_lod" in one.get("extensions", {})]
    ids = node["extensions"]["MSFT_lod"]["ids"]
    assert [nodes[one]["name"] for one in ids] == ["globe_LOD1", "globe_LOD2"]
    assert not set(ids) & set(found["scenes"][0]["nodes"])
    moved = {channel["target"]["node"] for channel in found["animations"][0]["channels"]}
    assert nodes.index(node) in moved
    assert not set(ids) & moved, "players of the scene find no node for such a channel"
    names = [found["meshes"][nodes[one]["mesh"]]["extras"]["targetNames"] for one in (nodes.index(node), *ids)]
    assert names[1:] == names[:1] * 2


@pytest.mark.skipif(not usd_installed(), reason="usd-core is not installed")
def test_usd_has_a_variant_of_each_level(scene: Scene, tmp_path: Path) -> None:
    from pxr import Usd, UsdGeom, UsdSkel

    write_usd(tmp_path / "levels.usdc", scene)
    stage = Usd.Stage.Open(str(tmp_path / "levels.usdc"))
    root = stage.GetDefaultPrim()
    variants = root.GetVariantSets().GetVariantSet(LEVELS)
    assert variants.GetVariantSelection() == "LOD0"
    counts = []
    for name in sorted(variants.GetVariantNames()):
        variants.SetVariantSelection(name)
        meshes = [prim for prim in root.GetChildren() if prim.IsA(UsdGeom.Mesh)]
        assert sorted(mesh.GetName() for mesh in meshes) == ["globe", "small"]
        (globe,) = [mesh for mesh in meshes if mesh.GetName() == "globe"]
        counts.append(len(UsdGeom.Mesh(globe).GetFaceVertexCountsAttr().Get()))
        assert UsdSkel.BindingAPI(globe).GetBlendShapesAttr().Get() == ["dent"]
    assert counts == [len(mesh.faces) for mesh in (scene.meshes[1], *scene.meshes[1].levels)]
