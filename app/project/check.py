"""Checks a project beyond field types: known names, unique ids, ordered times.

The same checks run after reading a file, after an edit and before saving, so that every accepted project can be saved
and read again.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import pairwise

from app.errors import UsageError
from app.project import limits
from app.project.camera_bookmarks import camera_faults
from app.project.check_corrections import project_correction_faults
from app.project.check_dancers import dancer_faults
from app.project.check_imported import import_faults
from app.project.check_score import controller_faults, metre_faults, note_faults, score_faults, tempo_faults
from app.project.check_stored import stored_faults
from app.project.frame_rate import is_storable_rate
from app.project.import_decisions import ReadTiming
from app.project.model import PlayerTakes, Project
from app.project.parameters import is_possible, range_text
from app.project.performers import Player
from app.project.recording import AudioTrack
from app.project.value_checks import (
    COLOUR,
    Fault,
    about,
    faults_at_key,
    faults_of_bounds,
    id_faults,
    look_faults,
    path_faults,
    text_faults,
    unique,
)
from app.project.video import VideoTrack
from app.score.take import Take, is_message
from metadata.model import ARKIT_MORPHS, Expression

_TAKE = re.compile(r"take:[1-9][0-9]{0,8}", re.ASCII)
_MORPHS = frozenset(ARKIT_MORPHS)


def faults(project: Project, before: Project | None = None) -> Iterator[Fault]:
    """Yield key path and description of every fault of a project; callers may stop at the first.

    Parameters
    ----------
    before : Project, optional
        A project known to be valid: objects shared with it are not checked again, so an edit costs only what it
        changes.
    """
    if before is None or project.score is not before.score:
        yield from faults_at_key("score", score_faults(project.score, None if before is None else before.score))
    yield from _player_faults(project, before)
    yield from project_correction_faults(project, before)
    yield from dancer_faults(project)
    yield from _setting_faults(project)
    yield from _read_faults(project, before)
    yield from _take_faults(project, before)
    yield from stored_faults(project, before)


def require_sound(project: Project, before: Project | None = None) -> None:
    """Raise UsageError for a project that could not be saved and read again.

    Parameters
    ----------
    before : Project, optional
        The project before the edit; faults that it already has are ignored, so that they do not block other edits.
    """
    known: frozenset[Fault] | None = None
    for fault in faults(project, before):
        if known is None:
            known = frozenset() if before is None else frozenset(faults(before))
        if fault not in known:
            raise UsageError("project.not_storable", place=fault[0], detail=fault[1])


def _read_faults(project: Project, before: Project | None) -> Iterator[Fault]:
    """Yield the faults in the stored notes of the MIDI file, in the order of the score."""
    known = {} if before is None else before.read_notes
    for part_id, notes in project.read_notes.items():
        if known.get(part_id) is notes:
            continue
        yield from id_faults("edited_notes", part_id)
        ordered = sorted(notes.values(), key=lambda note: (note.onset_tick, note.pitch))
        yield from note_faults(ordered, f"edited_notes[{part_id!r}]")
    if before is None or project.read_curves is not before.read_curves:
        for part_id, curves in project.read_curves.items():
            yield from id_faults("edited_curves", part_id)
            for index, curve in enumerate(curves):
                yield from controller_faults(curve, f"edited_curves[{part_id!r}][{index}]")
    timing, imported = project.read_timing, project.imported
    if timing is not None and (before is None or timing is not before.read_timing):
        yield from faults_at_key("read_timing", _timing_faults(timing))
    if imported is not None and (before is None or imported is not before.imported):
        yield from faults_at_key("imported", import_faults(imported))


def _timing_faults(timing: ReadTiming) -> Iterator[Fault]:
    yield from faults_of_bounds(
        "tempo_map.ticks_per_quarter", timing.tempo_map.ticks_per_quarter, limits.TICKS_PER_QUARTER
    )
    yield from tempo_faults(timing.tempo_map.changes)
    yield from metre_faults(timing.metres)
    yield from faults_of_bounds("pickup_ticks", timing.pickup_ticks, (0, limits.LAST_TICK))


def _player_faults(project: Project, before: Project | None) -> Iterator[Fault]:
    players = project.players
    if len(players) > limits.MOST_PLAYERS:
        yield "players", f"at most {limits.MOST_PLAYERS}"
    yield from unique("players", (player.id for player in players))
    yield from unique("players", (player.name.casefold() for player in players), "name")
    parts = {part.id for part in project.score.parts}
    musicians = {player.id: player for player in players}
    sound = frozenset() if before is None else frozenset(map(id, before.players))
    for index, player in enumerate(players):
        place = f"players[{index}]"
        if player.part_id not in parts:
            yield f"{place}.part_id", f"there is no part {player.part_id!r}"
        musician = musicians.get(player.doubles)
        if player.doubles and (musician is None or musician.doubles or musician is player):
            yield f"{place}.doubles", f"there is no player {player.doubles!r} with a body"
        if id(player) not in sound:
            yield from about(player, _one_player_faults(player, place))


def _one_player_faults(player: Player, place: str) -> Iterator[Fault]:
    for field in ("id", "instrument_id", "character_id"):
        yield from id_faults(f"{place}.{field}", getattr(player, field))
    yield from text_faults(f"{place}.name", player.name)
    yield from look_faults(player, place)
    for field in player.parameters.__struct_fields__:
        if not is_possible(field, getattr(player.parameters, field)):
            yield f"{place}.parameters.{field}", f"possible: {range_text(field)}"


def _take_faults(project: Project, before: Project | None) -> Iterator[Fault]:
    known = {player.id: player for player in project.players}
    all_takes = [take for recorded in project.takes.values() for take in recorded.takes]
    if len(all_takes) > limits.MOST_TAKES:
        yield "takes", f"at most {limits.MOST_TAKES}"
    yield from unique("takes", (take.id for take in all_takes))
    for player, recorded in project.takes.items():
        place = f"takes[{player!r}]"
        if player not in known:
            yield place, "there is no player of this id"
        if before is None or recorded is not before.takes.get(player):
            yield from about(known.get(player), _recorded_faults(recorded, place))


def _recorded_faults(recorded: PlayerTakes, place: str) -> Iterator[Fault]:
    for index, take in enumerate(recorded.takes):
        yield from take_faults(take, f"{place}.takes[{index}]")
    yield from _comp_faults(recorded, f"{place}.comp")
    yield from note_faults(recorded.before_notes, f"{place}.before_notes")
    for index, curve in enumerate(recorded.before_curves):
        yield from controller_faults(curve, f"{place}.before_curves[{index}]")


def take_faults(take: Take, place: str) -> Iterator[Fault]:
    """Yield key path and description of every fault in a take; ``place`` is the take's own key path."""
    if not _TAKE.fullmatch(take.id):
        yield f"{place}.id", 'must be like "take:1"'
    yield from text_faults(f"{place}.name", take.name)
    yield from text_faults(f"{place}.device", take.device)
    yield from text_faults(f"{place}.recorded", take.recorded)
    if take.colour and not COLOUR.fullmatch(take.colour):
        yield f"{place}.colour", 'must be empty or like "#3366cc"'
    yield from faults_of_bounds(f"{place}.wiring.channel", take.mapping.channel, (0, 16))
    for field, bounds in limits.CLEANING.items():
        yield from faults_of_bounds(f"{place}.cleaning.{field}", getattr(take.cleaning, field), bounds)
    yield from faults_at_key(place, tempo_faults(take.tempo_map.changes))
    yield from faults_of_bounds(
        f"{place}.tempo_map.ticks_per_quarter", take.tempo_map.ticks_per_quarter, limits.TICKS_PER_QUARTER
    )
    times = take.times_us
    if len(times) != len(take.messages):
        yield f"{place}.messages", "must be as many as the times"
    if len(times) > limits.MOST_TAKE_EVENTS:
        yield f"{place}.times_us", f"at most {limits.MOST_TAKE_EVENTS}"
    for value in (take.start_us, take.end_us, *times[:1], *times[-1:]):
        yield from faults_of_bounds(f"{place}.times_us", value, limits.TAKE_US)
    if take.start_us > take.end_us:
        yield f"{place}.end_us", "must not be before the start"
    if any(following < time for time, following in pairwise(times)):
        yield f"{place}.times_us", "must ascend"
    for raw in dict.fromkeys(take.messages):
        if not is_message(raw):
            yield f"{place}.messages[{take.messages.index(raw)}]", f"{raw[:20]!r} is no MIDI message in hexadecimal"
            return


