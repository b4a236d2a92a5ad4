"""The body in a captured skeleton: its joints, and the rotation of each bone in the T-pose.

Joints are found by `app.rig.characters.joint_mapping` from names, or by `app.choreography.joints_by_lengths`;
`app.choreography.anatomy` finds the T-pose, and `app.choreography.body_check` checks it.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from scipy.spatial.transform import Rotation

from app.arrays import FloatArray
from app.choreography.anatomy import t_pose
from app.choreography.body import ENDS, FEET, SEGMENTS
from app.choreography.body_check import SURE, Checked, checked, unlike
from app.choreography.captured_joints import ARM, LEG, NEAR_TOES, SIDES, Captured
from app.choreography.joints_by_lengths import joints_by_lengths
from app.choreography.raw_skeleton import JOINTS, REQUIRED, BodyError, RawSkeleton, raw_skeleton, zero_pose
from app.choreography.sides import called_after_the_other_side, exchanged, joints_by_side
from app.choreography.still_ends import without_still_ends
from app.errors import FileError, Message
from app.formats.bvh.clip import BvhClip
from app.rig import quaternion
from app.rig.characters.joint_mapping import JointMapping, corrected, map_joints
from app.rig.characters.t_pose import facing_ahead, rest_of, upright
from app.rig.figure import Figure

UPS: Final = {
    "+Y": Rotation.identity(),
    "-Y": Rotation.from_euler("z", 180.0, degrees=True),
    "+Z": Rotation.from_euler("x", -90.0, degrees=True),
    "-Z": Rotation.from_euler("x", 90.0, degrees=True),
    "+X": Rotation.from_euler("z", 90.0, degrees=True),
    "-X": Rotation.from_euler("z", -90.0, degrees=True),
}
"""Rotations that take an axis of a file to +Y."""
TURNS: Final = 1e-4
"""Change of a quaternion's components above which a joint counts as rotating."""
THUMB: Final = ("Metacarpal", "Proximal", "Distal")


@dataclass(frozen=True, eq=False)
class CapturedBody:
    """A captured body in motion, with the rotations of its bones in a T-pose found for it.

    Attributes
    ----------
    profile : str
        Table of bone names; empty if the joints were found by shape.
    doubtful : tuple of str
        Joints with guessed bones.
    t_pose : mapping of str to ndarray, shape (4,)
        Rotation of each segment's bone in the T-pose.
    hanging : mapping of str to ndarray, shape (N, 3)
        Points attached to each of `app.choreography.body.ENDS` in its bone's axes; the first is the joint itself.
    up : str
        Axis of the file that points up, such as ``"+Z"``.
    guesses : tuple of Message
        Messages about what was guessed.
    checked : tuple of Checked
        Deviations of the T-pose.
    found : JointMapping
        Bones found automatically, before the user's corrections.
    """

    body: Captured
    profile: str
    doubtful: tuple[str, ...]
    t_pose: Mapping[str, FloatArray]
    hanging: Mapping[str, FloatArray]
    up: str
    guesses: tuple[Message, ...]
    checked: tuple[Checked, ...]
    found: JointMapping


def captured_body(bvh: BvhClip, file: str, joints: Mapping[str, str] | None = None) -> CapturedBody:
    """Find the body in a clip: its joints and its T-pose.

    Parameters
    ----------
    file : str
        Name of the file, for messages.
    joints : mapping of str to str
        The user's corrections, see `RawSkeleton.corrected`. Corrected pairs of legs, arms and eyes keep the sides of
        the corrections; others are exchanged as without corrections.

    Raises
    ------
    BodyError
        A leg, an arm, the hips or the head cannot be found, or the result is no body.
    FileError
        All joints are at one place, or a correction refers to an unknown joint or bone.
    """
    moving = without_still_ends(bvh)
    motion = _Motion(moving, file)
    body, found, wrong, missing = _automatic(motion)
    if body is not None:
        body = _with_sides_said(body, motion.figure)
    used = found
    if joints:
        used = corrected(motion.figure, found, joints, JOINTS)
        body, wrong, missing = _by_hand(motion, used, joints)
    if body is not None:
        if moving is not bvh:
            body = replace(body, body=_Motion(bvh, file).captured(body.body.joints, body.up)[0])
        return replace(body, found=found)
    if wrong and not np.ptp(motion.places, axis=1).any():
        raise FileError("motion.no_size", file=file)
    id, named = ("motion.misread", wrong) if wrong else ("motion.incomplete", missing)
    raise BodyError(id, motion.skeleton(found, used.bones), file=file, joints=", ".join(named))


