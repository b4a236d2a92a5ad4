"""Measures of a generated dance on its exported file: seams, feet, beats, variety, nearness to the sources.

    python -m tests.support.dance_measures [--set tuned|judged] [--seeds N]

learns a model of the clips in ``shared/data/mocap`` (each constructed pair: none was danced to these drums), dances it
to drums that the model was not learned from, writes BVH, reads it again and prints a table.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Final

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d
from scipy.signal import argrelmin
from scipy.spatial import cKDTree

from app.arrays import BoolArray, FloatArray
from app.choreography.body import ENDS, SEGMENTS
from app.choreography.clip import MotionClip, write_motion
from app.choreography.contacts import foot_contacts, tips_m
from app.choreography.dance import Dance, Manner
from app.choreography.derived_rhythm import audible_rhythm
from app.choreography.features import facing, height_m, points_m
from app.choreography.generate import Choreographer
from app.choreography.hands_out_of_body import depths_m
from app.choreography.learn import learn
from app.choreography.model import ChoreographyModel
from app.choreography.read_motion import read_motion
from app.choreography.read_pair import read_pair
from app.choreography.resample import resampled
from app.choreography.rhythm import Rhythm
from app.choreography.sequence import Weights
from app.rig import quaternion
from app.score.contents import uncast_score
from app.score.read import read_contents

STATURE_M: Final = 1.7
SHARED: Final = Path(__file__).parents[3] / "shared" / "data"
_LATIN, _SAMBA = "drummer5_session2_24_latin-brazilian-songo_120", "drummer1_session1_38_latin-samba_116"
_AFRO, _ROCK = "drummer1_session1_176_afrocuban_105", "drummer1_session2_111_rock-prog_110"
_JAZZ, _SECOND = "drummer1_session2_5_jazz_200", "drummer1_session1_100_neworleans-secondline_94"
PAIRS: Final = {
    "tuned": {"salsa_01": _JAZZ, "salsa_16": _SECOND, "indian_06": _SECOND},
    "judged": {"salsa_18": _LATIN, "salsa_03": _AFRO, "salsa_05": _SAMBA, "martial_04": _ROCK},
}
"""Clips with the drums that they are learned with. Parameters are tuned on the first set and judged on the second."""
PIECES: Final = {
    "tuned": (_JAZZ, _SECOND, "solo_flute_bach_partita_corrente"),
    "judged": (
        "drummer1_session1_101_dance-disco_120",
        "drummer5_session1_14_latin-brazilian-songo_112",
        "drummer5_session2_8_neworleans-chacha_124",
        "brass_quintet_pezel_sonata21",
        "reed_trio_mozart_k229_mv1",
    ),
}
"""Pieces for dances by set; those other than drums have no percussion."""
LONGEST_S: Final = 180.0
"""Greatest length in seconds of a piece."""


# -------------------------------------------------------------------------------------------------------------- seams


def angular_jumps(clip: MotionClip) -> FloatArray:
    """Change (F, 16) of each segment's angular velocity between adjacent frame intervals in rad/s; 0 at the ends."""
    steps = quaternion.multiply(quaternion.conjugate(clip.rotations[:-1]), clip.rotations[1:])
    velocity = quaternion.to_rotation_vector(steps) * float(clip.fps)
    jumps = np.zeros((len(clip), len(SEGMENTS)))
    jumps[1:-1] = np.linalg.norm(np.diff(velocity, axis=0), axis=-1)
    return jumps


def usual_jump_rad_s(sources: Sequence[MotionClip], fps: Fraction) -> float:
    """99.9th percentile of the jumps of all segments and frames within the source motion at a frame rate."""
    return float(np.percentile(np.concatenate([angular_jumps(resampled(one, fps))[1:-1] for one in sources]), 99.9))


def seam_jumps_rad_s(clip: MotionClip, seams: Sequence[int], after: int = 2) -> FloatArray:
    """Largest jump (N,) of any segment around each seam, from the frame before it, which the seam already influences,
    to some frames after it.
    """
    jumps = angular_jumps(clip).max(axis=1)
    return np.array([jumps[max(0, seam - 1) : seam + after + 1].max() for seam in seams])


# --------------------------------------------------------------------------------------------------------------- feet


