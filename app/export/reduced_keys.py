"""Fewer keys: which frames of a clip are written so that whatever a program shows between them is near enough.

What is bounded, at every frame, whether a program interpolates Euler angles (FBX) or quaternions (glTF, USD, Blender):

- each bone's rotation by `ROTATION_DEG` and place by `PLACE_MM`, each morph's weight by `WEIGHT`;
- after the hierarchy, every landmark of a character and every joint, or the whole surface of an instrument, by
  `PLACE_MM`.

A bone's rotation is allowed as much as its share of what the marks below it may be off. Shares are chosen so that keys
are few: a bone needs keys in proportion to the square root of how fast it changes direction, over the square root of
what it may be off; with the sum of squares over a chain of bones given, the least number comes of tolerances that grow
with (change / reach) to the power 2/3. What is still beyond its bound then is put right by further keys.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from app.arrays import AnyFloatArray, AnyIntArray, BoolArray, SingleArray
from app.export.key_reduction_landmarks import SkinnedMarks, rigid_links
from app.export.playback import METRES
from app.formats.continuous import continuous
from app.formats.euler import matrices
from app.formats.fbx.curves import curve_rotations, place_curves, rotation_curves
from app.formats.keys import Keys, KeySpans, runs, straight_keys
from app.formats.scene import Clip, Scene

PLACE_MM: Final = 0.5
INSTRUMENT_MM: Final = 0.25
"""An instrument has few bones, and what touches it adds its own share."""
ROTATION_DEG: Final = 0.25
WEIGHT: Final = 0.005

_ROTATION_RAD = float(np.radians(ROTATION_DEG))
_CHAIN = 1.2
"""Root of the sum of squares that the bones of a chain may have, as a multiple of the bound: they are seldom all off
at once and to the same side."""
_BOX = float(np.sqrt(2.0))
"""Each number of a rotation or place may be off by its tolerance over this."""
_MORPHS = 0.5
"""Share of a mark's tolerance for all morphs together."""
_SAMPLES, _CHUNK, _ROUNDS = 16, 512, 8
_STILL = 1e-7


def reduced(scene: Scene, marks: SkinnedMarks, most_mm: float, pose: bool = False) -> Scene:
    """A scene whose clip has few keys.

    Parameters
    ----------
    scene : Scene
        With a clip.
    marks : SkinnedMarks
        Of the scene's surfaces.
    most_mm : float
        How far marks, and bones from their parents, may be off.
    pose : bool
        Whether keys that all bones share are worked out too.
    """
    clip = scene.clip
    assert clip is not None
    weights, face = _weight_keys(clip, marks, most_mm / 1000.0)
    # Of the curves as they are written with few keys.
    clip = replace(clip, keys=Keys(tuple(np.zeros(1, np.intp) for _ in scene.bones), weights, face))
    motion = _Motion(scene, clip, marks, most_mm / 1000.0)
    bones = [np.zeros(1, np.intp) for _ in scene.bones]
    poses = np.zeros(1, np.intp) if pose else None
    if len(motion.moving):
        values = motion.scaled()
        kept = np.zeros((len(motion.moving), clip.frames), bool)
        for rows, numbers in values:
            kept[rows] = straight_keys(numbers)
        _settle(motion, kept, shared=False)
        for row, bone in enumerate(motion.moving.tolist()):
            bones[bone] = np.flatnonzero(kept[row])
        if pose:
            together = np.concatenate([row for _, numbers in values for row in numbers], axis=1)
            kept = np.repeat(straight_keys(together[None]), len(motion.moving), axis=0)
            _settle(motion, kept, shared=True)
            poses = np.flatnonzero(kept[0])
    keys = Keys(tuple(bones), weights, face, poses)
    return replace(scene, clip=replace(clip, keys=_with_end(keys, clip.frames)))


def _with_end(keys: Keys, frames: int) -> Keys:
    """The keys, with one on the last frame where there is none: programs take it for the animation's length."""
    end = np.array([0, frames - 1]) if frames > 1 else np.zeros(1, np.intp)
    if not any(one[-1] == frames - 1 for one in (*keys.bones, *keys.morphs.values())):
        keys = replace(keys, bones=(end, *keys.bones[1:]))
    if keys.pose is not None and keys.pose[-1] != frames - 1 and keys.face[-1] != frames - 1:
        keys = replace(keys, pose=np.union1d(keys.pose, end))
    return keys


