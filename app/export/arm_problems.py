"""Problems of arms that are too deep in trunk or clothes, from the measured depth of an export or of a motion alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Final

from app.contacts.breaks import JUDGED_PER_S
from app.errors import Message, StopRequested, raise_if_stopped
from app.export.arm_depths import ArmDepth, arm_depth
from app.export.character import character_scene
from app.export.joint_playback import JointPlayback
from app.export.playback import ScenePlayback
from app.export.target import normalised_target
from app.motion.model import Motion, joined
from app.motion.perform import PerformanceCurves
from app.performance.cast import Performer, performers_of
from app.performance.ensemble import Performance
from app.performance.motion import performance_curves
from app.performance.span import whole_span
from app.plan.model import Problem, TimeFrame
from app.project.performers import Player
from app.rig.model import Character

MOST_MEASURED: Final = 4
"""Greatest number of players whose arms are measured without a file (half a second each) unless more are asked for."""
MOST_FRAMES: Final = 4500
"""Greatest number of frames of a player among which those with arms near the trunk are looked for."""
_CHUNK: Final = 512
"""Number of frames computed between two checks for cancellation."""


def arm_problems(depth: ArmDepth, first_frame_s: float, fps: float) -> tuple[Problem, ...]:
    """Return a problem at the frame of the greatest depth if it is beyond its bound; else none.

    Parameters
    ----------
    first_frame_s : float
        Time in seconds of frame 0.
    fps : float
        Frames per second.
    """
    if depth.kept:
        return ()
    message = Message(
        "contact.arm_inside",
        {"side": depth.side, "depth_mm": round(depth.depth_mm, 1), "most_mm": round(depth.bound_mm)},
    )
    at_s = first_frame_s + depth.frame / fps
    return (Problem(message, None, at_s, at_s + 1.0 / JUDGED_PER_S),)


def arm_problems_of(
    character: Character, motion: Motion, stop_requested: StopRequested = lambda: False
) -> tuple[Problem, ...]:
    """Return the problems of a motion as in `arm_problems`, measured on the character's surfaces without any file.

    Raises
    ------
    Cancelled
        ``stop_requested`` returned true.
    """
    # Faces are no part of arms and trunk.
    still = replace(character, meshes=tuple(replace(mesh, morphs=()) for mesh in character.meshes))
    target = normalised_target(still.skeleton)
    scene = character_scene(still, motion, "character", "", target, face_parts=(), every_influence=True)
    raise_if_stopped(stop_requested)
    assert scene.clip is not None
    depth = arm_depth(JointPlayback(ScenePlayback(scene, scene.clip), target, still), stop_requested)
    return arm_problems(depth, motion.first_frame_s, float(motion.fps))


def performer_arm_problems(
    performer: Performer, curves: PerformanceCurves, frame: TimeFrame, stop_requested: StopRequested = lambda: False
) -> tuple[Problem, ...]:
    """Return the problems of a player's arms in a whole performance, as in `arm_problems_of`.

    Parameters
    ----------
    frame : TimeFrame
        Time from the first to the last frame of the performance.
    """
    per_s = min(float(JUDGED_PER_S), MOST_FRAMES / max(frame.end_s - frame.first_frame_s, 1.0))
    fps = Fraction(per_s).limit_denominator(1000)
    span, pieces = whole_span(frame, fps), list[Motion]()
    for first in range(span.first, span.first + span.count, _CHUNK):
        raise_if_stopped(stop_requested)
        piece = curves.motion(fps, first, min(_CHUNK, span.first + span.count - first))
        # A player who changes instruments has different face shapes in some pieces, which are not needed here.
        pieces.append(replace(piece, morphs={}))
    return arm_problems_of(performer.dressed, joined(pieces), stop_requested)


def all_arm_problems(
    performance: Performance, players: Sequence[Player], without_limit: bool = False
) -> tuple[dict[str, tuple[Problem, ...]], Message | None]:
    """Return the problems of the arms of players by id, without those that cannot be shown; and a message if none were
    measured because there are more than `MOST_MEASURED`.

    Parameters
    ----------
    without_limit : bool
        Measure the arms of all players, however long it takes.
    """
    if len(players) > MOST_MEASURED and not without_limit:
        return {}, Message("judged.no_arms", {"most": MOST_MEASURED})
    found = {
        player_id: performer_arm_problems(one, performance_curves(performance, one), performance.time_frame)
        for player_id, one in performers_of(performance, players).made.items()
    }
    return found, None
