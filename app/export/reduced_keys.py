"""Keyframe reduction: choice of those frames of a clip that are written as keys, such that the interpolated motion
stays within bounds.

The following errors are bounded at every frame, whether a program interpolates Euler angles (FBX) or quaternions (glTF,
USD, Blender):

- each bone's rotation by `ROTATION_DEG` and position by `PLACE_MM`, each morph's weight by `WEIGHT`;
- after the hierarchy, every landmark of a character and every joint, or the whole surface of an instrument, by
  `PLACE_MM`.

The tolerance of a bone's rotation is its share of the tolerance of the points below it. Shares are chosen to minimise
keys: the keys needed are proportional to the square root of the rate of change of direction over the square root of the
tolerance; for a given sum of squares along a chain, the minimum has tolerances proportional to (change / reach) to the
power 2/3; with cubics to another power (`app.export.keyed_motion`). Remaining violations of cubics are corrected by
choosing the keys around them again with a lower tolerance, others by additional keys.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final, TypeAlias

import numpy as np

from app.arrays import AnyFloatArray, AnyIntArray, BoolArray, SingleArray
from app.export.key_reduction_landmarks import SkinnedMarks
from app.export.keyed_motion import ROTATION_RAD, KeyedMotion, together
from app.formats.cubics import cubic_keys, stretches_again
from app.formats.keys import Keys, KeySpans, runs, straight_keys
from app.formats.scene import Clip, Scene

PLACE_MM: Final = 0.5
INSTRUMENT_MM: Final = 0.25
"""Error bound in millimetres for an instrument, lower than a body's, since its error adds to that of the
hands on it.
"""
ROTATION_DEG: Final = float(np.degrees(ROTATION_RAD))
WEIGHT: Final = 0.005

_Group: TypeAlias = tuple[AnyIntArray, SingleArray]
"""Rows of some moving bones, and their values; see `KeyedMotion.scaled`."""
_MORPHS = 0.5
"""Share of a landmark's tolerance for all morphs together."""
_CHUNK, _ROUNDS = 512, 8
_AGAIN = 5
"""Number of rounds in which keys around a violation are chosen again, before keys are added."""
_AROUND, _TIGHTER = 3, 0.8
"""Number of spans before and after a violation that are chosen again, and factor of the tolerance in its span."""


def reduced(scene: Scene, marks: SkinnedMarks, most_mm: float, pose: bool = False, curved: bool = True) -> Scene:
    """Return a scene whose clip has fewer keys.

    Parameters
    ----------
    scene : Scene
        Scene with a clip.
    marks : SkinnedMarks
        Points on the scene's surfaces whose positions are bounded.
    most_mm : float
        Tolerance in millimetres for the points, and for bones relative to their parents.
    pose : bool
        Whether to compute also keys that are shared by all bones; these are linear.
    curved : bool
        Whether the keys of bones are joined by cubics, which needs fewer keys than straight lines.
    """
    clip = scene.clip
    assert clip is not None
    weights, face = _weight_keys(clip, marks, most_mm / 1000.0)
    # Measured on the curves as written with few keys.
    clip = replace(clip, keys=Keys(tuple(np.zeros(1, np.intp) for _ in scene.bones), weights, face))
    motion = KeyedMotion(scene, clip, marks, most_mm / 1000.0, curved)
    bones = [np.zeros(1, np.intp) for _ in scene.bones]
    poses = np.zeros(1, np.intp) if pose else None
    if len(motion.moving):
        values = motion.scaled()
        kept = np.zeros((len(motion.moving), clip.frames), bool)
        for rows, numbers in values:
            kept[rows] = cubic_keys(numbers) if curved else straight_keys(numbers)
        _settle(motion, kept, False, values if curved else ())
        for row, bone in enumerate(motion.moving.tolist()):
            bones[bone] = np.flatnonzero(kept[row])
        if pose:
            together = np.concatenate([row for _, numbers in values for row in numbers], axis=1)
            kept = np.repeat(straight_keys(together[None]), len(motion.moving), axis=0)
            _settle(motion, kept, True)
            poses = np.flatnonzero(kept[0])
    keys = Keys(tuple(bones), weights, face, poses, curved)
    return replace(scene, clip=replace(clip, keys=_with_end(keys, clip.frames)))


def _with_end(keys: Keys, frames: int) -> Keys:
    """Return keys with one on the last frame, since programs take the last key as the animation's length."""
    end = np.array([0, frames - 1]) if frames > 1 else np.zeros(1, np.intp)
    if not any(one[-1] == frames - 1 for one in (*keys.bones, *keys.morphs.values())):
        keys = replace(keys, bones=(end, *keys.bones[1:]))
    if keys.pose is not None and keys.pose[-1] != frames - 1 and keys.face[-1] != frames - 1:
        keys = replace(keys, pose=np.union1d(keys.pose, end))
    return keys


