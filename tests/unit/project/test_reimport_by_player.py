"""A changed file that is applied to some players only, and the list of changes shown before."""

from __future__ import annotations

from fractions import Fraction

import msgspec
from hypothesis import given
from hypothesis import strategies as st

from app.plan.by_hand.corrections import AddGesture, PinFingering
from app.project.edit.corrections import with_corrections
from app.project.model import Project
from app.project.part_changes import PartChange, part_changes
from app.project.reimport import reimport
from app.score.marks import Mark
from app.score.model import Note, Score
from instrument_maps.load import bundled_maps
from tests.unit.project.pieces import small_project
from tests.unit.project.test_reimport import BAR, from_file, later, with_notes

MAPS = bundled_maps()
SAME = Fraction(1)


def both_later(project: Project) -> Score:
    """File with a bar inserted before the third note of both players."""
    score = project.score
    for index in range(2):
        score = with_notes(score, index, later(score.parts[index].notes, 960, BAR))
    return score


def test_a_kept_player_stays_as_it_is_and_is_offered_the_change_again() -> None:
    gestures = [AddGesture("mine", "sway", 960, 1440, 0.5), PinFingering("1:4", "1")]
    project = with_corrections(small_project(), "1.1.1", gestures)
    file = from_file(both_later(project))
    whole = reimport(project, file, MAPS)
    first, second = project.score.parts
    kept = whole.keeping({first.id})
    assert kept.project.score.parts[0] == first
    assert kept.project.score.parts[1] == whole.project.score.parts[1] != second
    assert kept.project.corrections == project.corrections
    assert kept.orphans == ()
    assert reimport(kept.project, file, MAPS).project.score.parts == whole.project.score.parts
    assert whole.keeping({first.id, second.id}).project is project
    assert whole.keeping(()).project == whole.project


def test_a_kept_player_stays_in_time_where_the_file_counts_otherwise() -> None:
    project = small_project()
    parts = tuple(
        msgspec.structs.replace(
            part,
            notes=tuple(Note(n.id, 2 * n.onset_tick, 2 * n.duration_tick, n.pitch + 1, n.velocity) for n in part.notes),
        )
        for part in project.score.parts
    )
    quarter = 2 * project.score.ticks_per_quarter
    tempo_map = msgspec.structs.replace(project.score.tempo_map, ticks_per_quarter=quarter)
    file = from_file(
        msgspec.structs.replace(project.score, ticks_per_quarter=quarter, tempo_map=tempo_map, parts=parts)
    )
    kept = reimport(project, file, MAPS).keeping({project.score.parts[0].id}).project.score
    assert [(n.id, n.onset_tick, n.duration_tick, n.pitch) for n in kept.parts[0].notes] == [
        (n.id, 2 * n.onset_tick, 2 * n.duration_tick, n.pitch) for n in project.score.parts[0].notes
    ]
    assert [n.pitch for n in kept.parts[1].notes] == [n.pitch + 1 for n in project.score.parts[1].notes]


def test_a_new_player_that_is_not_taken_stays_out_and_is_offered_again() -> None:
    project = small_project()
    more = tuple(Note(f"9:{place}", 700 * place, 300, 50 + 7 * place % 12, 80) for place in range(20))
    new = msgspec.structs.replace(project.score.parts[0], name="Another", voice=0, channel=9, notes=more)
    file = from_file(msgspec.structs.replace(project.score, parts=(*project.score.parts, new)))
    whole = reimport(project, file, MAPS)
    (player_id,) = whole.new_players
    without = whole.keeping({whole.project.player(player_id).part_id})
    assert without.new_players == without.added == ()
    assert without.project.score.parts == project.score.parts
    assert reimport(without.project, file, MAPS).new_players == whole.new_players


def changes(project: Project, score: Score, index: int = 0) -> tuple[PartChange, ...]:
    outcome = reimport(project, from_file(score), MAPS)
    return part_changes(project.score.parts[index], outcome.project.score.parts[index], SAME)


def test_inserted_bars_are_one_change_and_others_are_named_beside_it() -> None:
    project = small_project()
    first = project.score.parts[0].notes
    notes = later(first, 960, BAR)
    notes[3] = msgspec.structs.replace(notes[3], velocity=9)
    found = changes(project, with_notes(project.score, 0, notes))
    assert [(change.kind, change.tick, change.tick_now, change.count) for change in found] == [
        ("moved", 960, 960 + BAR, 2),
        ("changed", first[3].onset_tick, first[3].onset_tick + BAR, 1),
    ]
    assert isinstance(found[1].now, Note)
    assert found[1].now.velocity == 9


def test_marks_are_compared_where_their_music_is_now() -> None:
    part = small_project().score.parts[0]
    ids = [note.id for note in part.notes]
    before = msgspec.structs.replace(
        part, marks=(Mark("slur", ids[0], ids[1]), Mark("dynamic", tick=960, text="p"), Mark("tenuto", ids[3]))
    )
    now = msgspec.structs.replace(
        part,
        notes=tuple(later(part.notes, 960, BAR)),
        marks=(Mark("dynamic", tick=960 + BAR, text="f"), Mark("tenuto", ids[3]), Mark("accent", ids[2])),
    )
    found = [
        (change.tick_now, change.before and change.before.id, change.now and change.now.id)
        for change in part_changes(before, now, SAME)
        if change.kind == "marks"
    ]
    assert sorted(found, key=str) == sorted(
        [
            (0, f"mark:slur:{ids[0]}-{ids[1]}", None),
            (960 + BAR, "mark:dynamic:@2880", "mark:dynamic:@2880"),
            (960 + BAR, None, f"mark:accent:{ids[2]}"),
        ],
        key=str,
    )


@st.composite
def versions(draw: st.DrawFn) -> tuple[tuple[Note, ...], tuple[Note, ...]]:
    def notes() -> tuple[Note, ...]:
        ids = draw(st.sets(st.integers(0, 12)))
        field = st.tuples(st.integers(0, 5000), st.integers(1, 900), st.integers(40, 90), st.integers(1, 127))
        made = [Note(f"1:{id}", *draw(field)) for id in ids]
        return tuple(sorted(made, key=lambda note: (note.onset_tick, note.pitch)))

    return notes(), notes()


@given(versions())
def test_the_changes_lead_from_one_version_to_the_other(pair: tuple[tuple[Note, ...], tuple[Note, ...]]) -> None:
    """Each note is listed under exactly what differs of it, and nothing of it under anything else."""
    part = small_project().score.parts[0]
    before, now = (msgspec.structs.replace(part, notes=notes) for notes in pair)
    was, new = ({note.id: note for note in notes} for notes in pair)
    found = part_changes(before, now, SAME)
    listed = {
        kind: {(one.now or one.before).id for one in found if one.kind == kind}
        for kind in ("added", "removed", "changed")
    }
    both = was.keys() & new.keys()
    assert listed["added"] == new.keys() - was.keys()
    assert listed["removed"] == was.keys() - new.keys()
    assert listed["changed"] == {
        id for id in both if msgspec.structs.replace(was[id], onset_tick=new[id].onset_tick) != new[id]
    }
    moved = [id for id in both if was[id].onset_tick != new[id].onset_tick]
    assert sum(one.count for one in found if one.kind == "moved") == len(moved)
