"""Dynamics from velocities: the output of each notation program is read back as the original marks."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import mido
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.plan.music.dynamics_from_velocities import Velocities, VelocityReading, read_dynamics, read_velocities
from app.plan.music.velocity_ladders import DYNAMICS, MEZZOFORTE, articulated, ladder_of

FOLDER = Path(__file__).parents[3] / "data" / "midi" / "dynamics"
ENSEMBLE = FOLDER.parent / "ensemble"
MARKS = ("pp", "p", "mp", "mf", "f", "ff")
WRITTEN = {
    # Velocities that each program writes for pp, p, mp, mf, f and ff; LilyPond's by General MIDI program.
    ("MuseScore", 56): (33, 49, 64, 80, 96, 112),
    ("Finale", 56): (36, 49, 62, 75, 88, 101),
    ("Sibelius", 56): (39, 61, 71, 84, 98, 113),
    ("LilyPond", None): (62, 69, 77, 86, 95, 101),
    ("LilyPond", 73): (43, 48, 54, 60, 66, 71),
    ("LilyPond", 70): (37, 41, 46, 51, 57, 60),
    ("LilyPond", 60): (50, 54, 59, 64, 69, 73),
    ("LilyPond", 56): (56, 61, 66, 73, 79, 83),
}
FILES = ("solo_horn_mozart_k447_mv1.mid", "concert_band_hall_tenth_regiment_march.mid")


def velocity_marks(
    velocities: np.ndarray, program: int | None = None, reading: VelocityReading | None = None
) -> tuple[str, ...]:
    return tuple(DYNAMICS[mark][0] for mark in read_dynamics(Velocities(velocities, program), reading)[1].tolist())


def velocity_loudness(
    velocities: np.ndarray, program: int | None = None, reading: VelocityReading | None = None
) -> np.ndarray:
    return read_dynamics(Velocities(velocities, program), reading)[0]


def read(parts: Iterable[tuple[np.ndarray, int | None]]) -> VelocityReading:
    return read_velocities([Velocities(*part) for part in parts])


@st.composite
def scores(draw: st.DrawFn) -> tuple[list[tuple[np.ndarray, int | None]], list[list[str]]]:
    """Parts written by one program with passages at several marks, and those marks by note."""
    name = draw(st.sampled_from(sorted({name for name, _ in WRITTEN})))
    tables = [(program, row) for (one, program), row in WRITTEN.items() if one == name]
    parts, truth = [], []
    for _ in range(draw(st.integers(1, 3))):
        program, row = draw(st.sampled_from(tables))
        passages = draw(st.lists(st.tuples(st.sampled_from(range(6)), st.integers(4, 20)), min_size=6, max_size=12))
        passages += [(1, 8), (4, 8), (3, 8)]
        parts.append((np.concatenate([np.full(length, row[mark]) for mark, length in passages]), program))
        truth.append([MARKS[mark] for mark, length in passages for _ in range(length)])
    return parts, truth


@given(scores())
@settings(max_examples=60, deadline=None)
def test_every_programs_marks_are_read_back(score: tuple[list[tuple[np.ndarray, int | None]], list[list[str]]]) -> None:
    parts, truth = score
    reading = read(parts)
    for (velocities, program), marks in zip(parts, truth, strict=True):
        assert list(velocity_marks(velocities, program, reading)) == marks


@pytest.mark.parametrize("name", FILES)
def test_files_that_lilypond_wrote_are_read_by_its_ladder(name: str) -> None:
    parts = []
    for track in mido.MidiFile(ENSEMBLE / name).tracks:
        programs = [message.program for message in track if message.type == "program_change"]
        hits = [message for message in track if message.type == "note_on" and message.velocity]
        if hits and hits[0].channel != 9:
            parts.append((np.array([hit.velocity for hit in hits]), programs[0]))
    assert read(parts).ladder == "LilyPond"


def test_an_engraved_duet_has_the_marks_of_its_score() -> None:
    """Mozart, K. 487 no. 8: *f*, *p* and hairpins, engraved with LilyPond, which writes 95 and 69."""
    tracks = mido.MidiFile(FOLDER / "horn_duet_mozart_k487_no8.mid").tracks
    hits = [
        [message.velocity for message in track if message.type == "note_on" and message.velocity] for track in tracks
    ]
    parts = [(np.array(velocities), None) for velocities in hits if velocities]
    reading = read(parts)
    for velocities, program in parts:
        marks = np.array(velocity_marks(velocities, program, reading))
        assert set(marks[velocities == 95]) == {"f"}
        assert set(marks[velocities == 69]) == {"p"}
        assert set(marks[velocities == 86]) == {"mf"}


@pytest.mark.parametrize("velocity", [64, 80, 90, 96, 100, 127])
def test_a_programs_default_throughout_is_no_dynamic(velocity: int) -> None:
    one = np.full(32, velocity)
    assert set(velocity_marks(one)) == {"mf"}
    assert velocity_loudness(one) == pytest.approx(np.full(32, MEZZOFORTE))


@pytest.mark.parametrize(("program", "velocity"), [(73, 62), (70, 53), (60, 66), (56, 75), (57, 90)])
def test_lilyponds_default_is_no_dynamic_on_any_instrument(program: int, velocity: int) -> None:
    others = (np.full(40, 90), 58)
    reading = read([(np.full(40, velocity), program), others])
    assert set(velocity_marks(np.full(40, velocity), program, reading)) == {"mf"}


@pytest.mark.parametrize(("velocity", "mark"), [(30, "pp"), (120, "ff"), (49, "p"), (112, "ff"), (17, "ppp")])
def test_a_constant_velocity_that_no_program_has_by_default_is_a_dynamic(velocity: int, mark: str) -> None:
    assert set(velocity_marks(np.full(32, velocity), 56)) == {mark}


def test_a_default_among_other_levels_is_a_mark() -> None:
    assert velocity_marks(np.array([96] * 4 + [33])) == ("f",) * 4 + ("pp",)
    # A flute's forte from LilyPond is its default with a staccato.
    assert set(velocity_marks(np.full(40, 66), 73)) == {"f"}


def test_an_accent_is_louder_and_no_other_mark() -> None:
    velocities = np.array([49] * 10 + [96] * 12 + [49] * 10)
    velocities[15] = 115
    loudness, marks = velocity_loudness(velocities), velocity_marks(velocities)
    assert marks == ("p",) * 10 + ("f",) * 12 + ("p",) * 10
    assert loudness[15] > loudness[14] + 0.1


def test_a_hairpin_rises_from_mark_to_mark() -> None:
    velocities = np.array([69] * 8 + [72, 75, 78, 81, 85, 88, 91] + [95] * 8)
    loudness = velocity_loudness(velocities)
    assert (np.diff(loudness) >= -0.02).all()
    marks = velocity_marks(velocities)
    assert (marks[0], marks[-1]) == ("p", "f")
    assert {"mp", "mf"} <= set(marks)


def test_after_a_stress_the_level_returns() -> None:
    """LilyPond plays everything after a *sf* as loud as it; players stress a single note."""
    velocities = np.array([69] * 8 + [127] * 6 + [95] * 8 + [69] * 8)
    assert velocity_marks(velocities)[:14] == ("p",) * 14
    assert int(velocity_loudness(velocities)[:14].argmax()) == 8


def test_notes_without_a_mark_keep_the_mark_before_them() -> None:
    """LilyPond plays a second voice, or one after an empty one, at its default: 90, in a flute 62."""
    velocities = np.array([48] * 12 + [62] * 6 + [66] * 12 + [62] * 4)
    assert velocity_marks(velocities, 73) == ("p",) * 18 + ("f",) * 16


def test_notes_without_a_mark_are_as_loud_as_their_mark() -> None:
    """LilyPond writes 90 for them, which is near its forte."""
    marked = np.array([62, 69, 77, 86, 95, 101, 62, 69, 77, 86, 95, 101] * 4).repeat(6)
    unmarked = np.full(60, 90)
    reading = read([(marked, None), (unmarked, None)])
    assert velocity_marks(unmarked, None, reading) == ("mf",) * 60
    assert velocity_loudness(unmarked, None, reading) == pytest.approx(MEZZOFORTE)


def test_lilyponds_range_of_another_instrument_is_known() -> None:
    """A flute's part that was written as a voice: 69 is *piano*, 95 *forte*."""
    velocities = np.array([69] * 12 + [95] * 12 + [101] * 12 + [69] * 8)
    assert velocity_marks(velocities, 73) == ("p",) * 12 + ("f",) * 12 + ("ff",) * 12 + ("p",) * 8


