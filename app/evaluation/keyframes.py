"""Other animation as motion files, which replace the players' motion in clips of the variant ``keyframes``.

A file contains the joints of a body on the program's own skeleton, as written by `suisou export`: BVH, FBX or GLB. The
performance supplies the face, valves and slides. The instrument moves with the hand that supports it.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Final

import msgspec
import numpy as np

from app.arrays import FloatArray
from app.errors import FileError
from app.evaluation.excerpts import Excerpt
from app.evaluation.imported_videos import require_covered
from app.export.bind_pose import rest_transforms
from app.export.file_names import REPORT, figure_stems
from app.export.report import EarlierFiles
from app.export.target import normalised_target
from app.formats.bvh.clip import BvhClip
from app.formats.files import cannot_read, read_file
from app.formats.json_data import decode_json
from app.formats.motion_limits import require_rate
from app.performance.cast import Performer, performer_of
from app.performance.chunks import Pose
from app.performance.ensemble import Performance
from app.rig import quaternion
from app.rig.grip.grip_pose import hand_targets
from app.rig.model import Character, Skeleton
from app.rig.motion_file import SUFFIXES, read_motion_file
from app.rig.skeleton import forward

HIPS: Final = "hips"
_EYES: Final = ("leftEye", "rightEye")
"""Joints for which some formats lack bones."""
_OTHER_BODY_CM: Final = 1.0
"""Difference of bone lengths in centimetres above which a skeleton is not the player's."""
_HELD_M: Final = 0.03
"""Distance in metres of an instrument from its place in the hand below which it is considered to be in the hand."""
_MOST_LISTED: Final = 5
_REPORT_BYTES: Final = 64_000_000


class _Report(msgspec.Struct, frozen=True):
    """Fields read from the report beside exported files: the time of their first frame, and files of earlier exports
    with theirs.
    """

    first_frame_s: float
    earlier: tuple[EarlierFiles, ...] = ()

    def start_s(self, file: Path) -> float:
        """Return the time in seconds of the first frame of a file."""
        found = (one.first_frame_s for one in self.earlier if _listed(file, one))
        return next(found, self.first_frame_s)

    def is_earlier(self, file: Path) -> bool:
        """Return whether a file is of an earlier export than the report."""
        return any(_listed(file, one) for one in self.earlier)


def _listed(file: Path, earlier: EarlierFiles) -> bool:
    return file.name.casefold() in (name.casefold() for name in earlier.files)


def holds_motion(path: str | os.PathLike[str]) -> bool:
    """Return whether a path is that of motion files rather than of a video."""
    return os.path.isdir(path) or Path(path).suffix.lower() in SUFFIXES


