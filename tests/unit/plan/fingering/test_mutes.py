"""Muted passages are states of the plan, and a stopped horn is fingered a semitone lower on its F side."""

from __future__ import annotations

from typing import Any

from app.messages import WORDINGS
from app.plan.generate import MonophonicPart
from app.plan.model import PlayerPlan
from app.score.metre_map import Metre
from app.score.mutes import NAMED
from instrument_maps.load import bundled_maps
from tests.support.plan import PlainClock, even, make_plans, piece_of, time_frame

Q = 480
BAR = 4 * Q


def plan(instrument: str, pitches: list[int], **spans: Any) -> PlayerPlan:
    clock = PlainClock()
    line = MonophonicPart("p", even(pitches, Q), bundled_maps()[instrument], **spans)
    return make_plans(piece_of(clock, (Metre(0, 4, 4),)), (line,), time_frame((line,), clock))["p"]


def test_a_muted_passage_is_a_state_with_its_reason() -> None:
    found = plan("trumpet_Bb", [60, 62, 64, 65, 67, 65, 64, 62], muted=((BAR, 2 * BAR),))
    (mute,) = found.mutes
    assert (mute.kind, mute.start_tick, mute.end_tick, mute.reason.id) == ("mute", BAR, 2 * BAR, "mute.mute")
    assert (mute.start_s, mute.end_s) == (2.0, 4.0)
    plain = plan("trumpet_Bb", [60, 62, 64, 65, 67, 65, 64, 62])
    assert plain.mutes == ()
    assert [event.label for event in plain.fingerings] == [event.label for event in found.fingerings]


def test_a_stopped_horn_is_fingered_a_semitone_lower_on_the_f_side() -> None:
    pitches = [60, 62, 64, 65, 72, 74]
    spans = ((2 * Q, 6 * Q),)
    found = plan("horn_double_F_Bb", pitches, muted=spans, stopped=spans)
    (mute,) = found.mutes
    assert (mute.kind, mute.reason.id) == ("stopped", "mute.stopped_right")
    horn = bundled_maps()["horn_double_F_Bb"]
    for event, pitch in list(zip(found.fingerings, pitches, strict=True))[2:]:
        sides = [one.label for one in horn.fingerings_for(pitch - 1) if "thumb_valve" not in one.controls]
        assert event.label in sides
        assert "T" not in event.label
        assert event.reason.id == "fingering.stopped"
    open_ = plan("horn_double_F_Bb", pitches)
    assert [event.label for event in open_.fingerings[:2]] == [event.label for event in found.fingerings[:2]]
    assert [event.label for event in open_.fingerings[2:]] != [event.label for event in found.fingerings[2:]]


def test_an_instrument_that_no_hand_stops_takes_a_mute() -> None:
    spans = ((0, BAR),)
    found = plan("trumpet_Bb", [60, 62, 64, 65], muted=spans, stopped=spans)
    assert [(mute.kind, mute.reason.id) for mute in found.mutes] == [("mute", "mute.no_hand")]


def test_mute_and_hand_in_turn_are_two_passages() -> None:
    found = plan("horn_F_single", [60, 62, 64, 65], muted=((0, BAR),), stopped=((2 * Q, BAR),))
    assert [(mute.kind, mute.start_tick, mute.end_tick) for mute in found.mutes] == [
        ("mute", 0, 2 * Q), ("stopped", 2 * Q, BAR)
    ]  # fmt: skip


def test_mutes_of_two_kinds_are_two_passages_and_their_reasons_name_them() -> None:
    found = plan(
        "trumpet_Bb", [60, 62, 64, 65], muted=((0, BAR),), mute_kinds=((0, "cup"), (2 * Q, "harmon"))
    )  # fmt: skip
    assert [(mute.kind, mute.start_tick, mute.end_tick, mute.reason.id) for mute in found.mutes] == [
        ("cup", 0, 2 * Q, "mute.cup"), ("harmon", 2 * Q, BAR, "mute.harmon")
    ]  # fmt: skip


def test_every_mute_has_a_name_in_both_languages() -> None:
    assert {f"mute.{name}" for name in NAMED} <= WORDINGS.keys()