def _automatic(motion: _Motion) -> tuple[CapturedBody | None, JointMapping, Sequence[str], Sequence[str]]:
    """Find the body in a motion without the user's help. Returns the body (None if it fails), its bones or the
    likeliest ones, and the wrong and the missing joints.
    """
    named, by_names = map_joints(motion.figure), _by_names(motion.figure)
    by_lengths = motion.by_lengths()
    ways = [(by_names, True), (motion.by_zero_pose(), True)] if named.profile else []
    wrong: tuple[str, ...] = ()
    for mapping, sided in (*ways, (by_lengths, False)):
        if not _missing(mapping.bones):
            body = motion.read(mapping, sided)
            if isinstance(body, CapturedBody):
                return body, body.found, (), ()
            wrong = wrong or body
    complete = [one for one in (by_names, named, by_lengths) if not _missing(one.bones)]
    missing = _missing(named.bones) or _missing(by_lengths.bones)
    return None, complete[0] if complete else named, wrong, missing


def _by_hand(
    motion: _Motion, mapping: JointMapping, kept: Collection[str]
) -> tuple[CapturedBody | None, Sequence[str], Sequence[str]]:
    """Build the body from bones with the user's corrections; ``kept`` are the corrected joints. Returns the body (None
    if it fails), and the wrong and the missing joints.
    """
    if missing := _missing(mapping.bones):
        return None, (), missing
    body = motion.read(mapping, bool(mapping.profile), kept)
    return (body, (), ()) if isinstance(body, CapturedBody) else (None, body, ())


class _Motion:
    """A clip with the ways to find the body in it."""

    def __init__(self, bvh: BvhClip, file: str) -> None:
        self._bvh = bvh
        self.places, self._rotations = _world(bvh)
        self.figure = zero_pose(bvh, file)
        self._file = file

    def skeleton(self, found: JointMapping, bones: Mapping[str, int]) -> RawSkeleton:
        """Return the skeleton of the first frame for showing it to the user, with Y up if the up direction can be
        found.
        """
        known = {"head", *FEET} <= bones.keys()
        turn = np.asarray(UPS[_up(self.places, bones) if known else "+Y"].as_quat(), np.float64)
        places = quaternion.rotate(turn, self.places[0])
        return raw_skeleton(self._bvh, self._file, found, places, quaternion.multiply(turn, self._rotations[0]))

    def by_zero_pose(self) -> JointMapping:
        """Find joints by the names of bones and, where these are not enough, by the bones' positions in the
        zero pose.
        """
        mapping = map_joints(self.figure)
        if _missing(mapping.bones):
            return mapping
        # Left and right depend on the forward direction.
        standing = upright(self.figure, mapping.bones)
        return map_joints(facing_ahead(standing, mapping.bones, _foot_tips(self._bvh, standing, mapping.bones)))

    def read(self, mapping: JointMapping, named: bool, kept: Collection[str] = ()) -> CapturedBody | tuple[str, ...]:
        """Build the body from the bones of its joints; if the result is no plausible body, return the names of the
        wrong joints instead.

        Parameters
        ----------
        named : bool
            True if left and right are known from names.
        kept : collection of str
            Joints that a user corrected.
        """
        body, up = self.captured(mapping.bones)
        joints = joints_by_side(body, named, kept)
        if joints != mapping.bones:
            body, up = self.captured(joints)
        turns = t_pose(body)
        found = checked(body, turns)
        wrong = {one.joint: f"{one.joint} {one.off_deg:.0f}°" for one in found if one.wrong}
        wrong = {joint: joint for joint in unlike(body, self._bvh.parents)} | wrong
        if wrong:
            return tuple(wrong.values())
        hanging = {name: _hanging(self._bvh, self.places, self._rotations, body.segments[name]) for name in ENDS}
        bones = JointMapping(mapping.profile, body.joints, (), mapping.doubtful)
        guesses = tuple(_by_the_mean(body))
        return CapturedBody(body, mapping.profile, mapping.doubtful, turns, hanging, up, guesses, found, bones)

    def by_lengths(self) -> JointMapping:
        """Find joints by the lengths of bones; left and right follow from known names, or else from the motion."""
        ends = {joint: float(np.linalg.norm(end)) for joint, end in self._bvh.end_sites_cm.items()}
        turning = set(np.flatnonzero(np.ptp(self._bvh.rotations_xyzw, axis=0).max(axis=1) > TURNS).tolist())
        bones = joints_by_lengths(self._bvh.parents, self.places, ends, turning)
        if not _missing(bones):
            known = _by_names(self.figure).bones.items()
            sides = [one for one in (bones, exchanged(bones)) if any(one.get(joint) == bone for joint, bone in known)]
            bones = joints_by_side(self.captured(sides[0] if len(sides) == 1 else bones)[0], len(sides) == 1)
        return JointMapping("", bones, (), tuple(bones))

    def captured(self, bones: Mapping[str, int], up: str = "") -> tuple[Captured, str]:
        """Return the captured motion of these bones with Y up, and the axis of the file that points up, which is found
        if ``up`` is empty.
        """
        up = up or _up(self.places, bones)
        turn = np.asarray(UPS[up].as_quat(), np.float64)
        segments = _segment_bones(self._bvh.parents, bones)
        turned = quaternion.rotate(turn, self.places), quaternion.multiply(turn, self._rotations)
        thumbs = {f"{side}Hand": _thumb(self._bvh, bones, side, *turned) for side in ("left", "right")}
        others = {bone for joint, bone in bones.items() if "Thumb" in joint}
        tips = {name: _tip(self._bvh, name, segments[name], others) for name in ENDS}
        for name in ENDS:
            hanging = _hanging(self._bvh, self.places, self._rotations, segments[name])
            farthest = max(hanging, key=np.linalg.norm)
            near = NEAR_TOES * float(np.linalg.norm(farthest)) if name.endswith("Foot") else 0.0
            if np.linalg.norm(tips[name]) <= near:
                # The next joint is at the same position, or the toes' joint is below the ankle: the mean direction of
                # the farthest joint below it is used.
                tips[name] = farthest
        return Captured(*turned, bones, segments, tips, thumbs), up