@pytest.mark.parametrize(("low", "high"), [(0.2, 0.8), (0.4, 0.9), (0.2, 0.9)])
@pytest.mark.parametrize("program", [73, 60, 57])
def test_a_range_that_a_score_sets_itself_is_known(program: int, low: float, high: float) -> None:
    """LilyPond places its marks between ``midiMinimumVolume`` and ``midiMaximumVolume``."""
    volumes = {"pp": 0.49, "p": 0.55, "mf": 0.68, "f": 0.75, "ff": 0.8}
    truth = ["p", "f", "pp", "mf", "p", "ff"]
    velocities = np.repeat([int(127 * (low + (high - low) * volumes[mark])) for mark in truth], 12)
    assert velocity_marks(velocities, program) == tuple(mark for mark in truth for _ in range(12))


def test_what_lilypond_wrote_for_no_instruments_keeps_its_marks_under_any_programs() -> None:
    """Four voices that were assigned to winds afterwards; *p* is 69, and hairpins that lead to no mark end at 41 and
    98.
    """
    lines = [[69] * 40 + [55] * 8 + [41] * 30, [69] * 40 + [41] * 25 + [61, 60, 65], [69] * 30 + [98] * 6 + [69] * 12]
    parts = [(np.array(line), program) for line, program in zip(lines, (73, 71, 70), strict=True)]
    reading = read(parts)
    assert reading.ladder == "LilyPond"
    for velocities, program in parts:
        marks = np.array(velocity_marks(velocities, program, reading))
        assert set(marks[velocities == 69]) == {"p"}