def _comp_faults(recorded: PlayerTakes, place: str) -> Iterator[Fault]:
    known, end = {take.id for take in recorded.takes}, 0
    for index, span in enumerate(recorded.comp):
        if span.take_id not in known:
            yield f"{place}[{index}].take_id", f"there is no take {span.take_id!r}"
        if not end <= span.start_tick < span.end_tick <= limits.LAST_TICK:
            yield f"{place}[{index}].start_tick", "spans must be in order and apart"
            return
        end = span.end_tick


def _setting_faults(project: Project) -> Iterator[Fault]:
    yield from faults_of_bounds("seed", project.seed, limits.SEED)
    yield from faults_of_bounds("preroll_beats", project.preroll_beats, limits.PREROLL_BEATS)
    yield from faults_of_bounds("section_intensity", project.section_intensity, limits.SECTION_INTENSITY)
    if project.conductor is not None:
        yield from faults_of_bounds("conductor.x_m", project.conductor.x_m, limits.STAGE_M)
        yield from faults_of_bounds("conductor.z_m", project.conductor.z_m, limits.STAGE_M)
    if project.felt_beat_quarters is not None:
        yield from faults_of_bounds("felt_beat_quarters", project.felt_beat_quarters, limits.FELT_BEAT_QUARTERS)
    if not limits.FPS[0] <= project.fps <= limits.FPS[1]:
        yield "fps", f"must be from {limits.FPS[0]} to {limits.FPS[1]}"
    if not is_storable_rate(project.fps):
        yield "fps", "must be a fraction of whole numbers of at most nine digits"
    yield from path_faults("source", project.source)
    if project.audio is not None:
        yield from faults_at_key("audio", audio_faults(project.audio))
    if project.video is not None:
        yield from faults_at_key("video", track_faults(project.video))
    yield from camera_faults(project.cameras)
    yield from unique("expressions", (expression.name for expression in project.expressions), "name")
    for index, expression in enumerate(project.expressions):
        yield from expression_faults(expression, f"expressions[{index}]")


