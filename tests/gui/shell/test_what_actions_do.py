"""Every action in the whole editor, triggered by its shortcut if it has one, compared with its required effect."""

from __future__ import annotations

import dataclasses
import traceback
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDialog, QLineEdit, QWidget

from app.editor.listening import RecordedTake
from app.editor.selection import Selection
from app.errors import Message
from app.plan.by_hand.corrections import AddGesture, PinFingering, RemoveEvent, SetBreath, SetCue, Vary
from app.plan.by_hand.mark_corrections import SetMark
from app.project.casting import StagePosition
from app.project.edit.notes import move
from app.project.edit.players import change, join, place, set_parameters
from app.project.edit.takes import set_cleaning
from app.project.model import Project, map_choices
from app.project.piece_metadata import load_metadata, metadata_of, save_metadata
from app.rig.people.wardrobe import OutfitChoice
from app.score.marks import MARK_KINDS, WRITABLE, WRITABLE_DYNAMICS
from app.score.model import Note
from app.score.read import read_midi
from app.score.take import Cleaning
from app.shell.action_rows import rows
from app.shell.commands.timeline import LANES
from app.shell.first_steps.tour import FirstSteps
from instrument_maps.load import bundled_maps
from metadata.library import FOLDERS
from tests.gui.conftest import QUARTET
from tests.support.desk import (
    Deed,
    Desk,
    a_breath,
    afresh,
    dancing,
    has_percussion,
    has_recording,
    has_video,
    onset_s,
    recorded,
    recorded_and_taken,
)
from tests.support.tasks import ImmediateTasks
from tests.support.windows import child, show_in_front, wait_until
from widgets.common.actions import actions
from widgets.players.choreography.dancers import DancersSection

Right = Callable[[Desk], bool]


@dataclasses.dataclass(frozen=True)
class Case:
    """Required effect of an action.

    Attributes
    ----------
    right : callable
        Whether it did it.
    ready : callable
        What the user did before.
    edits : bool
        Whether the project is another one afterwards; then undo gives back the very same.
    """

    right: Right
    ready: Deed = lambda desk: None
    edits: bool = False


def typing_name(field: str) -> Right:
    """Return whether a name is being typed."""

    def right(desk: Desk) -> bool:
        found = desk.program.window.players.findChild(QLineEdit, field)
        return found is not None and found.isVisible()

    return right


def two_players_in_turn(desk: Desk) -> None:
    """The second player begins when the first has ended; both are selected."""
    first, second = desk.project.players[:2]
    ids = [note.id for note in desk.project.part(second).notes]
    later = move(desk.project, ids, desk.project.score.end_tick + 8 * 480, 0)
    desk.session.document.apply(Message("edit.move_notes", {"count": len(ids), "of": ""}), later)
    desk.session.set_players((first.id, second.id))


def wear_what_is_not_here(desk: Desk) -> None:
    edited = change(desk.project, [desk.player.id], outfit=OutfitChoice("elsewhere", "#102030"))
    desk.session.document.apply(Message("edit.player_outfit", {"of": "Trumpet 1"}), edited)


def joined(desk: Desk) -> None:
    two_players_in_turn(desk)
    first, second = desk.session.players
    desk.session.document.apply(Message("edit.join_players", {"of": "Trumpet 1"}), join(desk.project, second, first))


def each(desk: Desk, true: Callable[[Note, Note], bool]) -> bool:
    pairs = desk.chosen()
    return bool(pairs) and all(after is not None and true(note, after) for note, after in pairs)


def pitch_by(by: int) -> Case:
    return Case(lambda d: each(d, lambda a, b: b.pitch - a.pitch == by), edits=True)


def louder_by(by: int) -> Case:
    return Case(lambda d: each(d, lambda a, b: b.velocity - a.velocity == by), edits=True)


def moved(sign: int, quarters: float | None) -> Case:
    def right(desk: Desk) -> bool:
        score = desk.project.score
        fps = float(desk.project.fps)

        def true(a: Note, b: Note) -> bool:
            if quarters is not None:
                return b.onset_tick - a.onset_tick == round(sign * quarters * score.ticks_per_quarter)
            seconds = score.tempo_map.seconds
            return abs(seconds(float(b.onset_tick)) - seconds(float(a.onset_tick)) - sign / fps) < 0.004

        return each(desk, true)

    return Case(right, edits=True)


def typed(desk: Desk, label: str) -> None:
    """Select a note that has a fingering with this label; the piece may contain none."""
    for player in desk.project.players:
        instrument = desk.session.performance.instrument(player)
        for note in desk.project.part(player).notes:
            labels = [fingering.label for fingering in instrument.fingerings_for(note.pitch)]
            if label in labels:
                desk.session.set_players((player.id,))
                desk.session.select(Selection(frozenset({note.id})))
                desk.seen["typed"] = (player.id, note.id)
                return
    desk.seen["typed"] = None


def type_case(sign: str) -> Case:
    def right(desk: Desk) -> bool:
        if desk.seen["typed"] is None:
            # No instrument here has it: nothing happens, and the user is informed or it is the beginning of a longer
            # one.
            return desk.project is desk.before
        player_id, note_id = desk.seen["typed"]
        return PinFingering(note_id, sign) in desk.project.corrections[player_id]

    return Case(right, lambda desk: typed(desk, sign))


def gesture_case(kind: str) -> Case:
    return Case(lambda d: [item.kind for item in d.made(AddGesture)] == [kind], edits=True)  # type: ignore[attr-defined]


def mark_case(kind: str, text: str = "") -> Case:
    """Case in which the selected notes get the mark."""

    def right(desk: Desk) -> bool:
        made = [item.mark for item in desk.made(SetMark)]  # type: ignore[attr-defined]
        notes = [note for note, _ in desk.chosen()]
        at_ticks = MARK_KINDS[kind].anchor in ("place", "span")
        stands = {mark.tick if at_ticks else mark.note_id for mark in made}
        expected = {notes[0].onset_tick} if at_ticks else {note.id for note in notes}
        return bool(stands) and stands <= expected and {(mark.kind, mark.text) for mark in made} == {(kind, text)}

    return Case(right, edits=True)