def test_a_mark_is_no_articulation_of_notes_without_one() -> None:
    """A flute's *f* is 66, and so is a staccato of a voice without a mark."""
    velocities = np.array([48] * 12 + [66, 66, 62, 62, 66, 62, 66, 66] + [48] * 6)
    assert velocity_marks(velocities, 73) == ("p",) * 12 + ("f",) * 8 + ("p",) * 6


def test_a_voice_that_lilypond_made_in_no_instruments_range_keeps_the_mark() -> None:
    """A bassoon's *fff* is 70; a second voice of its staff may have 90, as without an instrument."""
    velocities = np.array([41] * 12 + [90, 90, 94, 90] + [60] * 12)
    assert velocity_marks(velocities, 70) == ("p",) * 16 + ("ff",) * 12


@pytest.mark.parametrize(("program", "default"), [(73, 62), (60, 66), (60, 90), (57, 90)])
def test_notes_without_a_mark_are_as_loud_as_the_mark_before_them(program: int, default: int) -> None:
    """Holds for LilyPond's default in every instrument's range and without an instrument."""
    piano = {73: 48, 60: 54, 57: 69}[program]
    velocities = np.array([piano] * 12 + [default] * 12 + [piano] * 12)
    assert velocity_loudness(velocities, program) == pytest.approx(
        np.full(36, velocity_loudness(velocities, program)[0])
    )


