"""``suisou inspect``: prints the contents of a file and the plans of its players."""

from __future__ import annotations

import argparse
import gc
import math
from collections.abc import Mapping, Sequence
from typing import TypeAlias

import numpy as np

from app.cli.commands import add_pitch_options
from app.cli.inspect_tables import Table, tables
from app.cli.options import add_ignored_option, add_rate_option, add_source_options, add_title_option, open_project
from app.cli.progress import find_holds
from app.cli.speech import ENGLISH, Speech, spoken
from app.cli.status import report_left_out
from app.cli.terminal import say, say_json
from app.contacts.breaks import by_time
from app.encoding import shown
from app.errors import Message
from app.export.arm_problems import all_arm_problems
from app.export.report import character_report
from app.performance.cast import attempt
from app.performance.ensemble import Performance
from app.performance.fact_sources import breath_source, note_sources, tempo_source
from app.performance.loudness import controller_input
from app.performance.performance_problems import all_problems, reported_lines
from app.plan.events_by_hand import AdditiveEvent, PoseEvent, StyleEvent
from app.plan.model import (
    BreathEvent,
    CueEvent,
    ExpressionEvent,
    FingeringEvent,
    GestureEvent,
    MuteEvent,
    PlayerPlan,
    TongueEvent,
)
from app.plan.music.pitch_bends import WRITTEN_BENDS, bends
from app.plan.problem_lines import with_names
from app.project.edit.marks import player_marks
from app.project.performers import Dancer, Player
from app.rig.characters.dressed_characters import character_title
from app.score.marks import Mark
from app.score.model import Note, Score
from app.score.mutes import is_muted
from app.score.tempo import TempoMap
from instrument_maps.fingering_words import fingering_words
from instrument_maps.model import InstrumentMap

Spanning: TypeAlias = BreathEvent | CueEvent | ExpressionEvent | GestureEvent | MuteEvent | PoseEvent | StyleEvent

COLLECTED_AFTER = 50_000
"""Number of new objects that starts a garbage collection. A report's objects live until it is printed, and with the
default a twelfth of the time goes into examining them again and again.
"""


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``suisou inspect``."""
    add_source_options(command)
    add_title_option(command)
    add_rate_option(command)
    add_ignored_option(command)
    command.add_argument("--json", action="store_true")
    add_pitch_options(command)
    contacts = command.add_mutually_exclusive_group()
    contacts.add_argument("--no-contacts", action="store_true")
    contacts.add_argument("--all-contacts", action="store_true")
    command.set_defaults(run=inspect)


def inspect(arguments: argparse.Namespace) -> int:
    """Print the file's plan and the players without a plan, and return the exit status."""
    thresholds = gc.get_threshold()
    gc.set_threshold(COLLECTED_AFTER)
    try:
        return _inspect(arguments)
    finally:
        gc.set_threshold(*thresholds)


def _inspect(arguments: argparse.Namespace) -> int:
    performance = Performance(open_project(arguments))
    if not arguments.no_contacts:
        find_holds(performance, performance.project.players)
    found = inspection(
        performance,
        speech=ENGLISH if arguments.json else spoken(),
        contacts=not arguments.no_contacts,
        without_limit=arguments.all_contacts,
        with_ignored=arguments.ignored,
    )
    if arguments.json:
        say_json(found)
    else:
        say(*tables(shown(arguments.file.name), found))
    left_out = attempt(performance.project.players, performance.instrument).left_out
    return report_left_out((one.player.name, spoken()(one.reason)) for one in left_out)


def inspection(
    performance: Performance,
    *,
    contacts: bool = True,
    without_limit: bool = False,
    with_ignored: bool = False,
    speech: Speech = ENGLISH,
) -> Table:
    """Return everything that ``inspect --json`` prints. Seconds are those of the performance; beats are quarters from
    tick 0.

    Parameters
    ----------
    contacts : bool
        Whether to generate all motion in order to check contacts.
    without_limit : bool
        Whether to check every player at the default frame rate, regardless of the time that this takes.
    with_ignored : bool
        Whether to list ignored problems among the warnings.
    speech : Speech
        Language of reasons, and notation of keys and pitches; `ENGLISH` for JSON.
    """
    project = performance.project
    score = project.score
    # Players whose instrument is missing are not planned.
    playable = attempt(project.players, performance.instrument)
    absent = {one.player.id for one in playable.left_out}
    if contacts:
        judged, notice = all_problems(performance, project.players, without_limit)
        # A piece with too much motion for its contacts has too much for arms, too.
        measured = project.players if notice is None or without_limit else ()
        arms, unmeasured = all_arm_problems(performance, measured, without_limit)
        problems = {id: by_time((*found, *arms.get(id, ()))) for id, found in judged.items()}
    else:
        problems = {player.id: performance.problems(player.id) for player in project.players}
        notice = unmeasured = None
    reported = [
        (player, *reported_lines(performance, player, problems[player.id], speech, with_ignored))
        for player in project.players
        if player.id not in absent
    ]
    return {
        **_piece(performance),
        "warnings": [
            *(speech(message) for message in score.warnings),
            *(speech(message) for message in (notice, unmeasured) if message is not None),
            *(f"{player.name}: {line}" for player, lines, _ in reported for line in lines),
        ],
        "ignored_problems": sum(ignored for _, _, ignored in reported),
        "unplayed": [
            {"name": part.name, "reason": speech(part.reason), "note_count": part.note_count} for part in score.unplayed
        ],
        "left_out": [{"player": one.player.name, "reason": speech(one.reason)} for one in playable.left_out],
        "players": [
            _player(performance, player, playable.made[player.id], speech)
            for player in project.players
            if player.id not in absent
        ],
        "dancers": [_dancer(dancer, speech) for dancer in project.dancers],
    }


