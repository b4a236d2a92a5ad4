"""A day at the editor, at random: edits of every kind, drags, undo, redo, saving, opening, generating, reading the MIDI
file again. Whatever happens, nothing done by hand is lost, undo gives back the very value, and a file holds it all."""

from __future__ import annotations

import shutil
import tempfile
from collections import Counter
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from app.errors import AppError, Message
from app.messages import text
from app.performance.ensemble import Performance
from app.plan.by_hand.corrections import (
    AddExpression,
    AddGesture,
    ChangeExpression,
    ChangeGesture,
    Correction,
    PinFingering,
    PoseCorrection,
    RemoveEvent,
    SetBreath,
    SetCue,
    SetEmbouchure,
    Vary,
)
from app.plan.by_hand.mark_corrections import OfMark, RemoveMark, SetMark
from app.plan.model import PlayerPlan
from app.project.casting import StagePosition
from app.project.check import faults
from app.project.edit import (
    breaths_and_cues,
    dance_corrections,
    dancers,
    events,
    generation,
    marks,
    notes,
    piece,
    players,
    takes,
    tempo,
)
from app.project.edit.corrections import take_back, with_corrections
from app.project.edit.found_events import events_of
from app.project.edit.placed_takes import BEFORE
from app.project.model import Project
from app.project.orphans import orphaned, reattached
from app.project.reimport import reimport
from app.project.storage import load, save
from app.project.undoable_document import Change, Document
from app.score.marks import WRITABLE
from app.score.take import Cleaning
from instrument_maps.load import bundled_maps
from tests.support.projects import expressions as any_expression
from tests.support.takes import take_of
from tests.unit.project.pieces import ANGRY, small_project

MAPS = bundled_maps()
NAME = Message("work.open")
Edit = Callable[[st.DataObject, Project], Project]

LABELS = ["0", "1", "2", "12", "13", "23", "123", "3", "7", "V"]
places = st.integers(0, 16).map(lambda eighths: 240 * eighths)
spans = st.tuples(places, st.integers(1, 6).map(lambda eighths: 240 * eighths))


def a_player(data: st.DataObject, project: Project) -> Any:
    return data.draw(st.sampled_from(project.players))


def some_notes(data: st.DataObject, project: Project) -> list[str]:
    ids = [note.id for part in project.score.parts for note in part.notes]
    return data.draw(st.lists(st.sampled_from(ids), min_size=1, max_size=4, unique=True)) if ids else []


def a_correction(data: st.DataObject, project: Project) -> tuple[str, Correction] | None:
    """About something the player really does."""
    player = a_player(data, project)
    played = project.part(player).notes
    if not played:
        return None
    note = data.draw(st.sampled_from([note.id for note in played]))
    first, length = data.draw(spans)
    share = data.draw(st.sampled_from([0.0, 0.4, 1.0]))
    plan = Performance(project).plan(player)
    gestures = [event.id for event in plan.gestures] or ["sway:@0"]
    faces = [event.id for event in plan.expressions]
    removable = [event.id for group in (plan.breaths, plan.cues, plan.gestures, plan.expressions) for event in group]
    name = data.draw(st.sampled_from(["a", "b", "c"]))
    made: list[Correction] = [
        PinFingering(note, data.draw(st.sampled_from(LABELS))),
        SetBreath(note, -120, -10, 0.2 + share / 2, data.draw(st.sampled_from(["breath", "preparation"]))),
        SetCue(note, 1.0 + share),
        SetEmbouchure(note, tension=share),
        AddGesture(name, "bell_height", first, first + length, share),
        AddExpression(name, data.draw(st.sampled_from(["smile", "angry"])), first, first + length, share),
        PoseCorrection(name, "head", first, first + length, up_deg=3.0),
        Vary(name, first, first + length, 7),
        ChangeGesture(data.draw(st.sampled_from(gestures)), amount=share),
        ChangeExpression(data.draw(st.sampled_from(faces)), strength=share),
        RemoveEvent(data.draw(st.sampled_from(removable))),
        SetMark(data.draw(st.sampled_from(["staccato", "breath", "trill"])), note),
        SetMark("dynamic", start_tick=first, end_tick=data.draw(st.sampled_from([None, first + length])), text="pp"),
        RemoveMark("slur", note, played[-1].id),
    ]
    return player.id, data.draw(st.sampled_from(made))