def skating_m_s(clip: MotionClip, height_limit_m: float = 0.025) -> float:
    """Mean over frames and feet of the horizontal speed of low tips, weighted by ``2 - 2^(h / H)``.

    Source: H. Zhang and others, "Mode-Adaptive Neural Networks for Quadruped Motion Control", SIGGRAPH 2018. The height
    is over the lowest within two seconds, for captured floors are not level.
    """
    tips = tips_m(clip)
    speed = np.linalg.norm(np.gradient(tips, axis=0)[..., [0, 2]], axis=-1) * float(clip.fps)
    around = max(1, round(2.0 * float(clip.fps)))
    padded = np.pad(tips[..., 1], ((around, around), (0, 0)), mode="edge")
    lowest = np.lib.stride_tricks.sliding_window_view(padded, 2 * around + 1, axis=0).min(axis=-1)
    share = np.clip((tips[..., 1] - lowest) / height_limit_m, 0.0, 1.0)
    return float((speed * (2.0 - 2.0**share)).mean())


def sliding_m_s(clip: MotionClip, standing: BoolArray) -> FloatArray:
    """Horizontal speed (N,) of the tips of feet that stand in a frame and in both adjacent ones."""
    tips = tips_m(clip)[..., [0, 2]]
    speed = np.zeros(standing.shape)
    speed[1:-1] = np.linalg.norm(tips[2:] - tips[:-2], axis=-1) * (0.5 * float(clip.fps))
    inside = standing.copy()
    inside[1:-1] &= standing[:-2] & standing[2:]
    inside[[0, -1]] = False
    return speed[inside]


def knee_pop_rad_s2(clip: MotionClip, percentile: float = 99.9) -> float:
    """Percentile of the angular acceleration of both knees, which reveals snapping knees."""
    knees = [SEGMENTS.index(f"{side}LowerLeg") for side in ("left", "right")]
    return float(np.percentile(angular_jumps(clip)[1:-1, knees], percentile) * float(clip.fps))


# -------------------------------------------------------------------------------------------------------------- beats


def kinematic_beats_s(clip: MotionClip) -> FloatArray:
    """Times of the local minima of the joints' mean speed, smoothed over 5 frames of 60 per second.

    As of Li and others, "AI Choreographer", ICCV 2021.
    """
    fps = float(clip.fps)
    speed = np.linalg.norm(np.gradient(points_m(clip)[:, : len(SEGMENTS)], axis=0), axis=-1).mean(axis=-1)
    (frames,) = argrelmin(gaussian_filter1d(speed, 5.0 / 60.0 * fps))
    return np.asarray(frames / fps)


def alignment(motion_s: FloatArray, music_s: FloatArray, sigma_s: float = 0.05) -> tuple[float, float]:
    """Beat alignment with a tolerance of 3 frames of 60 per second: mean over the motion's beats (FACT) and over the
    music's (Bailando).
    """
    if not len(motion_s) or not len(music_s):
        return 0.0, 0.0
    off = np.square(motion_s[:, None] - music_s[None, :])
    fits = np.exp(-off / (2.0 * sigma_s**2))
    return float(fits.max(axis=1).mean()), float(fits.max(axis=0).mean())


@dataclass(frozen=True)
class Alignment:
    """Alignment by one definition: of the dance, and mean and 95th percentile of shifted copies."""

    found: float
    chance: float
    chance_95: float


def alignments(motion_s: FloatArray, music_s: FloatArray, shifts: int = 1000, seed: int = 0) -> tuple[Alignment, ...]:
    """Beat alignment by both definitions, compared with the same motion shifted by random times with wrap-around."""
    music_s = music_s[(music_s >= motion_s.min(initial=0.0)) & (music_s <= motion_s.max(initial=0.0))]
    length_s = float(np.ptp(music_s)) if len(music_s) > 1 else 1.0
    first_s = float(music_s.min(initial=0.0))
    random = np.random.default_rng(seed).uniform(0.0, length_s, shifts)
    by_chance = np.array([alignment(first_s + (motion_s - first_s + by) % length_s, music_s) for by in random])
    return tuple(
        Alignment(found, float(others.mean()), float(np.percentile(others, 95.0)))
        for found, others in zip(alignment(motion_s, music_s), by_chance.T, strict=True)
    )


# ------------------------------------------------------------------------------------------------------ source, body