def _weight_keys(clip: Clip, marks: SkinnedMarks, most_m: float) -> tuple[dict[str, AnyIntArray], AnyIntArray]:
    """Frames of each morph's keys, and of those of all morphs together."""
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


class _Motion:
    """Motion of a scene's bones and of the marks on them.

    Attributes
    ----------
    moving : (N,) int
        Bones that do anything; the rows of the other arrays are of these.
    rotations : (N, F, 4) float32
    angles : (N, F, 3) float32
        Degrees, as in FBX.
    places_m : mapping of int to (F, 3) float64
        By row; of the bones that leave their place.
    """

    def __init__(self, scene: Scene, clip: Clip, marks: SkinnedMarks, most_m: float) -> None:
        self.marks, self.frames, self.most_m = marks, clip.frames, most_m
        self.parents = [bone.parent for bone in scene.bones]
        rotations = continuous(clip.rotations_xyzw)
        places_m = {
            bone: np.ascontiguousarray(place_curves(clip, bone).T, np.float64) * METRES for bone in clip.translations_cm
        }
        moves = (np.abs(rotations - rotations[:1]) > _STILL).any(axis=(0, 2))
        for bone, values in places_m.items():
            moves[bone] |= bool((values != values[0]).any())
        self.moving = np.flatnonzero(moves)
        self.rotations = np.ascontiguousarray(rotations[:, moves].transpose(1, 0, 2))
        self._turning = [scene.bones[bone] for bone in self.moving.tolist()]
        self.angles = rotation_curves(scene.bones, clip)[moves].transpose(0, 2, 1).astype(np.float32)
        self.places_m = {row: places_m[bone] for row, bone in enumerate(self.moving.tolist()) if bone in places_m}
        still_m = np.stack([np.asarray(bone.translation_cm, np.float64) for bone in scene.bones]) * METRES
        for bone, values in places_m.items():
            still_m[bone] = values[0]
        self._links, self._carried = rigid_links(marks, self.parents, self.moving, matrices(rotations[0]), still_m)
        rest = np.zeros(clip.frames)
        self.weights = np.array([clip.morph_weights.get(name, rest) for name in marks.morphs], np.float64)
        self.weights = self.weights.reshape(-1, clip.frames)
        assert clip.keys is not None
        face = np.zeros((1, clip.frames), bool)
        face[0, clip.keys.face] = True
        self._face_weights = KeySpans.of(face).straight(self.weights.T[None])[0].T
        self.chains = marks.hang_on(self.parents)[:, self.moving]
        """True for each mark (K,) that hangs on a moving bone (N,)."""
        self.reach_m = self._reach_m()

    # How much each bone may be off

    def _reach_m(self) -> AnyFloatArray:
        """Return how far marks are from each moving bone (N,) that they hang on."""
        frames = np.unique(np.linspace(0, self.frames - 1, _SAMPLES).astype(int))
        marks_m = self.places_of_marks(*self.meant(frames))
        result = np.zeros(len(self.moving))
        for row, bone in enumerate(self.moving.tolist()):
            away_m = np.linalg.norm(marks_m[self.chains[:, row]] - marks_m[bone], axis=-1)
            result[row] = away_m.max(initial=0.0)
        return result

    def scaled(self) -> list[tuple[AnyIntArray, SingleArray]]:
        """Rows of bones, and their numbers (n, F, D) over what each may be off; those that leave their place apart."""
        turns = np.concatenate([2.0 * self.rotations, np.radians(self.angles)], axis=2)
        changes = _changes(turns) / _BOX
        place_changes = np.zeros(len(self.moving))
        for row, places_m in self.places_m.items():
            place_changes[row] = _changes(places_m[None])[0]
        turned = np.cbrt(np.maximum(self.reach_m, _STILL) * changes**2)
        placed = np.cbrt(place_changes**2)
        chain = np.sqrt(np.maximum(self.chains @ (turned**2 + placed**2), _STILL**2))
        least = np.where(self.chains, _CHAIN * self.most_m / chain[:, None], np.inf).min(axis=0)
        tolerance = np.minimum(_ROTATION_RAD, least * turned / np.maximum(self.reach_m, _STILL))
        tolerance_m = np.minimum(self.most_m, least * placed)
        tolerance = np.where(changes > 0.0, tolerance, _ROTATION_RAD) / _BOX
        turns /= tolerance[:, None, None].astype(np.float32)
        result: list[tuple[AnyIntArray, SingleArray]] = []
        leaving = np.isin(np.arange(len(self.moving)), list(self.places_m))
        for rows in (np.flatnonzero(~leaving), np.flatnonzero(leaving)):
            numbers = turns[rows]
            if leaving[rows].any():
                off_m = np.where(place_changes > 0.0, tolerance_m, self.most_m)[rows] / _BOX
                places = np.stack([self.places_m[row] - self.places_m[row][0] for row in rows.tolist()])
                numbers = np.concatenate([numbers, (places / off_m[:, None, None]).astype(np.float32)], axis=2)
            if len(rows):
                result.append((rows, numbers))
        return result

    # What a program shows

    def places_of_marks(
        self, turned: AnyFloatArray, places_m: Mapping[int, AnyFloatArray], weights: AnyFloatArray
    ) -> AnyFloatArray:
        """Places of the marks (K, f, 3) at some frames, metres.

        Parameters
        ----------
        turned : (N, f, 4)
            Rotations of the moving bones.
        places_m : mapping of int to (f, 3)
            By row, of those that leave their place.
        weights : (M, f)
            Of the marks' morphs.
        """
        local = matrices(turned).astype(np.float32)
        placed_m = {row: values.astype(np.float32) for row, values in places_m.items()}
        result = np.zeros((self.marks.count, turned.shape[1], 3), np.float32)
        placed: list[tuple[AnyFloatArray, AnyFloatArray]] = []
        for row, link in enumerate(self._links):
            turn: AnyFloatArray = local[row]
            place_m: AnyFloatArray = placed_m.get(row, link.place_m)
            if link.turn is not None:
                turn, place_m = link.turn @ turn, _applied(link.turn, place_m) + link.offset_m
            if link.above >= 0:
                above, above_m = placed[link.above]
                turn, place_m = above @ turn, above_m + _applied(above, place_m)
            placed.append((turn, place_m))
        placed.append((np.eye(3, dtype=np.float32), np.zeros(3, np.float32)))
        for row, carried in self._carried.items():
            turn, place_m = placed[row]
            points = carried.points_m
            if carried.shapes_m.any():
                shaped = points[:, None] + np.tensordot(
                    carried.shapes_m, weights.astype(np.float32), axes=(0, 0)
                ).swapaxes(1, 2)
                moved = _applied(turn, shaped)
            else:
                moved = (points @ turn.reshape(-1, 3).T).reshape(len(points), -1, 3)
            result[carried.marks] += moved + carried.shares[:, None, None] * place_m
        return result

    def meant(self, frames: AnyIntArray) -> KeyedPoses:
        """Exact motion at some frames."""
        places_m = {row: values[frames] for row, values in self.places_m.items()}
        return KeyedPoses(self.rotations[:, frames].astype(np.float64), places_m, self.weights[:, frames])

    def shown(self, frames: AnyIntArray, spans: KeySpans, by_angles: bool) -> KeyedPoses:
        """Motion at some frames between keys in a program that interpolates angles or quaternions."""
        angles = spans.straight(self.angles) if by_angles else None
        turned = spans.turned(self.rotations) if angles is None else curve_rotations(self._turning, angles)
        places_m = {row: spans.row(row).straight(values[None])[0] for row, values in self.places_m.items()}
        return KeyedPoses(turned, places_m, self._face_weights[:, frames])


