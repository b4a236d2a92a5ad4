"""Takes of wind controllers: faults inserted into a clean melody are removed, and the music is kept."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from app.score.clean import clean_notes
from app.score.take import Cleaning, Controlled, Played

Rows = list[tuple[float, float, int, int]]
"""Onset and end in seconds, pitch, velocity."""
BLOWN, SAMPLED_S = 0.63, 0.01


def played(rows: Rows, dips: Sequence[float] = (), breath: bool = True, noise: float = 0.02) -> Played:
    """Notes with a breath from the first note of each legato to its last, which falls at the ``dips``."""
    rows = sorted(rows)
    curves = {}
    if breath:
        times = np.arange(-0.2, max(end for _, end, _, _ in rows) + 0.5, SAMPLED_S)
        values = np.zeros(len(times))
        for onset, end, _, velocity in rows:
            if velocity > 1:
                values[(times >= onset - 0.03) & (times <= end + 0.03)] = BLOWN
        for at in dips:
            values[np.abs(times - at) < 0.025] = 0.02
        values = np.where(values > 0.1, values + noise * np.sin(37.0 * times), np.abs(0.03 * np.sin(11.0 * times)))
        curves = {"breath": Controlled(times, values)}
    columns = np.array(rows, float).reshape(-1, 4)
    return Played(columns[:, 0], columns[:, 1], columns[:, 2].astype(int), columns[:, 3].astype(int), curves)


def cleaned_rows(notes: Played) -> list[tuple[float, int]]:
    found = clean_notes(notes, Cleaning())
    return [(round(float(found.onsets_s[index]), 3), int(found.pitches[index])) for index in found.kept]


def melody(pitches: list[int], lasts_s: float = 0.3, overlap_s: float = 0.008) -> Rows:
    """Legato melody; repeated notes are tongued, 80 ms apart."""
    rows: Rows = []
    for place, pitch in enumerate(pitches):
        repeated = place + 1 < len(pitches) and pitches[place + 1] == pitch
        rows.append((place * lasts_s, (place + 1) * lasts_s + (-0.08 if repeated else overlap_s), pitch, 90))
    return rows


def dips_of(rows: Rows) -> list[float]:
    return [one[1] + 0.04 for one, other in pairwise(rows) if one[2] == other[2]]


def expected(rows: Rows) -> list[tuple[float, int]]:
    return [(round(onset, 3), pitch) for onset, _, pitch, _ in rows]


PITCHES = st.lists(st.sampled_from([60, 62, 64, 65, 67, 69, 70, 71]), min_size=5, max_size=10)


@given(pitches=PITCHES, lasts_s=st.sampled_from([0.18, 0.3, 0.55]))
def test_a_clean_melody_stays(pitches: list[int], lasts_s: float) -> None:
    rows = melody(pitches, lasts_s)
    assert cleaned_rows(played(rows, dips_of(rows))) == expected(rows)


@given(
    pitches=PITCHES,
    at=st.integers(1, 3),
    kind=st.sampled_from(["octave", "late octave", "two octaves", "finger", "split", "retrigger", "flash", "flicker"]),
    fault_s=st.sampled_from([0.022, 0.035, 0.045]),
)
def test_a_fault_is_taken_out_again(pitches: list[int], at: int, kind: str, fault_s: float) -> None:
    rows = melody(pitches, 0.4)
    assume(pitches[at] != pitches[at - 1])
    dips, wrong = dips_of(rows), list(rows)
    onset, end, pitch, _ = rows[at]
    middle = onset + 0.2
    if kind in ("octave", "late octave", "two octaves"):
        off = {"octave": 12, "late octave": -12, "two octaves": 24}[kind]
        slip_s = 2.0 * fault_s
        wrong[at : at + 1] = [(onset, onset + slip_s + 0.004, pitch + off, 90), (onset + slip_s, end, pitch, 90)]
    elif kind == "finger":
        # A key that closed late: the note before sounds on, a fifth off.
        before = rows[at - 1]
        wrong[at - 1] = (before[0], onset - fault_s + 0.004, before[2], 90)
        wrong.insert(at, (onset - fault_s, onset + 0.004, pitch - 7 if pitch - 7 != before[2] else pitch - 6, 90))
    elif kind == "split":
        wrong[at : at + 1] = [(onset, middle, pitch, 90), (middle, end, pitch, 90)]
    elif kind == "retrigger":
        wrong[at : at + 1] = [(onset, middle, pitch, 90), (middle + fault_s, end, pitch, 90)]
    elif kind == "flash":
        flash_s = onset + 0.03
        before = rows[at - 1][2]
        wrong[at : at + 1] = [
            (onset, flash_s + 0.002, pitch, 90),
            (flash_s, flash_s + fault_s + 0.002, before, 90),
            (flash_s + fault_s, end, pitch, 90),
        ]
    else:
        last = max(one[1] for one in rows)
        wrong += [(last + 0.1, last + 0.2, 60, 1), (last + 0.25, last + 0.27, 60, 1)]
    found = cleaned_rows(played(wrong, dips))
    assert [note for _, note in found] == pitches
    late_s = [abs(one[0] - other[0]) for one, other in zip(found, rows, strict=True)]
    assert max(late_s) <= 0.08 if kind == "flash" else max(late_s) <= 0.001


MUSIC: dict[str, Rows] = {
    "a grace note": [(0.0, 0.5, 60, 90), (0.5, 0.56, 64, 90), (0.556, 1.0, 62, 90), (1.0, 1.4, 60, 90)],
    "a mordent": [(0, 0.07, 72, 90), (0.07, 0.14, 74, 90), (0.138, 0.6, 72, 90), (0.6, 1.0, 71, 90)],
    "a trill": [(0.07 * n, 0.07 * n + 0.074, 72 + 2 * (n % 2), 90) for n in range(12)],
    "a very fast trill": [(0.048 * n, 0.048 * n + 0.05, 72 + 2 * (n % 2), 90) for n in range(12)],
    "octaves in tempo": [(0.1 * n, 0.1 * n + 0.104, 60 + n // 2 + 12 * (n % 2), 90) for n in range(12)],
    "an octave leap and back": [(0, 0.4, 60, 90), (0.4, 0.6, 72, 90), (0.6, 1.0, 60, 90)],
    "a turn": [(0, 0.3, 72, 90), *((0.3 + 0.06 * n, 0.362 + 0.06 * n, p, 90) for n, p in enumerate((74, 72, 71, 72)))],
    "a fast scale": [(0.06 * n, 0.06 * n + 0.063, 60 + n, 90) for n in range(13)],
}


def slurred_grace(off: int, grace_s: float, step_s: float) -> Rows:
    """Equal legato notes, and before the fourth an ornament of it or of the third, which shortens the third."""
    pitches = (60, 62, 64, 65, 67, 69, 67, 65)
    rows = melody(list(pitches), step_s)
    at = rows[3][0]
    rows[2] = (rows[2][0], at - grace_s + 0.004, rows[2][2], 90)
    return [*rows[:3], (at - grace_s, at + 0.004, pitches[3] + off, 90), *rows[3:]]


for _off in (12, -12, 11, 7):
    for _grace_s in (0.06, 0.09, 0.125):
        for _step_s in (0.3, 0.5, 0.75):
            MUSIC[f"a slurred grace {_off} off, {_grace_s} s, {_step_s}"] = slurred_grace(_off, _grace_s, _step_s)


@pytest.mark.parametrize("name", MUSIC)
@pytest.mark.parametrize("breath", [True, False])
def test_what_is_music_stays(name: str, breath: bool) -> None:
    rows = MUSIC[name]
    assert cleaned_rows(played(rows, breath=breath)) == expected(rows)


def test_a_tongued_octave_and_a_tongued_repetition_stay() -> None:
    tongued: Rows = [(0, 0.395, 60, 90), (0.4, 0.49, 72, 90), (0.495, 0.9, 60, 90)]
    assert cleaned_rows(played(tongued, [0.4, 0.492])) == expected(tongued)
    double: Rows = [(0.1 * n, 0.1 * n + 0.06, 67, 90) for n in range(8)]
    assert cleaned_rows(played(double, [0.1 * n + 0.08 for n in range(8)])) == expected(double)


def test_a_breath_sensor_that_sends_nothing_silences_no_one() -> None:
    rows = melody([60, 62, 64, 65, 67])
    stuck = {"breath": Controlled(np.array([0.0]), np.array([0.0]))}
    notes = played(rows, breath=False)
    stopped = Played(notes.onsets_s, notes.ends_s, notes.pitches, notes.velocities, stuck)
    assert cleaned_rows(stopped) == expected(rows)


def test_a_swelling_note_is_joined_and_a_tongue_is_not_needed_for_another_pitch() -> None:
    rows: Rows = [(0, 0.5, 60, 90), (0.53, 1.0, 60, 90), (1.0, 1.5, 62, 90)]
    times = np.arange(-0.1, 1.6, SAMPLED_S)
    notes = played(rows, breath=False)
    swelling = {"breath": Controlled(times, 0.2 + 0.4 * np.clip(times, 0, 1.5))}
    found = Played(notes.onsets_s, notes.ends_s, notes.pitches, notes.velocities, swelling)
    assert cleaned_rows(found) == [(0.0, 60), (1.0, 62)]


def strokes(velocities: Sequence[int], gap_s: float, steps_s: Sequence[float]) -> Rows:
    """Notes of one pitch between others, struck again without the breath, with gaps as long as those of a retrigger."""
    rows: Rows = [(0.0, 0.404, 62, 90)]
    at = 0.4
    for velocity, step_s in zip(velocities, steps_s, strict=True):
        rows.append((at, at + step_s - gap_s, 65, velocity))
        at += step_s
    return [*rows, (at, at + 0.404, 67, 90), (at + 0.4, at + 0.8, 65, 90)]


@pytest.mark.parametrize("gap_s", [0.022, 0.04, 0.055])
@pytest.mark.parametrize(
    ("velocities", "steps_s", "struck"),
    [
        ((90, 90), (0.25, 0.25), False),
        ((90, 92), (0.25, 0.25), False),
        ((90, 90, 90), (0.1, 0.4, 0.2), False),
        ((90, 72), (0.25, 0.25), True),
        ((90, 104), (0.25, 0.25), True),
        ((90, 90, 90), (0.25, 0.25, 0.25), True),
        ((90, 88, 91, 90), (0.2, 0.21, 0.19, 0.2), True),
    ],
)
def test_a_note_struck_again_under_one_breath_stays_where_something_says_so(
    gap_s: float, velocities: Sequence[int], steps_s: Sequence[float], struck: bool
) -> None:
    rows = strokes(velocities, gap_s, steps_s)
    kept = [row for row in rows if row[2] != 65] + [row for row in rows if row[2] == 65][: None if struck else 1]
    kept += [] if struck else [rows[-1]]
    assert cleaned_rows(played(rows)) == expected(sorted(kept))


def test_a_player_who_detaches_all_notes_without_the_breath_strikes_repeated_ones_too() -> None:
    rows: Rows = [
        (0.3 * n, 0.3 * n + 0.26, pitch, 90) for n, pitch in enumerate((60, 62, 64, 64, 65, 67, 65, 64, 64, 62))
    ]
    assert cleaned_rows(played(rows)) == expected(rows)


def test_a_breath_that_was_sent_as_the_velocity_is_no_stroke() -> None:
    """A note that began before the breath and jumped back after it: softer first, like the breath."""
    rows: Rows = [(0.0, 0.25, 65, 60), (0.28, 0.8, 65, 90), (0.8, 1.2, 67, 90)]
    times = np.arange(-0.2, 1.5, SAMPLED_S)
    notes = played(rows, breath=False)
    breath = {"breath": Controlled(times, np.interp(times, (0.0, 0.2, 1.2, 1.25), (0.3, 0.65, 0.65, 0.0)))}
    found = Played(notes.onsets_s, notes.ends_s, notes.pitches, notes.velocities, breath)
    assert [pitch for _, pitch in cleaned_rows(found)] == [65, 67]
