"""Measures of how alive exported players are: ``python -m tests.support.alive_measures PIECE...`` prints a table.

Each piece is exported by the program's own exporter and the FBX files are read back; only loudness, pitch, beats and
planned steps come from the plan. Motion of one bone says little of the others: what a measure leaves out its docstring
says.
"""

from __future__ import annotations

import argparse
import itertools
import sys
import tempfile
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from pathlib import Path

import numpy as np
from scipy.signal import butter, periodogram, sosfiltfilt
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation
from scipy.stats import rankdata, spearmanr

from app.arrays import BoolArray, FloatArray
from app.evaluation.measures import quantity_of_motion_mm_s
from app.export.playback import ScenePlayback, Surface
from app.export.request import ExportRequest
from app.export.run import export
from app.formats.fbx.read import read_scene
from app.messages import text
from app.performance.ensemble import Performance
from app.performance.span import cut_span
from app.plan.model import PlayerPlan
from app.plan.music.dynamics import dynamics_of
from app.plan.music.piece import line_times
from app.project.edit.players import set_parameters
from app.project.model import Project, map_choices, project_from_score
from app.score.read import read_midi
from instrument_maps.load import bundled_maps

UPPER_FACE = ("brow", "eyeSquint", "eyeWide", "cheekSquint", "noseSneer")
LIPS = ("mouth", "jaw", "cheekPuff")
MOVES_PER_S = 0.02
"""Change of a weight per second above which it is visible."""
HELD_S = 1.0
STILL_WEIGHT = 0.01
"""Change of the lips' weights within a held note below which they count as motionless."""
SMALLEST = 0.05
"""Weight below which a difference between left and right is invisible."""
BEAT_SHARE = 0.05
SLAB_M = 0.015


@dataclass(frozen=True, eq=False)
class Read:
    """One player's character, as read from an exported file.

    Attributes
    ----------
    times_s : (F,) float64
        Of the performance.
    world : (F, J, 4, 4) float64
    """

    name: str
    playback: ScenePlayback
    plan: PlayerPlan
    times_s: FloatArray
    world: FloatArray
    onset_s: FloatArray
    end_s: FloatArray
    pitch: FloatArray
    loudness: FloatArray
    accents: FloatArray
    beats_s: FloatArray

    @property
    def fps(self) -> float:
        return float(self.playback.clip.fps)

    def bone(self, name: str) -> int:
        return self.playback.bone_names.index(name)

    def place_m(self, name: str) -> FloatArray:
        """Positions (F, 3) of a joint in metres."""
        return self.world[:, self.bone(name), :3, 3]

    def forward_rad(self, name: str) -> FloatArray:
        """Forward lean (F,) of a joint in the world in each frame, in radians."""
        ahead = self.world[:, self.bone(name), :3, 2]
        return np.arcsin(np.clip(-ahead[:, 1], -1.0, 1.0))

    def aside_rad(self, name: str) -> FloatArray:
        """Sideways lean (F,) of a joint relative to its mean pose in each frame, in radians."""
        turns = Rotation.from_matrix(self.world[:, self.bone(name), :3, :3])
        aside: FloatArray = -(turns * turns.mean().inv()).as_rotvec()[:, 2]
        return aside

    def weights(self, *parts: str) -> dict[str, FloatArray]:
        """Weights of the morphs whose names begin with a prefix."""
        found = self.playback.clip.morph_weights
        return {name: np.asarray(values, np.float64) for name, values in found.items() if name.startswith(parts)}

    @cached_property
    def playing(self) -> BoolArray:
        """Mask (F,) of the frames in which a note sounds."""
        note = np.searchsorted(self.onset_s, self.times_s, side="right") - 1
        return (note >= 0) & (self.times_s < self.end_s[np.maximum(note, 0)])


def upper_face_share(read: Read) -> float:
    """Share of the frames within notes in which brows, squint, cheeks or nose move; blinks do not count."""
    moving = np.zeros(len(read.times_s), np.bool_)
    for values in read.weights(*UPPER_FACE).values():
        moving |= np.abs(np.gradient(values)) * read.fps > MOVES_PER_S
    return float(moving[read.playing].mean())