@given(st.integers(40, 100), st.integers(2, 6), st.integers(0, 1000))
@settings(max_examples=30, deadline=None)
def test_strokes_of_one_level_are_mezzoforte(level: int, spread: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    velocities = np.clip(np.round(rng.normal(level, spread, 200)), 1, 127).astype(int)
    assert velocity_marks(velocities).count("mf") >= 190


@pytest.mark.parametrize("softer", [0, 12])
def test_played_phrases_are_read_by_the_pieces_own_distribution(softer: int) -> None:
    """A keyboard with a soft touch does not make the music soft."""
    rng = np.random.default_rng(3)
    truth = ["p"] * 60 + ["f"] * 60 + ["mf"] * 60
    levels = np.repeat([49, 96, 80], 60) - softer
    velocities = np.clip(np.round(rng.normal(levels, 5)), 1, 127).astype(int)
    marks = velocity_marks(velocities)
    order = ["ppp", "pp", "p", "mp", "mf", "f", "ff", "fff"]
    off = np.array([abs(order.index(found) - order.index(mark)) for found, mark in zip(marks, truth, strict=True)])
    assert (off <= 1).mean() >= 0.95
    assert (off == 0).mean() >= 0.6


def hairpins(rng: np.random.Generator, notes: int) -> tuple[np.ndarray, list[str]]:
    """LilyPond's line with hardly any constant level: single notes at marks, and hairpins between them."""
    row = WRITTEN["LilyPond", 73]
    mark, velocities, truth = 2, list[int](), list[str]()
    while len(velocities) < notes:
        after = (mark + int(rng.integers(1, 6))) % 6
        count = int(rng.integers(6, 12))
        velocities += np.linspace(row[mark], row[after], count, endpoint=False).astype(int).tolist()
        truth += [MARKS[mark], *[""] * (count - 1)]
        mark = after
    return np.array(velocities), truth


@pytest.mark.parametrize("seed", range(4))
def test_a_line_of_hairpins_is_written_not_played(seed: int) -> None:
    velocities, truth = hairpins(np.random.default_rng(seed), 120)
    others = (np.array([48] * 20 + [66] * 20 + [71] * 20 + [48] * 20), 73)
    marks = velocity_marks(velocities, 73, read([others, (velocities, 73)]))
    at = [(found, mark) for found, mark in zip(marks, truth, strict=True) if mark]
    assert sum(found == mark for found, mark in at) >= 0.8 * len(at)


def test_levels_between_marks_do_not_hide_the_ladder() -> None:
    """LilyPond's written-out diminuendo may stay at levels without marks for bars, as in a dance from a ballet."""
    dance = [level + more for level in (90, 84, 73, 67) for more in [0, 0, 0, 4, 4, 4, 20, 0, 4] * 4]
    velocities = np.array(dance + [95, 95, 95, 99, 99] * 12)
    assert velocity_marks(velocities)[len(dance) :] == ("f",) * 60


def test_players_of_one_staff_read_one_mark() -> None:
    """LilyPond applies marks only to the voice that contains them, and writes 62 in the flutes' other voice."""
    onsets = np.arange(0, 36 * 480, 480)
    first, second = np.array([48] * 12 + [66] * 12 + [48] * 12), np.full(36, 62)
    second[:3] = 71
    parts = [Velocities(first, 73, onsets, 1), Velocities(second, 73, onsets, 1), Velocities(second, 73, onsets, 2)]
    reading = read_velocities(parts)
    marks = [[DYNAMICS[mark][0] for mark in read_dynamics(part, reading)[1].tolist()] for part in parts]
    assert marks[0] == ["p"] * 12 + ["f"] * 12 + ["p"] * 12
    assert marks[1] == ["ff"] * 3 + ["p"] * 9 + ["f"] * 12 + ["p"] * 12
    assert marks[2] == ["ff"] * 36


def test_a_line_without_a_mark_plays_as_most_others_do() -> None:
    onsets = np.arange(0, 24 * 480, 480)
    parts = [Velocities(np.array([48] * 12 + [66] * 12), 73, onsets, staff) for staff in (1, 2)]
    parts += [Velocities(np.full(24, 71), 73, onsets, 3), Velocities(np.full(20, 62), 73, onsets[4:], 4)]
    reading = read_velocities(parts)
    marks = [DYNAMICS[mark][0] for mark in read_dynamics(parts[-1], reading)[1].tolist()]
    assert marks == ["p"] * 8 + ["f"] * 12


def test_no_notes_have_no_dynamics() -> None:
    assert velocity_marks(np.zeros(0, np.int64)) == ()
    assert read([]).ladder == ""


def test_an_accent_of_musescore_is_a_fifth_louder() -> None:
    """`Instrument::updateVelocity` of MuseScore 3: the velocity times 120 / 100 in integers."""
    for velocity, louder in ((33, 39), (49, 58), (64, 76), (80, 96), (96, 115)):
        assert [velocity + more for more, _ in articulated(ladder_of("MuseScore", None), velocity)] == [
            velocity,
            louder,
        ]