def poses_m(clip: MotionClip) -> FloatArray:
    """Positions (F, 63) of the body's points relative to the point below the hips and to their facing, for a body of
    1.7 m.
    """
    points = points_m(clip) - (clip.hips_m * (1.0, 0.0, 1.0))[:, None]
    seen = quaternion.rotate(quaternion.conjugate(facing(clip))[:, None], points)
    return np.asarray(seen * (STATURE_M / height_m(clip))).reshape(len(clip), -1)


def nearest_m(clip: MotionClip, sources: Sequence[MotionClip]) -> FloatArray:
    """Root mean square distance (F,) of the points of each pose to those of the most similar pose of the sources."""
    tree = cKDTree(np.concatenate([poses_m(one) for one in sources]))
    distances, _ = tree.query(poses_m(clip))
    return np.asarray(distances / np.sqrt(len(SEGMENTS) + len(ENDS)))


def longest_run(values: Sequence[int]) -> int:
    """Length of the longest run of equal values."""
    longest = run = 0
    for at, value in enumerate(values):
        run = run + 1 if at and value == values[at - 1] else 1
        longest = max(longest, run)
    return longest


# --------------------------------------------------------------------------------------------------------- comparison


def concatenated(model: ChoreographyModel, dance: Dance, fps: Fraction) -> tuple[MotionClip, list[int]]:
    """Segments of a dance joined without any blending, with continuous place and facing, and the frames of the joins.
    Each plays evenly from its start to its accent and from there to its end.

    Each goes evenly from its start to its accent, and on to its end, as a straightforward reconstruction does.
    """
    hips, rotations, seams = [], [], []
    place, face = np.zeros(3), 0.0
    frame = 0
    for step in dance.steps:
        segment = model.segments[step.segment]
        source = model.clips[segment.clip]
        stop = int(np.ceil((step.end_s - dance.steps[0].start_s) * float(fps)))
        times_s = dance.steps[0].start_s + np.arange(frame, stop) / float(fps)
        at = np.interp(times_s, [step.start_s, step.accent_s, step.end_s], [segment.start, segment.accent, segment.end])
        if not len(at):
            continue
        part = sampled(source, np.append(at, segment.end))
        yaw = yaws_rad(part)
        turn = quaternion.from_axis_angle(np.array([0.0, 1.0, 0.0]), face - yaw[0])
        flat = quaternion.rotate(turn, (part.hips_m - part.hips_m[0]) * (1.0, 0.0, 1.0)) + place
        turned = part.rotations.copy()
        turned[:, 0] = quaternion.multiply(turn, turned[:, 0])
        place, face = flat[-1], face + yaw[-1] - yaw[0]
        hips.append((flat + part.hips_m * (0.0, 1.0, 0.0))[:-1])
        rotations.append(turned[:-1])
        seams.append(frame)
        frame = stop
    every = np.concatenate(rotations)
    clip = MotionClip(dance.clip.shape, fps, np.concatenate(hips), one_sided(every))
    follows = {
        at
        for at, (one, other) in enumerate(zip(dance.steps, dance.steps[1:], strict=False), start=1)
        if other.segment == one.segment + 1
        and model.segments[one.segment].clip == model.segments[other.segment].clip
        and model.segments[one.segment].end == model.segments[other.segment].start
    }
    return clip, [seam for at, seam in enumerate(seams) if at and at not in follows]


def sampled(clip: MotionClip, frames: FloatArray) -> MotionClip:
    """Sample a motion at ascending fractional frames by cubic splines; linear interpolation would add seams."""
    first, last = max(0, int(frames[0]) - 4), min(len(clip), int(frames[-1]) + 5)
    known, at = np.arange(first, last), np.minimum(frames, len(clip) - 1.0)
    turns = quaternion.normalize(CubicSpline(known, clip.rotations[first:last])(at))
    return MotionClip(clip.shape, clip.fps, CubicSpline(known, clip.hips_m[first:last])(at), turns)


def yaws_rad(clip: MotionClip) -> FloatArray:
    """Direction (F,) of the hips about +Y without jumps of a whole turn."""
    turned = facing(clip)
    return np.unwrap(2.0 * np.arctan2(turned[:, 1], turned[:, 3]))


def one_sided(rotations: FloatArray) -> FloatArray:
    """Choose the sign of each quaternion nearest to the previous frame's."""
    turned = np.einsum("fji,fji->fj", rotations[1:], rotations[:-1]) < 0.0
    sides = np.concatenate([np.ones((1, rotations.shape[1])), np.where(turned, -1.0, 1.0)]).cumprod(axis=0)
    return np.asarray(rotations * sides[..., None])


