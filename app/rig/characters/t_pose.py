"""The T-pose of a figure: arms along +-X with palms down, legs straight down, fingers along the arm, feet forward.

Each joint gets the rotation from the file's rest pose to the T-pose, by the rules of the bundled characters
(``resources/build/character_skeleton.py``): the hinge of an elbow or finger is where it is bent at rest, a hand's
orientation is that of its knuckles, a thumb rotates within its hand. The trunk is unchanged.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final

import numpy as np

from app.arrays import FloatArray, IntArray, SingleArray
from app.rig import quaternion
from app.rig.characters.bone_placements import world_placements
from app.rig.figure import Figure

FINGERS: Final = ("Index", "Middle", "Ring", "Little")
PHALANGES: Final = ("Proximal", "Intermediate", "Distal")
THUMB: Final = ("ThumbMetacarpal", "ThumbProximal", "ThumbDistal")
THUMB_DIRECTION: Final = np.array([1.0, 0.0, 1.0]) / np.sqrt(2.0)
"""Direction of the left thumb; the right one is its mirror image."""
BENT_DEG: Final = (3.0, 8.0)
"""Bend in degrees below which a joint's hinge is unknown, and above which it is certain."""
MOST_HINGE_DEG: Final = 75.0
"""Greatest angle in degrees of a plausible hinge from the shortest rotation."""
WRIST_TWIST_DEG: Final = 30.0
"""Largest rotation of a hand about the arm that is attributed to the wrist; the rest is the forearm's."""
ALIKE: Final = float(np.cos(np.radians(8.0)))
"""Least cosine between a bone's own axis and its direction for them to agree."""
BACKWARDS: Final = 0.3
"""Excess of the foot's extent behind the ankle over that in front, relative to its length, from which feet point
backwards.
"""
ASKEW_DEG: Final = 20.0
"""Rotation in degrees up to which a figure is considered to be standing as intended."""
UP: Final = np.array([0.0, 1.0, 0.0])
AHEAD: Final = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class Rest:
    """Bones of a figure at rest in the world.

    Attributes
    ----------
    positions_m : (B, 3) float64
        World positions.
    rotations : (B, 4) float64
        World rotations, ``world_from_bone``.
    """

    positions_m: FloatArray
    rotations: FloatArray


def rest_of(figure: Figure) -> Rest:
    """Return the rest transforms of a figure's bones."""
    return Rest(*world_placements(figure.parents, figure.translations_m, figure.rotations))


def heaviest(figure: Figure) -> tuple[FloatArray, IntArray]:
    """Return the vertices (V, 3) of all meshes at rest, and for each the bone with the greatest weight (V,)."""
    points, holders = [np.zeros((0, 3))], [np.zeros(0, np.int64)]
    for mesh in figure.meshes:
        points.append(mesh.positions_m.astype(np.float64))
        best = np.argmax(mesh.weights, axis=1)
        holders.append(np.take_along_axis(mesh.joints, best[:, None], axis=1)[:, 0].astype(np.int64))
    return np.concatenate(points), np.concatenate(holders)


def upright(figure: Figure, bones: Mapping[str, int]) -> Figure:
    """Return the figure rotated to stand upright and face +Z by its legs and head; unchanged if it does.

    A figure with exchanged axes is rotated by right angles, only an oblique one by other angles.
    """
    places = rest_of(figure).positions_m

    def at(name: str) -> FloatArray:
        place: FloatArray = places[bones[name]]
        return place

    up = at("head") - at("hips")
    left = at("leftUpperLeg") - at("rightUpperLeg") + at("leftUpperArm") - at("rightUpperArm")
    left = left - up * (left @ up) / max(float(up @ up), 1e-12)
    if min(np.linalg.norm(up), np.linalg.norm(left)) < 1e-6:
        return figure
    frame = np.column_stack([_unit(left), _unit(up), np.cross(_unit(left), _unit(up))])
    from scipy.spatial.transform import Rotation  # slow to import; figures are rarely read

    turns = Rotation.create_group("O").as_matrix()
    turn = turns[int(np.argmax(np.einsum("gij,ij->g", turns, frame.T)))]
    heading = turn @ frame[:, 2]
    yaw = float(np.arctan2(heading[0], heading[2]))
    if abs(np.degrees(yaw)) > ASKEW_DEG:
        turn = Rotation.from_euler("y", -yaw).as_matrix() @ turn
    return figure if np.allclose(turn, np.eye(3)) else turned_figure(figure, turn)