def _weight_keys(clip: Clip, marks: SkinnedMarks, most_m: float) -> tuple[dict[str, AnyIntArray], AnyIntArray]:
    """Return the frames of the keys that each morph needs, by name, and the frames at which any morph has one;
    ``most_m`` is the permitted error of the skin in metres."""
    names = list(clip.morph_weights)
    if not names:
        return {}, np.zeros(1, np.intp)
    effect_m = np.zeros(len(marks.morphs))
    for carried in marks.carried.values():
        effect_m = np.maximum(effect_m, np.linalg.norm(carried.shapes_m, axis=-1).max(axis=-1, initial=0.0))
    effects = dict(zip(marks.morphs, effect_m.tolist(), strict=True))
    moved = sum(name in effects for name in names)
    tolerances = [
        min(WEIGHT, _MORPHS * most_m / (moved * effects[name])) if effects.get(name) else WEIGHT for name in names
    ]
    values = np.stack([np.asarray(clip.morph_weights[name], np.float64) for name in names]) / np.c_[tolerances]
    alone, together = straight_keys(values[..., None]), straight_keys(values.T[None])
    return {name: np.flatnonzero(row) for name, row in zip(names, alone, strict=True)}, np.flatnonzero(together[0])


def _settle(motion: KeyedMotion, kept: BoolArray, shared: bool, values: Sequence[_Group] = ()) -> None:
    """Choose keys again, or add keys, until every bound holds at every frame.

    Parameters
    ----------
    motion : KeyedMotion
        The exact motion.
    kept : (N, F) bool
        Keys of the moving bones; changed in place.
    shared : bool
        Whether all bones have keys at the same frames, and no program interpolates angles.
    values : sequence of (ndarray of int, ndarray)
        Groups of the moving bones' rows and values, divided by the tolerances, from which cubic keys are chosen again;
        empty for linear keys.
    """
    changed, rows = np.ones(motion.frames, bool), np.arange(len(kept))
    limits = np.ones(kept.shape, np.float32)
    rounds = 0
    while changed.any():
        rounds += 1
        if not shared:
            motion.draw(kept, rows)
        spans = KeySpans.of(kept)
        added, beyond = np.zeros(kept.shape, bool), np.zeros(motion.frames, bool)
        frames = np.flatnonzero(changed)
        for first in range(0, len(frames), _CHUNK):
            some = frames[first : first + _CHUNK]
            beyond[some] = _add_keys(motion, kept, added, spans, some, shared, rounds > _ROUNDS)
        if shared:
            added[:] = added.any(axis=0)
        # The interpolation between the keys around a new one has changed.
        new = added & ~kept
        if not new.any():
            return
        rows, places = np.nonzero(new)
        if values and rounds <= _AGAIN:
            changed = beyond | _choose_again(kept, limits, values, rows, places)
            rows = np.unique(rows)
            continue
        touched = np.zeros(motion.frames + 1, np.int64)
        np.add.at(touched, spans.before[rows, places], 1)
        np.add.at(touched, spans.after[rows, places] + 1, -1)
        changed = beyond | (np.cumsum(touched)[:-1] > 0)
        kept |= new
        rows = np.unique(rows)


def _choose_again(
    kept: BoolArray, limits: AnyFloatArray, values: Sequence[_Group], rows: AnyIntArray, places: AnyIntArray
) -> BoolArray:
    """Choose the keys around some frames again, with a lower tolerance in the span of each frame.

    Parameters
    ----------
    kept : (N, F) bool
        Keys of the moving bones; changed in place.
    limits : (N, F) float32
        Tolerance of each bone at each frame, as a multiple of its usual one; changed in place.
    values : sequence of (ndarray of int, ndarray)
        See `_settle`.
    rows, places : (V,) int
        Bone and frame of each violation, ordered by bone and frame; the frames have no keys.

    Returns
    -------
    ndarray of bool, shape (F,)
        Mask of the frames whose interpolation may have changed.
    """
    touched = np.zeros(kept.shape[1], bool)
    for group, numbers in values:
        stretches: list[tuple[int, int, int]] = []
        for lane, row in enumerate(group.tolist()):
            own = places[rows == row]
            if len(own):
                stretches += [(lane, first, last) for first, last in _stretches(kept[row], limits[row], own)]
        if not stretches:
            continue
        lanes, begins, ends = np.array(stretches).T
        chosen = stretches_again(numbers, limits[group], lanes, begins, ends)
        for (lane, first, last), keys in zip(stretches, chosen, strict=True):
            row = int(group[lane])
            kept[row, first + 1 : last] = False
            kept[row, keys] = True
            touched[first : last + 1] = True
    return touched