def pinned(desk: Desk) -> None:
    ids = sorted(desk.session.selection.notes)
    actions(desk.session)["fingering.cycle"].trigger()
    assert desk.session.selection.notes == frozenset(ids)
    if not desk.project.corrections.get(desk.player.id):
        actions(desk.session)["events.breath"].trigger()


def several(desk: Desk) -> None:
    desk.session.set_players(tuple(player.id for player in desk.project.players[:2]))


def at(seconds: float) -> Deed:
    return lambda desk: desk.session.set_playhead(seconds)


def remember(name: str, value: Callable[[Desk], object]) -> Deed:
    def keep(desk: Desk) -> None:
        desk.seen[name] = value(desk)

    return keep


def span_s(desk: Desk) -> float:
    return desk.timeline.axis.span_s


def axis(ready: Deed, right: Callable[[float, float], bool]) -> Case:
    def begin(desk: Desk) -> None:
        ready(desk)
        desk.seen["span"] = span_s(desk)

    return Case(lambda d: right(d.seen["span"], span_s(d)), begin)


def playing(desk: Desk) -> bool:
    was = desk.session.playing
    desk.session.playback.stop()
    return was


def camera_kept(desk: Desk, number: int = 1) -> None:
    """Store the camera a number of times; the last bookmark is active."""
    for _ in range(number):
        actions(desk.session)["cameras.keep"].trigger()
    desk.seen["camera"] = desk.project.cameras[-1]


def camera_turned_away(desk: Desk, number: int = 1) -> None:
    camera_kept(desk, number)
    actions(desk.session)["viewport.other_side"].trigger()


def toggled(action_id: str, state: Callable[[Desk], object]) -> Case:
    return Case(lambda d: state(d) != d.seen["state"], remember("state", state))


def becomes(state: Callable[[Desk], object], requested: object, ready: Deed = lambda desk: None) -> Case:
    def begin(desk: Desk) -> None:
        ready(desk)
        assert state(desk) != requested, f"it is {requested} already"

    return Case(lambda d: state(d) == requested, begin)


def command(action_id: str) -> Deed:
    return lambda desk: actions(desk.session)[action_id].trigger()


def tool(name: str) -> Case:
    other = "draw" if name == "select" else "select"
    return becomes(lambda d: d.timeline.tool.value, name, command(f"notes.tool_{other}"))


def ghosts(name: str) -> Case:
    other = "all" if name == "ghosts" else "ghosts"
    return becomes(lambda d: d.timeline.ghosts.value, name, command(f"timeline.{other}"))


def view(name: str) -> Case:
    other = "front" if name == "ensemble" else "ensemble"
    return becomes(lambda d: d.session.viewport.view, name, command(f"viewport.{other}"))


def problem(desk: Desk) -> None:
    """Add an unplayable note, twice."""
    notes = desk.notes()
    for note in (notes[4], notes[10]):
        desk.session.select(Selection(frozenset({note.id})))
        for _ in range(4):
            actions(desk.session)["notes.octave_up"].trigger()
    desk.session.select(Selection())
    desk.session.set_playhead(0.0)


def within_bar_3(desk: Desk) -> None:
    desk.session.set_playhead(bar_s(desk, 3) + 0.4)
    places: list[float] = []
    desk.session.playhead_changed.connect(places.append)
    desk.seen["places"] = places


def began_at(desk: Desk) -> float:
    """First position of the playhead, which may have advanced by seconds on a slow machine."""
    places = desk.seen["places"]
    assert isinstance(places, list)
    return float(places[0])


def event_gone(desk: Desk) -> bool:
    return [item.event_id for item in desk.made(RemoveEvent)] == [desk.seen["event"]]  # type: ignore[attr-defined]


def chosen_event(desk: Desk) -> None:
    a_breath(desk)
    (key,) = desk.session.selection.events
    desk.seen["event"] = key.event_id


def paste_ready(desk: Desk) -> None:
    actions(desk.session)["notes.copy"].trigger()
    desk.session.set_playhead(desk.project.score.tempo_map.seconds(float(desk.project.score.end_tick)))


def own_source(desk: Desk) -> None:
    assert desk.project.source


def set_language(code: str) -> Deed:
    return lambda desk: desk.program.editor.speak(code)


def owners(desk: Desk) -> list[str]:
    """Ids of the takes that form the part, in order of time."""
    return [span.take_id for span in desk.project.takes[desk.player.id].comp]


def lanes(desk: Desk) -> list[str]:
    return [take.id for take in desk.project.takes[desk.player.id].takes]


def recorded_take(desk: Desk) -> RecordedTake | None:
    """The take under audition, which ends with the sound."""
    take = desk.session.listening.take
    assert playing(desk)
    assert desk.session.listening.take is None
    return take


def higher_by(desk: Desk, count: int) -> bool:
    before = [note.pitch for note in desk.notes(desk.before)]
    return [note.pitch for note in desk.notes()] == [pitch + count for pitch in before]


def named(desk: Desk) -> bool:
    field = child(desk.timeline.takes, QLineEdit, "take_name_field")
    QTest.keyClicks(field, "Best")
    QTest.keyClick(field, Qt.Key.Key_Return)
    return [take.name for take in desk.project.takes[desk.player.id].takes] == ["Take 1", "Best"]


def otherwise_cleaned(desk: Desk) -> None:
    recorded("take:1")(desk)
    desk.session.attempt(
        Message("edit.clean_take", {"take": "1"}),
        lambda project: set_cleaning(project, desk.player.id, "take:1", Cleaning(quantise=1.0)),
    )


def looping(desk: Desk) -> bool:
    score, notes = desk.project.score, [note for note, _ in desk.chosen()]
    seconds = score.tempo_map.seconds
    requested = (seconds(float(notes[0].onset_tick)), seconds(float(max(note.end_tick for note in notes))))
    return desk.session.loop_s is not None and np.allclose(desk.session.loop_s, requested)


