"""Checks a project beyond the types of its fields: names that exist, ids that are unique, times in order.

One check at every door: what a reader makes of a file, an edit of the project, and a save must all pass `faults`, so
that whatever got in can be saved and is read again.

Messages (`UsageError`): ``project.not_storable`` (place, detail).
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import pairwise

from app.errors import UsageError
from app.project import limits
from app.project.check_corrections import project_correction_faults
from app.project.check_dancers import dancer_faults
from app.project.check_imported import import_faults
from app.project.check_media import audio_faults, track_faults
from app.project.check_stored import stored_faults
from app.project.fault import (
    COLOUR,
    Fault,
    about,
    faults_at_key,
    faults_of_bounds,
    id_faults,
    in_order,
    look_faults,
    path_faults,
    text_faults,
    unique,
)
from app.project.frame_rate import is_storable_rate
from app.project.import_decisions import ReadTiming
from app.project.model import PlayerTakes, Project
from app.project.parameters import is_possible, range_text
from app.project.performers import Player
from app.score.limits import too_long
from app.score.marks import Mark
from app.score.metre_map import Metre
from app.score.model import ControllerCurve, Marker, Note, Part, PercussionHit, Score, value_range
from app.score.take import Take, is_message
from app.score.tempo import TempoChange
from metadata.model import ARKIT_MORPHS, Expression

_TAKE = re.compile(r"take:[1-9][0-9]{0,8}", re.ASCII)
_MORPHS = frozenset(ARKIT_MORPHS)


def faults(project: Project, before: Project | None = None) -> Iterator[Fault]:
    """Everything that is wrong, one by one as it is found; a caller may stop at the first.

    Parameters
    ----------
    before : Project, optional
        A project that is known to be sound: what is the same object in both is not looked at again, so that an edit
        costs what it changes.
    """
    if before is None or project.score is not before.score:
        yield from faults_at_key("score", _score_faults(project.score, None if before is None else before.score))
    yield from _player_faults(project, before)
    yield from project_correction_faults(project, before)
    yield from dancer_faults(project)
    yield from _setting_faults(project)
    yield from _read_faults(project, before)
    yield from _take_faults(project, before)
    yield from stored_faults(project, before)


def require_sound(project: Project, before: Project | None = None) -> None:
    """Raise UsageError ``project.not_storable`` for a project that could not be saved and read again.

    Parameters
    ----------
    before : Project, optional
        What the project was made from. A fault that it has too is not the edit's, and no other edit is refused for it.
    """
    known: frozenset[Fault] | None = None
    for fault in faults(project, before):
        if known is None:
            known = frozenset() if before is None else frozenset(faults(before))
        if fault not in known:
            raise UsageError("project.not_storable", place=fault[0], detail=fault[1])


def _read_faults(project: Project, before: Project | None) -> Iterator[Fault]:
    """Of what the MIDI file held, in the order of the score."""
    known = {} if before is None else before.read_notes
    for part_id, notes in project.read_notes.items():
        if known.get(part_id) is notes:
            continue
        yield from id_faults("edited_notes", part_id)
        ordered = sorted(notes.values(), key=lambda note: (note.onset_tick, note.pitch))
        yield from _note_faults(ordered, f"edited_notes[{part_id!r}]")
    if before is None or project.read_curves is not before.read_curves:
        for part_id, curves in project.read_curves.items():
            yield from id_faults("edited_curves", part_id)
            for index, curve in enumerate(curves):
                yield from _curve_faults(curve, f"edited_curves[{part_id!r}][{index}]")
    timing, imported = project.read_timing, project.imported
    if timing is not None and (before is None or timing is not before.read_timing):
        yield from faults_at_key("read_timing", _timing_faults(timing))
    if imported is not None and (before is None or imported is not before.imported):
        yield from faults_at_key("imported", import_faults(imported))


def _timing_faults(timing: ReadTiming) -> Iterator[Fault]:
    yield from faults_of_bounds(
        "tempo_map.ticks_per_quarter", timing.tempo_map.ticks_per_quarter, limits.TICKS_PER_QUARTER
    )
    yield from _tempo_faults(timing.tempo_map.changes)
    yield from _metre_faults(timing.metres)
    yield from faults_of_bounds("pickup_ticks", timing.pickup_ticks, (0, limits.LAST_TICK))


def _score_faults(score: Score, before: Score | None) -> Iterator[Fault]:
    yield from text_faults("title", score.title)
    yield from faults_of_bounds("ticks_per_quarter", score.ticks_per_quarter, limits.TICKS_PER_QUARTER)
    if score.tempo_map.ticks_per_quarter != score.ticks_per_quarter:
        yield "tempo_map.ticks_per_quarter", "differs from the score's"
    yield from _tempo_faults(score.tempo_map.changes)
    yield from _metre_faults(score.metres)
    yield from _marker_faults(score.markers)
    if before is None or score.percussion is not before.percussion:
        yield from _percussion_faults(score.percussion)
    if not score.metres or score.metres[0].tick != 0 or not score.tempo_map.changes or score.ticks_per_quarter < 1:
        # How long anything is cannot be said.
        return
    yield from faults_of_bounds("pickup_ticks", score.pickup_ticks, (0, limits.LAST_TICK))
    if score.pickup_ticks and (len(score.metres) < 2 or score.metres[1].tick != score.pickup_ticks):
        yield "pickup_ticks", "no metre begins after the pickup"
    yield from unique("parts", (part.id for part in score.parts))
    sound = frozenset() if before is None else frozenset(map(id, before.parts))
    for index, part in enumerate(score.parts):
        if id(part) not in sound:
            yield from _part_faults(part, f"parts[{index}]")
    yield from _note_id_faults(score.parts, () if before is None else before.parts)
    for index, unplayed in enumerate(score.unplayed):
        yield from text_faults(f"unplayed[{index}].name", unplayed.name)
        yield from faults_of_bounds(f"unplayed[{index}].end_tick", unplayed.end_tick, (0, limits.LAST_TICK))
        yield from faults_of_bounds(f"unplayed[{index}].note_count", unplayed.note_count, (0, limits.LAST_TICK))
        spans = f"unplayed[{index}].sounding"
        free = 0
        for number, (start, end) in enumerate(unplayed.sounding):
            yield from faults_of_bounds(f"{spans}[{number}][0]", start, (free, limits.LAST_TICK))
            yield from faults_of_bounds(f"{spans}[{number}][1]", end, (start, limits.LAST_TICK))
            free = end
    long = too_long(score)
    if long is not None:
        yield "parts", "longer than {most_hours} hours, {most_quarters} quarters or {most_bars} bars".format_map(long)


def _note_id_faults(parts: Sequence[Part], before: Sequence[Part]) -> Iterator[Fault]:
    """Ids of notes that appear twice in the piece."""
    old = {part.id: part for part in before}
    if all(
        part.id in old and len(part.note_ids) == len(part.notes) and part.note_ids <= old[part.id].note_ids
        for part in parts
        if part is not old.get(part.id)
    ):
        # No part has an id that it did not have.
        return
    seen: set[str] = set()
    for index, part in enumerate(parts):
        for number, note in enumerate(part.notes):
            if note.id in seen:
                yield f"parts[{index}].notes[{number}].id", f"{note.id!r} appears twice"
            seen.add(note.id)


def _tempo_faults(changes: Sequence[TempoChange]) -> Iterator[Fault]:
    place = "tempo_map.changes"
    yield from in_order(place, [change.tick for change in changes])
    for index, change in enumerate(changes):
        yield from faults_of_bounds(
            f"{place}[{index}].microseconds_per_quarter",
            change.microseconds_per_quarter,
            limits.MICROSECONDS_PER_QUARTER,
        )


def _metre_faults(metres: Sequence[Metre]) -> Iterator[Fault]:
    yield from in_order("metres", [metre.tick for metre in metres])
    for index, metre in enumerate(metres):
        place = f"metres[{index}]"
        yield from faults_of_bounds(f"{place}.numerator", metre.numerator, limits.METRE_NUMERATOR)
        if metre.denominator not in limits.METRE_DENOMINATORS:
            yield f"{place}.denominator", f"must be one of {', '.join(map(str, limits.METRE_DENOMINATORS))}"


def _marker_faults(markers: Sequence[Marker]) -> Iterator[Fault]:
    for index, marker in enumerate(markers):
        yield from faults_of_bounds(f"markers[{index}].tick", marker.tick, (0, limits.LAST_TICK))
        yield from text_faults(f"markers[{index}].text", marker.text)
        if index and marker.tick < markers[index - 1].tick:
            yield f"markers[{index}].tick", "markers must be ordered by tick"


def _percussion_faults(hits: Sequence[PercussionHit]) -> Iterator[Fault]:
    for index, hit in enumerate(hits):
        before = hits[index - 1] if index else hit
        # One comparison for the many hits that are sound.
        if (
            0 <= hit.tick <= limits.LAST_TICK
            and 0 <= hit.pitch <= 127
            and 1 <= hit.velocity <= 127
            and (before.tick, before.pitch) <= (hit.tick, hit.pitch)
        ):
            continue
        place = f"percussion[{index}]"
        yield from faults_of_bounds(f"{place}.tick", hit.tick, (0, limits.LAST_TICK))
        yield from faults_of_bounds(f"{place}.pitch", hit.pitch, (0, 127))
        yield from faults_of_bounds(f"{place}.velocity", hit.velocity, (1, 127))
        if (hit.tick, hit.pitch) < (before.tick, before.pitch):
            yield f"{place}.tick", "hits must be ordered by tick, then pitch"


def _part_faults(part: Part, place: str) -> Iterator[Fault]:
    yield from id_faults(f"{place}.id", part.id)
    yield from text_faults(f"{place}.name", part.name)
    yield from id_faults(f"{place}.map_id", part.map_id)
    yield from faults_of_bounds(f"{place}.channel", part.channel, (0, 15))
    yield from faults_of_bounds(f"{place}.track", part.track, (0, limits.LAST_TICK))
    yield from faults_of_bounds(f"{place}.voice", part.voice, (0, limits.LAST_TICK))
    yield from faults_of_bounds(f"{place}.transposed_semitones", part.transposed_semitones, (-127, 127))
    if part.program is not None:
        yield from faults_of_bounds(f"{place}.program", part.program, (0, 127))
    for name, spans in (("muted", part.muted), ("stopped", part.stopped)):
        for index, (start, end) in enumerate(spans):
            yield from faults_of_bounds(f"{place}.{name}[{index}][0]", start, (0, limits.LAST_TICK))
            yield from faults_of_bounds(f"{place}.{name}[{index}][1]", end, (start, limits.LAST_TICK))
        if spans != tuple(sorted(spans)):
            yield f"{place}.{name}", "spans must be ordered by start"
    yield from _note_faults(part.notes, f"{place}.notes")
    for index, mark in enumerate(part.marks):
        yield from faults_at_key(f"{place}.marks[{index}]", _mark_faults(mark))
    for index, curve in enumerate(part.curves):
        yield from _curve_faults(curve, f"{place}.curves[{index}]")


def _mark_faults(mark: Mark) -> Iterator[Fault]:
    yield from id_faults("note_id", mark.note_id, least=0)
    yield from id_faults("last_note_id", mark.last_note_id, least=0)
    yield from faults_of_bounds("tick", mark.tick, (0, limits.LAST_TICK))
    if mark.end_tick:
        yield from faults_of_bounds("end_tick", mark.end_tick, (mark.tick, limits.LAST_TICK))
    yield from text_faults("text", mark.text, limits.MOST_NAME)


def _note_faults(notes: Sequence[Note], place: str) -> Iterator[Fault]:
    for index, note in enumerate(notes):
        # One comparison for the many notes that are sound.
        if (
            0 <= note.onset_tick < note.end_tick <= limits.LAST_TICK
            and 0 <= note.pitch <= 127
            and 1 <= note.velocity <= 127
            and 0 < len(note.id) <= limits.MOST_ID
        ):
            continue
        at = f"{place}[{index}]"
        yield from id_faults(f"{at}.id", note.id)
        yield from faults_of_bounds(f"{at}.onset_tick", note.onset_tick, (0, limits.LAST_TICK))
        yield from faults_of_bounds(f"{at}.duration_tick", note.duration_tick, (1, limits.LAST_TICK - note.onset_tick))
        yield from faults_of_bounds(f"{at}.pitch", note.pitch, (0, 127))
        yield from faults_of_bounds(f"{at}.velocity", note.velocity, (1, 127))
    for index, (note, following) in enumerate(pairwise(notes), 1):
        if (following.onset_tick, following.pitch) < (note.onset_tick, note.pitch):
            yield f"{place}[{index}].onset_tick", "notes must be ordered by onset, then pitch"
            return


def _curve_faults(curve: ControllerCurve, place: str) -> Iterator[Fault]:
    if len(curve.ticks) != len(curve.values):
        yield f"{place}.values", "must be as many as the ticks"
    for index, (tick, following) in enumerate(pairwise(curve.ticks), 1):
        if following <= tick:
            yield f"{place}.ticks[{index}]", "ticks must ascend"
            return
    if curve.ticks and not (curve.ticks[0] >= 0 and curve.ticks[-1] <= limits.LAST_TICK):
        yield f"{place}.ticks", f"must be from 0 to {limits.LAST_TICK}"
    low, high = value_range(curve.kind)
    for index, value in enumerate(curve.values):
        if not low <= value <= high:
            yield f"{place}.values[{index}]", f"must be from {low:g} to {high:g}"
            return


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
    yield from _note_faults(recorded.before_notes, f"{place}.before_notes")
    for index, curve in enumerate(recorded.before_curves):
        yield from _curve_faults(curve, f"{place}.before_curves[{index}]")


def take_faults(take: Take, place: str) -> Iterator[Fault]:
    """What is wrong with a take, by itself."""
    if not _TAKE.fullmatch(take.id):
        yield f"{place}.id", 'must be like "take:1"'
    yield from text_faults(f"{place}.name", take.name)
    yield from text_faults(f"{place}.device", take.device)
    yield from text_faults(f"{place}.recorded", take.recorded)
    if take.colour and not COLOUR.fullmatch(take.colour):
        yield f"{place}.colour", 'must be empty or like "#3366cc"'
    yield from faults_of_bounds(f"{place}.wiring.channel", take.wiring.channel, (0, 16))
    for field, bounds in limits.CLEANING.items():
        yield from faults_of_bounds(f"{place}.cleaning.{field}", getattr(take.cleaning, field), bounds)
    yield from faults_at_key(place, _tempo_faults(take.tempo_map.changes))
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
    yield from unique("expressions", (expression.name for expression in project.expressions), "name")
    for index, expression in enumerate(project.expressions):
        yield from expression_faults(expression, f"expressions[{index}]")


def expression_faults(expression: Expression, place: str) -> Iterator[Fault]:
    """What is wrong with an expression of the animator's own."""
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
