"""Finding of a character's lips and of an instrument's place on them, by the kind of embouchure.

A cup lies on both lips where they meet, a plate under the lower lip. Other mouthpieces are in the middle of the mouth's
opening, whose edges are found among the vertices around the mouth, with the morphs of the embouchure applied and with
the jaw open as far as necessary.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Final

import numpy as np
import numpy.typing as npt

from app.arrays import BoolArray, FloatArray, IndexArray
from app.rig import quaternion
from app.rig.characters.landmarks import JAW_MORPHS
from app.rig.grip.body_size import face_size
from app.rig.grip.carriage import carriage_rotation, carrying, joint_rotations, usual_posture
from app.rig.grip.grip_pose import Lips
from app.rig.model import Character, Landmark
from app.rig.skeleton import forward
from app.rig.skinning import mesh_named, patch, skin_matrices
from instrument_maps.model import InstrumentMap
from metadata.model import Body

AROUND_M = 0.03
"""Distance in metres from the meeting point of the lips within which their edges are searched for."""
MIDDLE_M = 0.0045
"""Largest distance of the lips' edges from the middle of the face."""
DEPTH_M = 0.006
"""Largest depth of the lips' edges inside the mouth: farther in are gums and teeth."""
UPPER_SHARE, LOWER_SHARE = 0.3, 0.7
"""Share of the jaw's motion below which a vertex belongs to the upper lip, and above which to the lower lip."""
SAME_M = 1e-4
"""Distance in metres from the middle below which a vertex belongs to both halves."""
MOUTH_M = (0.0, -0.031, 0.104)
"""Position of an adult's lips in the head's frame, for a head without lips."""
WIDER = (1.0, 2.0, 4.0)
"""Factors of the distance from the middle, tried in turn if there are few vertices."""
LEAST_PARTED_M = 0.002
"""Least distance in metres by which the morph that opens an adult's mouth must part the lips."""
CLOSING_MORPH: Final = "mouthClose"
"""Shape that closes the lips while the jaw is open; on faces with it, shapes of the lips do not open the mouth."""
ROUNDS = 3
"""Rounds in which the edges are found with the jaw position that they require; two suffice for convergence."""


@dataclass(frozen=True, eq=False)
class LipPlaces:
    """Places on a character's lips that an instrument touches, as groups of vertices.

    Attributes
    ----------
    contact : Landmark
        Place of the map's ``mouthpiece.position_m`` during playing.
    carrier : Landmark
        Place that supports the instrument while the mouth is open for a breath.
    upper, lower : Landmark
        The edges of the opening between the lips.
    """

    contact: Landmark
    carrier: Landmark
    upper: Landmark
    lower: Landmark


def needed_landmarks(instrument_map: InstrumentMap) -> frozenset[str]:
    """Return the landmarks that the instrument's kind of embouchure requires."""
    return frozenset(("lips.contact", "lips.lower" if instrument_map.embouchure.kind == "air_jet" else "lips.upper"))


def lip_places(character: Character, instrument_map: InstrumentMap, body: Body) -> LipPlaces:
    """Return the place of the instrument on the lips."""
    marks, embouchure = character.landmarks, instrument_map.embouchure
    face = body.embouchure[embouchure.kind]
    opening_m = embouchure.lips_apart_m + face.opening_m
    mouth = None if opening_m == 0.0 else _mouth(character)
    if mouth is None:
        contact = marks["lips.lower" if embouchure.kind == "air_jet" else "lips.contact"]
        carrier = contact if embouchure.kind == "air_jet" else marks["lips.upper"]
        return LipPlaces(contact, carrier, marks["lips.upper"], marks["lips.lower"])
    up, ahead = _mouthpiece_axes(character, instrument_map, body)
    upper, lower = mouth.edges(face.usual, opening_m, up, ahead)
    edges = (Landmark(mouth.mesh, mouth.vertices[upper]), Landmark(mouth.mesh, mouth.vertices[lower]))
    if embouchure.kind == "air_jet":
        return LipPlaces(marks["lips.lower"], marks["lips.lower"], *edges)
    both = Landmark(mouth.mesh, np.concatenate([edge.vertices for edge in edges]))
    return LipPlaces(both, edges[0], *edges)


