"""Choices by players of each family, determined by hand: alternating little fingers, forked F, trill keys, thumb."""

from __future__ import annotations

import pytest

from app.plan.fingering.fingerings import plan_fingerings
from app.plan.generate import MonophonicPart
from app.plan.music.piece import line_times
from instrument_maps.load import bundled_maps
from instrument_maps.model import InstrumentMap
from tests.support.plan import PlainClock, line_of
from tests.support.woodwinds import clarinet, double_horn, oboe, saxophone

SLOW, EASY, FAST = 960, 240, 120
"""Length of a note in ticks: a second, a quarter and an eighth of a second."""


def keys(
    pitches: list[int], instrument: InstrumentMap, step_tick: int = EASY, bpm: float = 120.0, sounds: float = 1.0
) -> list[frozenset[str]]:
    """Controls held on each note of an even line whose notes sound for a share of their step."""
    notes = line_of(*((at * step_tick, round(sounds * step_tick), pitch) for at, pitch in enumerate(pitches)))
    times = line_times(MonophonicPart("p", notes, instrument), PlainClock(((0, bpm),)))
    return [frozenset(event.controls) for event in plan_fingerings(notes, times, instrument, {})[0]]


def little(held: list[frozenset[str]]) -> list[str]:
    """Keys of the little fingers of a clarinet, note by note."""
    return [" ".join(sorted(keys & {"LE", "LF", "LFs", "RE", "RF", "RFs", "RGs"})) for keys in held]


@pytest.mark.parametrize(
    ("pitches", "expected"),
    [
        # B, C sharp, D sharp: D sharp is on the right only, so C sharp is left, so B is right.
        ([71, 73, 75], ["RE", "LFs", "RGs"]),
        # C, E flat: E flat is on the right, so C is left, although right is its first choice.
        ([72, 75, 72], ["LF", "RGs", "LF"]),
        # E, F, F sharp, G, G sharp: left, right, left, none, right.
        ([52, 53, 54, 55, 56], ["LE", "RF", "LFs", "", "RGs"]),
        ([71, 72, 73, 74, 75], ["LE", "RF", "LFs", "", "RGs"]),
    ],
)
@pytest.mark.parametrize("step_tick", [FAST, EASY, SLOW])
def test_the_clarinets_little_fingers_take_turns_at_any_tempo(
    pitches: list[int], expected: list[str], step_tick: int
) -> None:
    assert little(keys(pitches, clarinet(), step_tick)) == expected


def test_detached_notes_leave_the_little_finger_free() -> None:
    assert little(keys([72, 75, 72], clarinet(), SLOW, sounds=0.5)) == ["RF", "RGs", "RF"]


def test_a_throat_note_keeps_the_right_hand_down_only_in_a_hurry_over_the_break() -> None:
    right = {"R1", "R2", "R3"}
    assert not keys([69, 71], clarinet(), SLOW)[0] & right
    assert keys([69, 71, 69, 71], clarinet(), FAST, bpm=150.0)[0] >= right
    # Below the break there is nothing to gain.
    assert not keys([67, 69, 67, 69], clarinet(), FAST, bpm=150.0)[1] & right


def test_a_trill_key_is_for_trills() -> None:
    assert all("sl" in held for held in keys([58, 59] * 4, clarinet(), FAST)[1::2])
    assert not any("sl" in held for held in keys([58, 59] * 4, clarinet(), SLOW))
    assert not any("sl" in held for held in keys([57, 58, 59, 60, 62], clarinet(), FAST))
    assert "sF" in keys([65, 66] * 4, saxophone(), FAST)[3]