def bar_s(desk: Desk, bar: int) -> float:
    score = desk.project.score
    return score.tempo_map.seconds(float(score.metre_map.tick_of_bar(bar)))


def go(ready_s: Callable[[Desk], float], requested_s: Callable[[Desk], float]) -> Case:
    return Case(
        lambda d: abs(d.session.playhead_s - requested_s(d)) < 1e-6, lambda d: d.session.set_playhead(ready_s(d))
    )


def reads_back(desk: Desk, path: Path) -> bool:
    """Return whether a MIDI file contains the players' notes."""
    score = read_midi(path, maps=map_choices(bundled_maps().values()))
    played = [(part.name, [(n.onset_tick, n.duration_tick, n.pitch) for n in part.notes]) for part in score.parts]
    return played == [
        (player.name, [(n.onset_tick, n.duration_tick, n.pitch) for n in desk.project.part(player).notes])
        for player in desk.project.players
    ]


FELT = {"eighth": 0.5, "quarter": 1.0, "dotted_quarter": 1.5, "half": 2.0, "dotted_half": 3.0}


def own_tables(desk: Desk) -> None:
    """Use a temporary folder for the user's tables, and a fake file manager."""
    desk.patch.setattr("app.shell.commands.piece_metadata.show_folder", lambda path: desk.seen.update(folder=path))
    for folder in FOLDERS:
        desk.patch.setenv(folder.variable, str(desk.folder / folder.name))


def has_metadata(desk: Desk) -> None:
    """Write metadata with other values for the first player."""
    project = set_parameters(desk.project, (desk.project.players[0].id,), style="jazz")
    desk.answers.path = desk.folder / "jazz.toml"
    save_metadata(metadata_of(project), desk.answers.path)


