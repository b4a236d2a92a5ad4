"""Motion of a scene's bones and points, exact and as interpolated from a few keys."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from app.arrays import AnyFloatArray, AnyIntArray, BoolArray, FloatArray, SingleArray
from app.export.key_reduction_landmarks import SkinnedMarks, rigid_links
from app.export.playback import METRES
from app.formats.continuous import continuous
from app.formats.cubics import curved_values
from app.formats.euler import matrices
from app.formats.fbx.curves import curve_rotations, place_curves, rotation_curves
from app.formats.keys import KeySpans
from app.formats.scene import Clip, Scene

ROTATION_RAD = float(np.radians(0.25))
"""Greatest error in radians of a bone's rotation after key reduction."""
_CHAIN, _CURVED_CHAIN = 1.2, 1.9
"""Greatest root sum of squares of the errors along a chain of bones, as a multiple of one bone's bound, for linear and
for cubic keys; errors rarely coincide in time and direction, and large errors of cubics last only a few frames. Where
they do coincide, cubics are fitted again with lower tolerances.
"""
_BOX, _CURVED_BOX = float(np.sqrt(2.0)), 1.0
"""Divisor of a bone's tolerance that gives the tolerance of each component of its rotation or position, for linear and
for cubic keys.
"""
_LIVELY, _CURVED_LIVELY = 2.0 / 3.0, 0.8
"""Exponent with which the need for keys of a bone increases its share of the tolerance, for linear and for cubic keys.
2/3 minimises the total number of linear keys. For cubics it was measured on a trombonist, a bassoonist and a band:
fewest keys altogether, and on arms within 2 % of the fewest.
"""
_SAMPLES = 16
_STILL = 1e-7


