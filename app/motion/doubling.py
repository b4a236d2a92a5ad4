"""Motion of one body that plays several instruments in turn.

Motion is computed for each instrument as if it were the only one, with the instrument lowered and put aside at changes.
The body blends between the motions only while the hands are empty, so a held instrument is never blended.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from fractions import Fraction

import numpy as np

from app.arrays import FloatArray, IndexArray, SingleArray
from app.motion.contacts.clear_seat import highest_seat, on_seat
from app.motion.contacts.instrument_put_aside import Aside
from app.motion.contacts.trunk_and_legs import solve_legs
from app.motion.curves.curve import EVERYWHERE, Curve, frame_times, moves
from app.motion.model import Motion, joined
from app.motion.perform import PerformanceCurves
from app.plan.doubling import InstrumentChange
from app.rig import quaternion

MOST_FRAMES, LEAST_FRAMES = 2**17, 256
"""Greatest number of frames of all instruments together in memory, and least number of each that are computed at a
time.
"""
LOWERS = 0.85
"""Share of the way aside at which the instrument has left the lips, and of the way back at which it begins to approach
them.
"""


class LastChunk:
    """Cache of a musician's motions with each instrument over the last requested frames."""

    def __init__(self) -> None:
        self._kept: tuple[tuple[Fraction, int, int, int] | None, dict[int, Motion]] = None, {}

    def motion(
        self, number: int, curves: PerformanceCurves, fps: Fraction, first_frame: int, frames: int, every: int
    ) -> Motion:
        """Return frames of a musician's motion with the instrument of index ``number``: from the cache if they were
        computed last, else computed by ``curves``. Several threads may call this at the same time.
        """
        kept, asked = self._kept, (fps, first_frame, frames, every)
        if kept[0] != asked:
            kept = self._kept = asked, {}
        made = kept[1]
        if number not in made:
            made[number] = curves.motion(*asked)
        return made[number]


