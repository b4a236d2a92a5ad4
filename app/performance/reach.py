"""Whether a player's hands reach everything the fingerings ask for.

Messages: ``contact.out_of_reach`` (label, gap_mm): "{label} is out of this player's reach ...", a problem of a note.
"""

from __future__ import annotations

from fractions import Fraction

import msgspec
import numpy as np

from app.errors import Message
from app.motion.perform import prepare
from app.performance.bodies import body_of, character_of, hold_of
from app.plan.model import FingeringEvent, PlayerParameters, PlayerPlan, Problem, TimeFrame
from app.project.model import Player
from app.rig.hold import hand_targets
from app.rig.skeleton import forward
from instrument_maps.model import InstrumentMap

MOST_GAP_M = 0.005
"""A hand may stay this far from its grip before a person sees it."""
_NOTE_S, _APART_S = 2.0, 4.0

Place = tuple[tuple[str, float], ...]
"""Where the controls are that whole hands move."""


def reach_problems(player: Player, instrument: InstrumentMap, plan: PlayerPlan) -> tuple[Problem, ...]:
    """A problem for every note whose fingering asks a hand to go where the player's arm ends before.

    Looked at are only controls that a whole hand moves, in every place that the plan uses, as the player would hold
    them standing or sitting still.
    """
    carried = frozenset(control.name for control in instrument.controls if control.finger.endswith(".hand"))
    if not carried:
        return ()
    examples: dict[Place, FingeringEvent] = {}
    for event in plan.fingerings:
        examples.setdefault(_place(event, carried), event)
    gaps_m = dict(zip(examples, _gaps_m(player, instrument, plan, list(examples.values())), strict=True))
    problems = []
    for event in plan.fingerings:
        gap_m = gaps_m[_place(event, carried)]
        if gap_m > MOST_GAP_M:
            message = Message("contact.out_of_reach", {"label": event.label, "gap_mm": 5 * round(200.0 * gap_m)})
            problems.append(Problem(message, event.note_id, event.start_s, event.end_s))
    return tuple(problems)


def _place(event: FingeringEvent, carried: frozenset[str]) -> Place:
    return tuple(sorted((name, value) for name, value in event.controls.items() if name in carried))


def _gaps_m(player: Player, instrument: InstrumentMap, plan: PlayerPlan, examples: list[FingeringEvent]) -> list[float]:
    """How far a hand stays from its grip while each fingering is held, metres."""
    held = tuple(
        msgspec.structs.replace(
            event,
            id=f"fingering:{index}",
            note_id=str(index),
            start_tick=index,
            end_tick=index + 1,
            start_s=_APART_S * index,
            end_s=_APART_S * index + _NOTE_S,
        )
        for index, event in enumerate(examples)
    )
    frame = TimeFrame(-_APART_S, _APART_S * len(held))
    still = PlayerPlan(plan.player_id, frame, held, (), (), (), (), (), (), ())
    parameters = PlayerParameters(amplitude=0.0, posture=player.parameters.posture, sway=0.0, weight_shift=0.0)
    character, hold = character_of(player), hold_of(player, instrument)
    playing = prepare(still, parameters, instrument, character, hold, body_of(player), beat_ticks=1)
    # One frame in the middle of each note.
    fps = Fraction(1, round(_NOTE_S / 2.0))
    motion = playing.motion(fps, 0, round((frame.end_s - frame.first_frame_s) * fps))
    times_s = motion.first_frame_s + np.arange(motion.frames) / float(fps)
    frames = [int(np.argmin(np.abs(times_s - (event.start_s + _NOTE_S / 2.0)))) for event in held]
    skeleton = character.skeleton
    gaps = np.zeros(len(held))
    for hand in hold.hands:
        wrist = skeleton.index(f"{hand.side}Hand")
        joints = forward(skeleton, motion.rotations[frames].astype(np.float64), motion.hips_m[frames], (wrist,))
        reached_m, _ = joints.of(wrist)
        wanted_m, _ = hand_targets(
            hand,
            motion.instrument_position_m[frames].astype(np.float64),
            motion.instrument_rotation[frames].astype(np.float64),
            {name: values[frames] for name, values in motion.controls.items()},
        )
        gaps = np.maximum(gaps, np.linalg.norm(reached_m - wanted_m, axis=1))
    return [float(gap) for gap in gaps]