def add_correction(data: st.DataObject, project: Project) -> Project:
    drawn = a_correction(data, project)
    return project if drawn is None else with_corrections(project, drawn[0], [drawn[1]])


def forget_correction(data: st.DataObject, project: Project) -> Project:
    player = a_player(data, project)
    own = project.corrections.get(player.id, ())
    return take_back(project, player.id, [data.draw(st.sampled_from(own))]) if own else project


def edit_event(data: st.DataObject, project: Project) -> Project:
    player = a_player(data, project)
    plan = Performance(project).plan(player)
    ids = [event.id for group in (plan.breaths, plan.cues, plan.gestures, plan.expressions) for event in group]
    if not ids:
        return project
    chosen = [data.draw(st.sampled_from(ids))]
    ticks = data.draw(st.sampled_from([-240, -1, 60, 480]))
    kind = data.draw(st.integers(0, 4))
    if kind == 0:
        return events.move(project, plan, chosen, ticks).project
    if kind == 1:
        return events.resize(project, plan, chosen, ticks)
    if kind == 2:
        return events.set_amounts(project, plan, {chosen[0]: 0.3})
    if kind == 3:
        return events.remove(project, plan, chosen)
    return breaths_and_cues.add_breath(project, plan, data.draw(places)).project


def edit_notes(data: st.DataObject, project: Project) -> Project:
    chosen = some_notes(data, project)
    tick = data.draw(places)
    match data.draw(st.integers(0, 9)):
        case 0:
            return notes.add_note(project, a_player(data, project).part_id, tick, 240, 62, 80)[0]
        case 1:
            return notes.move(
                project, chosen, data.draw(st.sampled_from([-240, 0, 960])), data.draw(st.integers(-3, 3))
            )
        case 2:
            return notes.resize(
                project, chosen, data.draw(st.sampled_from([-120, 240])), at_start=data.draw(st.booleans())
            )
        case 3:
            return notes.split(project, chosen, tick)[0]
        case 4:
            return notes.join(project, chosen)
        case 5:
            return notes.duplicate(project, chosen, 1920)[0]
        case 6:
            return notes.set_velocity(project, chosen, data.draw(st.integers(-1, 128)))
        case 7:
            return notes.quantise(project, chosen, Fraction(1, 3), 0.5, ends=True)
        case 8:
            return notes.paste(project, a_player(data, project).part_id, notes.copied(project, chosen), tick)[0]
        case _:
            return notes.change_velocity(project, chosen, 5)


def edit_marks(data: st.DataObject, project: Project) -> Project:
    """Write and take away marks over notes, change one, delete or revert one."""
    player = a_player(data, project)
    kind = data.draw(st.sampled_from([*WRITABLE, "dynamic"]))
    chosen = set(some_notes(data, project))
    mine = {player.id: [note for note in project.part(player).notes if note.id in chosen]}
    project = marks.toggle_marks(project, mine, kind, "mf" if kind == "dynamic" else "").project
    known = list(marks.player_marks(project, player.id))
    if not known:
        return project
    mark = data.draw(st.sampled_from(known))
    match data.draw(st.integers(0, 3)):
        case 0:
            return events.remove(project, Performance(project).plan(player), [mark.id])
        case 1:
            return events.give_back(project, player.id, [mark.id])
        case 2 if not mark.note_id:
            moved = msgspec.structs.replace(mark, tick=data.draw(places), end_tick=0)
            if mark.end_tick:
                moved = msgspec.structs.replace(moved, end_tick=moved.tick + 240)
            return marks.replace_mark(project, player.id, mark, moved)
        case _:
            return project


def edit_players(data: st.DataObject, project: Project) -> Project:
    chosen = [a_player(data, project).id]
    match data.draw(st.integers(0, 10)):
        case 0:
            return players.rename(project, chosen[0], data.draw(st.sampled_from(["Anna", "anna", "", "../x"])))
        case 1:
            return players.set_parameters(project, chosen, amplitude=data.draw(st.floats(-1.0, 2.0)), cue_leader=True)
        case 2:
            return players.reset_parameters(project, chosen)
        case 3:
            return players.randomise(project, [player.id for player in project.players], data.draw(st.floats(0.0, 1.0)))
        case 4:
            return players.change(project, chosen, muted=data.draw(st.booleans()), colour="#102030")
        case 5:
            return players.arrange(project)
        case 6:
            return players.add_player(project, MAPS["trumpet_Bb"], MAPS, "")[0] if len(project.players) < 4 else project
        case 7:
            return players.duplicate_players(project, chosen)[0] if len(project.players) < 4 else project
        case 8:
            return players.move_players(project, chosen, data.draw(st.integers(0, len(project.players))))
        case 9:
            part = data.draw(st.sampled_from(project.score.parts))
            return players.assign(project, chosen[:1], part_id=part.id)
        case 10:
            return players.assign(project, chosen, instrument_id=data.draw(st.sampled_from(sorted(MAPS))))
        case _:
            return generation.vary_players(project, chosen)