@dataclass(frozen=True, eq=False)
class Doubling(PerformanceCurves):
    """Motion of one instrument of a musician who plays several.

    Attributes
    ----------
    played : tuple of PerformanceCurves
        Curves of all the musician's instruments, each including the motion of putting it aside.
    shares : tuple of Curve
        Weight of each instrument's motion; they sum to 1.
    number : int
        Index of this instrument.
    last : LastChunk
        Cache shared by all instruments of the musician.
    """

    played: tuple[PerformanceCurves, ...] = ()
    shares: tuple[Curve, ...] = ()
    number: int = 0
    last: LastChunk = field(default_factory=lambda: LastChunk())

    def motion(self, fps: Fraction, first_frame: int, frames: int, every: int = 1) -> Motion:
        """Compute some frames: the body with the instrument in use, and this instrument in the hands or aside."""
        most = max(MOST_FRAMES // len(self.played), LEAST_FRAMES) // every * every
        if frames > most:
            end = first_frame + frames
            starts = range(first_frame, end, most)
            return joined([self.motion(fps, start, min(most, end - start), every) for start in starts])
        times_s = frame_times(self.start_s, fps, first_frame, frames)[::every]
        shares = np.array([curve.sample(times_s) for curve in self.shares])
        made = {
            number: self.last.motion(number, one, fps, first_frame, frames, every)
            for number, one in enumerate(self.played)
            if number == self.number or np.any(shares[number] > 0.0)
        }
        own = made[self.number]
        names = list(dict.fromkeys(name for motion in made.values() for name in motion.morphs))
        nothing = np.zeros(len(times_s), np.float32)
        leading = np.argmax(shares, axis=0)
        rotations, hips_m = np.empty_like(own.rotations), np.empty_like(own.hips_m)
        morphs = {name: np.zeros(len(times_s), np.float32) for name in names}
        for number in np.unique(leading).tolist():
            here = leading == number
            rotations[here], hips_m[here] = made[number].rotations[here], made[number].hips_m[here]
            for name in names:
                morphs[name][here] = made[number].morphs.get(name, nothing)[here]
        between = np.flatnonzero(np.max(shares, axis=0) < 1.0)
        if len(between):
            self._blend(shares[:, between], between, made, rotations, hips_m, morphs)
        return replace(own, rotations=rotations, hips_m=hips_m, morphs=morphs)

    def _blend(
        self,
        shares: FloatArray,
        frames: IndexArray,
        made: Mapping[int, Motion],
        rotations: SingleArray,
        hips_m: SingleArray,
        morphs: Mapping[str, SingleArray],
    ) -> None:
        """Fill in the frames in which the body blends between two motions."""
        order = np.argsort(shares, axis=0)
        # Always from the lower to the higher index, so that the direction does not change half way.
        pairs = np.sort(order[-2:], axis=0)
        for one, other in {tuple(pair) for pair in pairs.T.tolist()}:
            some = np.flatnonzero((pairs[0] == one) & (pairs[1] == other))
            here, share = frames[some], shares[other, some]
            a, b = made[one], made[other]
            turned = quaternion.slerp(
                a.rotations[here].astype(np.float64), b.rotations[here].astype(np.float64), share[:, None]
            )
            at_m = a.hips_m[here] + (b.hips_m[here] - a.hips_m[here]).astype(np.float64) * share[:, None]
            player = self.player
            hips = turned[:, player.skeleton.index("hips")]
            for joint, leg in solve_legs(player.place, player.skeleton, at_m, hips, {}).items():
                turned[:, joint] = leg
            rotations[here], hips_m[here] = turned, at_m
            for name, values in morphs.items():
                first, second = (
                    motion.morphs[name][here] if name in motion.morphs else np.zeros(len(here)) for motion in (a, b)
                )
                values[here] = first + (second - first) * share

    def changed_s(self, other: PerformanceCurves) -> FloatArray:
        """Return the spans (K, 2) in seconds in which the motion differs from ``other``, over all instruments of the
        musician; everything if they are not comparable."""
        if not isinstance(other, Doubling):
            return EVERYWHERE
        if len(self.played) != len(other.played) or self.number != other.number:
            return EVERYWHERE
        spans = [mine.changed_s(theirs) for mine, theirs in zip(self.played, other.played, strict=True)]
        spans += [mine.changed_s(theirs) for mine, theirs in zip(self.shares, other.shares, strict=True)]
        return np.concatenate(spans)


def doubled(played: Sequence[PerformanceCurves], first: str, found: Sequence[InstrumentChange]) -> tuple[Doubling, ...]:
    """Combine the motions of a musician with each instrument: one result for each instrument, with the others put
    aside.

    Parameters
    ----------
    played : sequence of PerformanceCurves
        Curves of one body, each made as if for its only instrument.
    first : str
        Id of the player whose instrument is in the hands first.
    found : sequence of InstrumentChange
        Instrument changes in order.
    """
    seated = _on_one_seat(played)
    ready = tuple(_with_ways(one, number, first, found) for number, one in enumerate(seated))
    shares = tuple(_share(one.player_id, first, found) for one in played)
    last = LastChunk()
    return tuple(_doubling(one, ready, shares, number, last) for number, one in enumerate(ready))


def _on_one_seat(played: Sequence[PerformanceCurves]) -> list[PerformanceCurves]:
    """Return the curves of a musician on the seat that is high enough for every instrument."""
    place = highest_seat(one.player for one in played)
    return [
        one
        if one.player.place is place or not place.seated
        else replace(one, player=on_seat(one.player, place, one.instrument_map.endpin))
        for one in played
    ]


def _doubling(
    own: PerformanceCurves,
    played: tuple[PerformanceCurves, ...],
    shares: tuple[Curve, ...],
    number: int,
    last: LastChunk,
) -> Doubling:
    members = {member.name: getattr(own, member.name) for member in fields(PerformanceCurves)}
    return Doubling(**members, played=played, shares=shares, number=number, last=last)


def _with_ways(
    curves: PerformanceCurves, number: int, first: str, found: Sequence[InstrumentChange]
) -> PerformanceCurves:
    """Return a player's curves with the moves added by which the instrument is put aside while another one
    is played.
    """
    ways = []
    for change in found:
        if change.before == curves.player_id:
            ways.append((change.start_s, change.put_s, 1.0))
        elif change.after == curves.player_id:
            ways.append((change.taken_s, change.end_s, 0.0))
    begins = 0.0 if curves.player_id == first else 1.0
    lowered = _lowered(curves, ways, begins)
    side = curves.instrument_map.hold.support_hand
    return replace(
        curves,
        player=replace(curves.player, aside=Aside(side, number)),
        layers=replace(curves.layers, lowered=lowered),
        stowed=moves(ways, begins),
    )


def _lowered(curves: PerformanceCurves, ways: Sequence[tuple[float, float, float]], begins: float) -> Curve:
    """Return the curve of lowering the instrument (0: at the lips, 1: lowered): as planned, and fully lowered while the
    instrument is put aside.
    """
    bell = curves.body.bell
    spans: list[tuple[float, float, float]] = []
    away_s = float("-inf") if begins else None
    for start_s, end_s, aside in ways:
        if aside:
            away_s = start_s
        elif away_s is not None:
            spans.append((away_s, end_s, end_s - start_s))
            away_s = None
    if away_s is not None:
        spans.append((away_s, float("inf"), 0.0))
    quick = {start_s: end_s - start_s for start_s, end_s, aside in ways if aside}
    rows = [(start_s, end_s, quick.get(start_s, bell.lower_s), back_s, 1.0) for start_s, end_s, back_s in spans]
    rows += [
        (event.start_s, event.end_s, bell.lower_s / LOWERS, bell.raise_s / LOWERS, event.amount)
        for event in curves.plan.gestures
        if event.part == "lowering" and event.end_s > event.start_s
    ]
    united: list[tuple[float, float, float, float, float]] = []
    for row in sorted(rows):
        if united and row[0] < united[-1][1]:
            before = united[-1]
            last = before if before[1] >= row[1] else row
            united[-1] = (before[0], last[1], before[2], last[3], max(before[4], row[4]))
        else:
            united.append(row)
    segments: list[tuple[float, float, float]] = []
    for start_s, end_s, down_s, up_s, amount in united:
        share = min(LOWERS, (end_s - start_s) / (down_s + up_s))
        if start_s > float("-inf"):
            segments.append((start_s, start_s + share * down_s, amount))
        if end_s < float("inf"):
            segments.append((end_s - share * up_s, end_s, 0.0))
    return moves(segments, 1.0 if united and united[0][0] == float("-inf") else 0.0)


def _share(player_id: str, first: str, found: Sequence[InstrumentChange]) -> Curve:
    """Return the weight over time, 0..1, of the motion with one player's instrument in the motion of a doubling
    musician: 1 while it is played, changing at instrument changes.
    """
    ways = [
        (change.put_s, change.taken_s, 1.0 if change.after == player_id else 0.0)
        for change in found
        if player_id in (change.before, change.after)
    ]
    return moves(ways, 1.0 if player_id == first else 0.0)
