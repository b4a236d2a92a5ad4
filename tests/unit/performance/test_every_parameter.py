"""Every parameter of a player, changed alone: reused results equal freshly computed ones, and the parameter influences
exactly what it declares.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cache

import numpy as np
import pytest

from app.motion.contacts.solve import padding_frames
from app.motion.curves.curve import frame_times
from app.motion.model import Motion, frame_count
from app.motion.perform import PerformanceCurves
from app.performance.ensemble import Performance
from app.plan.by_hand.corrections import PoseCorrection
from app.plan.parameters import PARAMETERS, Parameter
from app.project.edit.corrections import with_corrections
from app.project.edit.players import set_parameters
from tests.property.performance.edits import piece
from tests.support.parameters import others
from tests.support.performed import performance_curves

FPS = Fraction(6)


@cache
def before(danced: bool) -> Performance:
    """Two trumpets who lead in turn, and a trombone; the first trumpet may dance and holds the bell high."""
    project = piece()
    first = project.players[0].id
    project = with_corrections(project, first, [PoseCorrection("up", "bell", 0, 9600, up_deg=500.0)])
    made = Performance(set_parameters(project, (first,), choreography="salsa") if danced else project)
    made.prepare()
    return made


@cache
def old_playing(danced: bool, place: int) -> tuple[PerformanceCurves, Motion]:
    """Curves of a player of `before`, and all frames."""
    old = before(danced)
    playing = performance_curves(old, old.project.players[place])
    return playing, all_frames(playing)


def all_frames(playing: PerformanceCurves) -> Motion:
    return playing.motion(FPS, 0, frame_count(playing.plan.time_frame, FPS))


def arrays(motion: Motion) -> dict[str, np.ndarray]:
    of = {
        name: getattr(motion, name) for name in ("rotations", "hips_m", "instrument_position_m", "instrument_rotation")
    }
    return of | motion.morphs | motion.controls


def differing(one: Motion, other: Motion) -> np.ndarray:
    """Mask of the frames in which two motions are not equal bit by bit."""
    ours, theirs = arrays(one), arrays(other)
    assert ours.keys() == theirs.keys()
    differs = np.zeros(len(one.hips_m), bool)
    for name, values in ours.items():
        differs |= (values != theirs[name]).reshape(len(differs), -1).any(axis=1)
    return differs


def within(spans_s: np.ndarray, start_s: float, count: int) -> np.ndarray:
    """Mask of the frames within or close to some time spans."""
    times_s, room_s = frame_times(start_s, FPS, 0, count), float((padding_frames(FPS) + 1) / FPS)
    found = np.zeros(count, bool)
    for first_s, last_s in spans_s:
        found |= (times_s >= first_s - room_s) & (times_s <= last_s + room_s)
    return found


@pytest.mark.parametrize("parameter", PARAMETERS.values(), ids=PARAMETERS)
def test_a_change_makes_anew_what_it_says_and_no_less(parameter: Parameter) -> None:
    danced = parameter.section == "dance"
    old = before(danced)
    first = old.project.players[0]
    seen = False
    # One value only: random edits use any value (tests/property/performance).
    for value in others(parameter, getattr(first.parameters, parameter.name))[-1:]:
        changed = set_parameters(old.project, (first.id,), **{parameter.name: value})
        warm, cold = Performance(changed, old), Performance(changed)
        assert warm.plans == cold.plans
        assert [warm.problems(id) for id in cold.plans] == [cold.problems(id) for id in cold.plans]
        assert warm.plans == old.plans or parameter.decides != {"motion"}
        seen |= warm.plans != old.plans
        assert len(changed.players) == len(old.project.players)
        for place, player in enumerate(changed.players):
            then, shown_then = old_playing(danced, place)
            now, fresh = performance_curves(warm, player, then), performance_curves(cold, player)
            motion = all_frames(now)
            assert not differing(motion, all_frames(fresh)).any()
            differs = differing(motion, shown_then)
            assert not (differs & ~within(now.changed_s(then), now.start_s, len(differs))).any()
            seen |= bool(differs.any())
    assert seen, "it does nothing"