def edit_dancers(data: st.DataObject, project: Project) -> Project:
    if not project.dancers:
        return dancers.add_dancer(project, "salsa", data.draw(st.sampled_from(["Anna", "trumpet", ""])))[0]
    chosen = [data.draw(st.sampled_from(project.dancers)).id]
    match data.draw(st.integers(0, 7)):
        case 0 if len(project.dancers) < 4:
            return dancers.add_dancer(project, "/dances/a.choreography", "Anna")[0]
        case 1 if len(project.dancers) < 4:
            return dancers.duplicate_dancers(project, chosen)[0]
        case 2:
            return dancers.rename_dancer(project, chosen[0], data.draw(st.sampled_from(["ANNA", "trombone", "", "/"])))
        case 3:
            delay = data.draw(st.floats(-1.0, 9.0))
            return dancers.change_dancers(project, chosen, delay_beats=delay, mirrored=data.draw(st.booleans()))
        case 4:
            return dancers.move_dancers(project, chosen, data.draw(st.integers(0, len(project.dancers))))
        case 5:
            return dancers.place_dancers(project, {chosen[0]: StagePosition(data.draw(st.floats(-9.0, 9.0)), 3.0, 0.5)})
        case _:
            return dancers.set_choreography(project, chosen, data.draw(st.sampled_from(["waltz", "no such thing"])))


def correct_dances(data: st.DataObject, project: Project) -> Project:
    if not project.dancers:
        return project
    chosen = data.draw(st.sampled_from(project.dancers)).id
    first, length = data.draw(spans)
    index = data.draw(st.integers(0, 3))
    match data.draw(st.integers(0, 4)):
        case 0:
            return dance_corrections.pin_state(project, chosen, first, index)
        case 1:
            return dance_corrections.use_segment(project, chosen, first, index)
        case 2:
            return dance_corrections.forbid_state(project, chosen, first, first + length, index)
        case 3:
            return dance_corrections.clear(project, chosen)
        case _:
            return dancers.remove_dancers(project, [chosen])


def edit_piece(data: st.DataObject, project: Project) -> Project:
    tick = data.draw(places)
    match data.draw(st.integers(0, 13)):
        case 0:
            return tempo.set_tempo(project, tick, data.draw(st.sampled_from([0.0, 60.0, 133.3])))
        case 1:
            return tempo.move_tempo(project, tick, data.draw(places))
        case 2:
            return tempo.remove_tempo(project, tick)
        case 3:
            return tempo.scale_tempo(project, data.draw(st.sampled_from([0.98, 1.0, 1.05])))
        case 4:
            return tempo.set_metre(
                project, tick, data.draw(st.integers(1, 7)), data.draw(st.sampled_from([2, 4, 8, 3]))
            )
        case 5:
            return tempo.remove_metre(project, tick)
        case 6:
            return tempo.set_pickup(project, tick)
        case 7:
            return piece.set_audio(project, data.draw(st.sampled_from([None, "/music/a.wav", "/music/b.wav"])))
        case 8:
            return piece.set_offset(project, data.draw(st.floats(-5.0, 5.0)))
        case 9:
            return piece.set_fps(project, data.draw(st.sampled_from([Fraction(24), Fraction(30000, 1001)])))
        case 10:
            return piece.put_expression(project, data.draw(st.sampled_from([ANGRY]) | any_expression))
        case 11:
            return piece.put_expression(project, msgspec.structs.replace(ANGRY, name="mad"), former_name="angry")
        case 12:
            return piece.remove_expression(project, "angry")
        case _:
            return piece.set_felt_beat(project, data.draw(st.sampled_from([1.0, 1.5, 2.0])))