class KeyedPoses(NamedTuple):
    """Rotations (N, f, 4) and, by row, places (f, 3) of the moving bones, and weights (M, f) of the marks' morphs."""

    turned: AnyFloatArray
    places_m: Mapping[int, AnyFloatArray]
    weights: AnyFloatArray


def _together(shown: Sequence[KeyedPoses]) -> KeyedPoses:
    """Frames after frames."""
    return KeyedPoses(
        np.concatenate([one.turned for one in shown], axis=1),
        {row: np.concatenate([one.places_m[row] for one in shown]) for row in shown[0].places_m},
        np.concatenate([one.weights for one in shown], axis=1),
    )


def _applied(turns: AnyFloatArray, vectors: AnyFloatArray) -> AnyFloatArray:
    """Vectors (..., f, 3), or (3,), turned."""
    if vectors.ndim == 1 and turns.ndim == 3:
        return np.asarray((turns.reshape(-1, 3) @ vectors).reshape(-1, 3))
    return np.asarray(np.einsum("...ij,...j->...i", turns, vectors))


def _changes(values: AnyFloatArray) -> AnyFloatArray:
    """Return how many keys curves (N, F, D) need: the mean root of how much they change direction from frame to
    frame."""
    if values.shape[1] < 3:
        return np.zeros(len(values))
    seconds = np.diff(values, 2, axis=1)
    return np.asarray(np.sqrt(np.sqrt(np.einsum("nfd,nfd->nf", seconds, seconds))).mean(axis=1), np.float64)