@dataclass(frozen=True, eq=False)
class PlayerKeyframes:
    """A player's motion file with its position in the piece.

    Attributes
    ----------
    start_s, fps : float
        Performance time of the first frame in seconds, and frames per second.
    rotations : (F, J, 4) float64
        Rotations of J joints in F frames; NaN for eyes without bones in the file, which then move as in the
        performance.
    hips_m : (F, 3) float64
        Position of the hips as in `app.motion.model.Motion`.
    performer : Performer
        The player to whom the motion is applied.
    doubling : bool
        Whether the musician also plays other instruments.
    """

    path: Path
    start_s: float
    fps: float
    rotations: FloatArray
    hips_m: FloatArray
    performer: Performer
    doubling: bool

    @property
    def covered_s(self) -> tuple[float, float]:
        """Span of the performance in seconds that the motion file covers."""
        return self.start_s, self.start_s + len(self.hips_m) / self.fps

    def require_covered(self, excerpt: Excerpt) -> None:
        """Raise FileError if the file does not show all of an excerpt."""
        require_covered(self.path, self.covered_s, excerpt)

    def posed(self, time_s: float, pose: Pose) -> Pose:
        """Return the performance's pose with body and instrument replaced by the file's, interpolated between
        frames.
        """
        at = min(max((time_s - self.start_s) * self.fps, 0.0), len(self.hips_m) - 1.0)
        before = int(at)
        after, share = min(before + 1, len(self.hips_m) - 1), at - before
        turned = quaternion.slerp(self.rotations[before], self.rotations[after], share)
        turned = np.where(np.isnan(turned), pose.rotations, turned)
        hips_m = (1.0 - share) * self.hips_m[before] + share * self.hips_m[after]
        seen = replace(pose, rotations=turned.astype(np.float32), hips_m=hips_m.astype(np.float32))
        return self._held(seen, pose)

    def _held(self, seen: Pose, pose: Pose) -> Pose:
        """Return the pose ``seen`` (from the file) with the instrument moved to the hand that supports it, unless it is
        put aside.
        """
        hold, instrument = self.performer.grip, self.performer.instrument
        side = instrument.hold.support_hand
        hand = next((one for one in hold.hands if one.side == side), hold.hands[0])
        joint = self.performer.character.skeleton.index(f"{hand.side}Hand")
        controls = {name: np.array([value]) for name, value in pose.controls.items()}
        local_m, local = hand_targets(hand, np.zeros((1, 3)), quaternion.IDENTITY[None], controls)
        back = quaternion.conjugate(local)
        place_m, turn = self._hand(seen, joint)
        if self.doubling:
            theirs_m, theirs = self._hand(pose, joint)
            there_m = theirs_m - quaternion.rotate(quaternion.multiply(theirs, back), local_m)
            if np.linalg.norm(there_m - pose.instrument_position_m) > _HELD_M:
                return seen
        turned = quaternion.multiply(turn, back)
        position_m = place_m - quaternion.rotate(turned, local_m)
        return replace(
            seen,
            instrument_position_m=position_m[0].astype(np.float32),
            instrument_rotation=turned[0].astype(np.float32),
        )

    def _hand(self, pose: Pose, joint: int) -> tuple[FloatArray, FloatArray]:
        rotations = quaternion.normalize(pose.rotations[None].astype(np.float64))
        hips_m = pose.hips_m[None].astype(np.float64)
        return forward(self.performer.character.skeleton, rotations, hips_m, [joint]).of(joint)


@dataclass(frozen=True, eq=False)
class Keyframes:
    """The motion files of an evaluation by player id; players without a file perform as generated."""

    players: Mapping[str, PlayerKeyframes]

    @property
    def covered_s(self) -> tuple[float, float]:
        """Span of the performance in seconds that the files of all players show."""
        spans = [one.covered_s for one in self.players.values()]
        return max(first for first, _ in spans), min(last for _, last in spans)

    def require_covered(self, excerpt: Excerpt) -> None:
        """Raise FileError if a file does not show all of an excerpt."""
        for one in self.players.values():
            one.require_covered(excerpt)

    def posed(self, player_id: str, time_s: float, pose: Pose) -> Pose:
        """Return a player's pose at a time from the motion file that is compared, or ``pose`` if it lacks the
        player."""
        found = self.players.get(player_id)
        return pose if found is None else found.posed(time_s, pose)


def read_keyframes(
    performance: Performance, path: Path, player_ids: Sequence[str] = (), offset_s: float | None = None
) -> Keyframes:
    """Read the motion files of players.

    Parameters
    ----------
    path : Path
        A player's file, or a folder with a file for each, named as by `suisou export`.
    player_ids : sequence of str
        Players of the evaluation, all if empty; they must have files.
    offset_s : float or None
        Performance time of the first frame in seconds; None for the time in the report beside the files, else the
        beginning of the performance.

    Raises
    ------
    FileError
        A file is missing, cannot be read, is too large, or has another skeleton.
    AppError
        A player cannot be shown.
    """
    project = performance.project
    folder = os.path.isdir(path)
    requested = [body.id for body in project.bodies if not player_ids or body.id in player_ids]
    stems = {id: stem["character"] for id, stem in figure_stems(performance).items() if "character" in stem}
    report = None if offset_s is not None else _report(path if folder else path.parent)
    files = _in_folder(path, stems, report) if folder else _of_one(path, stems, requested)
    names = {body.id: body.name for body in project.bodies}
    if not files:
        raise FileError("evaluate.keyframes_player", file=str(path), players=", ".join(stems[id] for id in names))
    for player_id in requested:
        if player_id not in files:
            raise FileError(
                "evaluate.keyframes_lacking", file=str(path), player=names[player_id], name=f"{stems[player_id]}.bvh"
            )
    usual_s = performance.time_frame.first_frame_s if offset_s is None else offset_s
    found = dict[str, PlayerKeyframes]()
    for player_id, file in files.items():
        musician = project.player(player_id)
        performer = performer_of(performance, musician)
        clip = _read(file)
        rotations, hips_m = _on_skeleton(clip, file, performer)
        played = project.played_by(musician)
        start_s = usual_s if report is None else report.start_s(file)
        for one in played:
            held = performer if one.id == player_id else performer_of(performance, one)
            found[one.id] = PlayerKeyframes(file, start_s, float(clip.fps), rotations, hips_m, held, len(played) > 1)
    return Keyframes(found)