def another_performance(data: st.DataObject, project: Project) -> Project:
    first, length = data.draw(spans)
    chosen = [a_player(data, project).id]
    return data.draw(
        st.sampled_from(
            [
                lambda: generation.vary_everyone(project),
                lambda: generation.vary_players(project, chosen),
                lambda: generation.vary_span(project, chosen, first, first + length),
            ]
        )
    )()


def read_again(data: st.DataObject, project: Project) -> Project:
    """The MIDI file with a few notes fewer, some bars more, in another key."""
    gone = set(data.draw(st.lists(st.integers(0, 9), max_size=2)))
    later = data.draw(st.sampled_from([0, 1920]))
    after = data.draw(places)
    up = data.draw(st.sampled_from([0, 2]))
    parts = tuple(
        msgspec.structs.replace(
            part,
            id=f"{track}.1.1",
            notes=tuple(
                msgspec.structs.replace(
                    note,
                    id=f"{track}:{number}",
                    onset_tick=note.onset_tick + (later if note.onset_tick >= after else 0),
                    pitch=min(note.pitch + up, 127),
                )
                for number, note in enumerate(part.notes, 1)
                if number not in gone
            ),
        )
        for track, part in enumerate(project.score.parts, 1)
    )
    return reimport(project, msgspec.structs.replace(project.score, parts=parts), MAPS).project


def hang_on_another(data: st.DataObject, project: Project) -> Project:
    lost = orphaned(project)
    if not lost:
        return project
    orphan = data.draw(st.sampled_from(lost))
    played = project.part(project.player(orphan.player_id)).notes
    if not played:
        return project
    return reattached(project, orphan.player_id, orphan.correction, data.draw(st.sampled_from(played)).id)


played_notes = st.lists(
    st.tuples(
        st.integers(-4, 30).map(lambda eighths: eighths / 8.0),
        st.sampled_from([0.01, 0.03, 0.125, 0.14, 0.6]),
        st.integers(55, 75),
        st.sampled_from([0.0, 0.04, 0.3, 1.0]),
    ),
    max_size=8,
)
some_cleaning = st.builds(
    Cleaning,
    ghost_s=st.sampled_from([0.0, 0.05, 0.5]),
    ghost_loudness=st.sampled_from([0.0, 0.15, 1.0]),
    double_s=st.sampled_from([0.0, 0.03, 0.2]),
    overlap_s=st.sampled_from([0.0, 0.02]),
    quantise=st.sampled_from([0.0, 0.5, 1.0]),
    grid_quarters=st.sampled_from([0.25, 1 / 3, 16.0]),
    align=st.sampled_from([0.0, 0.0, 0.7, 1.0]),
)


def record(data: st.DataObject, project: Project, player_id: str) -> Project:
    """A take or two of a synthetic player who begins early, overlaps, repeats and sends what no one understands."""
    made = []
    for notes_played in data.draw(st.lists(played_notes, min_size=1, max_size=2)):
        notes_played = [(at, at + length, pitch, breath) for at, length, pitch, breath in notes_played]
        more = data.draw(st.lists(st.sampled_from([(0.2, "e00050"), (0.4, "d040"), (1.0, "f8"), (1.2, "b07b00")])))
        made.append(
            take_of(
                notes_played,
                more=sorted(more),
                start_s=-1.0,
                end_s=5.0,
                breathes=data.draw(st.booleans()),
                tempo_map=project.score.tempo_map,
            )
        )
    return takes.add_takes(project, player_id, made)[0]


def edit_takes(data: st.DataObject, project: Project) -> Project:
    if not any(recorded.takes for recorded in project.takes.values()):
        return record(data, project, a_player(data, project).id)
    player_id = data.draw(st.sampled_from([id for id, recorded in project.takes.items() if recorded.takes]))
    known = [take.id for take in project.takes[player_id].takes]
    take_id = data.draw(st.sampled_from(known))
    match data.draw(st.integers(0, 9)):
        case 0:
            return record(data, project, a_player(data, project).id)
        case 1:
            name = data.draw(st.sampled_from(["best", "", "\u202e", "x" * 999]))
            return takes.rename_take(project, player_id, take_id, name)
        case 2:
            return takes.colour_take(project, player_id, take_id, data.draw(st.sampled_from(["", "#102030"])))
        case 3:
            return takes.remove_take(project, player_id, take_id)
        case 4:
            return takes.move_take(project, player_id, take_id, data.draw(st.integers(0, len(known))))
        case 5:
            return takes.comp_whole(project, player_id, data.draw(st.sampled_from([BEFORE, *known])))
        case 6 | 7:
            first, length = data.draw(spans)
            owner = data.draw(st.sampled_from([BEFORE, *known]))
            return takes.comp(project, player_id, owner, first, first + length)
        case 8:
            beats_s = np.array([0.1, 0.6, 1.2, 1.7])
            return takes.follow_beats(project, player_id, take_id, beats_s)
        case _:
            return takes.set_cleaning(project, player_id, take_id, data.draw(some_cleaning))


