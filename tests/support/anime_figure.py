"""Make a VRM figure with the proportions of anime characters from a bundled character: large head, thin long arms,
small hands, twin tails, skirt. No such figure with a suitable licence was available. `python -m
tests.support.anime_figure FILE.vrm` writes one.

No such figure with a licence to keep was at hand. `python -m tests.support.anime_figure FILE.vrm` writes one.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from app.rig.characters.character_library import character_named
from app.rig.mesh import Mesh
from app.rig.model import Character
from app.rig.skeleton import rest_positions
from tests.support.bodies import Proportions, of_proportions
from tests.support.estranged import Foreign, foreign, write_glb

ANIME = Proportions(head=1.55, neck=0.6, trunk=0.66, arm=0.80, hand=0.5, leg=0.78, foot=0.7)
"""Proportions of a figure of 1.25 m with a head of a quarter of the height, and hands half as large as those of bundled
characters.
"""
THIN = 0.62
"""Additional factor for the thickness of arms and legs."""
AROUND = 12


def anime_body() -> Character:
    """Body with these proportions, without hair and clothes."""
    body = of_proportions(character_named("woman_adult"), ANIME, "anime")
    return replace(body, meshes=tuple(_thinned(body, mesh) for mesh in body.meshes))


def _thinned(body: Character, mesh: Mesh) -> Mesh:
    """Make upper and lower arms of a mesh thinner about their bones."""
    joints_m, names = rest_positions(body.skeleton), body.skeleton.names
    moved = mesh.positions_m.astype(np.float64)
    for side in ("left", "right"):
        for part, following in (("UpperArm", "LowerArm"), ("LowerArm", "Hand")):
            joint, end = names.index(side + part), names.index(side + following)
            share = np.where(mesh.joints == joint, mesh.weights, 0.0).sum(axis=1)
            bone = joints_m[end] - joints_m[joint]
            bone /= np.linalg.norm(bone)
            off = mesh.positions_m - joints_m[joint]
            across = off - np.outer(off @ bone, bone)
            moved -= share[:, None] * (1.0 - THIN) * across
    return replace(mesh, positions_m=moved.astype(np.float32))


def write_anime(path: Path) -> Path:
    """Write the figure as VRM 1.0."""
    body = anime_body()
    figure = foreign(body, extra=False, rename=lambda name: f"J_{name}")
    places_m = {name: figure.world[bone, :3, 3] for name, bone in figure.joints.items()}
    head_m, hips_m = places_m["head"], places_m["hips"]
    grown = [mesh.positions_m for mesh in figure.meshes]
    top_m = max(float(places[:, 1].max()) for places in grown)
    size_m = top_m - head_m[1]
    for side, sign in (("l", 1.0), ("r", -1.0)):
        begin_m = head_m + np.array([sign * 0.48 * size_m, 0.62 * size_m, -0.05])
        end_m = np.array([sign * 0.62 * size_m, hips_m[1], 0.06])
        _hang(figure, f"twintail_{side}", figure.joints["head"], begin_m, end_m, (0.055, 0.015), 5)
    for number, angle in enumerate(np.linspace(0.0, 2.0 * np.pi, 8, endpoint=False)):
        way = np.array([np.sin(angle), 0.0, np.cos(angle)])
        begin_m, end_m = hips_m + 0.10 * way, hips_m + 0.30 * way - [0.0, 0.24, 0.0]
        _hang(figure, f"skirt_{number}", figure.joints["hips"], begin_m, end_m, (0.06, 0.12), 2)
    return write_glb(path, figure, vrm=1)


def block(model: Mesh, name: str, bone: int, size_m: float) -> Mesh:
    """Make a box attached to a bone, with the material of another mesh."""
    corners = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
    triangles = np.array([[0, 1, 2], [1, 3, 2]], np.int32)
    return _mesh(model, name, size_m * corners, np.tile([0.0, 1.0, 0.0], (8, 1)), triangles, np.full(8, bone))


def _mesh(
    model: Mesh, name: str, positions_m: np.ndarray, normals: np.ndarray, triangles: np.ndarray, bones: np.ndarray
) -> Mesh:
    """Make a mesh whose vertices are attached to one bone each."""
    return Mesh(
        name=name,
        positions_m=positions_m.astype(np.float32),
        normals=normals.astype(np.float32),
        uvs=np.zeros((len(bones), 2), np.float32),
        triangles=triangles,
        triangle_materials=np.zeros(len(triangles), np.int32),
        materials=model.materials[:1],
        joints=bones[:, None].astype(np.int32),
        weights=np.ones((len(bones), 1), np.float32),
        morphs=(),
    )


def _hang(
    figure: Foreign,
    name: str,
    parent: int,
    begin_m: np.ndarray,
    end_m: np.ndarray,
    radii_m: tuple[float, float],
    bones: int,
) -> None:
    """Attach a tube with its chain of bones to a bone."""
    steps_m = np.linspace(begin_m, end_m, bones + 1)
    first = len(figure.names)
    for number, place_m in enumerate(steps_m[:-1]):
        world = np.eye(4)
        world[:3, 3] = place_m
        figure.names.append(f"{name}_{number}")
        figure.parents.append(parent if number == 0 else first + number - 1)
        object.__setattr__(figure, "world", np.concatenate([figure.world, world[None]]))
    rings, radii = np.linspace(begin_m, end_m, 2 * bones + 1), np.linspace(*radii_m, 2 * bones + 1)
    along = (end_m - begin_m) / np.linalg.norm(end_m - begin_m)
    aside = np.cross(along, [0.0, 0.0, 1.0])
    aside /= np.linalg.norm(aside)
    turn = np.linspace(0.0, 2.0 * np.pi, AROUND, endpoint=False)
    circle = np.outer(np.cos(turn), aside) + np.outer(np.sin(turn), np.cross(along, aside))
    positions_m = (rings[:, None] + radii[:, None, None] * circle).reshape(-1, 3)
    quads = [
        tuple((row + down) * AROUND + (k + on) % AROUND for down in (0, 1) for on in (0, 1))
        for row in range(len(rings) - 1)
        for k in range(AROUND)
    ]
    triangles = np.array([corner for a, b, c, d in quads for corner in ((a, b, c), (b, d, c))], np.int32)
    owner = first + np.minimum(np.repeat(np.arange(len(rings)), AROUND) // 2, bones - 1)
    normals = np.tile(circle, (len(rings), 1))
    figure.meshes.append(_mesh(figure.meshes[0], name, positions_m, normals, triangles, owner))


if __name__ == "__main__":
    write_anime(Path(sys.argv[1]))