def effort_correlations(read: Read) -> tuple[float, float, float]:
    """Rank correlations over the notes of the strain shown (brows, squint, cheeks, nose) with loudness, with pitch,
    and with both (the mean of their ranks). Constant loudness has none (nan)."""
    shown = sum(read.weights("browDown", "eyeSquint", "cheekSquint", "noseSneer").values())
    first, last = (np.searchsorted(read.times_s, at) for at in (read.onset_s, read.end_s))
    long = (last - first >= 3) & (read.end_s - read.onset_s >= 0.1)
    means = np.array([np.mean(shown[a:b]) for a, b in zip(first[long], last[long], strict=True)])
    loudness, pitch = read.loudness[long], read.pitch[long]
    # Equal values share a rank, so that constant loudness has no correlation with the order of the notes.
    both = rankdata(loudness) + rankdata(pitch)
    with np.errstate(all="ignore"):
        results = [
            spearmanr(means, other).statistic if len(means) > 4 and np.ptp(other) > 0 and np.ptp(means) > 0 else np.nan
            for other in (loudness, pitch, both)
        ]
    return results[0], results[1], results[2]


def held_without_motion(read: Read) -> tuple[int, int]:
    """Number of notes longer than a second in which no weight of lips, jaw or cheeks moves between 0.3 s after the
    onset and 0.2 s before the end, and number of all notes of this length.
    """
    lips = np.array(list(read.weights(*LIPS).values()))
    plateaus = held = 0
    for start_s, end_s in zip(read.onset_s, read.end_s, strict=True):
        if end_s - start_s > HELD_S:
            here = (read.times_s >= start_s + 0.3) & (read.times_s < end_s - 0.2)
            if here.sum() > 5:
                held += 1
                plateaus += bool(np.ptp(lips[:, here], axis=1).max() < STILL_WEIGHT)
    return plateaus, held


def asymmetry(read: Read) -> float:
    """Median difference between left and right as a share of their mean, over frames and pairs of any size."""
    weights = read.weights("")
    shares = []
    for name, left in weights.items():
        if name.endswith("Left") and not name.startswith(("eyeLook", "eyeBlink")):
            right = weights.get(name.removesuffix("Left") + "Right")
            if right is not None:
                mean = 0.5 * (left + right)
                seen = mean > SMALLEST
                shares.append(np.abs(left - right)[seen] / mean[seen])
    found = np.concatenate(shares) if shares else np.zeros(0)
    return float(np.median(found)) if len(found) else np.nan


def at_the_beat(read: Read) -> float:
    """Share of the energy of the head's pitch rotation (0.3 to 8 Hz) within 5 % of the beat's frequency. The curve is
    sampled by beats, so that changes of tempo blur nothing.
    """
    times, beats = read.times_s, read.beats_s
    beats = beats[(beats >= times[0]) & (beats <= times[-1])]
    if len(beats) < 16:
        return np.nan
    steps = 32
    at = np.arange(0, len(beats) - 1, 1.0 / steps)
    at_s = np.interp(at, np.arange(len(beats)), beats)
    values = np.interp(at_s, times, read.forward_rad("head"))
    hz, power = periodogram(values, fs=steps, detrend="linear", window="hann")
    beat_hz = 1.0 / float(np.median(np.diff(beats)))
    all_of = (hz * beat_hz >= 0.3) & (hz * beat_hz <= 8.0)
    near = np.abs(hz - 1.0) <= BEAT_SHARE
    return float(power[near].sum() / power[all_of].sum())


def accents_lag_s(read: Read) -> tuple[float, int]:
    """Median time in seconds from accented notes to the nearest peak of the head's downward acceleration, and number of
    accents. Unrelated peaks would give about a quarter of the time between peaks.
    """
    accented = read.onset_s[read.accents > 0.0]
    pitch = _lowpass(read.forward_rad("head"), read.fps, 6.0)
    acceleration = np.gradient(np.gradient(pitch))
    peaks = np.flatnonzero((acceleration[1:-1] < acceleration[:-2]) & (acceleration[1:-1] <= acceleration[2:])) + 1
    strong = peaks[acceleration[peaks] < -0.5 * acceleration.std()]
    if len(accented) == 0 or len(strong) == 0:
        return np.nan, len(accented)
    apart = read.times_s[strong][None, :] - accented[:, None]
    nearest = apart[np.arange(len(accented)), np.abs(apart).argmin(axis=1)]
    return float(np.median(np.abs(nearest))), len(accented)