KEEPING: list[Edit] = [edit_players, edit_dancers, edit_piece, another_performance, read_again, edit_takes, edit_takes]
"""Edits after which every correction must still exist, possibly moved with the music."""
OTHERS: list[Edit] = [
    correct_dances,
    add_correction,
    forget_correction,
    edit_event,
    edit_notes,
    edit_marks,
    hang_on_another,
]


class Day(RuleBasedStateMachine):
    def __init__(self) -> None:
        super().__init__()
        self.document = Document(small_project())
        self.past: list[Project] = []
        self.future: list[Project] = []
        self.reported: list[Change] = []
        self.folder = Path(tempfile.mkdtemp())
        self.document.observe(self.reported.append)
        self.performance = Performance(self.document.project)

    def teardown(self) -> None:
        shutil.rmtree(self.folder)

    def made(self, edit: Edit, data: st.DataObject) -> Project | None:
        before = self.document.project
        try:
            return edit(data, before)
        except AppError as error:
            text(error.message)
            return None

    def applied(self, project: Project) -> None:
        before = self.document.project
        self.document.apply(NAME, project)
        if project != before:
            self.past.append(before)
            self.future.clear()

    @initialize(data=st.data())
    def some_work_is_there(self, data: st.DataObject) -> None:
        for _ in range(3):
            self.applied(add_correction(data, self.document.project))

    @precondition(lambda self: self.document.project.players)
    @rule(edit=st.sampled_from(KEEPING), data=st.data())
    def something_that_keeps_corrections(self, edit: Edit, data: st.DataObject) -> None:
        before = self.document.project
        after = self.made(edit, data)
        if after is None:
            return
        for player in before.players:
            kinds = Counter(map(type, before.corrections.get(player.id, ())))
            assert kinds <= Counter(map(type, after.corrections.get(player.id, ()))), player.id
        for dancer in before.dancers:
            kinds = Counter(map(type, before.dance_corrections.get(dancer.id, ())))
            assert kinds <= Counter(map(type, after.dance_corrections.get(dancer.id, ()))), dancer.id
        self.applied(after)

    @precondition(lambda self: self.document.project.players)
    @rule(data=st.data())
    def somebody_records(self, data: st.DataObject) -> None:
        """Record a take and make it the whole part."""
        player_id = a_player(data, self.document.project).id
        after = record(data, self.document.project, player_id)
        self.applied(takes.comp_whole(after, player_id, after.takes[player_id].takes[-1].id))

    @precondition(lambda self: self.document.project.players)
    @rule(edit=st.sampled_from(OTHERS), data=st.data())
    def anything(self, edit: Edit, data: st.DataObject) -> None:
        after = self.made(edit, data)
        if after is not None:
            self.applied(after)

    @precondition(lambda self: len(self.document.project.players) > 1)
    @rule(data=st.data())
    def somebody_leaves(self, data: st.DataObject) -> None:
        player = a_player(data, self.document.project)
        after = players.remove_players(self.document.project, [player.id])
        assert player.id not in after.corrections
        self.applied(after)

    @precondition(lambda self: self.document.project.players)
    @rule(data=st.data(), steps=st.integers(1, 4), returns=st.booleans())
    def a_drag(self, data: st.DataObject, steps: int, returns: bool) -> None:
        """One step in the history, whatever the mouse did; none where it came back."""
        start, done = self.document.project, len(self.document.done)
        token = object()
        chosen = [a_player(data, start).id]
        amounts = data.draw(st.lists(st.floats(0.0, 1.0), min_size=steps, max_size=steps))
        if returns:
            amounts.append(start.player(chosen[0]).parameters.amplitude)
        for amount in amounts:
            self.document.apply(NAME, players.set_parameters(start, chosen, amplitude=amount), gesture=token)
        self.document.end_gesture()
        after = self.document.project
        if after == start:
            assert after is start
            assert len(self.document.done) == done
        else:
            assert len(self.document.done) == done + 1
            self.past.append(start)
        if any(amount != start.player(chosen[0]).parameters.amplitude for amount in amounts):
            self.future.clear()

    @precondition(lambda self: self.document.project.players)
    @rule(data=st.data(), steps=st.integers(1, 4))
    def a_drag_that_is_cancelled(self, data: st.DataObject, steps: int) -> None:
        """No step in the history, and the very project of before; a drag of someone else stays."""
        start, done, token = self.document.project, self.document.done, object()
        chosen = [player.id for player in start.players]
        for amount in data.draw(st.lists(st.floats(0.0, 1.0), min_size=steps, max_size=steps)):
            after = players.set_parameters(start, chosen, amplitude=amount)
            self.document.apply(NAME, after, gesture=token)
            if after is not start:
                self.future.clear()
        assert not self.document.cancel_gesture(object())
        moved = self.document.project is not start
        assert self.document.cancel_gesture(token) is moved
        assert self.document.project is start
        assert self.document.done == done

    @rule()
    def undo(self) -> None:
        before = self.document.project
        name = self.document.undo()
        assert (name is None) == (not self.past)
        if self.past:
            assert self.document.project is self.past[-1]
            self.past.pop()
            self.future.append(before)

    @rule()
    def redo(self) -> None:
        before = self.document.project
        name = self.document.redo()
        assert (name is None) == (not self.future)
        if self.future:
            assert self.document.project is self.future[-1]
            self.future.pop()
            self.past.append(before)

    @rule(reopen=st.booleans())
    def save_and_open(self, reopen: bool) -> None:
        path = self.folder / "piece.suisou"
        project = self.document.project
        save(project, path)
        self.document.mark_saved(project)
        assert self.document.is_saved
        back = load(path)
        assert back == project
        if reopen:
            self.document.open(back)
            self.past.clear()
            self.future.clear()

    @rule()
    def generate(self) -> None:
        """Every correction does what it says, or a problem says why it does not."""
        project = self.document.project
        self.performance = Performance(project, self.performance)
        anew = Performance(project)
        for player in project.players:
            plan = self.performance.plan(player)
            # What was taken over from before is what would be made anew.
            assert plan == anew.plan(player)
            for correction in project.corrections.get(player.id, ()):
                assert is_done(correction, plan, project.corrections[player.id]), correction

    @invariant()
    def the_project_is_sound(self) -> None:
        assert list(faults(self.document.project)) == []

    @invariant()
    def history_is_what_was_done(self) -> None:
        assert len(self.document.done) == len(self.past)
        assert [step.before for step in self.document.done] == self.past
        if self.reported:
            assert self.reported[-1].after is self.document.project


