"""Content of a take, and the notes that were intended."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.errors import AppError
from app.score.beats_of_free_playing import find_beats, tempo_of_beats
from app.score.clean import cleaned, highest
from app.score.take import Cleaning, Controlled, ControllerMapping, is_message
from tests.support.takes import PlayedNote, take_of

RAW = Cleaning(ghost_s=0.0, double_s=0.0, overlap_s=0.2)


def test_notes_and_breath_are_what_was_sent() -> None:
    played = take_of([(0.5, 1.0, 60, 0.5), (1.0, 1.5, 62, 1.0)]).played
    assert played.onsets_s.tolist() == [0.5, 1.0]
    assert played.ends_s.tolist() == [1.0, 1.5]
    assert played.pitches.tolist() == [60, 62]
    breath = played.curves["breath"]
    assert breath.at(np.array([0.0, 0.6, 1.2, 1.6])).tolist() == pytest.approx([0.0, 64 / 127, 1.0, 0.0])


def test_a_note_that_is_held_at_the_end_ends_with_the_take() -> None:
    take = take_of([], more=[(1.0, "903c40")], end_s=3.0)
    assert (take.played.onsets_s.tolist(), take.played.ends_s.tolist()) == ([1.0], [3.0])


def test_velocity_0_and_all_notes_off_end_notes() -> None:
    take = take_of([], more=[(1.0, "903c40"), (2.0, "903c00"), (3.0, "903e40"), (4.0, "b07b00")], end_s=9.0)
    assert take.played.ends_s.tolist() == [2.0, 4.0]


def test_only_the_wired_channel_is_received() -> None:
    more = [(0.0, "903c40"), (1.0, "803c00"), (1.0, "923e40"), (2.0, "823e00")]
    assert take_of([], more=more, mapping=ControllerMapping(channel=3)).played.pitches.tolist() == [62]
    assert take_of([], more=more).played.pitches.tolist() == [60, 62]


def test_breath_and_bite_are_what_the_wiring_says() -> None:
    more = [(0.0, "d040"), (0.0, "e00060"), (0.0, "b00110")]
    take = take_of([], more=more, mapping=ControllerMapping(breath="channel_pressure", bite="cc1"))
    values = {kind: curve.values.tolist() for kind, curve in take.played.curves.items()}
    assert values == {"breath": [64 / 127], "pitch_bend": [0.5], "bite": [16 / 127]}
    bent = take_of([], more=more, mapping=ControllerMapping(bite="pitch_bend")).played.curves
    assert bent["bite"].values.tolist() == bent["pitch_bend"].values.tolist() == [0.5]


def test_a_take_is_bent_by_the_range_that_its_controller_sets() -> None:
    messages = ("b06500", "b06400", "b0060c", "e00060", "e10060")
    more = [(0.1 * place, message) for place, message in enumerate(messages)]
    assert take_of([], more=more).played.curves["pitch_bend"].values.tolist() == [3.0, 0.5]


def test_what_is_no_message_is_known() -> None:
    assert is_message("903c40")
    assert not any(map(is_message, ("", "90", "903c", "zz", "903cff", "f7", "40", "903c4000")))


@given(st.lists(st.binary(min_size=0, max_size=4).map(bytes.hex), max_size=30))
def test_any_bytes_are_read_without_a_fault(messages: list[str]) -> None:
    take = take_of([], more=[(float(index), raw) for index, raw in enumerate(messages)], end_s=40.0)
    played = take.played
    assert (played.ends_s >= played.onsets_s).all()
    cleaned(take)


# Cleaning


def faults(notes: list[PlayedNote], cleaning: Cleaning | None = None, **more: bool) -> tuple[str, ...]:
    return cleaned(take_of(notes, cleaning=cleaning, **more)).faults


def test_a_short_soft_note_is_a_ghost_and_a_short_loud_one_is_not() -> None:
    assert faults([(0.0, 1.0, 60, 0.6), (1.5, 1.52, 64, 0.1), (2.0, 2.02, 64, 0.6)]) == ("", "ghost", "")
    assert faults([(0.0, 1.0, 60, 0.6), (1.5, 1.52, 64, 0.1)], RAW) == ("", "")


def test_a_note_without_breath_is_silent() -> None:
    assert faults([(0.0, 1.0, 60, 0.6), (1.5, 2.5, 64, 0.03)]) == ("", "silent")
    # A keyboard has no breath.
    assert faults([(0.0, 1.0, 60, 0.6), (1.5, 2.5, 64, 0.0)], breathes=False) == ("", "")


def test_a_finger_that_was_late_leaves_no_note_and_no_gap() -> None:
    take = take_of([(0.0, 1.0, 60, 0.6), (1.0, 1.02, 61, 0.6), (1.02, 2.0, 62, 0.6)])
    clean = cleaned(take)
    assert clean.faults == ("", "slip", "")
    assert clean.ends_s[0] == pytest.approx(1.02)


def test_a_key_that_springs_back_strikes_once_and_a_tongue_twice() -> None:
    clean = cleaned(take_of([(0.0, 0.02, 60, 0.6), (0.03, 1.0, 60, 0.6), (1.1, 1.3, 60, 0.6), (1.35, 1.5, 60, 0.6)]))
    assert clean.faults == ("", "double", "", "")
    assert clean.ends_s[0] == pytest.approx(1.0)


def test_legato_notes_overlap_a_little_and_no_more() -> None:
    clean = cleaned(take_of([(0.0, 1.2, 60, 0.6), (1.0, 2.0, 62, 0.6)]))
    assert clean.ends_s.tolist() == pytest.approx([1.02, 2.0])
    assert cleaned(take_of([(0.0, 0.9, 60, 0.6), (1.0, 2.0, 62, 0.6)])).ends_s[0] == pytest.approx(0.9)


notes_played = st.lists(
    st.tuples(st.floats(0, 20), st.floats(0.001, 2), st.integers(50, 80), st.floats(0, 1)).map(
        lambda note: (note[0], note[0] + note[1], note[2], note[3])
    ),
    max_size=25,
    unique_by=lambda note: (round(note[0], 2), note[2]),
)


@given(notes_played)
def test_what_stays_follows_one_another_and_nothing_is_invented(notes: list[PlayedNote]) -> None:
    take = take_of(notes)
    clean = cleaned(take)
    kept = clean.kept
    assert len(clean.faults) == len(take.played)
    onsets, ends = clean.onsets_s[kept], clean.ends_s[kept]
    assert (ends >= onsets).all()
    assert (ends[:-1] <= onsets[1:] + take.cleaning.overlap_s + 1e-9).all()
    assert set(onsets.tolist()) <= set(take.played.onsets_s.tolist())
    raw = cleaned(take_of(notes, cleaning=RAW))
    assert not any(raw.faults)


@given(
    st.lists(st.tuples(st.floats(0, 10), st.floats(0, 1)), min_size=1, max_size=20, unique_by=lambda step: step[0]),
    st.lists(st.tuples(st.floats(-1, 11), st.floats(0, 3)), max_size=8),
)
def test_the_highest_value_is_what_a_slow_search_finds(
    steps: list[tuple[float, float]], spans: list[tuple[float, float]]
) -> None:
    steps.sort()
    curve = Controlled(np.array([time for time, _ in steps]), np.array([value for _, value in steps]))
    found = highest(curve, np.array([at for at, _ in spans]), np.array([at + length for at, length in spans]))
    for (at, length), value in zip(spans, found.tolist(), strict=True):
        held = [step for time, step in steps if time <= at][-1:]
        assert value == max(
            [0.0, *held, *(step for time, step in steps if at <= time <= at + length)][1 if held else 0 :]
        )


# Beats


def test_the_beats_of_a_player_who_slows_down_are_found() -> None:
    rng = np.random.default_rng(3)
    beats = np.cumsum(np.concatenate([[1.3], np.linspace(0.5, 0.62, 40)]))
    halves = (beats[:-1] + np.diff(beats) / 2)[::3]
    onsets = np.sort(np.concatenate([beats, halves]) + rng.normal(0.0, 0.008, len(beats) + len(halves)))
    ends = np.append(onsets[1:], onsets[-1] + 1.0)
    found = find_beats(onsets, ends)
    inner = beats[2:-2]
    nearest = np.abs(found[:, None] - inner).min(axis=0)
    assert len(found) == len(beats)
    assert np.median(nearest) < 0.015
    assert nearest.max() < 0.06
    tempo = tempo_of_beats(found, 480)
    placed = tempo.ticks(inner - found[0]) / 480
    assert np.abs(placed - np.rint(placed)).max() < 0.12


def test_too_few_notes_have_no_beat() -> None:
    with pytest.raises(AppError) as caught:
        find_beats(np.arange(3.0), np.arange(3.0) + 0.5)
    assert caught.value.message.id == "take.too_few_notes"