def _by_the_mean(body: Captured) -> list[Message]:
    """Return notes about body parts whose rotation could only be guessed from their mean in the motion: a head without
    eyes, hands without fingers, limbs that never bend.
    """
    parts = [] if {"leftEye", "rightEye"} <= body.joints.keys() or len(body.posed) else ["head"]
    for side, sign in SIDES:
        for limb in ([side + name for name in names] for names in (ARM, LEG)):
            if body.hinge(limb[0], body.bend(limb, sign))[1] < SURE:
                parts.append(limb[0])
        shown = len(body.knuckles(side)) > 1 or body.thumbs[f"{side}Hand"].any() or len(body.posed)
        if not shown:
            parts.append(f"{side}Hand")
    return [Message("motion.mean_turns", {"joints": ", ".join(parts)})] if parts else []


def _with_sides_said(body: CapturedBody, figure: Figure) -> CapturedBody:
    """Add a note to the body if limbs have bones that are named after the other side."""
    against = called_after_the_other_side(body.found.bones, figure.bone_names)
    if not against:
        return body
    bones = {joint: figure.bone_names[body.found.bones[joint]] for joint in against}
    guess = Message("motion.sides", {"joints": ", ".join(f"{joint} {bone}" for joint, bone in bones.items())})
    sides = tuple(joint for joint in body.doubtful if not joint.startswith(("left", "right")))
    return replace(body, guesses=(*body.guesses, guess), doubtful=sides)


def _by_names(figure: Figure) -> JointMapping:
    """Find joints by the names of bones only, for a figure whose joints are all at one place, so that it has no shape
    to check.
    """
    mapping = map_joints(replace(figure, translations_m=np.zeros_like(figure.translations_m)))
    bones = {joint: bone for joint, bone in mapping.bones.items() if joint not in mapping.doubtful}
    return replace(mapping, bones=bones, doubtful=())


def _missing(bones: Mapping[str, int]) -> list[str]:
    return [joint for joint in REQUIRED if joint not in bones]


def _foot_tips(bvh: BvhClip, figure: Figure, bones: Mapping[str, int]) -> dict[str, FloatArray]:
    """Position (3,) in metres, in the rest pose, of the tip of each foot, by side: its end site or the bone below the
    ankle that is farthest from it horizontally.
    """
    rest = rest_of(figure)
    tips = {}
    for side in ("left", "right"):
        foot = bones[f"{side}Foot"]
        ankle = rest.positions_m[foot]
        ends = [rest.positions_m[bone] for bone, parent in enumerate(figure.parents) if parent == foot]
        if foot in bvh.end_sites_cm:
            ends.append(ankle + quaternion.rotate(rest.rotations[foot], bvh.end_sites_cm[foot]))
        if ends:
            tips[side] = max(ends, key=lambda end: float(np.linalg.norm((end - ankle)[[0, 2]])))
    return tips