def is_done(correction: Correction, plan: PlayerPlan, others: tuple[Correction, ...]) -> bool:
    said = {str(value) for problem in plan.problems for value in problem.message.arguments.values()}
    event = events_of(plan).get(correction.about)
    if isinstance(correction, Vary):
        return True
    if isinstance(correction, OfMark):
        played = {event.note_id for event in plan.fingerings}
        return not correction.is_lost(played, ()) or str(correction.note_id) in said
    if isinstance(correction, RemoveEvent):
        # What is put there by hand again is there.
        by_hand = any(item.about == correction.event_id for item in others if item is not correction)
        return event is None or by_hand
    if event is not None and event.corrected:
        return not isinstance(correction, PinFingering) or event.label == correction.label
    taken_out = any(isinstance(item, RemoveEvent) and item.event_id == correction.about for item in others) or any(
        getattr(item, "moved_from", None) == getattr(correction, "note_id", "") for item in others
    )
    if isinstance(correction, PinFingering) and correction.label in said:
        return True
    anchors = {
        getattr(correction, field)
        for field in ("note_id", "event_id", "name", "expression")
        if getattr(correction, field, None) is not None
    }
    return taken_out or bool(anchors & said)


Day.TestCase.settings = settings(
    max_examples=30, stateful_step_count=25, deadline=None, suppress_health_check=list(HealthCheck)
)
TestDay = Day.TestCase
