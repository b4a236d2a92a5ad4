"""Edits of notes compared with a slow reference: one flat list of tuples."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import msgspec
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from app.errors import AppError
from app.plan.by_hand.corrections import PinFingering, RemoveEvent, SetBreath
from app.plan.parameters import PlayerParameters
from app.project.casting import StagePosition
from app.project.edit import notes as edit
from app.project.model import Project
from app.project.performers import Player
from app.project.snap_grid import Grid
from app.score.model import Note, Part, Score
from app.score.tempo import TempoMap

pytestmark = pytest.mark.slow

TPQ = 480
Row = tuple[str, str, int, int, int, int]
"""Part, id, onset, end, pitch, velocity."""


def part(id: str, notes: list[Note]) -> Part:
    ordered = tuple(sorted(notes, key=lambda note: (note.onset_tick, note.pitch)))
    return Part(id, id, 0, 0, 0, None, None, "trumpet_Bb", ordered)


def project_of(*parts: Part) -> Project:
    players = tuple(
        Player("player " + each.id, each.id, each.id, "trumpet_Bb", "maria", PlayerParameters(), StagePosition(0, 0, 0))
        for each in parts
    )
    return Project(Score("", TPQ, TempoMap(TPQ), parts=parts), players)


@st.composite
def projects(draw: st.DrawFn) -> Project:
    parts = []
    for number in range(1, draw(st.integers(1, 3)) + 1):
        rows = draw(
            st.lists(
                st.tuples(st.integers(0, 4000), st.integers(1, 900), st.integers(0, 127), st.integers(1, 127)),
                max_size=8,
            )
        )
        parts.append(part(f"{number}.1.1", [Note(f"{number}:{i}", *row) for i, row in enumerate(rows, 1)]))
    return project_of(*parts)


@st.composite
def chosen(draw: st.DrawFn) -> tuple[Project, frozenset[str]]:
    project = draw(projects())
    ids = [row[1] for row in rows(project)]
    return project, draw(st.frozensets(st.sampled_from(ids)) if ids else st.just(frozenset()))


def rows(project: Project) -> list[Row]:
    return [
        (each.id, note.id, note.onset_tick, note.end_tick, note.pitch, note.velocity)
        for each in project.score.parts
        for note in each.notes
    ]


def well_formed(project: Project) -> None:
    ids = [row[1] for row in rows(project)]
    assert len(ids) == len(set(ids))
    for each in project.score.parts:
        keys = [(note.onset_tick, note.pitch) for note in each.notes]
        assert keys == sorted(keys)
        assert all(note.duration_tick >= 1 and note.onset_tick >= 0 for note in each.notes)
        assert all(0 <= note.pitch <= 127 and 1 <= note.velocity <= 127 for note in each.notes)


def agrees(project: Project, expected: list[Row]) -> None:
    well_formed(project)
    assert sorted(rows(project)) == sorted(expected)


DISTANCES = st.integers(-3000, 3000)


@given(chosen(), DISTANCES, st.integers(-130, 130))
def test_move(given: tuple[Project, frozenset[str]], by_tick: int, by_pitch: int) -> None:
    project, ids = given
    expected = [
        (p, i, on + by_tick, end + by_tick, pitch + by_pitch, v) if i in ids else (p, i, on, end, pitch, v)
        for p, i, on, end, pitch, v in rows(project)
    ]
    if any(on < 0 or not 0 <= pitch <= 127 for _, _, on, _, pitch, _ in expected):
        with pytest.raises(AppError):
            edit.move(project, ids, by_tick, by_pitch)
    else:
        agrees(edit.move(project, ids, by_tick, by_pitch), expected)
    reach = edit.reach_of_move(project, ids, by_tick, by_pitch)
    well_formed(edit.move(project, ids, *reach))
    # It gives way no farther than it must.
    for index, (asked, got) in enumerate(zip((by_tick, by_pitch), reach, strict=True)):
        if ids and got != asked:
            farther = list(reach)
            farther[index] += 1 if asked > got else -1
            with pytest.raises(AppError):
                edit.move(project, ids, *farther)


@given(chosen(), DISTANCES, st.booleans())
def test_resize(given: tuple[Project, frozenset[str]], by_tick: int, at_start: bool) -> None:
    project, ids = given
    expected = []
    for p, i, on, end, pitch, v in rows(project):
        if i in ids and at_start:
            on = max(0, min(end - 1, on + by_tick))
        elif i in ids:
            end = max(on + 1, end + by_tick)
        expected.append((p, i, on, end, pitch, v))
    agrees(edit.resize(project, ids, by_tick, at_start=at_start), expected)


@given(chosen())
def test_erase(given: tuple[Project, frozenset[str]]) -> None:
    project, ids = given
    agrees(edit.erase(project, ids), [row for row in rows(project) if row[1] not in ids])


@given(chosen(), st.integers(0, 5000))
def test_split(given: tuple[Project, frozenset[str]], tick: int) -> None:
    project, ids = given
    cut = [row for row in rows(project) if row[1] in ids and row[2] < tick < row[3]]
    if not cut:
        with pytest.raises(AppError):
            edit.split(project, ids, tick)
        return
    result, new = edit.split(project, ids, tick)
    names = {row[1]: name for row, name in zip(cut, new, strict=True)}
    expected = [(p, i, on, tick if i in names else end, *more) for p, i, on, end, *more in rows(project)]
    expected += [(p, names[i], tick, end, *more) for p, i, _, end, *more in cut]
    agrees(result, expected)


@given(
    st.lists(st.tuples(st.integers(0, 50), st.integers(2, 300), st.integers(60, 61)), min_size=1, max_size=8), st.data()
)
def test_what_was_split_is_joined_again(line: list[tuple[int, int, int]], data: st.DataObject) -> None:
    notes, at = [], 0
    for gap, duration, pitch in line:
        notes.append(Note(f"1:{len(notes)}", at + gap, duration, pitch, 80))
        at += gap + duration
    cut = data.draw(st.sampled_from(notes))
    tick = data.draw(st.integers(cut.onset_tick + 1, cut.end_tick - 1))
    project = project_of(part("1.1.1", notes))
    result, new = edit.split(project, {note.id for note in notes}, tick)
    assert edit.join(result, {cut.id, *new}) == project


def test_join_takes_runs_of_one_pitch_only() -> None:
    notes = [Note(f"1:{i}", 100 * i, 60, pitch, 80) for i, pitch in enumerate([60, 60, 62, 62, 62, 60])]
    project = project_of(part("1.1.1", notes))
    result = edit.join(project, {"1:0", "1:1", "1:2", "1:4"})
    assert [(row[1], row[2], row[3]) for row in rows(result)] == [
        ("1:0", 0, 160),
        ("1:2", 200, 260),
        ("1:3", 300, 360),
        ("1:4", 400, 460),
        ("1:5", 500, 560),
    ]
    with pytest.raises(AppError):
        edit.join(project, {"1:0", "1:2"})


@given(chosen(), st.integers(0, 5000), st.integers(-20, 20))
def test_duplicate(given: tuple[Project, frozenset[str]], by_tick: int, by_pitch: int) -> None:
    project, ids = given
    taken = [row for row in rows(project) if row[1] in ids]
    assume(all(0 <= row[4] + by_pitch <= 127 for row in taken))
    result, new = edit.duplicate(project, ids, by_tick, by_pitch)
    copies = [
        (p, name, on + by_tick, end + by_tick, pitch + by_pitch, v)
        for (p, _, on, end, pitch, v), name in zip(taken, new, strict=True)
    ]
    agrees(result, rows(project) + copies)


@given(chosen(), st.integers(-130, 130), st.floats(0, 3))
def test_velocity(given: tuple[Project, frozenset[str]], by: int, factor: float) -> None:
    project, ids = given
    expected = [
        (*row[:5], max(1, min(127, round(row[5] * factor) + by)) if row[1] in ids else row[5]) for row in rows(project)
    ]
    agrees(edit.change_velocity(project, ids, by, factor), expected)


@given(
    chosen(),
    st.sampled_from([Fraction(1), Fraction(1, 4), Fraction(1, 3), Fraction(1, 7)]),
    st.floats(0, 1),
    st.booleans(),
    st.booleans(),
)
def test_quantise(
    given: tuple[Project, frozenset[str]], quarters: Fraction, strength: float, onsets: bool, ends: bool
) -> None:
    project, ids = given
    bar = 4 * TPQ

    def near(tick: int) -> int:
        base = tick // bar * bar
        lines = sorted({base + round(k * quarters * TPQ) for k in range(int(4 / quarters) + 1)} | {base + bar})
        return min(lines, key=lambda line: (abs(line - tick), line))

    expected = []
    for p, i, on, end, pitch, v in rows(project):
        if i in ids:
            length = end - on
            if onsets:
                on = round(on + strength * (near(on) - on))
            end = round(end + strength * (near(end) - end)) if ends else on + length
            end = max(end, on + 1)
        expected.append((p, i, on, end, pitch, v))
    agrees(edit.quantise(project, ids, quarters, strength, onsets=onsets, ends=ends), expected)


@given(chosen(), st.integers(0, 9000))
def test_copy_and_paste(given: tuple[Project, frozenset[str]], at: int) -> None:
    project, ids = given
    target = project.score.parts[-1].id
    taken = [row for row in rows(project) if row[1] in ids]
    clip = msgspec.json.decode(msgspec.json.encode(edit.copied(project, ids)), type=edit.ClipboardNotes)
    result, new = edit.paste(project, target, clip, at)
    first = min((row[2] for row in taken), default=0)
    several = len({row[0] for row in taken}) > 1
    pasted = [
        (p if several else target, name, at + on - first, at + end - first, pitch, v)
        for (p, _, on, end, pitch, v), name in zip(taken, new, strict=True)
    ]
    agrees(result, rows(project) + pasted)


def test_paste_counts_ticks_anew_in_another_resolution() -> None:
    clip = edit.ClipboardNotes(TPQ * 2, (edit.CopiedLine("9.9.9", (edit.CopiedNote(960, 1, 60, 80),)),))
    result, _ = edit.paste(project_of(part("1.1.1", [])), "1.1.1", clip, 10)
    assert [row[2:4] for row in rows(result)] == [(490, 491)]


@given(projects(), st.integers(-5, 3000), st.integers(-2, 900), st.integers(-3, 130), st.integers(-3, 130))
def test_add(project: Project, onset: int, duration: int, pitch: int, velocity: int) -> None:
    target = project.score.parts[0].id
    if onset < 0 or duration < 1 or not 0 <= pitch <= 127 or not 1 <= velocity <= 127:
        with pytest.raises(AppError):
            edit.add_note(project, target, onset, duration, pitch, velocity)
        return
    result, name = edit.add_note(project, target, onset, duration, pitch, velocity)
    agrees(result, [*rows(project), (target, name, onset, onset + duration, pitch, velocity)])


@given(chosen())
def test_what_changes_nothing_is_the_very_same(given: tuple[Project, frozenset[str]]) -> None:
    project, ids = given
    assert edit.move(project, ids, 0, 0) is project
    assert edit.resize(project, ids, 0) is project
    assert edit.change_velocity(project, ids) is project
    assert edit.quantise(project, ids, Fraction(1), 0.0, ends=True) is project
    assert edit.erase(project, {"unknown"}) is project
    untouched = {each.id: each for each in project.score.parts}
    for each in edit.erase(project, ids).score.parts:
        if not any(note.id in ids for note in untouched[each.id].notes):
            assert each is untouched[each.id]


def corrected() -> Project:
    project = project_of(part("1.1.1", [Note("1:1", 0, 100, 60, 80), Note("1:11", 200, 100, 62, 80)]))
    items = (
        PinFingering("1:1", "13"),
        SetBreath("1:11", -50),
        RemoveEvent("breath:1:1"),
        RemoveEvent("breath:1:11", "1:11"),
    )
    return replace(project, corrections={"player 1.1.1": items})


def test_erasing_a_note_erases_its_corrections_and_no_others() -> None:
    left = edit.erase(corrected(), {"1:1"}).corrections["player 1.1.1"]
    assert left == (SetBreath("1:11", -50), RemoveEvent("breath:1:11", "1:11"))
    assert edit.erase(corrected(), {"1:1", "1:11"}).corrections == {}


def test_the_first_half_keeps_the_corrections() -> None:
    result, new = edit.split(corrected(), {"1:1"}, 40)
    assert result.corrections == corrected().corrections
    assert new == ("n:1",)


def test_a_name_that_a_correction_still_waits_for_is_not_given_again() -> None:
    project = project_of(part("1.1.1", [Note("n:2", 0, 100, 60, 80)]))
    project = replace(project, corrections={"player 1.1.1": (PinFingering("n:7", "0"),)})
    _, name = edit.add_note(project, "1.1.1", 0, 1, 60, 80)
    assert name == "n:8"


def test_the_oracles_grid_is_the_documents() -> None:
    assert Grid(Fraction(1, 3)).snap(project_of().score.metre_map, 170) == 160


def test_the_grid_never_steps_across_a_bar_line() -> None:
    grid, bars = Grid(Fraction(3)), project_of().score.metre_map
    assert [grid.snap(bars, tick) for tick in (0, 3 * TPQ, 3.4 * TPQ, 3.9 * TPQ, 4 * TPQ)] == [
        *(0, 3 * TPQ, 3 * TPQ),
        *(4 * TPQ, 4 * TPQ),
    ]