def facing_ahead(figure: Figure, bones: Mapping[str, int], tips_m: Mapping[str, FloatArray] | None = None) -> Figure:
    """Return the figure rotated by half a turn if its feet point backwards; otherwise unchanged.

    Parameters
    ----------
    bones : mapping of str to int
        Bones by VRM 1.0 joint.
    tips_m : mapping of str to (3,) float64, optional
        End of each foot at rest by ``left`` and ``right``, for a figure without toes and skin.
    """
    rest = rest_of(figure)
    ahead, size = 0.0, 0.0
    for side in ("left", "right"):
        foot = bones[side + "Foot"]
        ankle = rest.positions_m[foot]
        if side + "Toes" in bones:
            ways = (rest.positions_m[bones[side + "Toes"]] - ankle)[None]
        elif tips_m and side in tips_m:
            ways = (tips_m[side] - ankle)[None]
        else:
            points, holders = heaviest(figure)
            if not (holders == foot).any():
                continue
            ways = points[holders == foot] - ankle
        ahead += float(ways[:, 2].max() + ways[:, 2].min())
        size += float(np.abs(ways[:, 2]).max())
    return turned_figure(figure, np.diag([-1.0, 1.0, -1.0])) if ahead < -BACKWARDS * size < 0.0 else figure


def turned_figure(figure: Figure, turn: FloatArray) -> Figure:
    """Return the figure rotated about the origin by a matrix."""
    roots = np.array([parent < 0 for parent in figure.parents])
    translations, rotations = figure.translations_m.copy(), figure.rotations.copy()
    translations[roots] = translations[roots] @ turn.T
    rotations[roots] = quaternion.multiply(quaternion.from_matrix(turn), rotations[roots])
    posed = None if figure.posed is None else figure.posed.copy()
    if posed is not None:
        posed[roots] = quaternion.multiply(quaternion.from_matrix(turn), posed[roots])

    def moved(vectors: SingleArray) -> SingleArray:
        return (vectors @ turn.T).astype(np.float32)

    meshes = tuple(
        replace(
            mesh,
            positions_m=moved(mesh.positions_m),
            normals=moved(mesh.normals),
            morphs=tuple(
                replace(
                    morph,
                    deltas_m=moved(morph.deltas_m),
                    normal_deltas=None if morph.normal_deltas is None else moved(morph.normal_deltas),
                )
                for morph in mesh.morphs
            ),
        )
        for mesh in figure.meshes
    )
    return replace(figure, translations_m=translations, rotations=rotations, meshes=meshes, posed=posed)


def turns_to_t_pose(figure: Figure, rest: Rest, bones: Mapping[str, int]) -> dict[str, FloatArray]:
    """Return world rotations (4,) of joints from the rest pose to the T-pose; joints that are absent rotate with their
    parent.

    Parameters
    ----------
    figure : Figure
        Figure that stands upright.
    bones : mapping of str to int
        Bones by VRM 1.0 joint, including all required ones.
    """
    pose = _Pose(figure, rest, bones)
    turns: dict[str, FloatArray] = {}
    for side, sign in (("left", 1.0), ("right", -1.0)):
        turns.update(pose.arm(side, sign))
        turns.update(pose.leg(side))
    return turns