CASES: dict[str, Case] = {
    # Files
    "file.new": Case(lambda d: not d.project.players and d.program.editor.files.is_open),
    "file.open": Case(
        lambda d: d.answers.asked == ["open", "import"] and len(d.project.players) == 4 and d.project is not d.before,
        lambda d: setattr(d.answers, "path", QUARTET),
    ),
    "file.open_example": Case(lambda d: len(d.project.players) == 4 and d.project is not d.before),
    "file.open_danced_example": Case(
        lambda d: (
            len(d.project.players) == 4
            and [dancer.choreography for dancer in d.project.dancers] == ["salsa"]
            and len(d.project.score.percussion) > 100
        )
    ),
    "file.save": Case(
        lambda d: (d.folder / "saved.suisou").is_file() and d.session.document.is_saved,
        lambda d: setattr(d.answers, "path", d.folder / "saved.suisou"),
    ),
    "file.save_as": Case(
        lambda d: (d.folder / "other.suisou").is_file() and d.program.editor.files.path == d.folder / "other.suisou",
        lambda d: setattr(d.answers, "path", d.folder / "other"),
    ),
    "file.import_midi": Case(
        lambda d: "import" in d.answers.asked and len(d.project.players) == 4 and d.project is not d.before,
        lambda d: setattr(d.answers, "path", QUARTET),
    ),
    "file.reimport": Case(lambda d: d.dialog("reimport_midi"), own_source),
    "file.reimport_other": Case(
        lambda d: d.answers.asked == ["open"] and d.dialog("reimport_midi"),
        lambda d: setattr(d.answers, "path", QUARTET),
    ),
    "file.add_audio": Case(
        lambda d: d.project.audio is not None and d.project.audio.path.endswith("tone.wav"),
        lambda d: (has_recording(d), d.session.document.undo(), setattr(d.answers, "path", d.folder / "tone.wav")),
        edits=True,
    ),
    "file.add_video": Case(
        lambda d: d.project.video is not None and d.project.video.path.endswith("film.mp4"),
        lambda d: (has_video(d), d.session.document.undo(), setattr(d.answers, "path", d.folder / "film.mp4")),
        edits=True,
    ),
    "file.export_midi": Case(
        lambda d: d.answers.asked == ["save"] and reads_back(d, d.folder / "piece.mid"),
        lambda d: setattr(d.answers, "path", d.folder / "piece"),
    ),
    "file.save_metadata": Case(
        lambda d: (
            d.answers.asked == ["save"]
            and load_metadata(d.folder / "piece.toml") == metadata_of(d.project)
            and d.project is d.before
        ),
        lambda d: setattr(d.answers, "path", d.folder / "piece"),
    ),
    "file.load_metadata": Case(
        lambda d: [player.parameters.style for player in d.project.players] == ["jazz", *["section_player"] * 3],
        lambda d: has_metadata(d),
        edits=True,
    ),
    "file.compare_metadata": Case(lambda d: d.dialog("metadata_differences"), lambda d: has_metadata(d)),
    "file.rules": Case(lambda d: d.dialog("rules")),
    "file.metadata_folder": Case(
        lambda d: d.seen["folder"] == d.folder and all((d.folder / folder.name).is_dir() for folder in FOLDERS),
        lambda d: own_tables(d),
    ),
    "file.close": Case(lambda d: not d.program.editor.files.is_open and d.program.window.start_page.isVisible()),
    "file.piece_settings": Case(lambda d: d.dialog("piece_settings")),
    "export.files": Case(lambda d: d.dialog("export_files")),
    "export.playblast": Case(lambda d: d.dialog("playblast")),
    "file.evaluation": Case(lambda d: d.dialog("evaluation")),
    "file.evaluation_results": Case(lambda d: d.dialog("evaluation_results")),
    # Notes
    "edit.undo": Case(lambda d: d.project is d.seen["first"], lambda d: (d.seen.update(first=d.project), louder(d))),
    "edit.redo": Case(
        lambda d: d.project is d.seen["louder"],
        lambda d: (louder(d), d.seen.update(louder=d.project), d.session.document.undo()),
    ),
    "notes.cut": Case(lambda d: all(after is None for _, after in d.chosen()), edits=True),
    "notes.copy": Case(
        lambda d: QApplication.clipboard().mimeData().hasFormat("application/x-suisou-notes+json"),
        lambda d: QApplication.clipboard().clear(),
    ),
    "notes.paste": Case(
        lambda d: len(d.notes()) == len(d.notes(d.before)) + 3 and len(d.session.selection.notes) == 3,
        paste_ready,
        edits=True,
    ),
    "notes.duplicate": Case(lambda d: len(d.notes()) == len(d.notes(d.before)) + 3, edits=True),
    "notes.select_all": Case(lambda d: d.session.selection.notes == {note.id for note in d.notes()}),
    "notes.select_none": Case(lambda d: not d.session.selection),
    "notes.select_pitch": Case(
        lambda d: (
            d.session.selection.notes
            == {note.id for note in d.notes() if note.pitch in {note.pitch for note, _ in d.chosen()}}
        )
    ),
    "notes.select_bar": Case(
        lambda d: (
            d.session.selection.notes
            == {
                note.id
                for note in d.notes()
                if d.project.score.metre_map.bar_of_tick(note.onset_tick)
                in {d.project.score.metre_map.bar_of_tick(chosen.onset_tick) for chosen, _ in d.chosen()}
            }
        )
    ),
    "notes.select_span": Case(
        lambda d: (
            d.session.selection.notes
            == {note.id for note in d.notes() if note.onset_tick < d.project.score.metre_map.tick_of_bar(3)}
        ),
        lambda d: d.session.select(Selection(span=(0, d.project.score.metre_map.tick_of_bar(3)))),
    ),
    **{f"notes.tool_{name}": tool(name) for name in ("select", "draw", "erase", "split")},
    "notes.split": Case(
        lambda d: len(d.notes()) == len(d.notes(d.before)) + 1,
        lambda d: d.session.set_playhead(
            d.project.score.tempo_map.seconds(float(d.notes()[4].onset_tick + d.notes()[4].duration_tick // 2))
        ),
        edits=True,
    ),
    "notes.join": Case(
        lambda d: len(d.notes()) == len(d.notes(d.before)) - 1,
        lambda d: (
            d.session.set_playhead(
                d.project.score.tempo_map.seconds(float(d.notes()[4].onset_tick + d.notes()[4].duration_tick // 2))
            ),
            d.session.select(Selection(frozenset({d.notes()[4].id}))),
            actions(d.session)["notes.split"].trigger(),
        ),
        edits=True,
    ),
    "notes.quantise": Case(lambda d: quantise_asked(d)),
    "notes.up": pitch_by(1),
    "notes.down": pitch_by(-1),
    "notes.octave_up": pitch_by(12),
    "notes.octave_down": pitch_by(-12),
    "notes.earlier": moved(-1, 0.25),
    "notes.later": moved(1, 0.25),
    "notes.frame_earlier": moved(-1, None),
    "notes.frame_later": moved(1, None),
    "notes.louder": louder_by(8),
    "notes.softer": louder_by(-8),
    "fingering.cycle": Case(
        lambda d: bool(d.made(PinFingering)), lambda d: d.session.select(Selection(with_alternates(d))), edits=True
    ),
    **{f"fingering.type_{sign.lower()}": type_case(sign) for sign in "01234567T"},
    **{f"marks.{kind}": mark_case(kind) for kind in WRITABLE},
    **{f"marks.dynamic_{text}": mark_case("dynamic", text) for text in WRITABLE_DYNAMICS},
    "marks.dynamic": Case(lambda d: d.menu("marks.dynamic_mf")),
    # Events
    "edit.delete": Case(event_gone, chosen_event, edits=True),
    "events.give_back": Case(
        lambda d: not d.project.corrections.get(d.player.id),
        lambda d: (d.session.select(Selection(with_alternates(d))), actions(d.session)["fingering.cycle"].trigger()),
        edits=True,
    ),
    "events.give_back_player": Case(lambda d: not d.project.corrections.get(d.player.id), pinned, edits=True),
    "events.breath": Case(
        lambda d: bool(d.made(SetBreath)),
        lambda d: d.session.select(Selection(frozenset({unbreathed(d)}))),
        edits=True,
    ),
    "events.preparation": Case(lambda d: bool(d.made(SetBreath) or d.made(RemoveEvent)), a_breath, edits=True),
    "events.cue": Case(lambda d: bool(d.made(SetCue)), edits=True),
    "events.gesture": Case(lambda d: d.menu("gesture.sway", "gesture.bell_height")),
    "events.style": Case(lambda d: d.menu("style_soloist")),
    "events.expression": Case(lambda d: d.menu("expression_strained")),
    "gesture.sway": gesture_case("sway"),
    "gesture.weight_shift": gesture_case("weight_shift"),
    "gesture.bell_height": gesture_case("bell_height"),
    "gesture.lower_instrument": gesture_case("lower_instrument"),
    "gesture.lean": gesture_case("lean"),
    "gesture.accent": gesture_case("accent"),
    "gesture.step": gesture_case("step"),
    "gesture.tap": gesture_case("tap"),
    "gesture.heel": gesture_case("heel"),
    "gesture.nod": gesture_case("nod"),
    "gesture.count": gesture_case("count"),
    "gesture.look_about": gesture_case("look_about"),
    "gesture.settle_grip": gesture_case("settle_grip"),
    "gesture.hold_still": gesture_case("hold_still"),
    "gesture.look_up": gesture_case("look_up"),
    "gesture.bow": gesture_case("bow"),
    # Players
    "dancers.add": Case(lambda d: len(d.project.dancers) == len(d.before.dancers) + 1, edits=True),
    "dancers.rename": Case(typing_name("dancer_name"), dancing),
    "dancers.duplicate": Case(lambda d: len(d.project.dancers) == 2, dancing, edits=True),
    "dancers.choreography": Case(lambda d: d.dialog("choreography"), dancing),
    "dancers.remove": Case(lambda d: d.project.dancers == (), dancing, edits=True),
    "players.rename": Case(typing_name("player_name")),
    "dancers.learn": Case(lambda d: d.dialog("learn_choreography")),
    "players.add": Case(lambda d: len(d.project.players) == len(d.before.players) + 1, edits=True),
    "players.duplicate": Case(lambda d: len(d.project.players) == len(d.before.players) + 1, edits=True),
    "players.remove": Case(
        lambda d: [p.id for p in d.project.players] == [p.id for p in d.before.players[1:]], edits=True
    ),
    "players.mute": Case(lambda d: [p.muted for p in d.project.players] == [True, False, False, False], edits=True),
    "players.solo": Case(lambda d: [p.soloed for p in d.project.players] == [True, False, False, False], edits=True),
    "players.mute_section": Case(
        lambda d: [p.muted for p in d.project.players] == [True, True, False, False], edits=True
    ),
    "players.solo_section": Case(
        lambda d: [p.soloed for p in d.project.players] == [True, True, False, False], edits=True
    ),
    "players.select_section": Case(lambda d: d.session.players == tuple(p.id for p in d.project.players[:2])),
    "players.grouped": Case(lambda d: not d.session.groups_players, lambda d: twice_the_players(d)),
    "players.fold_sections": Case(
        lambda d: all(d.session.folded.get(f"players_section_{name}") for name in ("trumpets", "trombones")),
        lambda d: twice_the_players(d),
    ),
    "players.hear_everyone": Case(
        lambda d: not any(p.muted or p.soloed for p in d.project.players), command("players.mute"), edits=True
    ),
    "players.join": Case(
        lambda d: [p.doubles for p in d.project.players[:2]] == ["", d.project.players[0].id],
        two_players_in_turn,
        edits=True,
    ),
    "players.separate": Case(
        lambda d: not any(p.doubles for p in d.project.players),
        joined,
        edits=True,
    ),
    "players.next": Case(lambda d: d.player is d.project.players[1]),
    "players.previous": Case(lambda d: d.player is d.project.players[-1]),
    "players.posture": Case(
        lambda d: d.project.players[0].parameters.posture != d.before.players[0].parameters.posture, edits=True
    ),
    "players.randomise": Case(
        lambda d: all(a.parameters != b.parameters for a, b in zip(d.before.players, d.project.players, strict=True)),
        edits=True,
    ),
    "players.dress_everyone": Case(
        lambda d: {player.outfit for player in d.project.players} == {OutfitChoice("elsewhere", "#102030")},
        lambda d: wear_what_is_not_here(d),
        edits=True,
    ),
    "players.arrange": Case(
        lambda d: d.project.players == d.seen["on the arc"],
        lambda d: place_by_hand(d),
        edits=True,
    ),
    "players.select_all": Case(lambda d: len(d.session.players) == 4),
    "players.reset": Case(
        lambda d: d.project.players[0].parameters == d.seen["as cast"],
        lambda d: (d.seen.update({"as cast": d.player.parameters}), actions(d.session)["players.randomise"].trigger()),
        edits=True,
    ),
    # How the timeline is seen
    "timeline.zoom_in": axis(lambda d: d.timeline.fit(), lambda a, b: b < 0.95 * a),
    "timeline.zoom_out": axis(lambda d: d.timeline.axis.show(4.0, 8.0), lambda a, b: b > 1.05 * a),
    "timeline.zoom_in_pitch": Case(
        lambda d: d.timeline.roll.row_px > 1.2 * d.seen["row"], remember("row", lambda d: d.timeline.roll.row_px)
    ),
    "timeline.zoom_out_pitch": Case(
        lambda d: d.timeline.roll.row_px < 0.9 * d.seen["row"], remember("row", lambda d: d.timeline.roll.row_px)
    ),
    "timeline.fit": axis(lambda d: d.timeline.axis.show(4.0, 8.0), lambda a, b: b > 10.0),
    "timeline.zoom_selection": Case(
        lambda d: (
            d.timeline.axis.start_s <= onset_s(d, 3)
            and onset_s(d, 5) < d.timeline.axis.end_s
            and span_s(d) < d.seen["span"]
        ),
        lambda d: (d.timeline.fit(), d.seen.update(span=span_s(d))),
    ),
    **{f"timeline.{name}": ghosts(name) for name in ("ghosts", "selected", "all", "alone")},
    "timeline.marks": toggled("timeline.marks", lambda d: d.timeline.marks_shown),
    **{
        f"timeline.count_{name}": becomes(
            lambda d: d.session.time_display,
            name,
            command("timeline.count_seconds" if name == "bars" else "timeline.count_bars"),
        )
        for name in ("bars", "seconds", "frames")
    },
    # The felt beat
    "beat.automatic": Case(lambda d: d.project.felt_beat_quarters is None, command("beat.half"), edits=True),
    **{
        f"beat.{name}": Case(lambda d, quarters=quarters: d.project.felt_beat_quarters == quarters, edits=True)
        for name, quarters in FELT.items()
    },
    # The viewport
    **{f"viewport.{name}": view(name) for name in ("ensemble", "front", "side", "top", "hands", "mouth", "feet")},
    "viewport.frame": Case(lambda d: d.seen["framed"] == [True], lambda d: framed(d)),
    "viewport.frame_all": Case(lambda d: d.seen["framed"] == [False], lambda d: framed(d)),
    **{
        f"viewport.{name}": toggled(f"viewport.{name}", lambda d, name=name: d.session.viewport.shows(name))
        for name in ("names", "skeleton", "contacts", "wireframe", "props")
    },
    "viewport.other_side": Case(
        lambda d: abs(d.viewport.camera.yaw_rad - d.seen["yaw_rad"]) > 0.1,
        lambda d: d.seen.update(yaw_rad=d.viewport.camera.yaw_rad),
    ),
    **{
        f"viewport.dolly_{name}": Case(
            lambda d, sign=sign: sign * (d.viewport.camera.distance_m - d.seen["distance_m"]) < 0.0,
            lambda d: d.seen.update(distance_m=d.viewport.camera.distance_m),
        )
        for name, sign in (("in", 1.0), ("out", -1.0))
    },
    "cameras.keep": Case(lambda d: len(d.project.cameras) == 1, edits=True),
    "cameras.update": Case(lambda d: d.project.cameras[0].yaw_rad != d.seen["camera"].yaw_rad, camera_turned_away),
    "cameras.rename": Case(lambda d: child(d.program.window, QLineEdit, "camera_name").isVisible(), camera_kept),
    "cameras.remove": Case(lambda d: not d.project.cameras, camera_kept, edits=True),
    **{
        f"cameras.recall_{number}": Case(
            lambda d: d.viewport.camera.yaw_rad == d.seen["camera"].yaw_rad,
            partial(camera_turned_away, number=number),
        )
        for number in range(1, 10)
    },
    "viewport.camera_follows_never": becomes(lambda d: d.session.viewport.camera_follows, "never"),
    "viewport.camera_follows_always": becomes(lambda d: d.session.viewport.camera_follows, "always"),
    "viewport.camera_follows_close_ups": becomes(
        lambda d: d.session.viewport.camera_follows,
        "close_ups",
        lambda d: d.session.viewport.set(camera_follows="never"),
    ),
    "viewport.follow_selection": toggled("viewport.follow_selection", lambda d: d.session.viewport.follows_selection),
    "viewport.pose": toggled("viewport.pose", lambda d: d.session.viewport.posing),
    # Playing
    "play.toggle": Case(playing),
    "play.bar": Case(lambda d: began_at(d) == bar_s(d, 3) and playing(d), within_bar_3),
    "play.stop": Case(
        lambda d: not d.session.playing,
        lambda d: (actions(d.session)["play.toggle"].trigger(), d.seen.update(playing=d.session.playing)),
    ),
    "play.loop": Case(looping),
    "play.to_start": go(lambda d: 5.0, lambda d: d.session.performance.time_frame.first_frame_s),
    "play.to_end": go(lambda d: 5.0, lambda d: d.project.score.tempo_map.seconds(float(d.project.score.end_tick))),
    "play.frame_back": go(lambda d: 60 / float(d.project.fps), lambda d: 59 / float(d.project.fps)),
    "play.frame_on": go(lambda d: 60 / float(d.project.fps), lambda d: 61 / float(d.project.fps)),
    "play.note_back": go(lambda d: onset_s(d, 4), lambda d: onset_s(d, 3)),
    "play.note_on": go(lambda d: onset_s(d, 4), lambda d: onset_s(d, 5)),
    "play.bar_back": go(lambda d: bar_s(d, 4), lambda d: bar_s(d, 3)),
    "play.bar_on": go(lambda d: bar_s(d, 4), lambda d: bar_s(d, 5)),
    **{
        f"play.speed_{percent}": becomes(
            lambda d: round(100 * d.session.listening.speed),
            percent,
            command("play.speed_75" if percent == 100 else "play.speed_100"),
        )
        for percent in (25, 50, 75, 100, 150, 200)
    },
    **{
        f"play.source_{source}": becomes(
            lambda d: d.session.listening.source,
            source,
            lambda d, source=source: (
                has_recording(d),
                d.session.listening.set(source="both" if source == "recording" else "recording"),
            ),
        )
        for source in ("recording", "synthesiser", "both")
    },
    "play.click": toggled("play.click", lambda d: d.session.listening.click),
    "play.percussion": Case(lambda d: not d.session.listening.percussion, has_percussion),
    "play.scrub": toggled("play.scrub", lambda d: d.session.listening.scrub_sound),
    "play.follow": toggled("play.follow", lambda d: d.session.follow),
    "play.estimate_offset": Case(lambda d: "estimate" in last_work(d), has_recording),
    "play.follow_recording": Case(lambda d: d.dialog("follow_recording"), has_recording),
    "play.fit_tempo": Case(lambda d: "estimate" in last_work(d), has_recording),
    "play.remove_recording": Case(lambda d: d.project.audio is None, has_recording, edits=True),
    # The reference video
    "video.beside": Case(
        lambda d: d.session.video.placement == "beside",
        lambda d: (has_video(d), d.session.video.set(placement="hidden")),
    ),
    "video.behind": Case(lambda d: d.session.video.placement == "behind", has_video),
    "video.hidden": Case(lambda d: d.session.video.placement == "hidden", has_video),
    "video.estimate_offset": Case(
        lambda d: works(d) == d.seen["works"] + 1 and "estimate" in last_work(d),
        lambda d: (has_video(d), QApplication.processEvents(), d.seen.update(works=works(d))),
    ),
    "video.remove": Case(lambda d: d.project.video is None, has_video, edits=True),
    # Generating
    "generate.everyone": Case(lambda d: d.project.seed != d.before.seed, edits=True),
    "generate.players": Case(
        lambda d: [a != b for a, b in zip(d.before.players, d.project.players, strict=True)] == [True] + 3 * [False],
        edits=True,
    ),
    "generate.bars": Case(lambda d: bool(d.made(Vary)), edits=True),
    "generate.bars_back": Case(
        lambda d: not d.project.corrections.get(d.player.id), command("generate.bars"), edits=True
    ),
    # Takes
    "takes.listen": Case(
        lambda d: recorded_take(d) == RecordedTake(d.player.id, "take:2", alone=False), recorded("take:2")
    ),
    "takes.listen_alone": Case(
        lambda d: recorded_take(d) == RecordedTake(d.player.id, "take:2", alone=True), recorded("take:2")
    ),
    "takes.whole": Case(lambda d: higher_by(d, 4) and owners(d) == ["take:2"], recorded("take:2"), edits=True),
    "takes.above": Case(
        lambda d: owners(d) == ["take:1"] and d.session.selection.take == "take:1",
        recorded("take:2", (0, 4000)),
        edits=True,
    ),
    "takes.below": Case(
        lambda d: owners(d) == ["take:2"] and d.session.selection.take == "take:2",
        recorded("take:1", (0, 4000)),
        edits=True,
    ),
    "takes.before": Case(
        lambda d: owners(d) == [] and len(d.before.takes[d.player.id].comp) == 1, recorded_and_taken, edits=True
    ),
    "takes.rename": Case(named, recorded("take:2"), edits=True),
    "takes.earlier_lane": Case(lambda d: lanes(d) == ["take:2", "take:1"], recorded("take:2"), edits=True),
    "takes.later_lane": Case(lambda d: lanes(d) == ["take:2", "take:1"], recorded("take:1"), edits=True),
    "takes.usual_cleaning": Case(
        lambda d: d.project.takes[d.player.id].takes[0].cleaning == Cleaning(), otherwise_cleaned, edits=True
    ),
    "takes.find_beats": Case(
        lambda d: d.project.score.tempo_map != d.before.score.tempo_map and owners(d) == ["take:1"],
        recorded("take:1", alone=True),
        edits=True,
    ),
    "takes.remove": Case(lambda d: lanes(d) == ["take:1"], recorded("take:2"), edits=True),
    "problems.next": Case(lambda d: d.session.selection.notes == {d.notes()[4].id}, problem),
    "problems.previous": Case(
        lambda d: len(d.session.selection.notes) == 1 and d.session.selection.notes != {d.notes()[4].id}, problem
    ),
    # The editor itself
    "application.palette": Case(lambda d: shown(d, d.program.window.palette_popup)),
    "application.full_screen": Case(
        lambda d: d.program.window.is_full_screen and not d.program.window.docks["timeline"].isVisible()
    ),
    **{
        f"panel.{name}": toggled(f"panel.{name}", lambda d, name=name: d.program.window.is_panel_shown(name))
        for name in ("players", "inspector", "timeline", "recording")
    },
    **{
        f"lanes.{name}": toggled(f"lanes.{name}", lambda d, name=name: d.program.window.timeline.is_lane_open(name))
        for name in LANES
    },
    "lanes.stacked": Case(lambda d: d.program.window.timeline.players.active, command("players.select_all")),
    "lanes.fold_all": becomes(lambda d: any(map(d.program.window.timeline.is_lane_open, LANES)), False),
    "lanes.unfold_all": becomes(
        lambda d: any(lane.folded for lane in d.program.window.timeline.lanes.values() if not lane.isHidden()),
        False,
        command("lanes.fold_all"),
    ),
    "workspace.animate": becomes(lambda d: d.program.window.workspaces.current, "animate", command("workspace.check")),
    "workspace.record": becomes(lambda d: d.program.window.workspaces.current, "record"),
    "workspace.check": becomes(lambda d: d.program.window.workspaces.current, "check"),
    "workspace.reset": becomes(
        lambda d: {name: not dock.isHidden() for name, dock in d.program.window.docks.items()},
        {"players": False, "inspector": True, "timeline": True, "recording": False},
        lambda d: (
            d.program.window.choose_workspace("check"),
            d.program.window.docks["players"].show(),
            d.program.window.docks["timeline"].hide(),
        ),
    ),
    "pitch.concert": becomes(lambda d: d.session.pitch_display.written, False, command("pitch.written")),
    "pitch.written": becomes(lambda d: d.session.pitch_display.written, True),
    "pitch_octave.c4": becomes(lambda d: d.session.pitch_display.middle_c_octave, 4, command("pitch_octave.c3")),
    "pitch_octave.c3": becomes(lambda d: d.session.pitch_display.middle_c_octave, 3),
    "pitch_names.letters": becomes(lambda d: d.session.pitch_display.names, "letters", command("pitch_names.german")),
    "pitch_names.german": becomes(lambda d: d.session.pitch_display.names, "german"),
    "pitch_names.syllables": becomes(lambda d: d.session.pitch_display.names, "syllables"),
    "theme.dark": becomes(lambda d: d.session.tokens.name, "dark", command("theme.light")),
    "theme.light": becomes(lambda d: d.session.tokens.name, "light"),
    "language.en": becomes(lambda d: actions(d.session)["file.save"].text(), "Save", set_language("ja")),
    "language.ja": becomes(lambda d: actions(d.session)["file.save"].text(), "保存"),
    "application.instruments": Case(lambda d: d.dialog("instruments")),
    "application.preferences": Case(lambda d: d.dialog("preferences")),
    "application.shortcuts": Case(lambda d: d.dialog("preferences")),
    "file.add_character": Case(lambda d: d.answers.asked[-1:] == ["open"]),
    "application.characters": Case(lambda d: d.dialog("characters")),
    "stream.toggle": Case(lambda d: d.session.streaming.on and len(d.session.streaming.lines) == 1),
    "stream.settings": Case(lambda d: d.dialog("stream")),
    "record.devices": Case(lambda d: d.dialog("midi_devices")),
    "record.latency": Case(lambda d: d.dialog("latency")),
    "record.toggle": Case(lambda d: d.session.recording.running and d.session.playing),
    "record.arm": Case(lambda d: d.session.recording.armed == d.project.players[0].id),
    "record.punch": Case(lambda d: d.session.recording.punch and d.session.recording.punch_ticks == span_of_chosen(d)),
    "record.count_in_0": Case(lambda d: d.session.recording.count_in_bars == 0),
    "record.count_in_1": Case(
        lambda d: d.session.recording.count_in_bars == 1, lambda d: d.session.recording.set(count_in_bars=0)
    ),
    "record.count_in_2": Case(lambda d: d.session.recording.count_in_bars == 2),
    "help.first_steps": Case(
        lambda d: d.project.source.endswith("quartet.mid") and d.program.window.findChild(FirstSteps) is not None
    ),
    "help.guides": Case(lambda d: d.dialog("help")),
    "help.here": Case(lambda d: d.dialog("help")),
    "application.about": Case(lambda d: d.dialog("about")),
    # Last: it ends the editor.
    "file.quit": Case(lambda d: not d.program.window.isVisible()),
}


def span_of_chosen(desk: Desk) -> tuple[int, int]:
    chosen = [note for note in desk.notes() if note.id in desk.session.selection.notes]
    return min(note.onset_tick for note in chosen), max(note.end_tick for note in chosen)


def louder(desk: Desk) -> None:
    actions(desk.session)["notes.louder"].trigger()
    assert len(desk.session.document.done) == 1


def with_alternates(desk: Desk) -> frozenset[str]:
    instrument = desk.session.performance.instrument(desk.player)
    found = [note.id for note in desk.notes() if len(instrument.fingerings_for(note.pitch)) > 1]
    return frozenset(found[:1])


def unbreathed(desk: Desk) -> str:
    """Select a note without a breath before it."""
    breathed = {breath.id.partition(":")[2] for breath in desk.plan.breaths}
    return next(note.id for note in desk.notes()[4:] if note.id not in breathed)


def twice_the_players(desk: Desk) -> None:
    """Double the players, so that the list shows sections."""
    desk.session.set_groups_players(True)
    for name in ("players.select_all", "players.duplicate"):
        actions(desk.session)[name].trigger()


def place_by_hand(desk: Desk) -> None:
    desk.seen["on the arc"] = desk.project.players
    there = {desk.player.id: StagePosition(0.3, 1.2, 0.25)}
    desk.session.attempt(Message("edit.place_players", {"of": "Trumpet 1"}), lambda project: place(project, there))


def framed(desk: Desk) -> None:
    reported: list[object] = []
    desk.seen["framed"] = reported
    desk.session.viewport.framed.connect(reported.append)


def last_work(desk: Desk) -> str:
    tasks = desk.program.tasks
    assert isinstance(tasks, ImmediateTasks)
    return " ".join(name.id for name in tasks.names[-4:])


def works(desk: Desk) -> int:
    assert isinstance(desk.program.tasks, ImmediateTasks)
    return len(desk.program.tasks.names)


def shown(desk: Desk, widget: QWidget) -> bool:
    was = widget.isVisible()
    widget.hide()
    return was


def quantise_asked(desk: Desk) -> bool:
    popup = QApplication.activePopupWidget()
    found = [popup] if popup is not None else []
    found += [w for w in QApplication.topLevelWidgets() if isinstance(w, QDialog) and w.isVisible()]
    for widget in found:
        widget.close()
    return len(found) == 1


def focus(desk: Desk, context: str) -> QWidget:
    """Move the keyboard focus to the panel in which the shortcut applies."""
    window = desk.program.window
    # After a dialog was closed the display may take its time, and shortcuts belong to the active window.
    show_in_front(window)
    if context == "timeline":
        target: QWidget = desk.timeline.roll.plot
    elif context == "viewport":
        canvas = desk.viewport.canvas_widget()
        target = canvas if canvas is not None else desk.viewport
    elif context == "dancers":
        target = window.players.findChild(DancersSection).list
    elif context in window.panels:
        panel = window.panels[context]
        target = next(
            child
            for child in panel.findChildren(QWidget)
            if child.isVisible() and child.focusPolicy() & Qt.FocusPolicy.TabFocus and child.isEnabled()
        )
    else:
        target = window.palette_field
    target.setFocus()
    QApplication.processEvents()
    return target


def do(desk: Desk, action_id: str) -> None:
    """Trigger an action by its shortcut if it has one, else from its menu or the palette."""
    row = desk.program.editor.table.rows[action_id]
    keys = desk.program.editor.table.keys(action_id)
    action = actions(desk.session)[action_id]

    def is_enabled() -> bool:
        desk.program.editor.table.refresh()
        return action.isEnabled()

    # On a slow machine the plan is made beside the window.
    assert wait_until(is_enabled), "greyed out"
    if keys:
        target = focus(desk, row.context)
        sequence = QKeySequence.fromString(keys.split(";")[0], QKeySequence.SequenceFormat.PortableText)[0]
        QTest.keyClick(target, sequence.key(), sequence.keyboardModifiers())
    else:
        action.trigger()
    desk.settle()


def test_every_action_has_an_expectation() -> None:
    assert {row.id for row in rows()} == set(CASES)


NEED_PLAYERS_DRAWN = frozenset(
    {
        *(row.id for row in rows() if row.id.startswith("viewport.") or row.context == "viewport"),
        *("export.playblast", "file.evaluation"),
    }
)


@pytest.mark.drawn
def test_every_action_on_drawn_players_does_what_it_says(desk: Desk) -> None:
    check(desk, [action_id for action_id in CASES if action_id in NEED_PLAYERS_DRAWN])


def test_every_other_action_does_what_it_says(desk: Desk) -> None:
    check(desk, [action_id for action_id in CASES if action_id not in NEED_PLAYERS_DRAWN])


def check(desk: Desk, action_ids: list[str]) -> None:
    """Trigger actions one after another and report all failures together."""
    wrong: list[str] = []
    opened: Project | None = None
    for action_id in action_ids:
        case = CASES[action_id]
        opened = afresh(desk, opened)
        try:
            case.ready(desk)
            desk.settle()
            desk.before = desk.project
            steps = len(desk.session.document.done)
            do(desk, action_id)
            if not case.right(desk):
                wrong.append(f"{action_id}: not done")
            elif case.edits:
                assert len(desk.session.document.done) == steps + 1, f"{action_id}: one step"
                desk.session.document.undo()
                assert desk.project is desk.before, f"{action_id}: undo gives back the very same project"
            elif desk.session.document.is_saved and action_id.split(".")[0] in ("timeline", "viewport", "play"):
                assert desk.project is desk.before, f"{action_id}: it is no edit"
        except Exception:  # noqa: BLE001 - all that is wrong is reported at once
            wrong.append(f"{action_id}: {traceback.format_exc(limit=-2)}")
    assert not wrong, "\n".join(wrong)