def _stretches(kept: BoolArray, limits: AnyFloatArray, places: AnyIntArray) -> list[tuple[int, int]]:
    """Return the first and last frames, both with keys, of the stretches around violations of one bone at ``places``.

    Parameters
    ----------
    kept : (F,) bool
        Keys of the bone. A violation after the last key gets one on the last frame.
    limits : (F,) float32
        Tolerance, lowered in place in the spans that contain a violation.
    """
    if places[-1] > np.flatnonzero(kept)[-1]:
        kept[-1] = True
    keys = np.flatnonzero(kept)
    after = np.searchsorted(keys, places)
    found: list[tuple[int, int]] = []
    for number in np.unique(after).tolist():
        limits[keys[number - 1] : keys[number] + 1] *= _TIGHTER
        first, last = int(keys[max(number - 1 - _AROUND, 0)]), int(keys[min(number + _AROUND, len(keys) - 1)])
        if found and first < found[-1][1]:
            first, _ = found.pop()
        found.append((first, last))
    return found


def _add_keys(
    motion: KeyedMotion,
    kept: BoolArray,
    added: BoolArray,
    spans: KeySpans,
    frames: AnyIntArray,
    shared: bool,
    all_frames: bool,
) -> BoolArray:
    """Determine the keys to add because a bound is violated: at the worst frame of each run of violations, or at all
    frames.

    Parameters
    ----------
    kept : (N, F) bool
        Present keys of the moving bones.
    added : (N, F) bool
        Set to True at the keys to add.
    spans : KeySpans
        Spans between the present keys.
    frames : (f,) int
        Frames to check.
    shared : bool
        Whether all bones have keys at the same frames.
    all_frames : bool
        Whether to add a key at every frame of a violation.

    Returns
    -------
    ndarray of bool, shape (f,)
        Whether a bound is violated at each frame.
    """
    beyond = np.zeros(len(frames), bool)
    here = spans.at(frames)
    meant = motion.meant(frames)
    if motion.curved and not shared:
        shown = [motion.drawn(frames, by_angles) for by_angles in (False, True)]
    else:
        shown = [motion.shown(frames, here, by_angles) for by_angles in ((False,) if shared else (False, True))]
    marks_m = motion.places_of_marks(*together([meant, *shown]))
    meant_m, *shown_m = np.split(marks_m, 1 + len(shown), axis=1)
    for one, one_m in zip(shown, shown_m, strict=True):
        placed_m = np.zeros((len(motion.moving), len(frames)))
        for row, places_m in one.places_m.items():
            placed_m[row] = _lengths(places_m - meant.places_m[row])
        off = _angles(one.turned, meant.turned)
        excess = np.maximum(off / ROTATION_RAD, placed_m / motion.most_m)
        beyond |= (excess > 1.0).any(axis=0)
        for row in np.flatnonzero((excess > 1.0).any(axis=1)).tolist():
            added[row, frames[_worst(excess[row], all_frames)]] = True
        # Share of each bone in the error of a mark.
        off_m = _lengths(one_m - meant_m)
        effect_m = np.where(kept[:, frames], 0.0, off * motion.reach_m[:, None] + placed_m)
        marks_off = off_m.max(axis=0, initial=0.0) / motion.most_m
        beyond |= marks_off > 1.0
        for at in _worst(marks_off, all_frames):
            effects = np.where(motion.chains[int(off_m[:, at].argmax())], effect_m[:, at], 0.0)
            added[(effects > 0.0) & (effects >= (0.0 if all_frames else 0.5 * effects.max())), frames[at]] = True
    return beyond


def _worst(excess: AnyFloatArray, all_frames: bool) -> list[int]:
    """Return the frames at which ``excess`` is above 1: the worst of each run, or all."""
    beyond = excess > 1.0
    if all_frames:
        return np.flatnonzero(beyond).tolist()
    return [span.start + int(excess[span].argmax()) for span in runs(beyond)]


def _lengths(vectors: AnyFloatArray) -> AnyFloatArray:
    """Return the lengths of vectors along the last axis."""
    return np.asarray(np.sqrt(np.einsum("...i,...i->...", vectors, vectors)))


def _angles(shown: AnyFloatArray, meant: AnyFloatArray) -> AnyFloatArray:
    """Return the angles (...) between unit quaternions (..., 4), in radians."""
    chord = np.minimum(_lengths(shown - meant), _lengths(shown + meant))
    return np.asarray(4.0 * np.arcsin(np.minimum(0.5 * chord, 1.0)))