def expression_faults(expression: Expression, place: str) -> Iterator[Fault]:
    """Yield key path and description of every fault in an expression added by the animator; ``place`` is its own key
    path.
    """
    yield from id_faults(f"{place}.name", expression.name)
    yield from text_faults(f"{place}.description", expression.description)
    for morph, weight in expression.weights.items():
        if morph not in _MORPHS:
            yield f"{place}.weights.{morph}", "not one of the 52 ARKit morph targets"
        yield from faults_of_bounds(f"{place}.weights.{morph}", weight, (0.0, 1.0))
    for field in ("fade_in_s", "fade_out_s"):
        value = getattr(expression, field)
        if not 0.0 < value <= 60.0:
            yield f"{place}.{field}", "must be more than 0 and at most 60"


def track_faults(track: AudioTrack | VideoTrack) -> Iterator[Fault]:
    """Yield the faults in path, offset and confidence of a recording or video."""
    if not track.path:
        yield "path", "must be the path of a file"
    yield from path_faults("path", track.path)
    yield from faults_of_bounds("offset_s", track.offset_s, limits.OFFSET_S)
    if track.confidence is not None:
        yield from faults_of_bounds("confidence", track.confidence, (0.0, 1.0))


def audio_faults(audio: AudioTrack) -> Iterator[Fault]:
    """Yield key path and description of every fault in a recording and its alignment."""
    yield from track_faults(audio)
    for index, pin in enumerate(audio.pins):
        yield from faults_of_bounds(f"pins[{index}].tick", pin.tick, (0, limits.LAST_TICK))
        yield from faults_of_bounds(f"pins[{index}].recording_s", pin.recording_s, limits.OFFSET_S)
    if any(one.tick >= two.tick or one.recording_s >= two.recording_s for one, two in pairwise(audio.pins)):
        yield "pins", "ticks and seconds must rise"
    for index, doubt in enumerate(audio.doubts):
        yield from faults_of_bounds(f"doubts[{index}].confidence", doubt.confidence, (0.0, 1.0))
        if not 0 <= doubt.start_tick < doubt.end_tick <= limits.LAST_TICK:
            yield f"doubts[{index}].start_tick", "must be before the end"
    if any(one.end_tick > two.start_tick for one, two in pairwise(audio.doubts)):
        yield "doubts", "must be in order and apart"
