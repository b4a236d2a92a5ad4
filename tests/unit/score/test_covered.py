"""Notes that overlap others, counted in one pass, compared with counting all pairs."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from app.score.channel_notes import ChannelNotes, covered

NOTES = st.lists(st.tuples(st.integers(0, 30), st.integers(0, 20), st.integers(60, 64)), max_size=40)


@given(NOTES)
def test_each_note_is_compared_with_the_latest_end_of_another_pitch(drawn: list[tuple[int, int, int]]) -> None:
    rows = sorted(drawn)
    onsets, ends = [onset for onset, _, _ in rows], [onset + lasts for onset, lasts, _ in rows]
    pitches = [pitch for _, _, pitch in rows]
    notes = ChannelNotes()
    notes.onset_ticks.extend(onsets)
    notes.pitches.extend(pitches)
    swallowed = together = 0
    for at, (onset, end) in enumerate(zip(onsets, ends, strict=True)):
        others = [ends[before] for before in range(at) if pitches[before] != pitches[at]]
        latest = max(others, default=onset)
        swallowed += latest >= end
        together += max(min(latest, end) - onset, 0)
    assert covered(notes, ends) == (swallowed, together)
