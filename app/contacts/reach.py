"""Checks whether a player's hands reach everything that the fingerings require.

A control moved by a hand stops where the arm ends (`app.motion.contacts.controls_within_reach`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import Final, NamedTuple

import msgspec
import numpy as np

from app.contacts.bounds import UNREACHED_M
from app.contacts.touches import hand_gaps_m
from app.errors import Message
from app.motion.perform import prepare
from app.plan.model import FingeringEvent, PlayerPlan, Problem, TimeFrame, grips_of
from app.plan.parameters import PlayerParameters
from app.rig.grip.grip_pose import GripPose
from app.rig.model import Character
from app.rig.skeleton import forward
from app.steps import StepRuns
from instrument_maps.map_table import Posture
from instrument_maps.model import InstrumentMap
from metadata.model import Body

OUT_OF_REACH: Final = "contact.out_of_reach"
_NOTE_S, _APART_S = 2.0, 4.0

Place = tuple[tuple[str, float], ...]
"""Values of the controls that move whole hands, by the name of the control."""


class Holding(NamedTuple):
    """Inputs for posing a player's body with an instrument: character, grip and the table of body motion."""

    player_id: str
    character: Character
    grip: GripPose
    body: Body
    posture: Posture


@dataclass(frozen=True)
class Reached:
    """Reach of a player's hands.

    Attributes
    ----------
    asked : tuple
        All inputs of the result: player, instrument, and the controls and fingers of each distinct fingering.
    gaps_m : tuple of float
        Distance in metres by which a hand misses its grip, for each distinct fingering in the same order.
    problems : tuple of Problem
        A problem for every note whose fingering is out of a hand's reach.
    """

    asked: tuple[object, ...]
    gaps_m: tuple[float, ...]
    problems: tuple[Problem, ...]


def notes_out_of_reach(problems: Iterable[Problem]) -> frozenset[str | None]:
    """Ids of the notes that are out of reach."""
    return frozenset(problem.note_id for problem in problems if problem.message.id == OUT_OF_REACH)


def carried_controls(instrument: InstrumentMap) -> frozenset[str]:
    """Names of the controls along which a whole hand moves, such as a slide; reach is checked only for these."""
    return frozenset(control.name for control in instrument.controls if control.finger.endswith(".hand"))


def hand_reach(
    before: Reached | None,
    player: object,
    instrument: InstrumentMap,
    fingerings: tuple[FingeringEvent, ...],
    holding: Callable[[], Holding],
) -> Reached:
    """Check whether the hands reach every fingering of a plan.

    Checks each distinct fingering with the player standing or sitting still. If they equal those of ``before``, its
    result is used again.

    Parameters
    ----------
    before : Reached or None
        Earlier result, if there is one.
    player : object
        All inputs of ``holding``, compared with those of ``before``.
    instrument : InstrumentMap
        Instrument fitted to the player's body.
    fingerings : tuple of FingeringEvent
        Fingerings of the plan.
    holding : callable
        Function that returns the body with its grip; called only if needed.
    """
    carried = carried_controls(instrument)
    if not carried:
        return Reached((), (), ())
    known: dict[int, Place] = {}
    places: list[Place] = []
    grips = grips_of(fingerings)
    for event in grips:
        # Compared by identity: notes with the same fingering share its table.
        place = known.get(id(event.controls))
        if place is None:
            place = known[id(event.controls)] = _place(event, carried)
        places.append(place)
    examples: dict[Place, FingeringEvent] = {}
    for place, event in zip(places, grips, strict=True):
        examples.setdefault(place, event)
    held = tuple((place, event.controls, event.fingers) for place, event in examples.items())
    asked = (player, instrument, held)
    if before is not None and before.asked == asked:
        gaps_m = before.gaps_m
    else:
        gaps_m = tuple(_gaps_m(holding(), instrument, list(examples.values())))
    far = {place: gap_m for place, gap_m in zip(examples, gaps_m, strict=True) if gap_m > UNREACHED_M}
    problems = []
    for place, event in zip(places, grips, strict=True):
        if place in far:
            control = max(sorted(carried), key=lambda name: event.controls.get(name, 0.0))
            gap_mm = 5 * round(200.0 * far[place])
            message = Message(OUT_OF_REACH, {"label": event.label, "control": control, "gap_mm": gap_mm})
            problems.append(Problem(message, event.note_id, event.start_s, event.end_s))
    return Reached(asked, gaps_m, tuple(problems))


def _place(event: FingeringEvent, carried: frozenset[str]) -> Place:
    return tuple(sorted((name, value) for name, value in event.controls.items() if name in carried))


def _gaps_m(holding: Holding, instrument: InstrumentMap, examples: list[FingeringEvent]) -> list[float]:
    """Return the distance in metres by which a hand misses its grip for each fingering."""
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
    player_id, character, grip, body, posture = holding
    still = PlayerPlan(player_id, frame, held, (), (), (), (), (), (), ())
    parameters = PlayerParameters(amplitude=0.0, posture=posture, sway=0.0, weight_shift=0.0)
    curves = prepare(StepRuns(), still, parameters, instrument, character, grip, body, felt_beats=((0, 1),))
    # One frame at the middle of each note.
    fps = Fraction(1, round(_NOTE_S / 2.0))
    motion = curves.motion(fps, 0, round((frame.end_s - frame.first_frame_s) * fps))
    times_s = motion.first_frame_s + np.arange(motion.frames) / float(fps)
    frames = [int(np.argmin(np.abs(times_s - (event.start_s + _NOTE_S / 2.0)))) for event in held]
    skeleton = character.skeleton
    asked = {
        control.name: np.array([event.controls.get(control.name, control.rest_value) for event in held])
        for control in instrument.controls
    }
    gaps = np.zeros(len(held))
    place_m = motion.instrument_position_m[frames].astype(np.float64)
    turn = motion.instrument_rotation[frames].astype(np.float64)
    for hand in grip.hands:
        wrist = skeleton.index(f"{hand.side}Hand")
        joints = forward(skeleton, motion.rotations[frames].astype(np.float64), motion.hips_m[frames], (wrist,))
        gaps = np.maximum(gaps, hand_gaps_m(hand, joints.of(wrist)[0], place_m, turn, asked))
    return [float(gap) for gap in gaps]