def fit_lips(character: Character, instrument_map: InstrumentMap, body: Body) -> Lips:
    """Return the place of an instrument on the lips in the head's frame, with the influence of each morph."""
    embouchure = instrument_map.embouchure
    if not needed_landmarks(instrument_map) <= character.landmarks.keys():
        about_m = face_size(character) * np.array(MOUTH_M)
        return Lips(about_m, {}, {}, about_m)
    places = lip_places(character, instrument_map, body)
    contact_m, contact = _in_head(character, places.contact)
    _, carrier = _in_head(character, places.carrier)
    opening_m = body.embouchure[embouchure.kind].opening_m
    usual_m, gap_m, gap, jaw, vowels = contact_m, 0.0, dict[str, float](), "", tuple[str, ...]()
    mouth = None if embouchure.lips_apart_m + opening_m == 0.0 else _mouth(character)
    if mouth is not None:
        up, _ = _mouthpiece_axes(character, instrument_map, body)
        (upper_m, upper), (lower_m, lower) = (_in_head(character, edge) for edge in (places.upper, places.lower))
        still = np.zeros(3)
        gap_m = float((upper_m - lower_m) @ up)
        gap = {
            name: float((upper.get(name, still) - lower.get(name, still)) @ up)
            for name in sorted(upper.keys() | lower.keys())
        }
        # Lips that the morph hardly parts cannot be set by it: the mouth would stay open for nothing.
        jaw = mouth.jaw if gap.get(mouth.jaw, 0.0) > LEAST_PARTED_M * mouth.size else ""
        if jaw and CLOSING_MORPH not in mouth.deltas_m:
            vowels = tuple(name for name, opens_m in gap.items() if name.startswith("mouth") and opens_m > 0.0)
            # Where a shape moves half of the upper lip, its edge is found above the seam of lips closed at rest.
            gap_m = min(gap_m, LEAST_PARTED_M * mouth.size)
        if embouchure.lips_apart_m > 0.0:
            # Independent of the face's weights, so that holds need not be fitted again when they change.
            usual_m = _in_head(character, character.landmarks["lips.contact"])[0] - 0.5 * embouchure.lips_apart_m * up
    return Lips(
        contact_rest_m=contact_m,
        contact_deltas_m=contact,
        carrier_deltas_m=carrier,
        usual_m=usual_m,
        apart_m=embouchure.lips_apart_m,
        opening_m=opening_m,
        gap_rest_m=gap_m,
        gap_deltas_m=gap,
        jaw=jaw,
        vowels=vowels,
    )


def with_lip_landmarks(character: Character, instrument_map: InstrumentMap, body: Body) -> Character:
    """Return the character with landmarks ``lips.contact`` and ``lips.upper`` at the places of the instrument during
    playing and breathing, for the measurement of contacts. For a cup they exist already; a character without lips is
    unchanged.
    """
    if not needed_landmarks(instrument_map) <= character.landmarks.keys():
        return character
    places = lip_places(character, instrument_map, body)
    if places.contact is character.landmarks["lips.contact"]:
        return character
    vertices = (tuple(place.vertices.tolist()) for place in (places.contact, places.carrier))
    return _with_lips(character, places.contact.mesh, *vertices)


@lru_cache(maxsize=64)
def _with_lips(character: Character, mesh: str, contact: tuple[int, ...], carrier: tuple[int, ...]) -> Character:
    own = {
        name: Landmark(mesh, np.array(vertices, dtype=np.int32))
        for name, vertices in (("lips.contact", contact), ("lips.upper", carrier))
    }
    return replace(character, landmarks={**character.landmarks, **own})


def _in_head(character: Character, place: Landmark) -> tuple[FloatArray, dict[str, FloatArray]]:
    """Return the position (3,) of a landmark in the head's frame at rest, and its displacement by each morph at weight
    1.
    """
    return _of_head(character, place.mesh, tuple(place.vertices.tolist()))


@lru_cache(maxsize=64)
def _of_head(character: Character, mesh: str, vertices: tuple[int, ...]) -> tuple[FloatArray, dict[str, FloatArray]]:
    # Most instruments use the same landmarks.
    positions, deltas = _skin(character, Landmark(mesh, np.array(vertices, dtype=np.int32)))
    moved = {name: delta.mean(axis=0) for name, delta in deltas.items()}
    moving = {name: delta for name, delta in moved.items() if np.abs(delta).max() > 1e-6}
    return positions.mean(axis=0), moving


def _skin(character: Character, place: Landmark) -> tuple[FloatArray, dict[str, FloatArray]]:
    """Return the positions (V, 3) of a landmark's V vertices in the head's frame at rest, and their displacements by
    morph.
    """
    part = patch(character, mesh_named(character, place.mesh), place.vertices)
    skeleton = character.skeleton
    rest = forward(skeleton, np.tile(quaternion.IDENTITY, (1, len(skeleton.names), 1)))
    head_m, _ = rest.of(skeleton.index("head"))
    matrices = np.tensordot(part.weights, skin_matrices(part.joints, part.joint_from_mesh, rest)[0], axes=1)
    positions = np.einsum("vab,vb->va", matrices[..., :3], part.positions_m) + matrices[..., 3] - head_m[0]
    return positions, {name: np.einsum("vab,vb->va", matrices[..., :3], delta) for name, delta in part.morphs.items()}


def _mouthpiece_axes(character: Character, instrument_map: InstrumentMap, body: Body) -> tuple[FloatArray, FloatArray]:
    """Return the mouthpiece's up direction (3,) and the direction of the air (3,) in the head's frame in the usual
    carriage.
    """
    usual = usual_posture(instrument_map)
    carriage = instrument_map.hold.carriage(usual)
    posed = forward(character.skeleton, joint_rotations(character.skeleton, carrying(body, usual, carriage)))
    _, head = posed.of(character.skeleton.index("head"))
    turn = carriage_rotation(carriage.pitch_down_deg[1], carriage.yaw_left_deg[1], carriage.roll_left_deg[1])
    inward = quaternion.multiply(quaternion.conjugate(head[0]), turn)
    mouthpiece = instrument_map.mouthpiece
    return (
        quaternion.rotate(inward, np.asarray(mouthpiece.up_axis, dtype=np.float64)),
        quaternion.rotate(inward, np.asarray(mouthpiece.air_axis, dtype=np.float64)),
    )