def _piece(performance: Performance) -> Table:
    """Return the piece's settings, tempo and markers."""
    project = performance.project
    score, place = project.score, project.conducting
    return {
        "title": score.title,
        "fps": float(project.fps),
        "fps_exact": str(project.fps),
        "preroll_beats": project.preroll_beats,
        "felt_beat_quarters": project.felt_beat_quarters,
        "seed": project.seed,
        "section_intensity": project.section_intensity,
        "conductor": None if place is None else {"x_m": place.x_m, "z_m": place.z_m},
        "duration_s": score.tempo_map.seconds(float(score.sounding_end_tick)),
        "ticks_per_beat": score.ticks_per_quarter,
        "tempo": [{"tick": tick, "bpm": bpm} for tick, bpm in score.tempo_map.bpm],
        "tempo_source": tempo_source(score),
        "markers": [
            {"tick": marker.tick, "s": score.tempo_map.seconds(float(marker.tick)), "text": marker.text}
            for marker in score.markers
        ],
        "percussion_hits": len(score.percussion),
        "first_frame_s": performance.time_frame.first_frame_s,
    }


def _dancer(dancer: Dancer, speech: Speech) -> Table:
    return {
        "name": dancer.name,
        "choreography": shown(dancer.choreography),
        **_person(dancer, speech),
        "x_m": dancer.stage.x_m,
        "z_m": dancer.stage.z_m,
        "turn_deg": math.degrees(dancer.stage.turn_rad),
        **{
            field: getattr(dancer, field)
            for field in ("seed", "delay_beats", "mirrored", "source", "size", "weight", "melody")
        },
    }


def _person(one: Player | Dancer, speech: Speech) -> Table:
    """Return name and clothes of a performer's character."""
    person = character_report(one)
    return {
        "character": one.character_id,
        "character_title": character_title(one.character_id, speech.language),
        "outfit": person.outfit,
        "outfit_colours": person.outfit_colours,
    }


class _Reasons:
    """Makes sentences of the reasons for events, in which pitches, bars, beats and keys are named.

    Results are cached, since many events have equal reasons.
    """

    def __init__(self, score: Score, part_id: str, instrument: InstrumentMap, speech: Speech) -> None:
        self._score, self._part_id, self._instrument, self._speech = score, part_id, instrument, speech
        self._known: dict[int, tuple[Message, str]] = {}
        self._equal: dict[tuple[str, str], str] = {}

    def __call__(self, message: Message) -> str:
        known = self._known.get(id(message))
        if known is None:
            known = self._known[id(message)] = (message, self._sentence(message))
        return known[1]

    def _sentence(self, message: Message) -> str:
        key = message.id, repr(message.arguments)
        sentence = self._equal.get(key)
        if sentence is None:
            named = with_names(message, self._score, self._speech, self._part_id, self._instrument)
            sentence = self._equal[key] = self._speech(named)
        return sentence


def _player(performance: Performance, player: Player, instrument: InstrumentMap, speech: Speech) -> Table:
    plan = performance.plan(player)
    clock = performance.piece.clock
    part = performance.project.part(player)
    reason = _Reasons(performance.project.score, part.id, instrument, speech)
    fingerings = {event.note_id: event for event in plan.fingerings}
    played = [note for note in part.notes if note.id in fingerings]
    labels = {event.label for event in plan.fingerings}
    keys = {label: fingering_words(instrument, label, speech.language) for label in labels}
    loudness = {event.note_id: event.air for event in plan.embouchures}
    marks, blown = performance.marks(player), controller_input(part)
    tongues = {event.note_id: event for event in plan.tongues}
    corrections = performance.project.corrections.get(player.id, ())
    origins = player_marks(performance.project, player.id)
    bends_of_marks: dict[str, list[str]] = {}
    for mark in origins:
        if mark.kind in WRITTEN_BENDS:
            bends_of_marks.setdefault(mark.note_id, []).append(mark.kind)
    sources = note_sources(part, played, plan, corrections, clock.ticks_per_quarter)
    table = {
        "name": player.name,
        "instrument": player.instrument_id,
        "transposition_semitones": instrument.transposition_semitones,
        "part": part.name,
        "source": part.source,
        "musician": performance.project.musician(player).name,
        **_person(player, speech),
        # Only one of several simultaneous notes is played; the others are listed among the problems.
        "notes": [
            _note(note, fingerings[note.id], keys[fingerings[note.id].label], instrument, clock)
            | {
                **_tongued(tongues.get(note.id), reason),
                "bend": list(bent) or bends_of_marks.get(note.id, []),
                "loudness": loudness[note.id],
                "dynamic": marks[note.id],
                "muted": is_muted(part.muted, note.onset_tick),
                "sources": said,
            }
            for note, bent, said in zip(
                played, bends(played, None if blown is None else blown.bend), sources, strict=True
            )
        ],
        "breaths": [
            breath | {"source": breath_source(event)}
            for event, breath in zip(plan.breaths, _events(plan.breaths, clock, reason, "kind"), strict=True)
        ],
        "cues": _events(plan.cues, clock, reason, "", "peak_s", "beat_s", "downbeat_s", "takers"),
        "gestures": _events(plan.gestures, clock, reason, "kind", "amount"),
        "expressions": _events(plan.expressions, clock, reason, "expression", "strength", "fade_in_s", "fade_out_s"),
    }
    return table | _of_some_players(plan, clock, reason, origins, part.source)


