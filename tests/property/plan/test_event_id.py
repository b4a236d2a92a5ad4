"""Ids of events are composed from parts to a text, and parsed back."""

from __future__ import annotations

import hypothesis.strategies as st
import msgspec
import pytest
from hypothesis import given

from app.plan.by_hand.additive_curve import AdditiveCurve, CurveKey
from app.plan.by_hand.corrections import (
    AddExpression,
    AddGesture,
    Correction,
    PinFingering,
    PlayStyle,
    PoseCorrection,
    RemoveEvent,
    SetBreath,
    SetCue,
    SetEmbouchure,
    Vary,
)
from app.plan.event_id import EventId
from app.plan.kinds import BREATH_KINDS, GESTURE_KINDS

KINDS = st.sampled_from([*BREATH_KINDS, *GESTURE_KINDS, "cue", "expression", "pose", "fingering"])
PLACES = st.from_regex(r"([a-z_]+:)?([nft0-9]{1,3}:[0-9]{1,4}|@-?[0-9]{1,6}|own-[0-9]{1,3})", fullmatch=True)


@given(st.builds(EventId, KINDS, PLACES, st.integers(1, 99)))
def test_parts_and_text_are_the_same(id: EventId) -> None:
    assert EventId.parse(str(id)) == id
    assert str(EventId.parse(str(id))) == str(id)


@given(st.text(max_size=40))
def test_any_text_has_parts(text: str) -> None:
    kind, of, _ = EventId.parse(text)
    assert text.startswith(kind)
    assert text.endswith(of)
    assert ":" not in kind


def test_a_digit_more_than_numbers_have_is_no_number() -> None:
    assert EventId.parse(f"within.{'9' * 5000}:1:5") == ("within", "1:5", 1)


def test_places_are_what_each_colon_leaves() -> None:
    assert list(EventId.parse("expression:rule:strained:1:5").places) == [
        "rule:strained:1:5",
        "strained:1:5",
        "1:5",
        "5",
    ]
    assert list(EventId.parse("bow:end").places) == ["end"]


@pytest.mark.parametrize(
    ("correction", "id", "stored"),
    [
        (PinFingering("1:5", "0"), "fingering:1:5", '{"correction":"pin_fingering","note_id":"1:5","label":"0"}'),
        (
            RemoveEvent("breath:1:5", "1:5"),
            "breath:1:5",
            '{"correction":"remove","event_id":"breath:1:5","note_id":"1:5"}',
        ),
        (
            SetBreath("1:5", -9, kind="within", number=2),
            "within.2:1:5",
            '{"correction":"set_breath","note_id":"1:5","start_offset_tick":-9,"end_offset_tick":0,"depth":1.0,'
            '"kind":"within","added":false,"moved_from":null,"number":2}',
        ),
        (
            SetCue("@480", 2.0),
            "cue:@480",
            '{"correction":"set_cue","note_id":"@480","beats":2.0,"added":false,"moved_from":null,"takers":null}',
        ),
        (
            SetEmbouchure("1:5", 0.5),
            "embouchure:1:5",
            '{"correction":"set_embouchure","note_id":"1:5","tension":0.5,"effort":null,"air":null}',
        ),
        (
            AddGesture("own-1", "sway", 0, 9, 0.5),
            "sway:own-1",
            '{"correction":"add_gesture","name":"own-1","kind":"sway","start_tick":0,"end_tick":9,"amount":0.5,'
            '"gesture":""}',
        ),
        (
            AddExpression("own-1", "smile", 0, 9),
            "expression:own-1",
            '{"correction":"add_expression","name":"own-1","expression":"smile","start_tick":0,"end_tick":9,'
            '"strength":1.0,"fade_in_s":0.2,"fade_out_s":0.3}',
        ),
        (
            PoseCorrection("own-1", "bell", 0, 9),
            "pose:own-1",
            '{"correction":"pose","name":"own-1","target":"bell","start_tick":0,"end_tick":9,"up_deg":0.0,'
            '"left_deg":0.0,"roll_deg":0.0,"fade_in_ticks":0,"fade_out_ticks":0}',
        ),
        (
            AdditiveCurve("c", "head_up", (CurveKey(0, 1.0),)),
            "additive:c",
            '{"correction":"additive","name":"c","channel":"head_up","keys":[{"tick":0,"value":1.0,'
            '"interpolation":"bezier","arrive":null,"leave":null}],"blend_in_ticks":0,"blend_out_ticks":0,'
            '"weight":1.0,"enabled":true,"title":""}',
        ),
        (Vary("v", 0, 9, 3), "vary:v", '{"correction":"vary","name":"v","start_tick":0,"end_tick":9,"seed":3}'),
        (
            PlayStyle("own-1", "soloist", 0, 9),
            "style:own-1",
            '{"correction":"play_style","name":"own-1","style":"soloist","start_tick":0,"end_tick":9,'
            '"fade_in_ticks":0,"fade_out_ticks":0}',
        ),
    ],
)
def test_a_correction_names_its_event_and_is_stored_as_ever(correction: Correction, id: str, stored: str) -> None:
    assert correction.about == id
    assert msgspec.json.encode(correction).decode() == stored
    assert msgspec.json.decode(stored, type=Correction) == correction