def _in_folder(folder: Path, stems: Mapping[str, str], report: _Report | None) -> dict[str, Path]:
    """Find the motion file of each player in a folder, by player id; players without a file are omitted. Files of the
    last export are preferred to those that an earlier one left.
    """
    try:
        there = {path.name.casefold(): path for path in sorted(folder.iterdir())}
    except OSError as error:
        raise cannot_read(folder, error) from error
    found = dict[str, Path]()
    for player_id, stem in stems.items():
        paths = [there[name] for suffix in SUFFIXES if (name := f"{stem}{suffix}".casefold()) in there]
        if paths:
            found[player_id] = min(paths, key=lambda one: report is not None and report.is_earlier(one))
    return found


def _of_one(path: Path, stems: Mapping[str, str], requested: Sequence[str]) -> dict[str, Path]:
    """Find the player of a single motion file by its name, or else the only player of the evaluation; returns the path
    by player id.
    """
    named = [player_id for player_id, stem in stems.items() if stem.casefold() == path.stem.casefold()]
    owners = named or (list(requested) if len(requested) == 1 else [])
    return {owners[0]: path} if owners else {}


def _report(folder: Path) -> _Report | None:
    """Return the report of the exported files in a folder; None if there is none."""
    report = folder / REPORT
    if not os.path.isfile(report):
        return None
    return decode_json(read_file(report, _REPORT_BYTES), _Report, str(report), "evaluate.keyframes_report")


def _read(path: Path) -> BvhClip:
    clip = read_motion_file(path)
    # A guess of the frame rate could not be reported here, so the stated frame time is used.
    said = clip.rate_guess
    require_rate(clip.fps if said is None else 1 / Fraction(said.arguments["said"]), str(path))
    return clip


def _on_skeleton(clip: BvhClip, path: Path, performer: Performer) -> tuple[FloatArray, FloatArray]:
    """Convert a motion file to a character's skeleton: rotations (F, J, 4) of its J joints, and hip positions (F, 3) in
    metres.
    """
    skeleton = performer.character.skeleton
    place = {name: joint for joint, name in enumerate(clip.names)}
    below = [joint for joint in range(len(skeleton.names)) if _hangs_on_hips(skeleton, joint)]
    eyes = [skeleton.index(eye) for eye in _EYES if eye not in place]
    below = [joint for joint in below if joint not in eyes]
    missing = [skeleton.names[joint] for joint in below if skeleton.names[joint] not in place]
    if HIPS not in place or 2 * len(missing) > len(below):
        raise FileError("evaluate.keyframes_skeleton", file=str(path))
    if missing:
        listed = ", ".join(missing[:_MOST_LISTED]) + (" ..." if len(missing) > _MOST_LISTED else "")
        raise FileError("evaluate.keyframes_bones", file=str(path), bones=listed)
    clip = _upright(clip, skeleton, place)
    jointed = [joint for joint in below if skeleton.names[joint] != HIPS]
    places, parents = (
        [place[skeleton.names[joint]] for joint in jointed],
        [skeleton.parents[joint] for joint in jointed],
    )
    if any(clip.names[clip.parents[at]] != skeleton.names[of] for at, of in zip(places, parents, strict=True)):
        raise FileError("evaluate.keyframes_skeleton", file=str(path))
    rest = _rest(np.asarray(clip.offsets_cm[places], np.float64), jointed, parents, performer.character)
    apart_cm = np.linalg.norm(_offsets_cm(skeleton, rest, jointed, parents) - clip.offsets_cm[places], axis=1)
    if apart_cm.max() > _OTHER_BODY_CM:
        bone, character = skeleton.names[jointed[int(apart_cm.argmax())]], performer.player.character_id
        raise FileError("evaluate.keyframes_body", file=str(path), bone=bone, character=character)
    rotations = np.tile(quaternion.IDENTITY, (len(clip.rotations_xyzw), len(skeleton.names), 1))
    hips_m, turn = _hips(clip, place[HIPS])
    rotations[:, skeleton.index(HIPS)] = quaternion.multiply(turn, rest[skeleton.index(HIPS)])
    turned = quaternion.multiply(clip.rotations_xyzw[:, places], rest[jointed])
    rotations[:, jointed] = quaternion.multiply(quaternion.conjugate(rest[parents]), turned)
    rotations[:, eyes] = np.nan
    return quaternion.normalize(rotations), hips_m