def overlap_ms(read: Read) -> tuple[str, str]:
    """Delay in milliseconds of the chest behind the hips and of the head behind the chest: the lag of the greatest
    correlation of their sideways leans (0.15 to 3 Hz), with that correlation, from the first note to the last.
    """
    swaying = (read.times_s >= read.onset_s[0]) & (read.times_s <= read.end_s[-1])
    for event in read.plan.gestures:
        if event.gesture is not None:
            swaying &= (read.times_s < event.start_s - 0.2) | (read.times_s > event.end_s + 0.3)
    reach = round(0.3 * read.fps)
    places = np.flatnonzero(swaying)
    places = places[(places >= reach) & (places < len(swaying) - reach)]
    results = []
    for before, after in (("hips", "upperChest"), ("upperChest", "head")):
        one, other = (_bandpass(read.aside_rad(name), read.fps, 0.15, 3.0) for name in (before, after))
        found = np.array([abs(np.corrcoef(one[places], other[places + lag])[0, 1]) for lag in range(-reach, reach + 1)])
        best = int(np.clip(np.argmax(found), 1, 2 * reach - 1))
        low, peak, high = found[best - 1 : best + 2]
        lag = best - reach + float(np.clip(0.5 * (low - high) / (low - 2.0 * peak + high), -0.5, 0.5))
        results.append(f"{1000.0 * lag / read.fps:.0f} ({peak:.2f})")
    return results[0], results[1]


def pelvis_cm(read: Read) -> tuple[float, float]:
    """Range of the hips' forward and sideways motion during notes in centimetres, from the 2nd to the 98th
    percentile.
    """
    hips = read.place_m("hips")[read.playing]
    ranges = 100.0 * np.subtract(*np.percentile(hips, [98, 2], axis=0))
    return float(ranges[2]), float(ranges[0])


def feet_mm(read: Read) -> tuple[float, float]:
    """Greatest distance of a foot (ankle and toe joints) from its usual place in millimetres, outside of planned steps
    and taps, and within them. Seated feet count too.
    """
    planned = np.zeros(len(read.times_s), np.bool_)
    for event in read.plan.gestures:
        if event.kind in ("step", "tap", "bow", "heel"):
            planned |= (read.times_s >= event.start_s - 0.2) & (read.times_s <= event.end_s + 0.3)
    outside = within = 0.0
    for name in ("leftFoot", "rightFoot", "leftToes", "rightToes"):
        if name in read.playback.bone_names:
            place = read.place_m(name)
            moved = np.concatenate(([0.0], np.linalg.norm(np.diff(place, axis=0), axis=1)))
            height = np.abs(place[:, 1] - np.median(place[:, 1]))
            if not planned.all():
                outside = max(outside, float(1000.0 * moved[~planned].max()), float(1000.0 * height[~planned].max()))
            if planned.any():
                within = max(within, float(1000.0 * height[planned].max()))
    return outside, within


def girth_cm(read: Read) -> float:
    """Increase in centimetres of the chest's girth (the convex hull of a slab of the trunk's vertices) in the deepest
    breaths. Vertices of the trunk are those with weights for chest and spine.
    """
    depths = sorted(read.plan.breaths, key=lambda event: -event.depth if event.kind == "breath" else 0.0)[:4]
    trunk = [read.bone(name) for name in ("spine", "chest", "upperChest") if name in read.playback.bone_names]
    chest, grown = read.bone("upperChest"), []
    surfaces = []
    for mesh in read.playback.scene.meshes:
        carried = np.isin(mesh.joint_indices, trunk) * mesh.weights
        own = np.flatnonzero(carried.sum(axis=1) > 0.95 * mesh.weights.sum(axis=1))
        if len(own) > 50:
            surfaces.append(Surface(read.playback, mesh, own))
    for event in depths:
        frames = [int(np.argmin(np.abs(read.times_s - at))) for at in (event.start_s, event.end_s - 0.02)]
        girths = []
        for frame in frames:
            world = read.world[frame : frame + 1]
            points = np.concatenate([surface.positions_m(world, frame, frame + 1)[0] for surface in surfaces])
            local = (points - world[0, chest, :3, 3]) @ world[0, chest, :3, :3]
            slab = local[np.abs(local[:, 1]) < SLAB_M][:, [0, 2]]
            hull = slab[ConvexHull(slab).vertices]
            girths.append(100.0 * np.linalg.norm(hull - np.roll(hull, 1, axis=0), axis=1).sum())
        grown.append(girths[1] - girths[0])
    return float(np.max(grown)) if grown else np.nan


def head_mm_s(read: Read) -> float:
    """Quantity of motion: root mean square speed of the head's joint between 0.3 and 15 Hz during notes, in mm/s."""
    found = quantity_of_motion_mm_s(read.place_m("head"), read.fps, read.playing)
    return np.nan if found is None else found


def pairwise(reads: list[Read]) -> float:
    """Greatest correlation of two players' heads (sideways and forward paths, 0.1 to 3 Hz) while both play; outside of
    notes all players move together, raising instruments at the start and bowing at the end.
    """
    found = [0.0]
    for one, other in itertools.combinations(reads, 2):
        both_play = one.playing & other.playing
        for axis in (0, 2):
            paths = [_bandpass(read.place_m("head")[:, axis], read.fps, 0.1, 3.0)[both_play] for read in (one, other)]
            if both_play.sum() > 10.0 * one.fps:
                found.append(abs(float(np.corrcoef(*paths)[0, 1])))
    return max(found)


