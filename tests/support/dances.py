"""Small synthetic motions and models: a body that steps and swings its arms in several ways."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from scipy.spatial.transform import Rotation

from app.choreography.body import SEGMENTS
from app.choreography.clip import BodyShape, MotionClip
from app.choreography.model import ChoreographyModel, MotionSegment, TrainingPair
from app.choreography.rhythm import Rhythm
from app.rig import quaternion

HIPS_M, ANKLE_M, THIGH_M, SHANK_M = 0.95, 0.08, 0.43, 0.40
_ARM, _LEG = [(0.18, 0.22, 0), (0.3, 0, 0), (0.26, 0, 0)], [(0.1, -0.04, 0), (0, -THIGH_M, 0), (0, -SHANK_M, 0)]
_MIRRORED = np.array((-1, 1, 1))
SHAPE = BodyShape.of(
    np.array(
        [(0, HIPS_M, 0), (0, 0.1, 0), (0, 0.2, 0), (0, 0.3, 0), *_ARM, *(_ARM * _MIRRORED), *_LEG, *(_LEG * _MIRRORED)]
    ),
    np.array([(0, 0.25, 0), (0.18, 0, 0), (-0.18, 0, 0), (0, -ANKLE_M, 0.2), (0, -ANKLE_M, 0.2)], np.float64),
)
"""A body of 1.8 m that stands with its soles on the floor."""


def still(frames: int, fps: int = 60) -> MotionClip:
    """Motion that stays in the T-pose."""
    rotations = np.zeros((frames, len(SEGMENTS), 4))
    rotations[..., 3] = 1.0
    return MotionClip(SHAPE, Fraction(fps), np.tile((0.0, HIPS_M, 0.0), (frames, 1)), rotations)


def stepping(beats: int, seed: int = 1, beat_s: float = 0.5, fps: int = 60) -> MotionClip:
    """Steps on the spot, one per beat, with arms that swing randomly far: smooth, with motionless standing feet, and
    with the greatest acceleration on the beat.
    """
    random = np.random.default_rng(seed)
    times = np.arange(round(beats * beat_s * fps) + 1) / fps / beat_s
    clip = still(len(times), fps)
    rotations = clip.rotations.copy()
    lifts = np.zeros((len(times), 2))
    arms = np.zeros((len(times), 2))
    for beat in range(beats):
        inside = np.clip(times - beat, 0.0, 1.0)
        bump = np.sin(np.pi * inside) ** 2 * ((times >= beat) & (times < beat + 1))
        lifts[:, beat % 2] += bump
        arms[:, (beat + 1) % 2] += bump * random.uniform(0.3, 1.4)
    down = Rotation.from_rotvec
    for side, sign in enumerate((1.0, -1.0)):
        name = ("left", "right")[side]
        # The knee comes up over the ankle: the foot goes straight up, and down on its place.
        raised = 0.15 * lifts[:, side]
        bend = np.arccos(np.clip(1.0 - raised / (THIGH_M + SHANK_M), -1.0, 1.0))
        across = np.stack([bend, np.zeros_like(bend), np.zeros_like(bend)], 1)
        rotations[:, SEGMENTS.index(f"{name}UpperLeg")] = down(-across).as_quat()
        shank = np.arcsin(np.clip(np.sin(bend) * THIGH_M / SHANK_M, -1.0, 1.0))
        turned = np.stack([bend + shank, np.zeros_like(bend), np.zeros_like(bend)], 1)
        rotations[:, SEGMENTS.index(f"{name}LowerLeg")] = down(turned).as_quat()
        level = np.stack([-shank, np.zeros_like(bend), np.zeros_like(bend)], 1)
        rotations[:, SEGMENTS.index(f"{name}Foot")] = down(level).as_quat()
        hang = np.zeros((len(times), 3))
        hang[:, 2] = -sign * 1.2
        swing = np.zeros((len(times), 3))
        swing[:, 0] = -arms[:, side]
        rotations[:, SEGMENTS.index(f"{name}UpperArm")] = (down(swing) * down(hang)).as_quat()
    return MotionClip(SHAPE, clip.fps, clip.hips_m, rotations)


def moving(frames: int, seed: int = 1) -> MotionClip:
    """Smooth random rotations of all joints; knees and elbows bend about one axis."""
    random = np.random.default_rng(seed)
    times_s = np.arange(frames)[:, None, None] / 60.0
    phases, rates = random.uniform(0.0, 6.0, (2, 1, len(SEGMENTS), 3))
    turns = 0.3 * np.sin(phases + rates * times_s)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        for part, axis in (("LowerLeg", (1.0, 0.0, 0.0)), ("LowerArm", (0.0, -sign, 0.0))):
            at = SEGMENTS.index(side + part)
            turns[:, at] = (0.6 + turns[:, at, :1]) * axis
    hips_m = (0.0, HIPS_M, 0.0) + 0.3 * np.sin(times_s[:, 0] * (1.0, 2.0, 3.0))
    return MotionClip(SHAPE, Fraction(60), hips_m, quaternion.from_rotation_vector(turns))


def model(beats: int = 24, states: int = 4, seed: int = 1) -> ChoreographyModel:
    """Model of two sources of steps, cut at half beats, with random states and probabilities."""
    random = np.random.default_rng(seed)
    clips = (stepping(beats, seed), stepping(beats, seed + 1, beat_s=0.6))
    segments = []
    for number, (clip, beat_s) in enumerate(zip(clips, (0.5, 0.6), strict=True)):
        length = round(beat_s * 60)
        for beat in range(1, beats - 1):
            start = beat * length - length // 2
            state = int(random.integers(states))
            segments.append(MotionSegment(number, start, beat * length, start + length, state))
        assert segments[-1].end < len(clip)
    rows = random.dirichlet(np.ones(states), states)
    return ChoreographyModel(
        name="steps",
        sources=tuple(TrainingPair(f"{name}.bvh", f"{name}.mid", 0.0, None, "") for name in ("one", "other")),
        clips=clips,
        segments=tuple(segments),
        transition=rows,
        emission=random.dirichlet(np.ones(47), states),
        initial=random.dirichlet(np.ones(states)),
    )


def beaten(beats: int, beat_s: float = 0.5, seed: int = 0) -> Rhythm:
    """Bars of four with a kick on each beat and random strokes between."""
    random = np.random.default_rng(seed)
    beats_s = beat_s * np.arange(beats)
    extra = np.sort(random.uniform(0.0, beats_s[-1], beats))
    hits = np.sort(np.concatenate([beats_s, extra]))
    return Rhythm(
        beats_s=beats_s,
        bar_beats=np.arange(beats) % 4,
        hits_s=hits,
        symbols=random.integers(0, 47, len(hits)),
        strengths=random.uniform(0.2, 1.0, len(hits)),
        derived=False,
    )
