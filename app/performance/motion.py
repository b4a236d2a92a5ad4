"""Computes one player's motion at a frame rate in pieces, with progress and cancellation."""

from __future__ import annotations

from functools import lru_cache
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.errors import Progress
from app.identity_cache import IdentityCache
from app.motion.doubling import Doubling, doubled
from app.motion.generated_channel import generated
from app.motion.model import Motion, joined
from app.motion.perform import PerformanceCurves, prepare
from app.performance.cast import Performer, performer_of, performers_of
from app.performance.dances import layer_of
from app.performance.ensemble import Performance
from app.performance.motion_copies import made_by_copies, shares
from app.performance.span import FrameSpan
from app.plan.doubling import changes, first_played
from app.plan.model import PlayerPlan
from app.score.metre_map import FeltBeats
from app.steps import StepRuns

RATE_HZ: Final = 25.0
MOST_SAMPLES: Final = 200_000
_ASKED: Final = ("breaths", "tongues", "embouchures", "cues", "gestures", "expressions", "poses", "traces")
"""Fields of a plan on which a channel depends besides its own curves."""


CHUNK = 16384
"""Number of frames computed between two checks for cancellation."""

_PLAYING: IdentityCache[PerformanceCurves] = IdentityCache(8)
_DOUBLED: IdentityCache[tuple[Doubling, ...]] = IdentityCache(8)


def performance_curves(
    performance: Performance, performer: Performer, before: PerformanceCurves | None = None, *, danced: bool = True
) -> PerformanceCurves:
    """Return the curves of a player's plan, cached for each plan; unchanged parts of ``before`` are used again.

    ``danced``: include the player's choreography, which may take seconds to generate.
    """
    played = performance.project.played_by(performer.player)
    if len(played) == 1:
        return _alone(performance, performer, before, danced)
    old = before if isinstance(before, Doubling) else None
    # Performers that cannot be shown are ignored.
    others = performers_of(performance, (one for one in played if one.id != performer.player.id)).made
    all_of = [others.get(one.id, performer) for one in played if one.id in others or one.id == performer.player.id]
    known = {} if old is None else {one.player_id: one for one in old.played}
    alone = [_alone(performance, one, known.get(one.player.id), danced) for one in all_of]
    found = _DOUBLED.step(_doubled, *alone)
    return found[[one.player.id for one in all_of].index(performer.player.id)]


def _doubled(*alone: PerformanceCurves) -> tuple[Doubling, ...]:
    plans = {one.player_id: one.plan for one in alone}
    return doubled(alone, first_played(plans), changes(plans))


def _alone(
    performance: Performance, performer: Performer, before: PerformanceCurves | None, danced: bool
) -> PerformanceCurves:
    """Compute the curves of a player's plan as if the musician had no other instrument."""
    player, plan = performer.player, performance.plan(performer.player)
    dance = layer_of(performance, player) if danced and player.parameters.choreography else None
    parameters = performance.parameters(player)
    felt_beats, expressions = _same(performance.piece.metre_map.felt_beats), performance.expressions
    return _PLAYING.helped(
        prepare,
        StepRuns(None if before is None else before.runs),
        plan,
        parameters,
        performer.instrument,
        performer.dressed,
        performer.grip,
        performer.body,
        felt_beats=felt_beats,
        expressions=expressions,
        dance=dance,
    )


@lru_cache(maxsize=64)
def _same(felt_beats: FeltBeats) -> FeltBeats:
    """Return one shared object for equal lists of felt beats, so that caches which compare inputs by identity find
    them.
    """
    return felt_beats


def player_motion(
    performance: Performance,
    performer: Performer,
    span: FrameSpan,
    progress: Progress = lambda share: None,
    cores: int = 1,
) -> Motion:
    """Compute one player's motion over some frames; a frame is bit-identical whatever span is requested.

    Parameters
    ----------
    cores : int
        Number of idle cores, including this process's: forked copies compute a share where worthwhile.
    """
    curves = performance_curves(performance, performer)
    first, *others = shares(span.count, cores)

    def make(part: range) -> Motion:
        pieces = []
        for start in part[::CHUNK]:
            end = min(start + CHUNK, part.stop)
            pieces.append(curves.motion(span.fps, span.first + start, end - start))
            if part is first:
                progress((end - part.start) / len(part))
        return joined(pieces)

    with made_by_copies(make, others) as made:
        return joined([make(first), *made()])


def generated_channel(performance: Performance, player_id: str, channel: str) -> tuple[FloatArray, FloatArray]:
    """Sample an animation channel without the user's additive curves: times (N,) in seconds, and values (N,) in the
    channel's unit. Raises AppError if the player cannot be shown.
    """
    performer = performer_of(performance, performance.project.player(player_id))
    curves = performance_curves(performance, performer, danced=False)
    frame = curves.plan.time_frame
    count = int(min(RATE_HZ * (frame.end_s - frame.first_frame_s) + 2.0, MOST_SAMPLES))
    times_s = np.linspace(frame.first_frame_s, frame.end_s, count)
    return times_s, generated(curves, channel, times_s)


def generated_anew(before: PlayerPlan, after: PlayerPlan) -> bool:
    """Return whether any event from which animation channels are generated was planned again between two plans, so that
    the channels' generated values may differ.
    """
    if before is after:
        return False
    same = before.player_id == after.player_id and before.time_frame == after.time_frame
    return not (same and all(getattr(before, kind) is getattr(after, kind) for kind in _ASKED))