def test_the_oboes_ring_finger_never_goes_from_its_hole_to_the_f_key() -> None:
    oboes = oboe()
    for before in (62, 63, 60):
        for step_tick in (FAST, EASY, SLOW):
            for line in ([before, 65], [65, before], [before, 65, before]):
                for held, following in zip(
                    keys(line, oboes, step_tick), keys(line, oboes, step_tick)[1:], strict=False
                ):
                    assert not ("R3" in held and "F" in following)
                    assert not ("F" in held and "R3" in following)
    assert keys([62, 65, 62], oboes)[1] >= {"LF"}
    # If the left little finger is needed immediately for A flat, F is forked.
    assert keys([62, 65, 68], oboes)[1] == {"L1", "L2", "L3", "R1", "R3"}
    # Between E and G nothing is in its way.
    assert keys([64, 65, 67], oboes)[1] >= {"F"}


def test_the_bundled_oboe_has_its_three_f_where_players_take_them() -> None:
    bundled = bundled_maps()["oboe"]
    labels = {control.name: control.label for control in bundled.controls}

    def signs(pitches: list[int]) -> list[set[str]]:
        return [{labels[name] for name in held} for held in keys(pitches, bundled)]

    assert "Lp_f" in signs([62, 65, 62])[1]
    assert "Lp_f" in signs([63, 65, 63])[1]
    assert "Rr_f" in signs([64, 65, 67])[1]
    forked = signs([62, 65, 68])[1]
    assert "R3" in forked
    assert not forked & {"Lp_f", "Rr_f"}
    # From C to E flat one little finger cannot do both: the left hand has the key too.
    assert "Lp_ees" in signs([60, 63, 60])[1]
    # An octave higher from C sharp likewise.
    assert "Lp_ees" in signs([73, 75, 73])[1]


@pytest.mark.parametrize("step_tick", [FAST, EASY])
def test_the_bundled_oboe_plays_a_repeated_f_so_that_d_can_follow(step_tick: int) -> None:
    bundled = bundled_maps()["oboe"]
    left_f, plate = "key_F_left", "plate_R3"
    for pitches in ([64, 65, 65, 62], [76, 77, 77, 74]):
        held = keys(pitches, bundled, step_tick)
        assert left_f in held[2]
        assert plate in held[3]


def test_the_saxophones_b_flat_depends_on_where_it_comes_from() -> None:
    saxophones = saxophone()
    # The chromatic scale takes the side key: with bis the index would roll off.
    assert keys([69, 70, 71], saxophones)[1] == {"L1", "L2", "sB"}
    # From F and back the right index stays where it is: one and one.
    assert keys([65, 70, 65], saxophones)[1] == {"L1", "R1"}


def test_the_saxophones_high_f_is_at_the_front_by_leaps_and_on_the_palm_in_scales() -> None:
    assert keys([84, 88, 84], saxophone(), FAST)[1] >= {"f"}
    assert keys([86, 87, 88, 87, 86], saxophone())[2] >= {"pD", "pE", "pF"}


def test_the_bundled_double_horn_stays_on_one_side_in_fast_passages() -> None:
    horn = bundled_maps()["horn_double_F_Bb"]
    up = horn.transposition_semitones

    def thumb(written: list[int], step_tick: int, bpm: float) -> list[bool]:
        return ["thumb_valve" in held for held in keys([pitch - up for pitch in written], horn, step_tick, bpm)]

    assert thumb([60, 62, 64, 65, 67, 69, 71, 72, 74], EASY, 120.0) == [False] * 5 + [True] * 4
    assert not any(thumb([65, 67, 69, 67, 65, 67, 69, 67], FAST, 130.0))
    assert thumb([65, 67, 69, 67, 65], 480, 80.0) == [False, False, True, False, False]


def test_the_double_horns_thumb_changes_sides_once_in_a_scale_and_not_to_and_fro() -> None:
    horn = double_horn()
    scale = ["T" in held for held in keys([60, 62, 64, 65, 67, 69, 71, 72], horn)]
    assert scale == [False] * 5 + [True] * 3
    fast = [65, 67, 69, 67, 65, 67, 69, 67]
    assert not any("T" in held for held in keys(fast, horn, FAST, bpm=130.0))
    slow = ["T" in held for held in keys([65, 67, 69, 67, 65], horn, 480, bpm=80.0)]
    assert slow == [False, False, True, False, False]
