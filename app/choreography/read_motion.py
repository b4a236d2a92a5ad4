"""Reading of motion capture as a motion of the 16 segments.

Bones and the T-pose are found by `app.choreography.captured_body`. Joints between two segments (collars, buttocks,
neck, further vertebrae) are merged into the segment beyond them: its world rotation is that of the file, its offset the
mean over the clip of its joint's place on the parent segment.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.choreography.body import ENDS, PARENT_OF, SEGMENTS
from app.choreography.body_check import report
from app.choreography.captured_body import captured_body
from app.choreography.captured_floor import floor_of_all, floors_m
from app.choreography.cleaning import CleanedClip, cleaned, remarks
from app.choreography.clip import BodyShape, MotionClip
from app.choreography.held_frames import held_frames
from app.choreography.place_units import place_units, with_places
from app.choreography.raw_skeleton import BodyError, RawSkeleton, raw_skeleton
from app.choreography.still_ends import moving_frames
from app.errors import FileError, Message, shortened
from app.formats.bvh.clip import BvhClip
from app.formats.motion_limits import require_frames, require_rate
from app.rig import quaternion
from app.rig.motion_file import read_motion_file

UNITS_M: Final = {"cm": 0.01, "m": 1.0, "inch": 0.0254, "CMU": 0.0254 / 0.45, "mm": 0.001}
"""Units of length in BVH files in metres; CMU: a 0.45th of an inch (CMU's ASF files, and BVH made from them)."""
FARTHEST_CM: Final = 1e9
"""Longest way of a body, in centimetres, whatever unit a file is in; larger numbers are damage."""
SAME: Final = 1e-5
"""Difference of rotations and positions up to which frames are repeated, since converters round."""
HEIGHTS_M: Final = (1.35, 2.15)
"""Plausible heights of a figure in metres; the first of `UNITS_M` that gives one is used."""
HEIGHT_M: Final = 1.7
"""Height in metres given to a figure that no unit fits."""
MOST_FIGURES: Final = 16
"""Greatest number of skeletons of a file that are tried if none is requested."""
FAR_M: Final = 0.05
"""Joints farther from their place in the file are reported."""
HAND_PART: Final = 0.108
CROWN_PART: Final = 0.13
FOOT_PART: Final = 0.12
"""Distances from wrist to fingertips, head joint to crown and ankle to toes relative to the height, if the file has no
ends (D. Winter, "Biomechanics and Motor Control of Human Movement", 4th ed. 2009, fig. 4.1).
"""


@dataclass(frozen=True, eq=False)
class ReadMotion:
    """A motion with guesses about its file.

    Attributes
    ----------
    profile : str
        Table of bone names; empty if the joints were found by shape.
    unit : str
        Key of `UNITS_M`; empty if none fits and the figure was scaled to `HEIGHT_M`.
    up : str
        Axis of the file that points up, such as ``"+Z"``.
    file_fps : Fraction
        Frame rate in the file; the clip's may have been given.
    cleaned : CleanedClip
        The clip with a description of its changes.
    joints_doubtful : tuple of str
        Joints with guessed bones.
    checked : Message
        Deviation of the body's T-pose.
    skeleton : RawSkeleton
        The file's own skeleton in the clip's first frame.
    rate_guess, file_guesses
        See `BvhClip`; also the interpreted unit of the hips' positions.
    apart_m : float
        Greatest distance in metres of a joint from its place in the file relative to the hips: a segment keeps its
        world rotation, but its joint has a fixed place on the parent segment, even if collars or a neck move.
    floor_moved_m : float
        Greatest difference in metres between two heights of the floor in the file, which was levelled.
    """

    cleaned: CleanedClip
    profile: str
    unit: str
    unit_m: float
    up: str
    file_fps: Fraction
    joints_doubtful: tuple[str, ...]
    apart_m: float
    checked: Message
    skeleton: RawSkeleton
    rate_guess: Message | None = None
    file_guesses: tuple[Message, ...] = ()
    floor_moved_m: float = 0.0

    @property
    def clip(self) -> MotionClip:
        """The motion that was read, with its damage mended."""
        return self.cleaned.clip

    @property
    def start_s(self) -> float:
        """Start time of the clip in the file in seconds."""
        return self.cleaned.start_s


def read_motion(
    path: str | os.PathLike[str],
    fps: Fraction | None = None,
    joints: Mapping[str, str] | None = None,
    figure: str = "",
) -> ReadMotion:
    """Read the motion of a humanoid from a motion capture file.

    Parameters
    ----------
    path : str or path-like
        BVH, FBX or glTF file (also VRM Animation), recognised by its content.
    fps : Fraction, optional
        True frame rate, if the file's is wrong.
    joints : mapping of str to str, optional
        Corrections of bones, see `captured_body`.
    figure : str
        Root of the skeleton to read from a BVH file with several; empty for the first that is a body.

    Raises
    ------
    FileError
        The file has another format or no animation, or a leg, an arm, the hips or the head cannot be found.
    """
    file = Path(path)
    bvh = read_motion_file(file, figure)
    if not bvh.figures or figure:
        return _of_figure(bvh, file, fps, joints)
    failures = list[FileError]()
    for name in bvh.figures[:MOST_FIGURES]:
        one = bvh if name == bvh.figure else read_motion_file(file, name)
        others = shortened(", ".join(other for other in bvh.figures if other != name), 80)
        guess = Message("motion.figures", {"name": name, "others": others})
        try:
            return _of_figure(replace(one, guesses=(*one.guesses, guess)), file, fps, joints)
        except FileError as error:
            # Corrections may name bones of another figure.
            failures.append(error)
    no_body = next((error for error in failures if isinstance(error, BodyError)), None)
    if no_body is None:
        raise failures[0]
    figures = shortened(", ".join(bvh.figures), 200)
    raise BodyError("motion.no_body", no_body.skeleton, file=str(file), figures=figures) from no_body


def _of_figure(bvh: BvhClip, file: Path, fps: Fraction | None, joints: Mapping[str, str] | None) -> ReadMotion:
    """Read the motion of one skeleton in a file, and check it against the size limits."""
    rate = fps or bvh.fps
    require_rate(rate, str(file))
    seconds = (len(bvh.rotations_xyzw) - 1) / float(rate)
    # Files beside this one count too.
    size = max(file.stat().st_size, bvh.rotations_xyzw.nbytes)
    require_frames(str(file), seconds, float(rate), len(SEGMENTS), size)
    return motion_of(bvh, str(file), fps, joints)


def guesses(motion: ReadMotion) -> tuple[Message, ...]:
    """Return messages about what was guessed when a motion file was read, which the user may want to correct."""
    found = []
    if (rate := motion.clip.fps * motion.cleaned.held) != motion.file_fps:
        found.append(Message("motion.rate", {"rate": str(rate), "said": str(motion.file_fps)}))
    elif motion.rate_guess is not None:
        found.append(motion.rate_guess)
    found += motion.file_guesses
    if not motion.unit:
        found.append(Message("motion.no_unit"))
    found += remarks(motion.cleaned)
    if motion.floor_moved_m:
        found.append(Message("motion.floor_moved", {"moved_cm": round(100.0 * motion.floor_moved_m)}))
    if motion.joints_doubtful:
        found.append(Message("motion.doubtful", {"joints": ", ".join(motion.joints_doubtful)}))
    if motion.apart_m > FAR_M:
        found.append(Message("motion.apart", {"apart_mm": round(1000.0 * motion.apart_m)}))
    return tuple(found)


def motion_of(
    bvh: BvhClip, file: str, fps: Fraction | None = None, joints: Mapping[str, str] | None = None
) -> ReadMotion:
    """Read the motion of a clip; ``file`` is its name for messages, other parameters as of `read_motion`."""
    lengths = (bvh.offsets_cm, bvh.root_translation_cm, *bvh.end_sites_cm.values(), *bvh.translations_cm.values())
    if any((np.abs(one) > FARTHEST_CM).any() for one in lengths):
        raise FileError("motion.far", file=file)
    file_fps, repeats, bvh = bvh.fps, *_without_held(bvh)
    fps = fps / repeats if fps else bvh.fps
    found = captured_body(bvh, file, joints)
    units = place_units(found.body.positions, found.body.joints)
    if units is not None:
        bvh = with_places(bvh, found.body.joints["hips"], *units)
        found = captured_body(bvh, file, joints)
    held = list(found.body.segments.values())
    t_pose = np.array([found.t_pose[name] for name in SEGMENTS])
    rotations = quaternion.multiply(found.body.rotations[:, held], quaternion.conjugate(t_pose))
    positions = found.body.positions[:, held]
    moving = moving_frames(bvh)
    offsets = _offsets(positions[moving], rotations[moving])
    ends = np.array([_end(name, quaternion.rotate(found.t_pose[name], found.hanging[name])) for name in ENDS])
    offsets[0] = 0.0
    high = _height(offsets, ends)
    unit, unit_m = _unit(high)
    ends = _lengthened(ends, high) * unit_m
    offsets, positions = offsets * unit_m, positions * unit_m
    offsets[0, 1] = -_lowest(offsets, ends)
    floor_m = floor_of_all(positions, rotations, ends)
    hips = positions[:, 0] - (0.0, floor_m, 0.0)
    whole = MotionClip(BodyShape.of(offsets, ends), fps, hips, _local(rotations))
    done = cleaned(whole)
    before, after = (round(done.held * frames) for frames in (done.lead_in, done.trail))
    proper = slice(before, len(whole) - after)
    apart_m = _apart(whole.span(proper.start, proper.stop), (positions - positions[:, :1])[proper])
    under_m = floors_m(done)
    start_m = done.clip.hips_m[0] * (1.0, 0.0, 1.0) + under_m[:, None] * (0.0, 1.0, 0.0)
    clip = replace(done.clip, hips_m=done.clip.hips_m - start_m)
    first = found.body.positions[before], found.body.rotations[before]
    return ReadMotion(
        replace(done, clip=clip, held=done.held * repeats), found.profile, unit, unit_m, found.up, file_fps,
        found.doubtful, apart_m,
        report(found.checked), raw_skeleton(bvh, file, found.found, *first), bvh.rate_guess,
        (*bvh.guesses, *found.guesses), float(np.ptp(under_m)),
    )  # fmt: skip


def _without_held(bvh: BvhClip) -> tuple[Fraction, BvhClip]:
    """Return the mean number of frames for which each is repeated, and the clip with the first of them only."""
    tracks = (bvh.rotations_xyzw, bvh.root_translation_cm, *bvh.translations_cm.values())
    changes = [np.any(np.abs(np.diff(track, axis=0)) > SAME, axis=tuple(range(1, track.ndim))) for track in tracks]
    count, kept = held_frames(np.any(changes, axis=0))
    if count == 1:
        return count, bvh
    rotations, root, *others = (track[kept] for track in tracks)
    moved = dict(zip(bvh.translations_cm, others, strict=True))
    return count, replace(
        bvh, fps=bvh.fps / count, rotations_xyzw=rotations, root_translation_cm=root, translations_cm=moved
    )


def _offsets(positions: FloatArray, rotations: FloatArray) -> FloatArray:
    """Mean position (16, 3) of each segment's joint relative to its parent segment, in the parent's axes."""
    offsets = np.zeros((len(SEGMENTS), 3))
    for at, name in enumerate(SEGMENTS[1:], start=1):
        above = SEGMENTS.index(PARENT_OF[name])
        way = positions[:, at] - positions[:, above]
        offsets[at] = quaternion.rotate(quaternion.conjugate(rotations[:, above]), way).mean(axis=0)
    return offsets


def _end(name: str, ways: FloatArray) -> FloatArray:
    """Vector (3,) to the farthest of the points ``ways`` (N, 3) attached to a last segment (head, hand or foot), in the
    T-pose.
    """
    along = {"head": (0.0, 1.0, 0.0), "leftHand": (1.0, 0.0, 0.0), "rightHand": (-1.0, 0.0, 0.0)}
    reach = ways @ np.array(along.get(name, (0.0, 0.0, 1.0)))
    # A head extends beyond joints such as eyes, along the upward axis; other segments extend to their farthest point.
    return ways[int(np.argmax(reach))] if name != "head" else np.array([0.0, float(reach.max()), 0.0])


def _apart(clip: MotionClip, seen: FloatArray) -> float:
    """Greatest distance in metres of a joint of the clip from its position in the file, given relative to the hips as
    ``seen`` (F, 16, 3).
    """
    joints = clip.world().positions_m[:, 1:]
    return float(np.linalg.norm(joints - joints[:, :1] - seen, axis=-1).max())


def _height(offsets: FloatArray, ends: FloatArray) -> float:
    places = _t_places(offsets)
    crown = places[SEGMENTS.index("head")] + ends[ENDS.index("head")]
    return float(crown[1] - _lowest(offsets, ends))


def _t_places(offsets: FloatArray) -> FloatArray:
    places = offsets.copy()
    for at, name in enumerate(SEGMENTS[1:], start=1):
        places[at] += places[SEGMENTS.index(PARENT_OF[name])]
    return places


def _lowest(offsets: FloatArray, ends: FloatArray) -> float:
    """Return the height of the lowest point of the feet in the T-pose, relative to the hips' offset."""
    places = _t_places(offsets)
    heights = [places[SEGMENTS.index(name), 1] + min(0.0, float(ends[ENDS.index(name), 1])) for name in ENDS[3:]]
    return float(min(heights))


def _unit(height: float) -> tuple[str, float]:
    if height <= 0.0:
        return "", 1.0
    fits = [(name, unit) for name, unit in UNITS_M.items() if HEIGHTS_M[0] <= height * unit <= HEIGHTS_M[1]]
    return fits[0] if fits else ("", HEIGHT_M / height)


def _lengthened(ends: FloatArray, height: float) -> FloatArray:
    """Replace end vectors that are missing (shorter than a third of the usual length) by ones of usual length for a
    body of this height.
    """
    ways = ((0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, 1.0))
    parts = (CROWN_PART, HAND_PART, HAND_PART, FOOT_PART, FOOT_PART)
    result = ends.copy()
    for at, (way, part) in enumerate(zip(ways, parts, strict=True)):
        if np.linalg.norm(ends[at]) < part * height / 3.0:
            result[at] = np.array(way) * part * height
    return result


def _local(rotations: FloatArray) -> FloatArray:
    """Convert the world rotations (F, S, 4) of S segments to rotations relative to their parent segments, continuous
    over time.
    """
    local = rotations.copy()
    for at, name in enumerate(SEGMENTS[1:], start=1):
        above = SEGMENTS.index(PARENT_OF[name])
        local[:, at] = quaternion.multiply(quaternion.conjugate(rotations[:, above]), rotations[:, at])
    local = quaternion.normalize(local)
    flips = np.einsum("fji,fji->fj", local[1:], local[:-1]) < 0.0
    sides = np.concatenate([np.ones((1, len(SEGMENTS))), np.where(flips, -1.0, 1.0)]).cumprod(axis=0)
    continuous: FloatArray = local * sides[..., None]
    return continuous