def _rest(offsets_cm: FloatArray, joints: Sequence[int], parents: Sequence[int], character: Character) -> FloatArray:
    """Find the rest pose of a motion file: rotations (J, 4) of the joints, which are those of the T-pose or of the mesh
    (FBX, GLB).
    """
    skeleton = character.skeleton
    bound = rest_transforms(character, normalised_target(skeleton))[:, :3, :3].astype(np.float64)
    poses = np.tile(quaternion.IDENTITY, (len(skeleton.names), 1)), quaternion.from_matrix(bound)
    return min(poses, key=lambda pose: float(np.abs(_offsets_cm(skeleton, pose, joints, parents) - offsets_cm).max()))


def _offsets_cm(skeleton: Skeleton, rest: FloatArray, joints: Sequence[int], parents: Sequence[int]) -> FloatArray:
    return 100.0 * quaternion.rotate(rest[list(parents)], skeleton.offsets_m[list(joints)])


def _hangs_on_hips(skeleton: Skeleton, joint: int) -> bool:
    while joint >= 0 and skeleton.names[joint] != HIPS:
        joint = skeleton.parents[joint]
    return joint >= 0


def _hips(clip: BvhClip, hips: int) -> tuple[FloatArray, FloatArray]:
    """World positions (F, 3) in metres and rotations (F, 4) of the hips, with the motion of all their
    parents included.
    """
    frames = len(clip.rotations_xyzw)
    place_cm, turn = np.zeros((frames, 3)), np.tile(quaternion.IDENTITY, (frames, 1))
    joint = hips
    while joint >= 0:
        own = np.asarray(clip.rotations_xyzw[:, joint], np.float64)
        still = clip.root_translation_cm if clip.parents[joint] < 0 else clip.offsets_cm[joint]
        moved = np.asarray(clip.translations_cm.get(joint, still), np.float64)
        place_cm = quaternion.rotate(own, place_cm) + moved
        turn = quaternion.multiply(own, turn)
        joint = clip.parents[joint]
    return place_cm / 100.0, turn


def _upright(clip: BvhClip, skeleton: Skeleton, place: Mapping[str, int]) -> BvhClip:
    """Rotate a clip so that Y is up, since some programs (Blender) write BVH with Z up."""
    spine = place[next(name for name in skeleton.names if _on_hips(skeleton, name))]
    way = clip.offsets_cm[spine]
    ours = skeleton.offsets_m[skeleton.index(clip.names[spine])]
    quarter = np.array([-np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)])
    turned = quaternion.rotate(quarter, way)
    if np.linalg.norm(turned / 100.0 - ours) >= np.linalg.norm(way / 100.0 - ours):
        return clip
    back = quaternion.conjugate(quarter)
    return replace(
        clip,
        offsets_cm=quaternion.rotate(quarter, clip.offsets_cm),
        root_translation_cm=quaternion.rotate(quarter, clip.root_translation_cm),
        rotations_xyzw=quaternion.multiply(quarter, quaternion.multiply(clip.rotations_xyzw, back)),
        translations_cm={joint: quaternion.rotate(quarter, moved) for joint, moved in clip.translations_cm.items()},
    )


def _on_hips(skeleton: Skeleton, name: str) -> bool:
    parent = skeleton.parents[skeleton.index(name)]
    return parent >= 0 and skeleton.names[parent] == HIPS
