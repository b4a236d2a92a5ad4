"""Bodies made from bundled ones with other proportions, or without parts that foreign characters may lack. All are
converted to the T-pose like characters read from foreign files.

Every one is baked into the T-pose, as a character that comes from a foreign file is.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from unittest.mock import patch

import numpy as np

from app.arrays import FloatArray
from app.rig.characters.character_library import character_named
from app.rig.characters.landmarks import found_landmarks
from app.rig.mesh import Mesh, Morph
from app.rig.model import Character, Skeleton
from app.rig.skeleton import rest_positions


@dataclass(frozen=True)
class Proportions:
    """Sizes of the parts of a body relative to the original body. ``thick`` widens hands and fingers across their
    length.

    ``thick`` widens hands and fingers across their length.
    """

    head: float = 1.0
    neck: float = 1.0
    trunk: float = 1.0
    arm: float = 1.0
    hand: float = 1.0
    thick: float = 1.0
    leg: float = 1.0
    foot: float = 1.0

    def matrix(self, joint: str) -> FloatArray:
        """Return the matrix (3, 3) that scales the part of the body at a joint."""
        bare = re.sub("^(left|right)", "", joint)
        if re.match("Hand|Thumb|Index|Middle|Ring|Little", bare):
            across = self.hand * self.thick
            return np.diag([self.hand, across, across])
        parts = {
            self.head: "head|Eye|jaw",
            self.neck: "neck",
            self.arm: "UpperArm|LowerArm",
            self.leg: "UpperLeg|LowerLeg",
            self.foot: "Foot|Toes",
        }
        found = next((size for size, names in parts.items() if re.match(names, bare)), self.trunk)
        return np.eye(3) * found


CHILD = Proportions(head=0.87, neck=0.72, trunk=0.72, arm=0.69, hand=0.74, leg=0.66, foot=0.72)
"""Proportions of a child of about seven years, 1.2 m tall."""
BIG_HEAD = Proportions(head=2.0, neck=0.8, trunk=0.8, arm=0.7, hand=0.9, thick=1.35, leg=0.6, foot=1.1)
"""Proportions of a stylised figure with short limbs and thick fingers."""
CHIBI = Proportions(head=1.3, neck=0.5, trunk=0.5, arm=0.42, hand=0.5, thick=1.3, leg=0.4, foot=0.6)
"""Proportions of a figure whose height is two and a half heads."""


def of_proportions(body: Character, proportions: Proportions, id: str) -> Character:
    """Scale the parts of a body, with the soles at the same height above the floor."""
    skeleton = body.skeleton
    before_m = rest_positions(skeleton)
    scales = np.array([proportions.matrix(name) for name in skeleton.names])
    offsets_m = skeleton.offsets_m.copy()
    for joint, parent in enumerate(skeleton.parents):
        if parent > 0:
            offsets_m[joint] = scales[parent] @ offsets_m[joint]
    hips = skeleton.index("hips")
    after_m = rest_positions(replace(skeleton, offsets_m=offsets_m))
    meshes = tuple(_baked(body, mesh, before_m, after_m, scales) for mesh in body.meshes)
    floor_m = min(float(_baked(body, mesh, before_m, before_m).positions_m[:, 1].min()) for mesh in body.meshes)
    drop_m = min(float(mesh.positions_m[:, 1].min()) for mesh in meshes) - floor_m
    offsets_m[hips, 1] -= drop_m
    moved = tuple(
        replace(mesh, positions_m=(mesh.positions_m - [0.0, drop_m, 0.0]).astype(np.float32)) for mesh in meshes
    )
    return _bound(body, Skeleton(skeleton.names, skeleton.parents, offsets_m), moved, id)


def _bound(body: Character, skeleton: Skeleton, meshes: tuple[Mesh, ...], id: str) -> Character:
    """Convert the meshes of a body to the T-pose."""
    joint_from_mesh = np.tile(np.eye(4), (len(skeleton.names), 1, 1))
    joint_from_mesh[:, :3, 3] = -rest_positions(skeleton)
    return replace(body, id=id, skeleton=skeleton, joint_from_mesh=joint_from_mesh, meshes=meshes)


def _baked(
    body: Character, mesh: Mesh, before_m: FloatArray, after_m: FloatArray, scales: FloatArray | None = None
) -> Mesh:
    """Convert a mesh to the T-pose, with each part scaled about its joint."""
    turn, place = body.joint_from_mesh[:, :3, :3], body.joint_from_mesh[:, :3, 3]
    if scales is not None:
        turn, place = scales @ turn, np.einsum("jab,jb->ja", scales, place)
    weights = np.zeros((len(mesh.positions_m), len(after_m)))
    np.add.at(weights, (np.arange(len(weights))[:, None], mesh.joints), mesh.weights)
    blended = np.tensordot(weights, turn, axes=1)
    positions_m = np.einsum("vab,vb->va", blended, mesh.positions_m) + weights @ (place + after_m)
    normals = np.einsum("vab,vb->va", np.linalg.inv(blended).transpose(0, 2, 1), mesh.normals)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    morphs = tuple(
        Morph(
            morph.name,
            morph.vertices,
            np.einsum("vab,vb->va", blended[morph.vertices], morph.deltas_m).astype(np.float32),
            None,
        )
        for morph in mesh.morphs
    )
    return replace(mesh, positions_m=positions_m.astype(np.float32), normals=normals.astype(np.float32), morphs=morphs)


def _mitten(body: Character) -> Character:
    """Attach the skin of the fingers to the hand, as in a file without finger bones."""
    names, table = body.skeleton.names, np.arange(len(body.skeleton.names), dtype=np.int32)
    for joint, name in enumerate(names):
        found = re.match("(left|right)(Thumb|Index|Middle|Ring|Little)", name)
        if found:
            table[joint] = names.index(f"{found[1]}Hand")
    return replace(body, meshes=tuple(replace(mesh, joints=table[mesh.joints]) for mesh in body.meshes))


def _without_morphs(body: Character) -> Character:
    return replace(body, meshes=tuple(replace(mesh, morphs=()) for mesh in body.meshes))


def _found(body: Character) -> Character:
    """Detect the body's landmarks instead of using known ones."""
    return replace(body, landmarks=found_landmarks(body.skeleton, body.joint_from_mesh, body.meshes))