@dataclass(frozen=True, eq=False)
class _Mouth:
    """The skin around the middle of the mouth in the head's frame.

    Attributes
    ----------
    vertices : (V,) int32
        Indices in the face's mesh.
    positions_m : (V, 3) float64
        Positions at rest.
    deltas_m : dict of str to (V, 3) float64
        Displacements by each morph at weight 1.
    seam_m : (3,) float64
        Meeting point of the lips.
    jaw : str
        Morph that opens the mouth.
    upper, lower : (V,) bool
        Whether each vertex belongs to the upper or lower lip.
    size : float
        Size of the face relative to an adult's.
    """

    mesh: str
    vertices: npt.NDArray[np.int32]
    positions_m: FloatArray
    deltas_m: Mapping[str, FloatArray]
    seam_m: FloatArray
    jaw: str
    upper: BoolArray
    lower: BoolArray
    size: float = 1.0

    def edges(
        self, weights: Mapping[str, float], opening_m: float, up: FloatArray, ahead: FloatArray
    ) -> tuple[IndexArray, IndexArray]:
        """Return the vertex indices of upper and lower lip that touch the mouthpiece, with the lips opened to the
        height ``opening_m``; ``up`` and ``ahead`` are directions in the head's frame.
        """
        shape: FloatArray = self.positions_m + sum(
            weight * self.deltas_m[name] for name, weight in weights.items() if name in self.deltas_m
        )
        jaw = 0.0
        upper = lower = np.zeros(0, dtype=np.intp)
        for _ in range(ROUNDS):
            opened = shape + jaw * self.deltas_m[self.jaw]
            height = opened @ up
            # Depth of each lip separately: the jaw takes the lower one back.
            depth = (opened - self.seam_m) @ ahead
            upper, lower = (
                self._edge(height * sign, depth, own) for sign, own in ((1.0, self.upper), (-1.0, self.lower))
            )
            drop = self.deltas_m[self.jaw] @ up
            gap_m = (shape @ up)[upper].mean() - (shape @ up)[lower].mean()
            jaw = float(np.clip((opening_m - gap_m) / (drop[upper].mean() - drop[lower].mean()), 0.0, 1.0))
        return upper, lower

    def _edge(self, height: FloatArray, depth: FloatArray, own: BoolArray) -> IndexArray:
        """Return the indices of the lowest vertex in the left half and in the right half of a lip.

        Their mean is in the middle of the mouth. ``height`` and ``depth`` (V,) are those of all vertices, ``own`` (V,)
        marks the vertices of the lip.
        """
        front = float(np.percentile(depth[own], 90.0))
        outside = own & (depth > front - DEPTH_M * self.size)
        off_m = self.positions_m[:, 0] - self.seam_m[0]
        halves = (np.flatnonzero(outside & half) for half in (off_m > -SAME_M, off_m < SAME_M))
        return np.array([rows[height[rows].argmin()] for rows in halves if len(rows)], dtype=np.intp)


@lru_cache(maxsize=32)
def _mouth(character: Character) -> _Mouth | None:
    """Return the mouth of a character; None if no morph opens it."""
    lips, size = character.landmarks["lips.contact"], face_size(character)
    mesh = mesh_named(character, lips.mesh)
    morphs = {morph.name for morph in mesh.morphs}
    jaw = next((name for name in JAW_MORPHS if name in morphs), None)
    if jaw is None:
        return None
    raw = np.asarray(mesh.positions_m, dtype=np.float64)
    near = np.linalg.norm(raw - raw[lips.vertices].mean(axis=0), axis=1) < AROUND_M * size
    around = Landmark(lips.mesh, np.flatnonzero(near).astype(np.int32))
    positions_m, deltas_m = _skin(character, around)
    if jaw not in deltas_m:
        return None
    seam_m, _ = _in_head(character, lips)
    # A drawn mouth that is a slit at rest opens upwards too.
    drop = np.linalg.norm(deltas_m[jaw], axis=1) * np.where(deltas_m[jaw][:, 1] > 0.0, -1.0, 1.0)
    for wider in WIDER:
        middle = np.abs(positions_m[:, 0] - seam_m[0]) < wider * MIDDLE_M * size
        most = drop[middle].max(initial=0.0)
        upper, lower = middle & (drop < UPPER_SHARE * most), middle & (drop > LOWER_SHARE * most)
        # A chin that does not move with the mouth lies below it.
        upper &= positions_m[:, 1] > positions_m[lower, 1].min(initial=np.inf)
        if upper.any() and lower.any():
            return _Mouth(lips.mesh, around.vertices, positions_m, deltas_m, seam_m, jaw, upper, lower, size)
    return None
