"""Places of catch breaths if no rest comes in time, compared with engraved marks, and individual reasons
for a place.
"""

from __future__ import annotations

import itertools
import random

import numpy as np
import pytest

from app.plan.breath.catch_breath_places import cheapest_chain
from app.plan.breath.lungs import FULL_BREATH_S
from app.plan.generate import MonophonicPart
from app.plan.parameters import PlayerParameters
from app.score.metre_map import Metre
from tests.support.engraved_breaths import marked_lines, share_at_phrase_ends
from tests.support.plan import PlainClock, PlainNote, line_of, make_plans, piece_of, time_frame, valves

Q = 480


def catches(notes: tuple[PlainNote, ...], lung_s: float, bpm: float = 120.0, need: float = 0.35) -> list[float]:
    """Ends of the breaths after the first one, in quarters from the start."""
    clock = PlainClock(((0, bpm),))
    line = MonophonicPart("p", notes, valves(), PlayerParameters(lung_s=lung_s, breath_need=need))
    plan = make_plans(piece_of(clock, (Metre(0, 4, 4),)), (line,), time_frame((line,), clock))["p"]
    return [event.end_tick / Q for event in plan.breaths if event.kind == "breath"][1:]


# Three of the marks that are not followed stand between a dotted note and its short one.
@pytest.mark.parametrize(("held_out", "least"), [(False, 0.77), (True, 0.74)])
def test_most_breaths_are_where_engravers_mark_them(held_out: bool, least: float) -> None:
    rows = [row for row in marked_lines() if row["held_out"] == held_out]
    assert rows
    assert share_at_phrase_ends(rows) >= least


@pytest.mark.parametrize(("dearer", "chosen"), [(0.1, 0), (0.02, 1)])
def test_a_clearer_end_is_chosen_though_air_is_left(dearer: float, chosen: int) -> None:
    """Two places in a passage of 12 s: after 5 s, and, with a higher cost, after 8 s of lungs that last 10 s."""
    at_s = np.array([0.0, 5.0, 8.0, 12.0]).tobytes()
    cost, drawn_s = np.array([3.0, 3.0 + dearer]).tobytes(), np.array([8.0, 8.0]).tobytes()
    assert cheapest_chain(at_s, at_s, cost, drawn_s, 1.0, 10.0, 3.5) == ((chosen,), True)


