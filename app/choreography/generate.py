"""Generation of a dance: segments of a model in an order that suits the music, on its beats, joined smoothly."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.choreography.accent_grid import AccentGrid, grid_of
from app.choreography.arrivals import FPS, arrival_frames, beats_met, best_arrival_map, joint_speed_m_s, smoothed
from app.choreography.clip import MotionClip
from app.choreography.coming_to_rest import ENDS_S, GOES_ON_S, CapturedStands, between_stands, captured_stands
from app.choreography.dance import Dance, Manner, SegmentStep
from app.choreography.dance_ends import EndOdds, danced_grid, odds_of_ends
from app.choreography.dance_flaws import usual_change_rad_s
from app.choreography.drafts import DRAFT_FPS, DRAFTS, draft_of
from app.choreography.drums_of_dancers import TakeShares, take_shares
from app.choreography.feet_on_beats import feet_on_beats
from app.choreography.feet_on_floor import grounded
from app.choreography.foot_plants import STEP_S, FootPlant, planted_frames, stands, steps_s
from app.choreography.hands_out_of_body import out_of_body
from app.choreography.hit_log_odds import Hearing, hearing
from app.choreography.idling import idling_odds
from app.choreography.joins import distances_m
from app.choreography.joint_changes import within_changes
from app.choreography.legs_apart import with_legs_apart, with_swings_apart
from app.choreography.limbs import hinged, unbroken, wrists_within
from app.choreography.model import ChoreographyModel
from app.choreography.music_motion_dependence import trust_in
from app.choreography.phrases import returning_places
from app.choreography.rhythm import Rhythm, felt_at, own_beat_s, pace_of
from app.choreography.segment_arrivals import accents_s, meets_of
from app.choreography.sequence import Constraints, SegmentCandidates, Weights, choose
from app.choreography.shortest_times import ShortestTimes
from app.choreography.sized import sized
from app.choreography.spins import hips_within
from app.choreography.stage import on_stage
from app.choreography.step_balance import step_balance
from app.choreography.stitch import Frames, Stitcher
from app.choreography.sudden_ends import UsualAccelerations, usual_accelerations, within_limits
from app.choreography.transition_scores import SPEEDS
from app.choreography.warp import TimeMap, map_with_arrivals

_LEAST_S: Final = 0.01
"""Margin in seconds beyond the first start and the last end, since a segment's beat may be at either."""
STANDING: Final = 4.0
"""Log odds of a first and last segment with both feet on the floor against none."""
PREFERRED: Final = 12.0
"""Log odds of a segment of the preferred source."""


@dataclass(frozen=True, eq=False)
class _Plan:
    """Sequence of danced segments with their times.

    Attributes
    ----------
    times : TimeMap or None
        Time map; None without segments.
    hits_s : (N,) float64
        Position of each segment's accent along all motions in seconds.
    """

    steps: tuple[SegmentStep, ...]
    times: TimeMap | None
    hits_s: FloatArray


class _Motion(NamedTuple):
    """Motion of a plan before feet are fixed: the clip, its path over the floor, the captured contacts of the feet, the
    seams between segments, and speeds.
    """

    clip: MotionClip
    moved_m: FloatArray
    contacts: BoolArray
    seams: tuple[int, ...]
    speeds: FloatArray