class _Pose:
    """Directions of the limbs of a figure at rest, from which its rotations to the T-pose follow."""

    def __init__(self, figure: Figure, rest: Rest, bones: Mapping[str, int]) -> None:
        self._rest, self._bones = rest, bones
        self._joint_of = {bone: name for name, bone in bones.items()}
        self._figure = figure
        self._children: dict[int, list[int]] = {}
        for bone, parent in enumerate(figure.parents):
            self._children.setdefault(parent, []).append(bone)

    def _at(self, name: str) -> FloatArray | None:
        return self._rest.positions_m[self._bones[name]] if name in self._bones else None

    def _way(self, start: str, end: str) -> FloatArray | None:
        """Return the unit vector (3,) from one joint to another; None if one is missing or they coincide."""
        a, b = self._at(start), self._at(end)
        if a is None or b is None or np.linalg.norm(b - a) < 1e-6:
            return None
        return _unit(b - a)

    # ------------------------------------------------------------------------------------------------------- arms

    def arm(self, side: str, sign: float) -> dict[str, FloatArray]:
        along = np.array([sign, 0.0, 0.0])
        upper, lower = self._way(side + "UpperArm", side + "LowerArm"), self._way(side + "LowerArm", side + "Hand")
        if upper is None or lower is None:
            return {}
        hinge = np.array([0.0, -sign, 0.0])
        turn_upper = _hinged(upper, along, quaternion.IDENTITY, [(upper, lower)], hinge)
        turn_lower = _hinged(lower, along, turn_upper, [(upper, lower)], hinge)
        turn_hand = self._hand(side, sign, along, turn_lower)
        twist = quaternion.multiply(turn_hand, quaternion.conjugate(turn_lower))
        angle = float(np.degrees(quaternion.twist_angle(twist, along)))
        excess = np.sign(angle) * max(abs(angle) - WRIST_TWIST_DEG, 0.0)
        turn_lower = quaternion.multiply(quaternion.from_axis_angle(along, np.radians(excess)), turn_lower)
        turns = {side + "UpperArm": turn_upper, side + "LowerArm": turn_lower, side + "Hand": turn_hand}
        for finger in FINGERS:
            turns.update(self._finger([side + finger + bone for bone in PHALANGES], along, sign, turn_hand))
        turns.update(self._thumb([side + bone for bone in THUMB], sign, turn_hand))
        return turns

    def _hand(self, side: str, sign: float, along: FloatArray, turn_lower: FloatArray) -> FloatArray:
        knuckles = {finger: self._at(f"{side}{finger}Proximal") for finger in FINGERS}
        present = [place for place in knuckles.values() if place is not None]
        wrist = self._at(side + "Hand")
        assert wrist is not None
        middle = knuckles["Middle"] if knuckles["Middle"] is not None else np.mean(present, axis=0) if present else None
        if middle is None:
            middle = self._mitten(side)
        if middle is None or np.linalg.norm(middle - wrist) < 1e-3:
            return turn_lower
        direction = _unit(middle - wrist)
        across = present[0] - present[-1] if len(present) > 1 else None
        if across is None:
            thumb = next((place for name in THUMB if (place := self._at(side + name)) is not None), None)
            across = None if thumb is None else thumb - wrist
        if across is not None:
            across = across - direction * (across @ direction)
        if across is None or np.linalg.norm(across) < 1e-4:
            return _swung(direction, along, turn_lower)
        x_axis, z_axis = sign * direction, _unit(across)
        rest_frame = np.column_stack([x_axis, np.cross(z_axis, x_axis), z_axis])
        return quaternion.from_matrix(rest_frame.T)

    def _mitten(self, side: str) -> FloatArray | None:
        """Return the centre (3,) of the skin of a hand without finger bones, without the thumb; None if it
        has no skin.
        """
        own = {self._bones[side + "Hand"]}
        thumbs = {self._bones[side + name] for name in THUMB if side + name in self._bones}
        for bone, parent in enumerate(self._figure.parents):
            if parent in own and bone not in thumbs:
                own.add(bone)
        points, holders = heaviest(self._figure)
        held = np.isin(holders, list(own))
        return points[held].mean(axis=0) if held.any() else None

    def _chain(self, joints: Sequence[str]) -> list[tuple[str, FloatArray | None]]:
        """Return those joints of a chain that the figure has, each with the unit direction (3,) to the next."""
        present = [name for name in joints if name in self._bones]
        ways = [self._way(a, b) for a, b in pairwise(present)]
        return [*zip(present, [*ways, self._tip(present)] if present else [], strict=True)]

    def _tip(self, present: Sequence[str]) -> FloatArray | None:
        """Return the unit direction (3,) of a chain's last bone: to the bone at its end, or along its own axes if all
        bones of the chain point along the same one."""
        last = self._bones[present[-1]]
        ends = [child for child in self._children.get(last, []) if child not in self._joint_of]
        if len(ends) == 1:
            way = self._rest.positions_m[ends[0]] - self._rest.positions_m[last]
            if np.linalg.norm(way) > 1e-4:
                return _unit(way)
        expected: FloatArray | None = None
        last_way = UP
        for start, end in pairwise(present):
            way_or_none = self._way(start, end)
            if way_or_none is None:
                return None
            before, after = self._rest.rotations[self._bones[start]], self._rest.rotations[self._bones[end]]
            if expected is not None and float(expected @ way_or_none) < ALIKE:
                return None
            expected = quaternion.rotate(after, quaternion.rotate(quaternion.conjugate(before), way_or_none))
            last_way = way_or_none
        # The last bone of a finger is never bent by more than a right angle.
        return expected if expected is not None and float(expected @ last_way) > 0.0 else None

    def _finger(
        self, joints: Sequence[str], along: FloatArray, sign: float, turn_hand: FloatArray
    ) -> dict[str, FloatArray]:
        chain = self._chain(joints)
        ways = [way for _, way in chain if way is not None]
        bends = list(pairwise(ways))
        turns: dict[str, FloatArray] = {}
        before = turn_hand
        for name, way in chain:
            if way is not None:
                before = _hinged(way, along, before, bends, np.array([0.0, 0.0, -sign]))
            turns[name] = before
        return turns

    def _thumb(self, joints: Sequence[str], sign: float, turn_hand: FloatArray) -> dict[str, FloatArray]:
        straight = THUMB_DIRECTION * np.array([sign, 1.0, 1.0])
        turns: dict[str, FloatArray] = {}
        before = turn_hand
        for name, way in self._chain(joints):
            if way is not None:
                before = _swung(way, straight, turn_hand)
            turns[name] = before
        return turns

    # ------------------------------------------------------------------------------------------------------- legs

    def leg(self, side: str) -> dict[str, FloatArray]:
        upper, lower = self._way(side + "UpperLeg", side + "LowerLeg"), self._way(side + "LowerLeg", side + "Foot")
        if upper is None or lower is None:
            return {}
        heading = self._heading(side)
        yaw = quaternion.from_axis_angle(UP, -np.arctan2(heading[0], heading[2]))
        turns = {side + name: yaw for name in ("Foot", "Toes")}
        across = np.cross(UP, heading)
        for name, way in (("UpperLeg", upper), ("LowerLeg", lower)):
            y_axis = -way
            x_axis = across - y_axis * (across @ y_axis)
            if np.linalg.norm(x_axis) < 1e-3:
                turns[side + name] = _swung(way, -UP, quaternion.IDENTITY)
                continue
            x_axis = _unit(x_axis)
            rest_frame = np.column_stack([x_axis, y_axis, np.cross(x_axis, y_axis)])
            turns[side + name] = quaternion.from_matrix(rest_frame.T)
        return turns

    def _heading(self, side: str) -> FloatArray:
        """Return the horizontal direction (3,) in which the foot of a side points; forward if unknown."""
        foot = self._at(side + "Foot")
        assert foot is not None
        ends = [self._at(side + "Toes")]
        if ends[0] is None:
            ends = [self._rest.positions_m[child] for child in self._children.get(self._bones[side + "Foot"], [])]
        level = np.array([1.0, 0.0, 1.0])
        ways = [(end - foot) * level for end in ends if end is not None]
        way = max(ways, key=lambda w: float(np.linalg.norm(w)), default=np.zeros(3))
        # A bone that points sideways or backwards is not the direction of the foot.
        return _unit(way) if np.linalg.norm(way) > 0.02 and way[2] > 0.5 * np.linalg.norm(way) else AHEAD


