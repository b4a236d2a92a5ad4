"""Motion of a single player, by `app.performance.motion`, for tests."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from app.motion.model import Motion, frame_count
from app.motion.perform import PerformanceCurves, prepare
from app.performance import motion
from app.performance.cast import performer_of
from app.performance.ensemble import Performance
from app.performance.span import FrameSpan
from app.plan.by_hand.corrections import PinFingering
from app.plan.model import PlayerPlan
from app.project.edit.corrections import with_corrections
from app.project.model import Project
from app.project.performers import Player
from app.score.metre_map import FeltBeats
from app.steps import StepRuns


def performance_curves(
    performance: Performance, player: Player, before: PerformanceCurves | None = None
) -> PerformanceCurves:
    """Curves of the player's plan."""
    return motion.performance_curves(performance, performer_of(performance, player), before)


def player_motion(performance: Performance, player: Player, span: FrameSpan) -> Motion:
    """Motion of the player over some frames."""
    return motion.player_motion(performance, performer_of(performance, player), span)


def perform(
    plan: PlayerPlan,
    *player: Any,
    felt_beats: FeltBeats,
    fps: Fraction,
    frames: int | None = None,
    first_frame: int = 0,
) -> Motion:
    """Motion of one player to the end or for a number of frames; ``player`` contains other arguments of `prepare`."""
    if frames is None:
        frames = max(0, frame_count(plan.time_frame, fps) - first_frame)
    return prepare(StepRuns(), plan, *player, felt_beats=felt_beats).motion(fps, first_frame, frames)


def in_seventh(project: Project, player: Player) -> Project:
    """Pin a tenor trombone's low E and B natural to seventh position in a project, as for an instrument without a
    trigger.
    """
    pins = [PinFingering(note.id, "7") for note in project.part(player).notes if note.pitch in (40, 47)]
    return with_corrections(project, player.id, pins)