class Choreographer:
    """A model prepared for generating, with everything independent of a piece computed once.

    Parameters
    ----------
    model : ChoreographyModel
        Model with at least one segment.
    """

    def __init__(self, model: ChoreographyModel) -> None:
        self.model = model
        self._stitcher = Stitcher(model)
        self._speeds = [joint_speed_m_s(clip) for clip in model.clips]
        self._usual_rad_s: dict[Fraction, float] = {}
        self._usual_ends: dict[Fraction, UsualAccelerations] = {}

    @cached_property
    def _beat_s(self) -> float:
        """Usual time in seconds between footfalls in the captures."""
        gaps_s = np.concatenate([np.diff(falls) for falls in self._falls_s])
        return own_beat_s(gaps_s)

    @cached_property
    def _stands(self) -> list[tuple[FootPlant, ...]]:
        """For each clip of the library the spans in which a foot stands."""
        return [stands(*pair) for pair in zip(self.model.clips, self._stitcher.contacts, strict=True)]

    @cached_property
    def _falls_s(self) -> list[FloatArray]:
        """For each clip the times in seconds at which a foot lands, ascending."""
        return [
            np.array(sorted({stand.start / float(clip.fps) for stand in standing}), np.float64)
            for clip, standing in zip(self.model.clips, self._stands, strict=True)
        ]

    @cached_property
    def _fps(self) -> list[float]:
        return [float(clip.fps) for clip in self.model.clips]

    @cached_property
    def _shortest(self) -> ShortestTimes:
        return ShortestTimes(self.model, self._hits_s)

    @cached_property
    def _arrivals(self) -> list[IntArray]:
        """For each clip the frames (N,) at which a movement arrives: minima of the joints' mean speed."""
        return [arrival_frames(speed, fps) for speed, fps in zip(self._speeds, self._fps, strict=True)]

    @cached_property
    def _hits_s(self) -> FloatArray:
        """Time (S,) in seconds, within its clip, of the moment of each of S segments that is put on a beat."""
        slow = [smoothed(speed, fps) for speed, fps in zip(self._speeds, self._fps, strict=True)]
        return accents_s(self.model.segments, self._fps, slow, self._arrivals, self._falls_s)

    @cached_property
    def _idle(self) -> FloatArray:
        """Log odds (S,) against segments whose dancer idles (see `app.choreography.idling.idling_odds`)."""
        return idling_odds(self.model.segments, self._speeds, self._fps)

    @cached_property
    def _end_odds(self) -> EndOdds:
        """Log odds of ending a dance with segments."""
        return odds_of_ends(self.model.clips, self.model.segments, self._hits_s)

    @cached_property
    def _stands_at_rest(self) -> CapturedStands:
        """Captured poses in which a dance may begin and end."""
        return captured_stands(self.model.clips, self._stitcher.hinges)

    @cached_property
    def _step_s(self) -> float:
        """Usual time in seconds that a step takes in the captures."""
        found = []
        for clip, standing in zip(self.model.clips, self._stands, strict=True):
            found += steps_s(standing, float(clip.fps))
        return float(np.median(found)) if found else STEP_S

    @cached_property
    def candidates(self) -> SegmentCandidates:
        """Return the model's segments, with the distances and odds of following each other."""
        model, segments, fps = self.model, self.model.segments, self._fps
        states = np.array([one.state for one in segments], np.int64)
        joins = distances_m(self._stitcher.ends, self._stitcher.starts)
        for at, (one, following) in enumerate(pairwise(segments)):
            if one.clip == following.clip and one.end == following.start:
                joins[at, at + 1] = 0.0
        log_a = np.log(model.transition * model.states)
        return SegmentCandidates(
            states=states,
            before_s=self._hits_s - np.array([one.start / fps[one.clip] for one in segments]),
            after_s=np.array([one.end / fps[one.clip] for one in segments]) - self._hits_s,
            joins_m=joins,
            log_transition=log_a[states[:, None], states[None, :]],
            meets=meets_of(segments, fps, self._arrivals, self._falls_s, self._hits_s),
            least_before_s=self._shortest.before_s,
            least_after_s=self._shortest.after_s,
        )

    @cached_property
    def hearing(self) -> Hearing:
        """Return the log odds with which sounds belong to the model's segments."""
        return hearing(self.model, trust_in(self.model))

    def dance(
        self,
        rhythm: Rhythm,
        manner: Manner,
        fps: Fraction,
        *,
        constraints: Constraints | None = None,
        weights: Weights | None = None,
        first_s: float = 0.0,
        end_s: float | None = None,
    ) -> Dance:
        """Generate a dance to a piece. Equal arguments give bitwise equal motion.

        Parameters
        ----------
        constraints : Constraints, optional
            The user's corrections.
        first_s, end_s : float
            Time of the first frame and of the end in seconds; by default from the first tick to `ENDS_S` after the last
            step. An earlier end ends the dance earlier, so that its last stand is held.
        """
        rhythm = self.felt(rhythm)
        plan, body = self._planned(rhythm, manner, constraints, weights), manner.source or 0
        if end_s is None:
            end_s = max(first_s, (plan.steps[-1].end_s if plan.steps else 0.0) + ENDS_S)
        count = max(1, math.ceil((end_s - first_s) * float(fps)))
        if not plan.steps:
            return Dance(self._stitcher.still(count, body, fps), first_s, (), np.zeros(count), (), ())
        rests_s = min(plan.steps[-1].end_s, end_s - ENDS_S)
        times_s = first_s + np.arange(count) / float(fps)
        clip, moved_m, contacts, seams, speeds = self._motion(plan, body, fps, times_s, rests_s, manner.seed)
        clip = sized(clip, manner.size, self._stitcher.hinges)
        if manner.mirrored:
            clip, moved_m, contacts = clip.mirrored(), moved_m * (-1.0, 1.0, 1.0), contacts[:, ::-1]
        clip = hips_within(clip, self._shortest.hips_rad_s, usual := self.usual_change_rad_s(fps))
        clip, fastest = wrists_within(out_of_body(clip)), self._shortest.fastest_rad_s(manner)
        feet = feet_on_beats(clip, contacts, moved_m, first_s, grid_of(rhythm), self._step_s, manner.weight)
        clip, standing = with_legs_apart(clip, feet.clip, feet.falls, manner.weight)
        # Knees that swing from side to side turn their thighs suddenly, so that they are turned before the limits too.
        clip = within_limits(hinged(clip), standing, self._usual_accelerations(fps), usual, fastest)
        # Legs slowed down in the air may enter each other again, and snap where they are swung apart.
        if (apart := with_swings_apart(clip, standing)) is not clip:
            on_floor = planted_frames(standing, count)
            clip = grounded(within_changes(apart, on_floor, usual, legs_only=True), on_floor)
        return Dance(hinged(clip), first_s, plan.steps, speeds, seams, standing)

    def usual_change_rad_s(self, fps: Fraction) -> float:
        """Usual change of motion in the model's captures, for a frame rate (see
        `app.choreography.dance_flaws.usual_change_rad_s`)."""
        if fps not in self._usual_rad_s:
            self._usual_rad_s[fps] = usual_change_rad_s(self.model.clips, fps)
        return self._usual_rad_s[fps]

    def _usual_accelerations(self, fps: Fraction) -> UsualAccelerations:
        """Usual accelerations in the model's captures, for a frame rate (see
        `app.choreography.sudden_ends.usual_accelerations`)."""
        if fps not in self._usual_ends:
            self._usual_ends[fps] = usual_accelerations(self.model.clips, fps)
        return self._usual_ends[fps]

    def steps(
        self, rhythm: Rhythm, manner: Manner, *, constraints: Constraints | None = None, weights: Weights | None = None
    ) -> tuple[SegmentStep, ...]:
        """Choose the segments of the motion library that are danced to a rhythm, and return them in order with their
        times."""
        return self._planned(self.felt(rhythm), manner, constraints, weights).steps

    def felt(self, rhythm: Rhythm) -> Rhythm:
        """Return the rhythm as the dancers of this model feel it, with their own length of beat; constraints refer to
        the grid of this rhythm.
        """
        return felt_at(rhythm, self._beat_s)

    def _planned(
        self, rhythm: Rhythm, manner: Manner, constraints: Constraints | None, weights: Weights | None
    ) -> _Plan:
        """Choose the segments for a rhythm, and fit them to its accents; the plan has the segments, their times, and
        the map from performance to motion time."""
        held = set() if constraints is None else {*constraints.pinned, *constraints.segments}
        candidates, grid, segments = self.candidates, danced_grid(rhythm, held), self.model.segments
        initial = np.log(self.model.initial * self.model.states)[candidates.states]
        pace = pace_of(rhythm, self._beat_s, SPEEDS[1])
        preferred = PREFERRED * np.array([one.clip == manner.source for one in segments], np.float64)
        chosen = choose(
            grid,
            replace(candidates, pace=pace),
            self.hearing.hits(rhythm, manner.melody, any_dancer=manner.source is None),
            seed=manner.seed,
            weights=weights,
            constraints=constraints,
            usual=preferred - self._idle,
            returns=returning_places(rhythm, grid.times_s, manner.melody),
            takes=self._take_shares(rhythm, grid) if manner.source is None else None,
            steps=step_balance(segments, self._fps, self._falls_s, pace),
            initial=initial + self._standing([one.start for one in segments]),
            final=self._standing([one.end for one in segments]) + self._end_odds.last,
            closing=self._end_odds.closing,
        )
        stay = np.array([place in held or place == chosen[-1][0] for place, _ in chosen], bool)
        plan = self._timed(chosen, grid, manner.source or 0, stay)
        if not plan.steps:
            return plan
        # The last motion ends soon after the last accent, and what is left of it is not danced.
        last = plan.steps[-1]
        ends_s = min(last.end_s, max(last.accent_s, rhythm.closes_s) + GOES_ON_S)
        return replace(plan, steps=(*plan.steps[:-1], replace(last, end_s=ends_s)))

    def _take_shares(self, rhythm: Rhythm, grid: AccentGrid) -> TakeShares:
        """Return the share of each take of the library at the accents of the grid: takes whose drums were like those of
        the rhythm get more (see `app.choreography.drums_of_dancers.take_shares`)."""
        takes = np.array([one.clip for one in self.model.segments], np.int64)
        lasting = self.candidates.before_s + self.candidates.after_s
        return take_shares(self.hearing.percussion.drums, rhythm, grid.times_s, takes, lasting)

    def _standing(self, frames: Sequence[int]) -> FloatArray:
        """Log odds (S,) that favour beginning or ending segments at the given frames of their clips, by how many feet
        stand there.
        """
        return np.asarray(0.5 * STANDING * (self._stitcher.feet_standing(frames) - 2.0))

    def _timed(self, chosen: Sequence[tuple[int, int]], grid: AccentGrid, body: int, held: BoolArray) -> _Plan:
        """Plan the times of chosen segments, given as pairs (accent, segment): first with their accents on the grid,
        then shifted so that all arrivals of the body fall on beats; those in the mask ``held`` stay.
        """
        if not chosen:
            return _Plan((), None, np.zeros(0))
        candidates, segments = self.candidates, np.array([segment for _, segment in chosen])
        before, after = candidates.before_s[segments], candidates.after_s[segments]
        hits = np.concatenate([[0.0], np.cumsum(after[:-1] + before[1:])])
        places_s = grid.times_s[[place for place, _ in chosen]]
        plain = TimeMap(
            np.array([places_s[0] - before[0] - _LEAST_S, *places_s, places_s[-1] + after[-1] + _LEAST_S]),
            np.array([-before[0] - _LEAST_S, *hits, hits[-1] + after[-1] + _LEAST_S]),
            np.array([False, *held, False]),
        )

        def planned(times: TimeMap) -> _Plan:
            edges_s = times.when(np.concatenate([[hits[0] - before[0]], hits + after])).tolist()
            steps = (
                SegmentStep(int(segment), int(candidates.states[segment]), place, *at)
                for (place, segment), *at in zip(chosen, edges_s, times.when(hits).tolist(), edges_s[1:], strict=False)
            )
            return _Plan(tuple(steps), times, hits)

        first_s, fps = float(plain.times_s[0]), float(DRAFT_FPS)
        draft_s = first_s + np.arange(math.ceil((float(plain.times_s[-1]) - first_s) * fps)) / fps
        arrivals, falls = self._arrivals_s(segments, hits), self._falls_along(segments, hits)
        shown = self._shortest.calmed(map_with_arrivals(plain, arrivals, grid, falls), segments, hits, hits + after)
        if len(draft_s) < 2:
            return planned(shown)
        best, best_worth = plain, -np.inf
        for number in range(1, DRAFTS + 1):
            motion = self._motion(planned(shown), body, DRAFT_FPS, draft_s)
            draft = draft_of(motion.clip, motion.contacts, motion.moved_m, draft_s, grid, self._step_s)
            worth = beats_met(draft_s[arrival_frames(draft.speed_m_s, fps)], draft.down_s, grid)
            if worth > best_worth:
                best, best_worth = shown, worth
            if number == DRAFTS:
                break
            following = best_arrival_map(draft.speed_m_s, draft_s, shown, plain, grid, draft.falls_s)
            if following is shown:
                break
            shown = self._shortest.calmed(following, segments, hits, hits + after)
        return planned(best)

    def _arrivals_s(self, segments: IntArray, hits: FloatArray) -> FloatArray:
        """Times (K,) of the arrivals (speed minima) in the given segments, in seconds along the segments placed one
        after another.
        """
        ends = hits + self.candidates.after_s[segments]
        first = hits[0] - float(self.candidates.before_s[segments[0]])
        along = np.arange(first, ends[-1], 1.0 / FPS)
        which = np.minimum(np.searchsorted(ends, along, side="right"), len(segments) - 1)
        speed = np.zeros(len(along))
        for number, clip in enumerate(self.model.clips):
            here = np.array([self.model.segments[segment].clip for segment in segments])[which] == number
            at_s = (self._hits_s[segments] - hits)[which[here]] + along[here]
            speed[here] = np.interp(at_s * float(clip.fps), np.arange(len(clip)), self._speeds[number])
        return np.asarray(along[arrival_frames(speed, FPS)])

    def _falls_along(self, segments: IntArray, hits: FloatArray) -> FloatArray:
        """Times (K,) of the footfalls in the given segments, in seconds along the segments placed one after another."""
        found = []
        for segment, hit, hit_s in zip(segments.tolist(), hits, self._hits_s[segments], strict=True):
            one = self.model.segments[segment]
            falls_s, fps = self._falls_s[one.clip], float(self.model.clips[one.clip].fps)
            first, stop = np.searchsorted(falls_s, (one.start / fps, one.end / fps))
            found.append(falls_s[first:stop] - hit_s + hit)
        return np.concatenate(found)

    def _motion(
        self, plan: _Plan, body: int, fps: Fraction, times_s: FloatArray, rests_s: float = np.inf, seed: int = 0
    ) -> _Motion:
        """Compute the motion of a plan at ascending times: its segments joined for the body of the clip with index
        ``body``, moving over the stage; it comes to rest after the last segment, from ``rests_s`` on at the latest.
        """
        assert plan.times is not None
        along, speeds = plan.times.at(times_s)
        segments = np.array([step.segment for step in plan.steps])
        which = np.searchsorted((plan.hits_s + self.candidates.after_s[segments])[:-1], along, side="right")
        # A join continues the motion of two frames before it; a single one is shown as a frame of the next segment.
        which[0] = which[min(1, len(which) - 1)]
        source_s = self._hits_s[segments[which]] + along - plan.hits_s[which]
        frames = Frames(segments, which, source_s, speeds)
        starts_s, ends_s = plan.times.times_s[[0, -1]]
        first, stop = np.searchsorted(times_s, (starts_s, min(ends_s, rests_s))).tolist()
        clip, contacts, seams = self._stitcher.stitched(frames, body, fps, stop)
        hips_m = on_stage(clip.hips_m, float(fps))
        moved_m, clip = hips_m - clip.hips_m, replace(clip, hips_m=hips_m)
        clip, moved_m, contacts = between_stands(clip, moved_m, contacts, (first, stop), self._stands_at_rest, seed)
        shown = tuple(seam for seam in seams if seam <= stop)
        return _Motion(unbroken(clip), moved_m, contacts, shown, np.where(times_s < rests_s, speeds, 0.0))
