"""Glissandi and bends in a score: motion of slide and lips."""

from __future__ import annotations

import numpy as np
import pytest

from app.contacts.controls import NoteFrames
from app.motion.fingering.control_curves import control_curves
from app.plan.generate import MonophonicPart
from app.plan.model import PlayerPlan
from app.score.marks import Mark
from instrument_maps.load import bundled_maps
from instrument_maps.model import InstrumentMap
from tests.support.plan import PlainClock, PlainNote, make_plans, piece_of, time_frame

Q = 480
CLOCK = PlainClock(((0, 60.0),))
TROMBONE = bundled_maps()["trombone_tenor_F_attachment"]
TRUMPET = bundled_maps()["trumpet_Bb"]
# G 3 and B flat 3 are one harmonic in the fourth and the first position.
NOTES = (PlainNote("1:1", 0, 2 * Q, 55), PlainNote("1:2", 2 * Q, 2 * Q, 58), PlainNote("1:3", 4 * Q, Q, 53))


def planned(instrument: InstrumentMap, *marks: Mark) -> PlayerPlan:
    line = MonophonicPart("p", NOTES, instrument, marks=marks, source="score")
    return make_plans(piece_of(CLOCK), (line,), time_frame((line,), CLOCK))["p"]


def slide_at(plan: PlayerPlan, *at_s: float) -> list[float]:
    curves = control_curves(plan.fingerings, TROMBONE.controls, ((0, Q),))
    found: list[float] = curves["slide"].sample(np.array(at_s)).tolist()
    return found


def test_a_slide_glides_through_a_glissando_and_the_next_note_is_not_tongued() -> None:
    plain, glided = planned(TROMBONE), planned(TROMBONE, Mark("glissando", "1:1"))
    start, end = slide_at(glided, 0.2, 2.05)
    middle = slide_at(glided, 1.4)[0]
    assert min(start, end) < middle < max(start, end)
    assert slide_at(plain, 1.4)[0] == pytest.approx(slide_at(plain, 0.2)[0])
    assert [event.note_id for event in glided.tongues] == ["1:1", "1:3"]
    assert [event.note_id for event in plain.tongues] == ["1:1", "1:2", "1:3"]


def test_the_judge_of_controls_lets_a_slide_glide() -> None:
    plan = planned(TROMBONE, Mark("glissando", "1:1"))
    times_s = np.arange(0.0, 5.0, 1.0 / 60.0)
    slide = next(control for control in TROMBONE.controls if control.kind == "slide")
    values = control_curves(plan.fingerings, TROMBONE.controls, ((0, Q),))["slide"].sample(times_s)
    assert NoteFrames(times_s, plan.fingerings).measure(slide, values, 60.0).held_wrong == 0


def test_valves_do_not_glide() -> None:
    assert all(event.glide_from_s is None for event in planned(TRUMPET, Mark("glissando", "1:1")).fingerings)


@pytest.mark.parametrize(
    ("kind", "sign", "at_s"), [("scoop", -1, 0.03), ("plop", 1, 0.03), ("fall", -1, 1.9), ("doit", 1, 1.9)]
)
def test_lips_bend_as_it_is_written(kind: str, sign: int, at_s: float) -> None:
    plan, plain = planned(TRUMPET, Mark(kind, "1:1")), planned(TRUMPET)
    assert plan.traces is not None
    tension = plan.traces.tension[round((at_s - plan.traces.start_s) / plan.traces.step_s)]
    assert (tension - plain.embouchures[0].tension) * sign > 0.05
    # In the middle of the note nothing bends, and the vibrato stays.
    middle = plan.traces.tension[round((1.0 - plan.traces.start_s) / plan.traces.step_s)]
    assert middle == pytest.approx(plain.embouchures[0].tension, abs=0.02)
    assert not plan.has_recorded_lips