def _world(bvh: BvhClip) -> tuple[FloatArray, FloatArray]:
    """World positions (F, J, 3) and rotations (F, J, 4) of the file's J joints, in the file's own coordinate system."""
    rotations = np.array(bvh.rotations_xyzw, np.float64)
    positions = np.empty((*rotations.shape[:2], 3))
    for joint, parent in enumerate(bvh.parents):
        if parent < 0:
            positions[:, joint] = bvh.root_translation_cm
        else:
            way = bvh.translations_cm.get(joint, bvh.offsets_cm[joint])
            moved = quaternion.rotate(rotations[:, parent], way)
            positions[:, joint] = positions[:, parent] + moved
            rotations[:, joint] = quaternion.multiply(rotations[:, parent], rotations[:, joint])
    return positions, rotations


def _up(positions: FloatArray, bones: Mapping[str, int]) -> str:
    """Find the axis of the file that points up, along which heads are usually above feet, such as ``"+Z"``."""
    feet = 0.5 * (positions[:, bones["leftFoot"]] + positions[:, bones["rightFoot"]])
    way = np.median(positions[:, bones["head"]] - feet, axis=0)
    axis = int(np.argmax(np.abs(way)))
    return f"{'+' if way[axis] >= 0.0 else '-'}{'XYZ'[axis]}"


def _segment_bones(parents: Sequence[int], bones: Mapping[str, int]) -> dict[str, int]:
    """Find the bone of each body segment, by segment name. Regardless of names the chest is the bone to which both arms
    are attached, and the spine the first bone between hips and chest.
    """
    hips = bones["hips"]
    carriers = _above(parents, bones["leftUpperArm"])
    right = set(_above(parents, bones["rightUpperArm"]))
    own = {hips, bones["head"], bones.get("neck", -1)}
    chest = next((bone for bone in carriers if bone in right and bone not in own - {hips}), hips)
    between = [bone for bone in [chest, *_above(parents, chest)] if hips in _above(parents, bone)]
    if not between:
        chest = hips
    spine = between[-1] if len(between) > 1 else hips
    return {name: {"spine": spine, "chest": chest}.get(name, bones.get(name, -1)) for name in SEGMENTS}


def _above(parents: Sequence[int], bone: int) -> list[int]:
    """Return the ancestors of a bone, the nearest first."""
    found = []
    while (bone := parents[bone]) >= 0:
        found.append(bone)
    return found


def _thumb(bvh: BvhClip, bones: Mapping[str, int], side: str, places: FloatArray, rotations: FloatArray) -> FloatArray:
    """World vector (F, 3) in cm from the wrist to the end of the thumb in every frame; zeros if there are no thumb
    bones.
    """
    parts = [bones[name] for part in THUMB if (name := f"{side}Thumb{part}") in bones]
    if not parts:
        return np.zeros_like(places[:, 0])
    end = places[:, parts[-1]] + quaternion.rotate(
        rotations[:, parts[-1]], bvh.end_sites_cm.get(parts[-1], np.zeros(3))
    )
    return np.asarray(end - places[:, bones[f"{side}Hand"]])


def _tip(bvh: BvhClip, name: str, bone: int, thumbs: Collection[int]) -> FloatArray:
    """Vector (3,) in cm from a bone to its tip, in the bone's own axes: to its farthest child or end site; for a hand
    the mean over the fingers without the thumb.
    """
    hand = name.endswith("Hand")
    nexts = [joint for joint, parent in enumerate(bvh.parents) if parent == bone and not (hand and joint in thumbs)]
    ways: FloatArray = np.array(
        [*(bvh.offsets_cm[joint] for joint in nexts), bvh.end_sites_cm.get(bone, np.zeros(3))], np.float64
    )
    sizes = np.linalg.norm(ways, axis=1)
    tip: FloatArray = ways[sizes > 0.0].sum(axis=0) / len(ways) if hand else ways[int(sizes.argmax())]
    return tip


def _hanging(bvh: BvhClip, places: FloatArray, rotations: FloatArray, bone: int) -> FloatArray:
    """Collect the points of a joint and of everything attached to its bone, (N, 3) relative to the joint in the bone's
    axes, averaged over P poses with positions (P, J, 3) and rotations (P, J, 4) of J joints.
    """
    below = {bone}
    for joint, parent in enumerate(bvh.parents):
        if parent in below:
            below.add(joint)
    points = [places[:, joint] for joint in sorted(below)]
    hanging = [(joint, end) for joint, end in bvh.end_sites_cm.items() if joint in below]
    points += [places[:, joint] + quaternion.rotate(rotations[:, joint], end) for joint, end in hanging]
    ways = np.array(points) - places[:, bone]
    return np.asarray(quaternion.rotate(quaternion.conjugate(rotations[:, bone]), ways).mean(axis=1))