# -------------------------------------------------------------------------------------------------------------- table


@dataclass(frozen=True)
class Measured:
    """Measures of one dance; speeds in m/s, jumps over the usual jump inside the sources. The speed of its generation,
    in multiples of real time, is by the time that its one thread ran: other processes do not count."""

    piece: str
    length_s: float
    times_real: float
    seams: int
    jump: float
    jump_plain: float
    jump_no_transition: float
    sliding_most: float
    skating: float
    knees: float
    beats_per_s: float
    fact: Alignment
    bailando: Alignment
    run: int
    used: float
    nearest_mean: float
    nearest_p99: float
    hands_p99: float
    away_m: float
    faces_deg: float


def measured(model: ChoreographyModel, piece: Path, seed: int, folder: Path, fps: Fraction = Fraction(60)) -> Measured:
    """Generate a dance to a piece and measure the exported file."""
    rhythm = first_part(audible_rhythm(uncast_score(read_contents(piece))))
    choreographer = Choreographer(model)
    choreographer.candidates  # noqa: B018 - the model's share is not the piece's
    began = time.thread_time()
    dance = choreographer.dance(rhythm, Manner(seed=seed), fps)
    took_s = time.thread_time() - began
    file = folder / f"{piece.stem}_{seed}.bvh"
    write_motion(file, dance.clip)
    clip = read_back(file)
    usual = usual_jump_rad_s(model.clips, fps)
    plain, plain_seams = concatenated(model, dance, fps)
    loose = Choreographer(model)
    loose.__dict__["candidates"] = replace(loose.candidates, log_transition=np.zeros_like(loose.candidates.joins_m))
    unjoined = loose.dance(rhythm, Manner(seed=seed), fps, weights=Weights(join_per_m=0.0))
    other, other_seams = concatenated(model, unjoined, fps)
    standing = np.zeros((len(clip), 2), bool)
    for stand in dance.standing:
        standing[stand.start : stand.stop, stand.foot] = True
    sliding = sliding_m_s(clip, standing)
    fact, bailando = alignments(dance.first_s + kinematic_beats_s(clip), rhythm.beats_s)
    near = nearest_m(clip, [resampled(one, fps) for one in model.clips])
    chosen = [step.segment for step in dance.steps]
    faces = np.exp(1j * yaws_rad(clip))
    # A reader puts the first frame in the middle of the stage.
    path = clip.hips_m - clip.hips_m[0] + dance.clip.hips_m[0]
    return Measured(
        piece=piece.stem.removeprefix("gmd_")[:40],
        length_s=clip.length_s,
        times_real=clip.length_s / took_s,
        seams=len(dance.seams),
        jump=seam_jumps_rad_s(clip, dance.seams).max(initial=0.0) / usual,
        jump_plain=seam_jumps_rad_s(plain, plain_seams).max(initial=0.0) / usual,
        jump_no_transition=seam_jumps_rad_s(other, other_seams).max(initial=0.0) / usual,
        sliding_most=float(sliding.max(initial=0.0)),
        skating=skating_m_s(clip),
        knees=knee_pop_rad_s2(clip),
        beats_per_s=len(kinematic_beats_s(clip)) / max(clip.length_s, 1e-9),
        fact=fact,
        bailando=bailando,
        run=longest_run(chosen),
        used=len(set(chosen)) / len(model.segments),
        nearest_mean=float(near.mean()),
        nearest_p99=float(np.percentile(near, 99.0)),
        hands_p99=float(np.percentile(depths_m(clip), 99.0)),
        away_m=float(np.hypot(path[:, 0], path[:, 2]).max()),
        faces_deg=float(np.degrees(np.angle(faces.mean()))),
    )


def first_part(rhythm: Rhythm, longest_s: float = LONGEST_S) -> Rhythm:
    """Beginning of a piece."""
    beats, hits = rhythm.beats_s < longest_s, rhythm.hits_s < longest_s
    return replace(
        rhythm,
        beats_s=rhythm.beats_s[beats],
        bar_beats=rhythm.bar_beats[beats],
        divisions=None if rhythm.divisions is None else rhythm.divisions[beats],
        hits_s=rhythm.hits_s[hits],
        symbols=rhythm.symbols[hits],
        strengths=rhythm.strengths[hits],
        melody=None if rhythm.melody is None else first_part(rhythm.melody, longest_s),
    )