def _unit(vector: FloatArray) -> FloatArray:
    result: FloatArray = vector / np.linalg.norm(vector)
    return result


def _swung(way: FloatArray, target: FloatArray, before: FloatArray) -> FloatArray:
    """Return the rotation (4,) that takes a bone's rest direction ``way`` to ``target``: ``before``, then the shortest
    rotation that remains.
    """
    return quaternion.multiply(quaternion.between(quaternion.rotate(before, way), target), before)


def _hinged(
    way: FloatArray,
    target: FloatArray,
    before: FloatArray,
    bends: Sequence[tuple[FloatArray, FloatArray]],
    hinge: FloatArray,
) -> FloatArray:
    """Return the rotation of `_swung` followed by one about ``target`` that aligns the axis of bending at rest with
    ``hinge``.

    ``bends`` are pairs of directions of successive bones at rest, which show that axis; nearly straight ones are
    ignored.
    """
    swung = _swung(way, target, before)
    axis = np.sum([np.cross(a, b) for a, b in bends], axis=0) if bends else np.zeros(3)
    bent_deg = float(np.degrees(np.arcsin(min(float(np.linalg.norm(axis)), 1.0))))
    sure = float(np.clip((bent_deg - BENT_DEG[0]) / (BENT_DEG[1] - BENT_DEG[0]), 0.0, 1.0))
    if sure == 0.0:
        return swung
    found = quaternion.rotate(swung, axis)
    found = found - target * (found @ target)
    if np.linalg.norm(found) < 1e-6:
        return swung
    angle = float(np.arctan2(np.cross(found, hinge) @ target, found @ hinge))
    if abs(np.degrees(angle)) > MOST_HINGE_DEG:
        return swung
    return quaternion.multiply(quaternion.from_axis_angle(target, angle * sure), swung)