def _without_joints(body: Character, pattern: str) -> Character:
    """Remove joints and attach their skin to the next joint above."""
    skeleton = body.skeleton
    gone = [bool(re.search(pattern, name)) for name in skeleton.names]
    above = list(range(len(gone)))
    for joint in range(len(gone)):
        if gone[joint]:
            above[joint] = above[skeleton.parents[joint]]
    kept = [joint for joint in range(len(gone)) if not gone[joint]]
    place = {joint: number for number, joint in enumerate(kept)}
    table = np.array([place[above[joint]] for joint in range(len(gone))], dtype=np.int32)
    rest_m = rest_positions(skeleton)
    parents = tuple(-1 if skeleton.parents[joint] < 0 else place[above[skeleton.parents[joint]]] for joint in kept)
    offsets_m = np.array(
        [
            rest_m[joint] - (rest_m[kept[parent]] if parent >= 0 else 0.0)
            for joint, parent in zip(kept, parents, strict=True)
        ]
    )
    slim = Skeleton(tuple(skeleton.names[joint] for joint in kept), parents, offsets_m)
    return _bound(body, slim, tuple(replace(mesh, joints=table[mesh.joints]) for mesh in body.meshes), body.id)


def _as_they_are(body: Character) -> Character:
    return body


_MADE: Mapping[str, tuple[str, Proportions, Callable[[Character], Character]]] = {
    "child": ("woman_adult", CHILD, _as_they_are),
    "big_head": ("man_adult", BIG_HEAD, _as_they_are),
    "chibi": ("woman_adult", CHIBI, _found),
    "mitten": ("man_adult", Proportions(), lambda body: _found(_mitten(body))),
    "still_face": ("woman_adult", Proportions(), lambda body: _found(_without_morphs(body))),
    "unmarked": ("woman_adult", Proportions(), _found),
    "eyeless": ("woman_adult", Proportions(), lambda body: _without_joints(body, "Eye|jaw")),
}
BODIES = tuple(_MADE)
"""Ids of the bodies that `odd_body` makes."""


@cache
def odd_body(id: str) -> Character:
    """Return one of `BODIES`, made on first use."""
    source, proportions, changed = _MADE[id]
    return changed(of_proportions(character_named(source), proportions, id))


@contextmanager
def playing() -> Iterator[None]:
    """Make the bodies of this module available to players by their ids within a ``with`` block."""
    from app.rig.characters import character_library as characters

    library, one = characters.character_library(), characters.character_named
    sources = {**library.sources, **{id: characters.CharacterSource(Path(f"{id}.glb")) for id in BODIES}}

    def either(id: str) -> Character:
        return odd_body(id) if id in BODIES else one(id)

    with (
        patch.object(characters.LIBRARY, "last", replace(library, items=sources)),
        patch("app.performance.bodies.character_named", either),
        patch("app.rig.characters.dressed_characters.character_named", either),
    ):
        yield