class KeyedMotion:
    """Exact motion of a scene's bones and of its points.

    Attributes
    ----------
    moving : (N,) int
        Indices of the bones that move; rows of the other arrays are these bones.
    rotations : (N, F, 4) float32
        Rotations relative to the parent.
    angles : (N, F, 3) float32
        Euler angles in degrees, as in FBX.
    places_m : mapping of int to (F, 3) float64
        Positions of bones that translate, by row.
    curved : bool
        Whether keys are joined by cubics.
    """

    def __init__(self, scene: Scene, clip: Clip, marks: SkinnedMarks, most_m: float, curved: bool = False) -> None:
        self.marks, self.frames, self.most_m, self.curved = marks, clip.frames, most_m, curved
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
        self._drawn: list[FloatArray] = []
        self._drawn_m: dict[int, FloatArray] = {}
        self.chains = marks.hang_on(self.parents)[:, self.moving]
        """True for each mark (K,) that hangs on a moving bone (N,)."""
        self.reach_m = self._reach_m()

    # Tolerances of bones

    def _reach_m(self) -> AnyFloatArray:
        """Return for each moving bone (N,) the distance in metres of the farthest point that it moves."""
        frames = np.unique(np.linspace(0, self.frames - 1, _SAMPLES).astype(int))
        marks_m = self.places_of_marks(*self.meant(frames))
        result = np.zeros(len(self.moving))
        for row, bone in enumerate(self.moving.tolist()):
            away_m = np.linalg.norm(marks_m[self.chains[:, row]] - marks_m[bone], axis=-1)
            result[row] = away_m.max(initial=0.0)
        return result

    def scaled(self) -> list[tuple[AnyIntArray, SingleArray]]:
        """Return groups of moving bones: their rows, and their values (n, F, D) divided by the tolerances.

        A deviation of 1 is then the permitted error. Bones that translate form groups of their own.
        """
        turns = np.concatenate([2.0 * self.rotations, np.radians(self.angles)], axis=2)
        over, within = (_CURVED_CHAIN, _CURVED_BOX) if self.curved else (_CHAIN, _BOX)
        changes = _changes(turns) / _BOX
        place_changes = np.zeros(len(self.moving))
        for row, places_m in self.places_m.items():
            place_changes[row] = _changes(places_m[None])[0]
        lively = _CURVED_LIVELY if self.curved else _LIVELY
        turned = np.cbrt(np.maximum(self.reach_m, _STILL)) * changes**lively
        placed = place_changes**lively
        chain = np.sqrt(np.maximum(self.chains @ (turned**2 + placed**2), _STILL**2))
        least = np.where(self.chains, over * self.most_m / chain[:, None], np.inf).min(axis=0)
        tolerance = np.minimum(ROTATION_RAD, least * turned / np.maximum(self.reach_m, _STILL))
        tolerance_m = np.minimum(self.most_m, least * placed)
        tolerance = np.where(changes > 0.0, tolerance, ROTATION_RAD) / within
        turns /= tolerance[:, None, None].astype(np.float32)
        result: list[tuple[AnyIntArray, SingleArray]] = []
        leaving = np.isin(np.arange(len(self.moving)), list(self.places_m))
        for rows in (np.flatnonzero(~leaving), np.flatnonzero(leaving)):
            numbers = turns[rows]
            if leaving[rows].any():
                off_m = np.where(place_changes > 0.0, tolerance_m, self.most_m)[rows] / within
                places = np.stack([self.places_m[row] - self.places_m[row][0] for row in rows.tolist()])
                numbers = np.concatenate([numbers, (places / off_m[:, None, None]).astype(np.float32)], axis=2)
            if len(rows):
                result.append((rows, numbers))
        return result

    # Motion as a program plays it

    def places_of_marks(
        self, turned: AnyFloatArray, places_m: Mapping[int, AnyFloatArray], weights: AnyFloatArray
    ) -> AnyFloatArray:
        """Return the positions (K, f, 3) of the K points in metres at f frames.

        Parameters
        ----------
        turned : (N, f, 4)
            Rotations of the moving bones.
        places_m : mapping of int to (f, 3)
            Positions of translating bones, by row.
        weights : (M, f)
            Weights of the points' morphs.
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
        """Return the exact rotations, positions and morph weights at the frames ``frames``, with which reduced keys are
        compared.
        """
        places_m = {row: values[frames] for row, values in self.places_m.items()}
        return KeyedPoses(self.rotations[:, frames].astype(np.float64), places_m, self.weights[:, frames])

    def shown(self, frames: AnyIntArray, spans: KeySpans, by_angles: bool) -> KeyedPoses:
        """Return the motion at some frames as shown by a program that interpolates between keys: Euler angles
        (``by_angles``) or quaternions.
        """
        angles = spans.straight(self.angles) if by_angles else None
        turned = spans.turned(self.rotations) if angles is None else curve_rotations(self._turning, angles)
        places_m = {row: spans.row(row).straight(values[None])[0] for row, values in self.places_m.items()}
        return KeyedPoses(turned, places_m, self._face_weights[:, frames])

    def draw(self, kept: BoolArray, rows: AnyIntArray) -> None:
        """Fit the cubic curves through the keys ``kept`` (N, F) of those moving bones with the indices ``rows``; do
        nothing if keys are linear.
        """
        if not self.curved:
            return
        if not self._drawn:
            self._drawn = [np.empty(self.rotations.shape), np.empty(self.angles.shape)]
        for drawn, values in zip(self._drawn, (self.rotations, self.angles), strict=True):
            drawn[rows] = curved_values(values[rows], kept[rows])
        for row in rows.tolist():
            if row in self.places_m:
                self._drawn_m[row] = curved_values(self.places_m[row][None], kept[row, None])[0]

    def drawn(self, frames: AnyIntArray, by_angles: bool) -> KeyedPoses:
        """Return the motion at some frames from the fitted cubics; parameters as in `shown`."""
        turned = self._drawn[by_angles][:, frames]
        if by_angles:
            turned = curve_rotations(self._turning, turned)
        else:
            turned /= np.linalg.norm(turned, axis=-1, keepdims=True)
        places_m = {row: values[frames] for row, values in self._drawn_m.items()}
        return KeyedPoses(turned, places_m, self._face_weights[:, frames])


class KeyedPoses(NamedTuple):
    """Poses of N moving bones in f frames: rotations (N, f, 4), positions (f, 3) of the translating ones by row, and
    weights (M, f) of M morphs.
    """

    turned: AnyFloatArray
    places_m: Mapping[int, AnyFloatArray]
    weights: AnyFloatArray


def together(shown: Sequence[KeyedPoses]) -> KeyedPoses:
    """Return poses of the same bones and morphs concatenated along their frames."""
    return KeyedPoses(
        np.concatenate([one.turned for one in shown], axis=1),
        {row: np.concatenate([one.places_m[row] for one in shown]) for row in shown[0].places_m},
        np.concatenate([one.weights for one in shown], axis=1),
    )


def _applied(turns: AnyFloatArray, vectors: AnyFloatArray) -> AnyFloatArray:
    """Return vectors (..., f, 3), or one (3,), rotated by ``turns`` (..., f, 4)."""
    if vectors.ndim == 1 and turns.ndim == 3:
        return np.asarray((turns.reshape(-1, 3) @ vectors).reshape(-1, 3))
    return np.asarray(np.einsum("...ij,...j->...i", turns, vectors))


def _changes(values: AnyFloatArray) -> AnyFloatArray:
    """Return for N curves (N, F, D) an estimate (N,) that is proportional to the number of keys they need: the mean
    square root of their second differences.
    """
    if values.shape[1] < 3:
        return np.zeros(len(values))
    seconds = np.diff(values, 2, axis=1)
    return np.asarray(np.sqrt(np.sqrt(np.einsum("nfd,nfd->nf", seconds, seconds))).mean(axis=1), np.float64)
