"""Normals of morph targets in files compared with a second, slow calculation from the deformed surface."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from app.export.character import character_scene
from app.export.morph_normals import with_morph_normals
from app.export.target import normalised_target
from app.formats.fbx.read import read_scene as read_fbx
from app.formats.fbx.write import write_scene
from app.formats.gltf.read_scene import read_scene as read_glb
from app.formats.gltf.write import write_glbs
from app.formats.scene import Material, SkinnedMesh
from app.motion.model import Motion
from app.rig.characters.character_library import character_named
from app.rig.mesh import Mesh, Morph


def slow_normals(places: np.ndarray, triangles: np.ndarray, alike: list[list[int]]) -> dict[int, np.ndarray]:
    """Normals of groups of vertices, calculated triangle by triangle."""
    group = {vertex: number for number, vertices in enumerate(alike) for vertex in vertices}
    sums = {number: np.zeros(3) for number in range(len(alike))}
    for triangle in triangles:
        a, b, c = places[triangle]
        normal = np.cross(b - a, c - a)
        if np.linalg.norm(normal) == 0.0:
            continue
        normal /= np.linalg.norm(normal)
        for vertex, (here, one, other) in zip(triangle, ((a, b, c), (b, c, a), (c, a, b)), strict=True):
            if vertex in group:
                u, v = one - here, other - here
                sums[group[vertex]] += np.arccos(u @ v / np.linalg.norm(u) / np.linalg.norm(v)) * normal
    return {number: total / np.linalg.norm(total) for number, total in sums.items()}


def grid(size: int = 6) -> Mesh:
    """Square of the floor with a seam of doubled but smooth vertices in the middle, and a wall at its end."""
    x, z = np.meshgrid(np.arange(size, dtype=float), np.arange(size, dtype=float), indexing="ij")
    floor = np.column_stack([x.ravel(), np.zeros(size * size), z.ravel()])
    wall = np.column_stack([np.full(2 * size, size - 1.0), np.repeat([0.0, 1.0], size), np.tile(np.arange(size), 2)])
    triangles = []
    for i in range(size - 1):
        for j in range(size - 1):
            a, b, c, d = i * size + j, i * size + j + 1, (i + 1) * size + j, (i + 1) * size + j + 1
            triangles += [[a, b, c], [b, d, c]]
    first = size * size
    for j in range(size - 1):
        triangles += [
            [first + j, first + j + 1, first + size + j],
            [first + j + 1, first + size + j + 1, first + size + j],
        ]
    normals = np.concatenate([np.tile([0.0, 1.0, 0.0], (first, 1)), np.tile([-1.0, 0.0, 0.0], (2 * size, 1))])
    positions = np.concatenate([floor, wall])
    moving = np.array([2 * size + 2, 2 * size + 3, (size - 1) * size + 2, first + 2], np.int32)
    deltas = np.array([[0.0, 0.6, 0.0], [0.0, 0.3, 0.1], [0.0, 0.4, 0.0], [0.0, 0.4, 0.0]], np.float32)
    return Mesh(
        "grid",
        positions.astype(np.float32),
        normals.astype(np.float32),
        np.zeros((len(positions), 2), np.float32),
        np.array(triangles, np.int32),
        np.zeros(len(triangles), np.int32),
        (Material("m", (1.0, 1.0, 1.0, 1.0)),),
        np.zeros((len(positions), 1), np.int32),
        np.ones((len(positions), 1), np.float32),
        (Morph("up", moving, deltas, None),),
    )


def test_normals_are_those_of_the_deformed_surface_and_a_hard_edge_stays() -> None:
    mesh = grid()
    (morph,) = with_morph_normals(mesh).morphs
    assert morph.normal_deltas is not None
    normals = mesh.normals.astype(float)
    normals[morph.vertices] += morph.normal_deltas
    places = mesh.positions_m.astype(float)
    places[morph.vertices] += morph.deltas_m
    slow = slow_normals(places, mesh.triangles, [[vertex] for vertex in range(len(places))])
    np.testing.assert_allclose(normals, np.stack(list(slow.values())), atol=2e-3)
    edge = (6 - 1) * 6 + 2
    assert normals[edge] @ normals[36 + 2] < 0.5, "floor and wall meet at an edge"
    np.testing.assert_array_equal(places[morph.vertices].shape, morph.normal_deltas.shape)


def test_a_seam_is_lit_as_one_surface() -> None:
    mesh = grid()
    row = np.arange(12, 18)
    # The triangles beyond the third row have vertices of their own there.
    doubled = np.where(
        (mesh.triangles >= 12) & (mesh.triangles < 18) & (mesh.triangles.max(axis=1) >= 18)[:, None],
        mesh.triangles - 12 + 48,
        mesh.triangles,
    )
    from dataclasses import replace

    split = replace(
        mesh,
        positions_m=np.concatenate([mesh.positions_m, mesh.positions_m[row]]),
        normals=np.concatenate([mesh.normals, mesh.normals[row]]),
        triangles=doubled.astype(np.int32),
        morphs=(
            Morph(
                "up",
                np.append(mesh.morphs[0].vertices, [50, 51]).astype(np.int32),
                np.concatenate([mesh.morphs[0].deltas_m, mesh.morphs[0].deltas_m[:2]]),
                None,
            ),
        ),
    )
    whole, seamed = (with_morph_normals(one).morphs[0] for one in (mesh, split))
    assert whole.normal_deltas is not None
    assert seamed.normal_deltas is not None
    both = np.zeros((54, 3))
    both[seamed.vertices] = seamed.normal_deltas
    expected = np.zeros((54, 3))
    expected[whole.vertices] = whole.normal_deltas
    expected[48:] = expected[12:18]
    np.testing.assert_allclose(both, expected, atol=1e-6)


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, SkinnedMesh]:
    folder = tmp_path_factory.mktemp("normals")
    character = character_named("woman_adult")
    still = np.tile(np.array([0.0, 0.0, 0.0, 1.0], np.float32), (1, len(character.skeleton.names), 1))
    hips_m = np.zeros((1, 3), np.float32)
    morphs = {"jawOpen": np.ones(1, np.float32), "eyeLookUpLeft": np.ones(1, np.float32)}
    motion = Motion(Fraction(30), 0.0, still, hips_m, morphs, {}, hips_m, np.array([[0, 0, 0, 1]], np.float32))
    scene = character_scene(character, motion, "x", "test", normalised_target(character.skeleton))
    write_scene(folder / "x.fbx", scene)
    write_glbs(folder / "x.glb", (scene,))
    return {
        "made": scene.meshes[0],
        "fbx": read_fbx(folder / "x.fbx").meshes[0],
        "glb": read_glb(folder / "x.glb", scene.meshes).meshes[0],
    }


@pytest.mark.parametrize("kind", ["fbx", "glb"])
@pytest.mark.parametrize("name", ["jawOpen", "eyeLookUpLeft", "cheekPuff"])
def test_a_file_says_how_a_face_is_lit(files: dict[str, SkinnedMesh], kind: str, name: str) -> None:
    mesh = files[kind]
    (morph,) = [one for one in mesh.morphs if one.name == name]
    assert morph.normal_deltas is not None
    made = np.asarray(files["made"].normals, float)
    assert len(made) == len(mesh.vertices_cm)
    normals = made.copy()
    normals[morph.vertex_indices] += morph.normal_deltas
    places = np.asarray(mesh.vertices_cm, float).copy()
    rest = places.copy()
    places[morph.vertex_indices] += morph.position_deltas_cm
    lengths = np.linalg.norm(places - rest, axis=1)
    strongest = np.argsort(-lengths)[:60]
    # Vertices that were one smooth corner: the same place and normal.
    keys = np.concatenate([np.rint(rest * 1e4), np.rint(made * 1e3)], axis=1)
    alike = [np.flatnonzero((keys == keys[vertex]).all(axis=1)).tolist() for vertex in strongest]
    alike = list({tuple(vertices): vertices for vertices in alike}.values())
    near = np.isin(mesh.faces, np.concatenate(alike)).any(axis=1)
    before, after = (slow_normals(at, mesh.faces[near], alike) for at in (rest, places))
    off, plain = [], []
    for number, (vertex, *_) in enumerate(alike):
        # The difference between the modeller's normal and the surface at rest is kept.
        surface = made[vertex] + after[number] - before[number]
        surface /= np.linalg.norm(surface)
        off.append(np.degrees(np.arccos(np.clip(normals[vertex] @ surface / np.linalg.norm(normals[vertex]), -1, 1))))
        plain.append(np.degrees(np.arccos(np.clip(made[vertex] @ surface, -1, 1))))
    assert max(off) < 1.0
    assert max(plain) > 5.0, "without them the face is lit as at rest"