def _settle(motion: _Motion, kept: BoolArray, shared: bool) -> None:
    """Add keys until everything is within its bounds at every frame.

    Parameters
    ----------
    motion : _Motion
    kept : (N, F) bool
        The keys of the moving bones; changed in place.
    shared : bool
        Whether all bones have theirs at the same frames, and no program interpolates angles.
    """
    changed = np.ones(motion.frames, bool)
    rounds = 0
    while changed.any():
        rounds += 1
        spans = KeySpans.of(kept)
        added, beyond = np.zeros(kept.shape, bool), np.zeros(motion.frames, bool)
        frames = np.flatnonzero(changed)
        for first in range(0, len(frames), _CHUNK):
            some = frames[first : first + _CHUNK]
            beyond[some] = _add_keys(motion, kept, added, spans, some, shared, rounds > _ROUNDS)
        if shared:
            added[:] = added.any(axis=0)
        # Whatever is between the keys around a new one has another line now.
        new = added & ~kept
        if not new.any():
            return
        rows, places = np.nonzero(new)
        touched = np.zeros(motion.frames + 1, np.int64)
        np.add.at(touched, spans.before[rows, places], 1)
        np.add.at(touched, spans.after[rows, places] + 1, -1)
        changed = beyond | (np.cumsum(touched)[:-1] > 0)
        kept |= new


def _add_keys(
    motion: _Motion,
    kept: BoolArray,
    added: BoolArray,
    spans: KeySpans,
    frames: AnyIntArray,
    shared: bool,
    all_frames: bool,
) -> BoolArray:
    """Add keys where something is beyond its bound at some frames: at the worst of each run of them, or at all.

    Returns
    -------
    ndarray of bool, shape (f,)
        Whether anything is beyond its bound at each frame.
    """
    beyond = np.zeros(len(frames), bool)
    here = spans.at(frames)
    meant = motion.meant(frames)
    shown = [motion.shown(frames, here, by_angles) for by_angles in ((False,) if shared else (False, True))]
    marks_m = motion.places_of_marks(*_together([meant, *shown]))
    meant_m, *shown_m = np.split(marks_m, 1 + len(shown), axis=1)
    for one, one_m in zip(shown, shown_m, strict=True):
        placed_m = np.zeros((len(motion.moving), len(frames)))
        for row, places_m in one.places_m.items():
            placed_m[row] = _lengths(places_m - meant.places_m[row])
        off = _angles(one.turned, meant.turned)
        excess = np.maximum(off / _ROTATION_RAD, placed_m / motion.most_m)
        beyond |= (excess > 1.0).any(axis=0)
        for row in np.flatnonzero((excess > 1.0).any(axis=1)).tolist():
            added[row, frames[_worst(excess[row], all_frames)]] = True
        # What each bone may have to do with a mark that is off.
        off_m = _lengths(one_m - meant_m)
        effect_m = np.where(kept[:, frames], 0.0, off * motion.reach_m[:, None] + placed_m)
        marks_off = off_m.max(axis=0, initial=0.0) / motion.most_m
        beyond |= marks_off > 1.0
        for at in _worst(marks_off, all_frames):
            effects = np.where(motion.chains[int(off_m[:, at].argmax())], effect_m[:, at], 0.0)
            added[(effects > 0.0) & (effects >= (0.0 if all_frames else 0.5 * effects.max())), frames[at]] = True
    return beyond


def _worst(excess: AnyFloatArray, all_frames: bool) -> list[int]:
    """Return where something is beyond its bound: at the worst of each run of frames, or at all of them."""
    beyond = excess > 1.0
    if all_frames:
        return np.flatnonzero(beyond).tolist()
    return [span.start + int(excess[span].argmax()) for span in runs(beyond)]


def _lengths(vectors: AnyFloatArray) -> AnyFloatArray:
    """Lengths of vectors (..., D)."""
    return np.asarray(np.sqrt(np.einsum("...i,...i->...", vectors, vectors)))


def _angles(shown: AnyFloatArray, meant: AnyFloatArray) -> AnyFloatArray:
    """Angles between unit quaternions (..., 4), radians."""
    chord = np.minimum(_lengths(shown - meant), _lengths(shown + meant))
    return np.asarray(4.0 * np.arcsin(np.minimum(0.5 * chord, 1.0)))
