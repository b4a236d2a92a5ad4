"""A performance played frame by frame to a live player who does not know the following notes."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from fractions import Fraction

import msgspec
import numpy as np

from app.arrays import FloatArray
from app.motion.contacts.trunk_and_legs import SIDES, Footing, Side, footing
from app.motion.model import Motion
from app.motion.perform import PerformanceCurves
from app.performance.chunks import Pose
from app.performance.ensemble import Performance
from app.performance.live import LiveMotion
from app.performance.play_along import PlayAlong
from app.plan.model import PlayerPlan
from app.project.model import project_from_score
from app.rig.grip.grip_pose import StationBlend
from app.score.model import Note, Part, Score
from app.score.tempo import TempoMap
from instrument_maps.load import bundled_maps
from tests.support.performed import performance_curves

QUARTER = 480
FPS = 60
LATE_S = 0.13
"""Seconds after an onset by which everything is in place: a finger's move to its key, and a frame."""

Notes = list[tuple[int, int, int]]
"""Onset and length in ticks and sounding pitch; a beat is half a second."""


@dataclass(frozen=True, eq=False)
class Played:
    """Live poses of a performance.

    Attributes
    ----------
    playing : PerformanceCurves
        The same notes as a performance has them.
    motion : Motion
        The live poses.
    plan : PlayerPlan
        What was fingered, `LATE_S` after each onset.
    """

    playing: PerformanceCurves
    motion: Motion
    plan: PlayerPlan
    hands: dict[str, FloatArray]

    @property
    def times_s(self) -> FloatArray:
        """Times of the frames."""
        times_s: FloatArray = self.motion.first_frame_s + np.arange(self.motion.frames) / FPS
        return times_s

    @property
    def player(self) -> object:
        """Same as in `PerformanceCurves`, for checking contacts."""
        return self.playing.player

    @property
    def instrument_map(self) -> object:
        """Same as in `PerformanceCurves`."""
        return self.playing.instrument_map

    @property
    def body(self) -> object:
        """Same as in `PerformanceCurves`."""
        return self.playing.body

    @property
    def stopping(self) -> object:
        """Same as in `PerformanceCurves`."""
        return self.playing.stopping

    @property
    def controls(self) -> dict[str, object]:
        """Same as in `PerformanceCurves`: empty, since controls are unknown in advance."""
        return {}

    def footings(self, times_s: FloatArray) -> dict[Side, Footing]:
        """Same as in `PerformanceCurves`: the feet of a live player do not move."""
        place = self.playing.player.place
        return {side: footing(place, side, {}, len(times_s)) for side in SIDES}

    def placed(self, times_s: FloatArray) -> dict[str, StationBlend]:
        """Positions of the hands at some times, by hand."""
        frames = np.round((times_s - self.motion.first_frame_s) * FPS).astype(int)
        return {name: StationBlend(*rows[frames].T) for name, rows in self.hands.items()}


def performance_of(instrument_id: str, notes: Notes) -> Performance:
    """Performance of one player."""
    rows = tuple(Note(f"1:{index}", *note, 80) for index, note in enumerate(notes, start=1))
    part = Part("1.1.1", "Player", 0, 0, 0, None, None, instrument_id, rows)
    return Performance(project_from_score(Score("live", QUARTER, TempoMap(QUARTER), parts=(part,)), bundled_maps()))


def line(instrument_id: str, count: int, seed: int = 1) -> Notes:
    """Notes from the whole range in eighths, quarters and halves, some of them after a rest."""
    limits = bundled_maps()[instrument_id].range
    random = np.random.default_rng(seed)
    notes, tick, pitch = [], 4 * QUARTER, (limits.easy_low + limits.easy_high) // 2
    for _ in range(count):
        pitch = int(np.clip(pitch + random.integers(-9, 10), limits.low, limits.high))
        length = int(random.choice([QUARTER // 2, QUARTER, 2 * QUARTER]))
        notes.append((tick, length, pitch))
        tick += length + (2 * QUARTER if random.random() < 0.1 else 0)
    return notes


def playing_alone(instrument_id: str, notes: Notes) -> PerformanceCurves:
    """Curves of a single player."""
    performance = performance_of(instrument_id, notes)
    return performance_curves(performance, performance.project.players[0])


def played(playing: PerformanceCurves, notes: Notes) -> Played:
    """Play the notes of a performance to a live player and record its poses."""
    along, plan = PlayAlong(playing), playing.plan
    events = [
        (time_s, on, note[2])
        for event, note in zip(plan.fingerings, notes, strict=True)
        for time_s, on in ((event.start_s, True), (event.end_s, False))
    ]
    events.sort(key=lambda event: event[:2])
    first_s, poses, fingered = plan.time_frame.first_frame_s, list[Pose](), []
    hands: dict[str, list[list[float]]] = defaultdict(list)
    for frame in range(int((events[-1][0] + 2.0 - first_s) * FPS)):
        now_s = first_s + frame / FPS
        while events and events[0][0] <= now_s:
            time_s, on, pitch = events.pop(0)
            if on:
                along.note_on(time_s, pitch)
                fingered.append(along.fingering)
            else:
                along.note_off(time_s, pitch)
        poses.append(along.pose(now_s))
        for name, where in along._hands.at(now_s).placed.items():
            hands[name].append([float(values[0]) for values in where])
    rows = [
        msgspec.structs.replace(
            event, start_s=event.start_s + LATE_S, label=own.label, controls=own.controls, fingers=own.fingers
        )
        for event, own in zip(plan.fingerings, fingered, strict=True)
        if own is not None and event.end_s - event.start_s > LATE_S
    ]
    return Played(
        playing,
        motion_of(poses, first_s),
        msgspec.structs.replace(plan, fingerings=tuple(rows), breaths=()),
        {name: np.array(values) for name, values in hands.items()},
    )


def motion_of(poses: list[Pose], first_s: float) -> Motion:
    """Join poses to a motion."""
    morphs = sorted({name for pose in poses for name in pose.morphs})
    return Motion(
        fps=Fraction(FPS),
        first_frame_s=first_s,
        rotations=np.array([pose.rotations for pose in poses]),
        hips_m=np.array([pose.hips_m for pose in poses]),
        morphs={name: np.array([pose.morphs.get(name, 0.0) for pose in poses], np.float32) for name in morphs},
        controls={name: np.array([pose.controls[name] for pose in poses], np.float32) for name in poses[0].controls},
        instrument_position_m=np.array([pose.instrument_position_m for pose in poses]),
        instrument_rotation=np.array([pose.instrument_rotation for pose in poses]),
    )


def ready_spans(live: LiveMotion, player_id: str) -> tuple[tuple[float, float], ...]:
    """Time spans (s, in order) for which a player's motion has been computed."""
    shown = live._shown
    track = shown.tracks.get(player_id)
    if track is None:
        return ()
    grid, spans = shown.grid, list[tuple[int, int]]()
    for index in sorted(track.chunks):
        if spans and spans[-1][1] == index:
            spans[-1] = (spans[-1][0], index + 1)
        else:
            spans.append((index, index + 1))
    step_s = grid.length * grid.fps.denominator / grid.fps.numerator
    end_s = grid.start_s + grid.frames * grid.fps.denominator / grid.fps.numerator
    return tuple((grid.start_s + first * step_s, min(grid.start_s + last * step_s, end_s)) for first, last in spans)