def _bandpass(values: FloatArray, fps: float, low_hz: float, high_hz: float) -> FloatArray:
    return np.asarray(sosfiltfilt(butter(2, (low_hz, high_hz), "band", fs=fps, output="sos"), values))


def _lowpass(values: FloatArray, fps: float, high_hz: float) -> FloatArray:
    return np.asarray(sosfiltfilt(butter(2, high_hz, "low", fs=fps, output="sos"), values))


def exported(project: Project, folder: Path, fps: int) -> list[Read]:
    """Export every player of a project and read the files."""
    performance = Performance(project)
    span = cut_span(performance.time_frame, Fraction(fps), -np.inf, np.inf)
    request = ExportRequest(
        performance, project.players, folder, frozenset({"fbx"}), span, None, "piece", "measures", keys="every"
    )
    report = export(request, text)
    found, lines = [], {line.player_id: line for line in performance.parts}
    for entry in report.players:
        player = next(player for player in project.players if player.name == entry.name)
        scene = read_scene(folder / entry.files["character_fbx"])
        assert scene.clip is not None
        playback = ScenePlayback(scene, scene.clip)
        piece, line = performance.piece, lines[player.id]
        times = line_times(line, piece.clock)
        ticks = piece.metre_map.felt_between(int(times.onset_tick[0]), int(times.onset_tick[-1]) + 1)
        found.append(
            Read(
                name=player.name,
                playback=playback,
                plan=performance.plan(player),
                times_s=span.first_frame_s + np.arange(scene.clip.frames) / float(scene.clip.fps),
                world=playback.world(0, scene.clip.frames),
                onset_s=times.onset_s,
                end_s=times.played_end_s,
                pitch=times.pitch.astype(np.float64),
                loudness=times.loudness,
                accents=dynamics_of(times, None).accents,
                beats_s=piece.clock.seconds(ticks.astype(np.float64)),
            )
        )
    return found


def row(read: Read) -> dict[str, float | str]:
    """All measures of one player."""
    loud, high, both = effort_correlations(read)
    plateaus, held = held_without_motion(read)
    lag_s, accents = accents_lag_s(read)
    chest_ms, head_ms = overlap_ms(read)
    ahead_cm, aside_cm = pelvis_cm(read)
    outside_mm, within_mm = feet_mm(read)
    return {
        "upper face %": 100.0 * upper_face_share(read),
        "effort~loud": loud,
        "effort~high": high,
        "effort~both": both,
        "plateaus": f"{plateaus}/{held}",
        "left-right %": 100.0 * asymmetry(read),
        "at beat %": 100.0 * at_the_beat(read),
        "accent ms": f"{1000.0 * lag_s:.0f} ({accents})",
        "chest lag ms": chest_ms,
        "head lag ms": head_ms,
        "pelvis z cm": ahead_cm,
        "pelvis x cm": aside_cm,
        "feet mm": outside_mm,
        "steps mm": within_mm,
        "girth cm": girth_cm(read),
        "head mm/s": head_mm_s(read),
    }


def main(arguments: list[str]) -> None:
    """Print a table with a row per player."""
    parser = argparse.ArgumentParser()
    parser.add_argument("pieces", nargs="+", type=Path)
    parser.add_argument("--amplitude", type=float, default=0.5)
    parser.add_argument("--seated", action="store_true")
    parser.add_argument("--players", type=int, default=4, help="at most so many of a piece")
    parser.add_argument("--fps", type=int, default=60)
    asked = parser.parse_args(arguments)
    maps = bundled_maps()
    first = True
    for path in asked.pieces:
        project = project_from_score(read_midi(path, maps=map_choices(maps.values())), maps)
        project = replace(project, players=project.players[: asked.players])
        ids = [player.id for player in project.players]
        posture = "seated" if asked.seated else "standing"
        project = set_parameters(project, ids, amplitude=asked.amplitude, posture=posture)
        with tempfile.TemporaryDirectory() as folder:
            reads = exported(project, Path(folder), asked.fps)
        for read in reads:
            figures = row(read)
            if first:
                print("| player |", " | ".join(figures), "|")
                print("|---|" + "---|" * len(figures))
                first = False
            cells = (value if isinstance(value, str) else f"{value:.2f}" for value in figures.values())
            print(f"| {path.stem} {read.name} |", " | ".join(cells), "|", flush=True)
        print(f"| {path.stem}: greatest correlation of two heads {pairwise(reads):.2f} |", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
