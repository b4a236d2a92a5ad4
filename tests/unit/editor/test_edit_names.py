"""Names of edits of notes and events state the kind, the player and the place."""

from __future__ import annotations

from typing import NamedTuple

from app.editor.edit_names import edit_at_events, edit_of_events, edit_of_notes, edit_of_parameter, edit_of_players
from app.editor.selection import EventKey
from app.errors import Message
from app.messages import text
from app.performance.ensemble import Performance
from app.plan.model import BreathEvent
from app.project.model import Project
from app.project.performers import Player
from tests.gui.conftest import quartet_project


class Shown(NamedTuple):
    project: Project
    performance: Performance


def _breaths(performance: Performance, player: Player) -> list[BreathEvent]:
    return [one for one in performance.plan(player).breaths if one.kind == "breath"]


def test_one_event_says_its_kind_player_and_place() -> None:
    project = quartet_project()
    performance = Performance(project)
    performance.prepare()
    player = project.players[1]
    breath = _breaths(performance, player)[0]
    named = edit_of_events(Shown(project, performance), "edit.move_events", [EventKey(player.id, breath.id)])
    place = project.score.metre_map.label(breath.start_tick)
    assert named == Message("edit.move_event", {"event": "breath", "of": f"{player.name} · {place}"})
    assert place in text(named)
    # Without plans, the place is that of the event's note.
    unplanned = edit_of_events(
        Shown(project, Performance(project)), "edit.move_events", [EventKey(player.id, breath.id)]
    )
    note = next(note for note in project.part(player).notes if breath.id.endswith(note.id))
    assert unplanned.arguments["of"] == f"{player.name} · {project.score.metre_map.label(note.onset_tick)}"


def test_what_is_called_alike_for_every_kind_says_whose_and_where() -> None:
    project = quartet_project()
    shown = Shown(project, Performance(project))
    first, second = project.players[:2]
    early, late = project.part(first).notes[2], project.part(second).notes[7]
    keys = [EventKey(first.id, f"fingering:{early.id}"), EventKey(second.id, f"preparation:{late.id}")]
    one = edit_at_events(shown, "edit.toggle_preparation", keys[1:])
    label = project.score.metre_map.label
    assert text(one) == f"Toggle Breath Preparation ({second.name} · {label(late.onset_tick)})"
    both = edit_at_events(shown, "edit.give_back", keys)
    places = f"{label(early.onset_tick)}–{label(late.onset_tick)}"
    assert text(both) == f"Revert to Generated ({first.name}, {second.name} · {places})"


def test_several_events_say_how_many_and_from_where_to_where() -> None:
    project = quartet_project()
    performance = Performance(project)
    performance.prepare()
    keys = [EventKey(one.id, _breaths(performance, one)[place].id) for one in project.players[:3] for place in (0, 2)]
    named = edit_of_events(Shown(project, performance), "edit.remove_events", keys)
    assert (named.id, named.arguments["event"], named.arguments["count"]) == ("edit.remove_events", "breath", 6)
    players, _, places = str(named.arguments["of"]).partition(" · ")
    assert players == f"{project.players[0].name}, {project.players[1].name}, …"
    first, last = places.split("–")
    assert int(first.partition(".")[0]) < int(last.partition(".")[0])
    cue = EventKey(project.players[0].id, performance.plan(project.players[0]).cues[0].id)
    mixed = edit_of_events(Shown(project, performance), "edit.remove_events", [*keys, cue])
    assert mixed.arguments["event"] == "event"


def test_an_edit_of_players_names_the_first_ones_and_counts_the_rest() -> None:
    project = quartet_project()
    ids = [player.id for player in project.players]
    one, two, every = (edit_of_players(project, "edit.mute", chosen) for chosen in (ids[:1], ids[1::-1], ids))
    assert text(one) == "Mute Trumpet 1"
    assert text(two) == "Mute Trumpet 1, Trumpet 2"
    assert text(every) == "Mute Trumpet 1, Trumpet 2, … (4)"
    assert text(every, "ja") == "ミュート: Trumpet 1, Trumpet 2, … (4)"
    assert text(edit_of_parameter(project, "amplitude", ids[2:3])).endswith(": Trombone 1")


def test_an_edit_of_notes_says_whose_they_are_and_from_where_to_where() -> None:
    project = quartet_project()
    first, second = project.players[:2]
    mine, others = project.part(first).notes, project.part(second).notes
    label = project.score.metre_map.label
    one = edit_of_notes(project, "edit.pin_fingerings", {mine[3].id}, (first.id,))
    assert text(one) == f"Pin Fingering of 1 Note ({first.name} · {label(mine[3].onset_tick)})"
    several = edit_of_notes(project, "edit.move_notes", {mine[9].id, mine[4].id, others[6].id})
    ticks = (mine[4].onset_tick, mine[9].onset_tick, others[6].onset_tick)
    place = f"{label(min(ticks))}–{label(max(ticks))}"
    assert text(several) == f"Move 3 Notes ({first.name}, {second.name} · {place})"
    assert text(several, "ja") == f"音符を移動（3 個、{first.name}, {second.name} · {place}）"