def read_back(file: Path) -> MotionClip:
    """Read the motion from a file."""
    return read_motion(file).clip


def learned(which: str) -> ChoreographyModel:
    """Learn a model from one of the sets of `PAIRS`."""
    pairs = []
    for motion, drums in PAIRS[which].items():
        file = SHARED / "mocap" / f"cmu_{motion}.bvh"
        fps = Fraction(60) if "salsa" in motion else None
        pairs.append(read_pair(file, midi(drums), offset_s=0.0, fps=fps).pair)
    return learn(pairs, states=None, seed=0, name=which)


def midi(name: str) -> Path:
    """MIDI file of a piece or of drums."""
    (file,) = [*SHARED.glob(f"midi/drums/gmd_{name}_*.mid"), *SHARED.glob(f"midi/ensemble/{name}.mid")]
    return file


COLUMNS: Final[dict[str, tuple[str, Callable[[Measured], float]]]] = {
    "s": ("5.0f", lambda one: one.length_s),
    "x real": ("7.0f", lambda one: one.times_real),
    "seams": ("6d", lambda one: one.seams),
    "jump": ("6.2f", lambda one: one.jump),
    "plain": ("6.1f", lambda one: one.jump_plain),
    "no A": ("6.1f", lambda one: one.jump_no_transition),
    "slide": ("6.1f", lambda one: 1e3 * one.sliding_most),
    "skate": ("6.1f", lambda one: 1e3 * one.skating),
    "knees": ("6.0f", lambda one: one.knees),
    "FACT": ("5.2f", lambda one: one.fact.found),
    "mean": ("5.2f", lambda one: one.fact.chance),
    "95%": ("5.2f", lambda one: one.fact.chance_95),
    "Bail": ("5.2f", lambda one: one.bailando.found),
    "mean ": ("5.2f", lambda one: one.bailando.chance),
    "95% ": ("5.2f", lambda one: one.bailando.chance_95),
    "b/s": ("4.1f", lambda one: one.beats_per_s),
    "run": ("4d", lambda one: one.run),
    "used": ("5.2f", lambda one: one.used),
    "near": ("5.0f", lambda one: 1e3 * one.nearest_mean),
    "99%": ("5.0f", lambda one: 1e3 * one.nearest_p99),
    "hands": ("5.0f", lambda one: 1e3 * one.hands_p99),
    "away": ("5.2f", lambda one: one.away_m),
    "faces": ("6.0f", lambda one: one.faces_deg),
}
"""Columns of the table: lengths in m, nearness in mm; sliding and skating in mm/s."""


def table(rows: Sequence[Measured]) -> str:
    """Table with a line per dance."""
    heads = [f"{head.strip():>{form.split('.')[0].rstrip('df')}}" for head, (form, _) in COLUMNS.items()]
    lines = [" ".join([f"{'piece':42}", *heads])]
    for one in rows:
        lines.append(" ".join([f"{one.piece:42}", *(f"{value(one):{form}}" for form, value in COLUMNS.values())]))
    return "\n".join(lines)


def of_sources(model: ChoreographyModel) -> str:
    """Line with the measures of each capture from which the model was learned."""
    lines = []
    for source, clip in zip(model.sources, model.clips, strict=True):
        sliding = sliding_m_s(clip, foot_contacts(clip))
        lines.append(
            f"{source.motion_name:17} slide 99 % {1e3 * np.percentile(sliding, 99.0):6.1f}"
            f" most {1e3 * sliding.max():6.1f} skate {1e3 * skating_m_s(clip):6.1f} knees {knee_pop_rad_s2(clip):6.0f}"
        )
    return "\n".join(lines)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--set", choices=tuple(PAIRS), default="judged")
    parser.add_argument("--seeds", type=int, default=1)
    arguments = parser.parse_args()
    model = learned(arguments.set)
    print(f"{arguments.set}: {len(model.segments)} segments, {model.states} states")
    print(of_sources(model))
    with tempfile.TemporaryDirectory() as folder:
        rows = [
            measured(model, midi(piece), seed, Path(folder))
            for piece in PIECES[arguments.set]
            for seed in range(arguments.seeds)
        ]
    print(table(rows))


if __name__ == "__main__":
    main()
