"""Characters on foreign skeletons, made from bundled ones: other names, other rest rotations, an A-pose, additional
bones. Their correct motion is known, since it is that of the bundled character.

What such a character does is known exactly, because it is one of ours underneath.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from app.rig.figure import Figure, OwnSkeleton
from app.rig.mesh import Mesh
from app.rig.model import Character
from app.rig.skeleton import rest_positions

PREFIX = "Bip01_"


def foreign(
    character: Character,
    seed: int = 7,
    *,
    roots: int = 1,
    lacking: tuple[str, ...] = (),
    in_chain: str = "",
    root: str = "Reference",
) -> Character:
    """Convert a character to a form as if read from a foreign file.

    Bones have turned rest frames and are at rest where the character was bound (an A-pose); a twist bone lies beside
    each forearm and upper arm, a chain of hair hangs from the head. Two morphs are of the file's own.

    Parameters
    ----------
    character : Character
        One of ours.
    seed : int
    roots : int
        Bones without a parent; those beyond the first carry nothing.
    lacking : tuple of str
        Joints the file does not have; what they carry goes with the joint above.
    in_chain : str
        A joint between which and its parent a bone stands that is no joint; empty: none.
    root : str
        Name of the first root.
    """
    skeleton = character.skeleton
    turns = Rotation.random(len(skeleton.names), random_state=seed)
    bound = np.linalg.inv(character.joint_from_mesh)
    joints = rest_positions(skeleton)
    names, parents, bone_of_joint = [root], [-1], [-1] * len(skeleton.names)
    rest: list[tuple[np.ndarray, Rotation]] = [(np.zeros(3), Rotation.from_euler("x", -90, degrees=True))]
    t_pose = list(rest)

    def add(name: str, parent: int, at_rest: tuple[np.ndarray, Rotation], in_t: tuple[np.ndarray, Rotation]) -> int:
        names.append(name)
        parents.append(parent)
        rest.append(at_rest)
        t_pose.append(in_t)
        return len(names) - 1

    def hung(parent: int, offset: np.ndarray, turn: Rotation) -> tuple[Any, ...]:
        """Add a bone that keeps its place relative to its parent, at rest and in the T-pose."""
        return tuple(
            (place[parent][0] + place[parent][1].apply(offset), place[parent][1] * turn) for place in (rest, t_pose)
        )

    def above(joint: int) -> int:
        while joint > 0:
            joint = skeleton.parents[joint]
            if bone_of_joint[joint] >= 0:
                return bone_of_joint[joint]
        return 0

    for joint, name in enumerate(skeleton.names):
        if name in ("root", *lacking):
            continue
        parent = above(joint)
        own = turns[joint]
        if name == in_chain:
            half = t_pose[parent][1].inv().apply((joints[joint] - t_pose[parent][0]) / 2.0)
            parent = add(f"{PREFIX}{name}_Nub", parent, *hung(parent, half, Rotation.random(random_state=seed + 3)))
        at_rest = (bound[joint, :3, 3], Rotation.from_matrix(bound[joint, :3, :3]) * own)
        bone_of_joint[joint] = add(PREFIX + name, parent, at_rest, (joints[joint], own))
        if name.endswith(("LowerArm", "UpperArm")):
            end = skeleton.index(name.replace("LowerArm", "Hand").replace("UpperArm", "LowerArm"))
            way = own.inv().apply(joints[end] - joints[joint])
            add(
                f"{PREFIX}{name}_Twist1",
                bone_of_joint[joint],
                *hung(bone_of_joint[joint], way * 0.6, Rotation.identity()),
            )
        if name == "head":
            strand = bone_of_joint[joint]
            for link in range(3):
                turn = Rotation.random(random_state=seed + 10 + link)
                strand = add(f"hair_{link}", strand, *hung(strand, np.array([0.0, 0.03, -0.05]), turn))
    for extra in range(1, roots):
        add(
            f"prop_{extra}",
            -1,
            (np.array([0.1, 0.0, 0.2]) * extra, Rotation.identity()),
            (np.zeros(3), Rotation.identity()),
        )
        t_pose[-1] = rest[-1]
    figure_parents = tuple(parents)
    translations, rotations = _local(figure_parents, rest)
    _, t_rotations = _local(figure_parents, t_pose)
    carrying = np.array([bone_of_joint[j] if bone_of_joint[j] >= 0 else above(j) for j in range(len(skeleton.names))])
    joint_of_carrying = {bone: joint for joint, bone in enumerate(bone_of_joint) if bone >= 0}
    kept = np.array([joint_of_carrying.get(int(bone), 0) for bone in carrying])
    meshes = tuple(_renamed(mesh, carrying[mesh.joints].astype(np.int32)) for mesh in character.meshes)
    normal = tuple(replace(mesh, joints=kept[mesh.joints].astype(np.int32)) for mesh in character.meshes)
    own_skeleton = OwnSkeleton(
        figure=Figure("foreign.fbx", "fbx", tuple(names), figure_parents, translations, rotations, meshes),
        bone_of_joint=tuple(bone_of_joint),
        joint_from_bone=turns.as_quat(),
        t_pose=t_rotations,
        morphs={morph.name: {f"Face.{morph.name}": 1.0} for mesh in character.meshes for morph in mesh.morphs},
    )
    return replace(character, id=f"{character.id}_foreign", meshes=normal, own=own_skeleton)


def _renamed(mesh: Mesh, joints: np.ndarray) -> Mesh:
    return replace(
        mesh,
        name=f"geo_{mesh.name}",
        joints=joints,
        morphs=tuple(replace(morph, name=f"Face.{morph.name}") for morph in mesh.morphs),
    )


def _local(parents: tuple[int, ...], world: list[tuple[np.ndarray, Rotation]]) -> tuple[np.ndarray, np.ndarray]:
    translations, rotations = [], []
    for parent, (place, turned) in zip(parents, world, strict=True):
        above, back = world[parent] if parent >= 0 else (np.zeros(3), Rotation.identity())
        translations.append(back.inv().apply(place - above))
        rotations.append((back.inv() * turned).as_quat())
    return np.array(translations), np.array(rotations)