@pytest.mark.parametrize("after", [1, 2])
def test_a_note_is_long_by_those_before_it(after: int) -> None:
    """Bars of quarters, then a half note, then notes of any length."""
    notes, at = [], 0
    for length in (*[1] * 14, 2, *[after] * (16 // after)):
        notes.append((at * Q, length * Q, 65 + at % 2))
        at += length
    assert catches(line_of(*notes), lung_s=10.0)[0] == 16.0


def test_even_notes_are_breathed_between_in_phrases_of_four_bars() -> None:
    notes = line_of(*((beat * Q, Q, 65 + beat % 2) for beat in range(32)))
    assert catches(notes, lung_s=12.0) == [16.0]


def test_running_notes_are_breathed_between_after_the_first_of_a_bar() -> None:
    notes = line_of(*((step * Q // 2, Q // 2, 65 + step % 2) for step in range(64)))
    found = catches(notes, lung_s=14.0)
    assert found
    assert all(place % 4 == 0.5 for place in found)


def test_no_upbeat_is_left_out_for_a_breath() -> None:
    """Eighths too short for a breath; the first of each beat except the last is slurred to the second."""
    slur = (10, 0, 10, 0, 10, 0, 0, 0)
    notes = line_of(*((step * Q // 2, Q // 2 + slur[step % 8], 65 + step % 2) for step in range(256)))
    found = catches(notes, lung_s=9.0, bpm=150.0)
    assert len(found) >= 3
    assert all(place % 4 for place in found)


def test_nothing_comes_between_the_upbeat_after_a_rest_and_its_downbeat() -> None:
    """An eighth rest fills half the lungs, and the upbeat is longer than the surrounding sixteenths; it still ends no
    phrase.
    """
    runs = [(at * Q // 4, Q // 4, 65 + at % 5) for at in range(44)]
    after = [(12 * Q + at * Q // 4, Q // 4, 65 + at % 5) for at in range(48)]
    found = catches(line_of(*runs, (12 * Q - Q // 2, Q // 2, 72), *after), lung_s=7.0)
    assert len(found) == 2
    assert found[0] == 11.5
    assert found[1] != 12.0


@pytest.mark.parametrize("seed", range(3))
def test_a_played_line_is_breathed_in_where_the_written_one_is(seed: int) -> None:
    by_chance = random.Random(seed)
    lengths = [1, 1, 0.5, 0.5, 1, 1.5, 0.5, 1, 1] * 8
    onsets = [round(sum(lengths[:place]) * Q) for place in range(len(lengths))]
    written = [
        (onset, round(length * Q), 65 + place % 3)
        for place, (onset, length) in enumerate(zip(onsets, lengths, strict=True))
    ]
    # Up to 15 ms early or late, and ends 30 to 60 ms before the next note should begin.
    played = [
        (
            max(onset + round(by_chance.uniform(-0.015, 0.015) * 2 * Q), 0),
            length - round(by_chance.uniform(0.03, 0.06) * 2 * Q),
            pitch,
        )
        for onset, length, pitch in written
    ]
    expected, found = (breathed_before(line_of(*notes)) for notes in (written, played))
    assert len(expected) >= 3
    assert found == expected


def test_a_line_that_overlaps_throughout_is_breathed_in_where_a_detached_one_is() -> None:
    """Legato as on a wind controller or keyboard, where only repeated notes do not overlap."""
    lengths = [1, 1, 0.5, 0.5, 1, 1.5, 0.5, 1, 1] * 8
    onsets = [round(sum(lengths[:place]) * Q) for place in range(len(lengths))]
    rows = list(zip(onsets, (round(length * Q) for length in lengths), strict=True))
    pitches = [65 + place // 2 % 3 for place in range(len(rows))]
    repeated = [after == pitch for pitch, after in zip(pitches, [*pitches[1:], 0], strict=True)]
    detached = [(onset, length, pitch) for (onset, length), pitch in zip(rows, pitches, strict=True)]
    legato = [
        (onset, length - 5 if same else length + 30, pitch)
        for (onset, length, pitch), same in zip(detached, repeated, strict=True)
    ]
    expected, found = (breathed_before(line_of(*notes)) for notes in (detached, legato))
    assert len(expected) >= 3
    assert found == expected


def test_a_breath_between_long_notes_takes_more_than_the_gap_of_an_early_release() -> None:
    """Notes of two seconds that end 130 ms early: longer than a gasp, but no rest."""
    notes = line_of(*((4 * place * Q, round(3.74 * Q), 65 + place % 2) for place in range(8)))
    clock = PlainClock()
    line = MonophonicPart("p", notes, valves(), PlayerParameters(lung_s=7.0))
    plan = make_plans(piece_of(clock, (Metre(0, 4, 4),)), (line,), time_frame((line,), clock))["p"]
    caught = [event for event in plan.breaths if event.reason.id == "breath.catch"]
    assert caught
    assert all(event.end_s - event.start_s == pytest.approx(FULL_BREATH_S) for event in caught)


@pytest.mark.parametrize("seed", range(4))
def test_no_breath_parts_a_dotted_note_from_its_short_one(seed: int) -> None:
    """Dotted quarters with eighths, some before a bar line, among quarters, in a file without slurs."""
    by_chance = random.Random(seed)
    lengths: list[float] = []
    while sum(lengths) < 96:
        lengths += by_chance.choice(([1.5, 0.5], [1, 1], [1.5, 0.5, 1, 1]))
    places = [sum(lengths[:index]) for index in range(len(lengths))]
    pitches = [65 + index % 4 for index in range(len(lengths))]
    rows = zip(places, lengths, pitches, strict=True)
    found = catches(line_of(*((round(at * Q), round(length * Q), pitch) for at, length, pitch in rows)), lung_s=9.0)
    assert len(found) >= 4
    assert all(lengths[places.index(place)] != 0.5 for place in found)


def test_a_song_for_horn_is_breathed_in_near_its_engraved_marks() -> None:
    """Nielsen, Canto serioso, bars 3 to 9: marks at 15, 23 and 30.5, dotted notes before 13.5, 17.5 and 27.5."""
    rows = [(8, 3, 41), (11, 1, 43), (12, 1.5, 46), (13.5, 0.5, 50), (14, 1, 53), (15, 1, 55), (16, 1.5, 53),
            (17.5, 0.5, 50), (18, 1, 46), (19, 1, 48), (20, 1, 50), (21, 2, 53), (23, 1, 51), (24, 1, 50), (25, 1, 46),
            (26, 1.5, 41), (27.5, 0.5, 43), (28, 2.5, 38), (30.5, 0.5, 37), (31, 0.5, 36), (31.5, 0.5, 35),
            (32, 4, 41)]  # fmt: skip
    notes = line_of(*((round(at * Q), round(length * Q), pitch) for at, length, pitch in rows))
    found = catches(notes, lung_s=11.0, bpm=60.0)
    assert len(found) == 3
    assert all(abs(place - mark) <= 1.0 for place, mark in zip(found, (15, 23, 30.5), strict=True))


SONG = ((5, 1), (4, 1), (3, 1), (4, 1), (5, 1), (5, 1), (5, 2), (4, 1), (4, 1), (4, 2), (5, 1), (7, 1), (7, 2),
        (5, 1), (4, 1), (3, 1), (4, 1), *[(5, 1)] * 4, (4, 1), (4, 1), (5, 1), (4, 1), (3, 4))  # fmt: skip
""""Mary had a little lamb" as steps and quarters: four bars, and four bars with the same beginning."""


def sung(times: int) -> tuple[PlainNote, ...]:
    rows, at = [], 0
    for step, quarters in SONG * times:
        rows.append((at * Q, quarters * Q, 60 + (0, 2, 4, 5, 7, 9, 11)[step - 3]))
        at += quarters
    return line_of(*rows)


def test_a_phrase_end_is_breathed_at_while_there_is_air() -> None:
    """The song lasts 16 s, the lungs 20 s."""
    assert catches(sung(1), lung_s=20.0) == [16.0]
    assert catches(sung(1), lung_s=20.0, need=1.0) == []
    assert catches(sung(1), lung_s=20.0, need=0.0) == []


def test_what_is_nearly_over_is_not_breathed_in_for_a_phrase_end() -> None:
    assert catches(sung(1), lung_s=60.0) == []


@pytest.mark.parametrize("lung_s", [6.0, 9.0, 14.0])
def test_a_song_is_breathed_in_at_its_phrase_ends(lung_s: float) -> None:
    """Lines of the text have four bars, half lines two."""
    found = catches(sung(4), lung_s)
    assert len(found) >= 7
    assert all(place % 8 == 0 for place in found)


@pytest.mark.parametrize("seed", range(6))
def test_no_breath_is_taken_among_staccato_notes(seed: int) -> None:
    """Rows of 4 to 12 staccato notes of one or two lengths, between held notes."""
    by_chance = random.Random(seed)
    rows: list[tuple[int, int, int]] = []
    within: set[float] = set()
    at = 0.0
    while at < 160:
        for length in by_chance.choice(([1, 1, 2], [2, 2], [1.5, 0.5, 2], [1, 1, 1, 1])):
            rows.append((round(at * Q), round(length * Q), 65 + by_chance.randrange(8)))
            at += length
        figure = by_chance.choice(([0.5], [1], [0.5, 0.25, 0.25], [0.5, 0.5, 1]))
        first = at
        for place in range(by_chance.randrange(4, 13)):
            length = figure[place % len(figure)]
            rows.append((round(at * Q), round(length * Q * 0.5), 65 + by_chance.randrange(8)))
            within |= {at} - {first}
            at += length
    found = catches(line_of(*rows), lung_s=9.0, bpm=110.0)
    assert len(found) >= 8
    assert not within & set(found)


@pytest.mark.parametrize("seed", range(5))
def test_no_breath_follows_another_within_a_second_of_playing(seed: int) -> None:
    """Loud fast and long notes with small lungs, and silences too short for a breath."""
    by_chance = random.Random(seed)
    rows: list[tuple[int, int, int, int]] = []
    at = 0.0
    while at < 240:
        length = by_chance.choice((0.25, 0.25, 0.5, 0.5, 1, 1.5, 3))
        rows.append((round(at * Q), round(length * Q), 65 + by_chance.randrange(9), by_chance.choice((60, 90, 115))))
        at += length + by_chance.choice((0, 0, 0, 0, 0, 0.12, 0.25))
    sounded_s, before_s = {}, 0.0
    for onset, length_ticks, *_ in rows:
        sounded_s[onset / Q] = before_s
        before_s += length_ticks / Q * 0.5
    found = catches(line_of(*rows), lung_s=5.0)
    assert len(found) >= 20
    assert all(sounded_s[after] - sounded_s[first] >= 1.0 for first, after in itertools.pairwise([0.0, *found]))


def breathed_before(notes: tuple[PlainNote, ...]) -> list[int]:
    """Positions of the notes after catch breaths."""
    ends = {note.onset_tick / Q: place for place, note in enumerate(notes)}
    return [ends[tick] for tick in catches(notes, lung_s=7.0)]
