"""The head's share of a glance: larger only while the instrument is lowered."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from app.errors import Message
from app.plan.faces.glances import FREE_HEAD, PLAYING_HEAD, glances_of
from app.plan.model import GestureEvent
from app.plan.music.piece import Seeds

TENTHS = st.integers(0, 400)


def gesture(kind: str, start: int, length: int) -> GestureEvent:
    start_s, end_s = start / 10.0, (start + length) / 10.0
    return GestureEvent(f"{kind}:{start}", kind, start, start + length, start_s, end_s, 1.0, Message("gesture.lean"))


@given(lowered=st.lists(st.tuples(TENTHS, st.integers(1, 100)), max_size=8), look=TENTHS, length=st.integers(20, 40))
def test_the_head_is_free_half_a_second_within_a_lowered_instrument(
    lowered: list[tuple[int, int]], look: int, length: int
) -> None:
    gestures = [gesture("look_about", look, length), *(gesture("lower_instrument", *span) for span in lowered)]
    spans = [(event.start_s, event.end_s) for event in gestures[1:]]
    glances = glances_of("p", (), gestures, {}, Seeds(("p",)))
    assert len(glances) == 2
    for glance in glances:
        # Lowered for longer by less than a rounding error is either.
        either = [
            any(
                start_s + 0.5 <= glance.start_s + by_s and glance.end_s <= end_s - 0.5 + by_s
                for start_s, end_s in spans
            )
            for by_s in (-1e-9, 1e-9)
        ]
        assert glance.head_share in {FREE_HEAD if inside else PLAYING_HEAD for inside in either}