def _of_some_players(
    plan: PlayerPlan, clock: TempoMap, reason: _Reasons, origins: Mapping[Mark, str], source: str
) -> Table:
    """Return those lists of a plan that are often empty: marks, poses, mutes, styles, additive curves.

    Parameters
    ----------
    origins : mapping of Mark to str
        Origin of each mark.
    source : str
        Origin of the mutes.
    """
    table: Table = {}
    if origins:
        table["marks"] = [_mark(mark) | {"source": origin} for mark, origin in origins.items()]
    if plan.poses:
        # Included only for a player whose hold was edited; other players have no such values.
        angles = ("up_deg", "left_deg", "roll_deg")
        table["poses"] = _events(plan.poses, clock, reason, "target", *angles, "fade_in_s", "fade_out_s")
    if plan.mutes:
        table["mutes"] = [event | {"source": source} for event in _events(plan.mutes, clock, reason, "kind")]
    if plan.styles:
        table["styles"] = _events(plan.styles, clock, reason, "style", "fade_in_s", "fade_out_s")
    if plan.additive:
        table["curves"] = _spans(plan.additive, clock, "channel", "low", "high")
    return table


def _mark(mark: Mark) -> Table:
    """Return a mark's kind, text, and notes or ticks."""
    if not mark.note_id:
        return {"kind": mark.kind, "tick": mark.tick, "end_tick": mark.end_tick or None, "text": mark.text}
    return {"kind": mark.kind, "note": mark.note_id, "last_note": mark.last_note_id or None, "text": mark.text}


def _tongued(event: TongueEvent | None, reason: _Reasons) -> Table:
    """Return the articulation at the start of a note as a table: slurred, or the tongue stroke with its reason."""
    if event is None:
        return {"articulation": "slurred", "tongue": "", "tongue_reason": ""}
    return {"articulation": event.articulation, "tongue": event.stroke, "tongue_reason": reason(event.reason)}


def _note(note: Note, fingering: FingeringEvent, keys: str, instrument: InstrumentMap, clock: TempoMap) -> Table:
    onset_s = clock.seconds(float(note.onset_tick))
    return {
        "id": note.id,
        "onset_tick": note.onset_tick,
        "duration_tick": note.duration_tick,
        "onset_s": onset_s,
        "duration_s": clock.seconds(float(note.onset_tick + note.duration_tick)) - onset_s,
        "pitch": note.pitch,
        "velocity": note.velocity,
        "fingering": fingering.label,
        "fingering_keys": keys,
        "controls": {
            control.name: fingering.controls.get(control.name, control.rest_value) for control in instrument.controls
        },
    }


def _events(
    events: Sequence[Spanning],
    clock: TempoMap,
    reason: _Reasons,
    what: str,
    *fields: str,
) -> list[Table]:
    """Return events as tables: the kind, times in seconds and beats, the named fields, and the reason.

    Parameters
    ----------
    what : str
        Name of the attribute with the kind; empty if the events have none.
    fields : str
        Names of the attributes to include.
    """
    return [
        span | {"reason": reason(event.reason)}
        for event, span in zip(events, _spans(events, clock, what, *fields), strict=True)
    ]


def _spans(
    events: Sequence[Spanning | AdditiveEvent],
    clock: TempoMap,
    what: str,
    *fields: str,
) -> list[Table]:
    """Return events as tables like `_events`, but without reasons."""
    seconds = np.array([(event.start_s, event.end_s) for event in events]).reshape(-1, 2)
    beats = clock.ticks(seconds) / clock.ticks_per_quarter
    return [
        {
            **({what: getattr(event, what)} if what else {}),
            "start_s": start_s,
            "end_s": end_s,
            "start_beat": start_beat,
            "end_beat": end_beat,
            **{field: getattr(event, field) for field in fields},
        }
        for event, (start_s, end_s), (start_beat, end_beat) in zip(
            events, seconds.tolist(), beats.tolist(), strict=True
        )
    ]
