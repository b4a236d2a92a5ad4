"""What makes a project sound beyond the types of its fields: names that exist, ids that are unique, times in order."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from typing import Any, TypeAlias

import msgspec

from app.errors import shortened
from app.plan.corrections import Correction
from app.project import limits
from app.project.model import AudioTrack, Player, PlayerTakes, Project
from app.project.parameters import is_possible, range_text
from app.score.limits import too_long
from app.score.model import ControllerCurve, Marker, Metre, Note, Part, Score
from app.score.take import Take, is_message
from app.score.tempo import TempoChange
from metadata.model import ARKIT_MORPHS, Expression

Fault: TypeAlias = tuple[str, str]
"""The key path, and what is wrong there."""

_COLOUR = re.compile(r"#[0-9a-fA-F]{6}", re.ASCII)
_TAKE = re.compile(r"take:[1-9][0-9]{0,8}", re.ASCII)
MOST_NAME = 60
"""Characters of a player's name in a message."""
_MORPHS = frozenset(ARKIT_MORPHS)


def faults(project: Project) -> Iterator[Fault]:
    """Everything that is wrong, one by one as it is found; whoever needs the first one only stops there."""
    yield from _within("score", _score_faults(project.score))
    yield from _player_faults(project)
    yield from _correction_faults(project)
    yield from _setting_faults(project)
    yield from _read_faults(project)
    yield from _take_faults(project)


def _read_faults(project: Project) -> Iterator[Fault]:
    """Of what the MIDI file held, in the order of the score."""
    for part_id, notes in project.read_notes.items():
        yield from _id("edited_notes", part_id)
        ordered = sorted(notes.values(), key=lambda note: (note.onset_tick, note.pitch))
        yield from _note_faults(ordered, f"edited_notes[{part_id!r}]")


def _score_faults(score: Score) -> Iterator[Fault]:
    yield from _text("title", score.title)
    yield from _between("ticks_per_quarter", score.ticks_per_quarter, limits.TICKS_PER_QUARTER)
    if score.tempo_map.ticks_per_quarter != score.ticks_per_quarter:
        yield "tempo_map.ticks_per_quarter", "differs from the score's"
    yield from _tempo_faults(score.tempo_map.changes)
    yield from _metre_faults(score.metres)
    yield from _marker_faults(score.markers)
    if not score.metres or score.metres[0].tick != 0 or not score.tempo_map.changes or score.ticks_per_quarter < 1:
        # How long anything is cannot be said.
        return
    yield from _between("pickup_ticks", score.pickup_ticks, (0, limits.LAST_TICK))
    if score.pickup_ticks and (len(score.metres) < 2 or score.metres[1].tick != score.pickup_ticks):
        yield "pickup_ticks", "no metre begins after the pickup"
    yield from _unique("parts", (part.id for part in score.parts))
    seen: set[str] = set()
    for index, part in enumerate(score.parts):
        place = f"parts[{index}]"
        yield from _part_faults(part, place)
        for number, note in enumerate(part.notes):
            if note.id in seen:
                yield f"{place}.notes[{number}].id", f"{note.id!r} appears twice"
            seen.add(note.id)
    for index, unplayed in enumerate(score.unplayed):
        yield from _text(f"unplayed[{index}].name", unplayed.name)
        yield from _between(f"unplayed[{index}].end_tick", unplayed.end_tick, (0, limits.LAST_TICK))
        yield from _between(f"unplayed[{index}].note_count", unplayed.note_count, (0, limits.LAST_TICK))
        heard = f"unplayed[{index}].sounding"
        free = 0
        for number, (start, end) in enumerate(unplayed.sounding):
            yield from _between(f"{heard}[{number}][0]", start, (free, limits.LAST_TICK))
            yield from _between(f"{heard}[{number}][1]", end, (start, limits.LAST_TICK))
            free = end
    long = too_long(score)
    if long is not None:
        yield "parts", "longer than {most_hours} hours, {most_quarters} quarters or {most_bars} bars".format_map(long)


def _tempo_faults(changes: Sequence[TempoChange]) -> Iterator[Fault]:
    place = "tempo_map.changes"
    yield from _in_order(place, [change.tick for change in changes])
    for index, change in enumerate(changes):
        yield from _between(
            f"{place}[{index}].microseconds_per_quarter",
            change.microseconds_per_quarter,
            limits.MICROSECONDS_PER_QUARTER,
        )


def _metre_faults(metres: Sequence[Metre]) -> Iterator[Fault]:
    yield from _in_order("metres", [metre.tick for metre in metres])
    for index, metre in enumerate(metres):
        place = f"metres[{index}]"
        yield from _between(f"{place}.numerator", metre.numerator, limits.METRE_NUMERATOR)
        if metre.denominator not in limits.METRE_DENOMINATORS:
            yield f"{place}.denominator", f"must be one of {', '.join(map(str, limits.METRE_DENOMINATORS))}"


def _marker_faults(markers: Sequence[Marker]) -> Iterator[Fault]:
    for index, marker in enumerate(markers):
        yield from _between(f"markers[{index}].tick", marker.tick, (0, limits.LAST_TICK))
        yield from _text(f"markers[{index}].text", marker.text)
        if index and marker.tick < markers[index - 1].tick:
            yield f"markers[{index}].tick", "markers must be ordered by tick"


def _part_faults(part: Part, place: str) -> Iterator[Fault]:
    yield from _id(f"{place}.id", part.id)
    yield from _text(f"{place}.name", part.name)
    yield from _id(f"{place}.map_id", part.map_id)
    yield from _between(f"{place}.channel", part.channel, (0, 15))
    yield from _between(f"{place}.track", part.track, (0, limits.LAST_TICK))
    yield from _between(f"{place}.voice", part.voice, (0, limits.LAST_TICK))
    yield from _between(f"{place}.transposed_semitones", part.transposed_semitones, (-127, 127))
    if part.program is not None:
        yield from _between(f"{place}.program", part.program, (0, 127))
    yield from _note_faults(part.notes, f"{place}.notes")
    for index, curve in enumerate(part.curves):
        yield from _curve_faults(curve, f"{place}.curves[{index}]")


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
        yield from _id(f"{at}.id", note.id)
        yield from _between(f"{at}.onset_tick", note.onset_tick, (0, limits.LAST_TICK))
        yield from _between(f"{at}.duration_tick", note.duration_tick, (1, limits.LAST_TICK - note.onset_tick))
        yield from _between(f"{at}.pitch", note.pitch, (0, 127))
        yield from _between(f"{at}.velocity", note.velocity, (1, 127))
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
    low = -1.0 if curve.kind == "pitch_bend" else 0.0
    for index, value in enumerate(curve.values):
        if not low <= value <= 1.0:
            yield f"{place}.values[{index}]", f"must be from {low:g} to 1"
            return


def _player_faults(project: Project) -> Iterator[Fault]:
    players = project.players
    if len(players) > limits.MOST_PLAYERS:
        yield "players", f"at most {limits.MOST_PLAYERS}"
    yield from _unique("players", (player.id for player in players))
    yield from _unique("players", (player.name.casefold() for player in players), "name")
    parts = {part.id for part in project.score.parts}
    for index, player in enumerate(players):
        place = f"players[{index}]"
        if player.part_id not in parts:
            yield f"{place}.part_id", f"there is no part {player.part_id!r}"
        yield from _of(player, _one_player_faults(player, place))


def _one_player_faults(player: Player, place: str) -> Iterator[Fault]:
    for field in ("id", "instrument_id", "character_id"):
        yield from _id(f"{place}.{field}", getattr(player, field))
    yield from _text(f"{place}.name", player.name)
    if player.colour and not _COLOUR.fullmatch(player.colour):
        yield f"{place}.colour", 'must be empty or like "#3366cc"'
    yield from _between(f"{place}.stage.x_m", player.stage.x_m, limits.STAGE_M)
    yield from _between(f"{place}.stage.z_m", player.stage.z_m, limits.STAGE_M)
    yield from _between(f"{place}.stage.turn_rad", player.stage.turn_rad, limits.TURN_RAD)
    for field in player.parameters.__struct_fields__:
        if not is_possible(field, getattr(player.parameters, field)):
            yield f"{place}.parameters.{field}", f"possible: {range_text(field)}"


def _correction_faults(project: Project) -> Iterator[Fault]:
    known = {player.id: player for player in project.players}
    for player, corrections in project.corrections.items():
        if player not in known:
            yield f"corrections[{player!r}]", "there is no player of this id"
        for index, correction in enumerate(corrections):
            found = _one_correction_faults(correction, f"corrections[{player!r}][{index}]")
            yield from _of(known.get(player), found)


def _one_correction_faults(correction: Correction, place: str) -> Iterator[Fault]:
    for field in correction.__struct_fields__:
        yield from _plain_faults(f"{place}.{field}", getattr(correction, field))


def _plain_faults(place: str, value: Any) -> Iterator[Fault]:
    """A value of whatever kind a correction has: texts and numbers of a sane size."""
    if isinstance(value, str):
        if len(value) > limits.MOST_ID:
            yield place, f"at most {limits.MOST_ID} characters"
    elif isinstance(value, int | float):
        if place.endswith(("_tick", "_ticks")):
            yield from _between(place, value, (-limits.LAST_TICK, limits.LAST_TICK))
        elif isinstance(value, float):
            yield from _between(place, value, (-limits.MOST_NUMBER, limits.MOST_NUMBER))
        elif abs(value) > limits.SEED[1]:
            yield place, f"must be from {-limits.SEED[1]} to {limits.SEED[1]}"
    elif isinstance(value, tuple | list):
        for index, item in enumerate(value):
            yield from _plain_faults(f"{place}[{index}]", item)
    elif isinstance(value, dict):
        for key, item in value.items():
            yield from _plain_faults(f"{place}[{key!r}]", item)
    elif isinstance(value, msgspec.Struct):
        for field in value.__struct_fields__:
            yield from _plain_faults(f"{place}.{field}", getattr(value, field))


def _take_faults(project: Project) -> Iterator[Fault]:
    known = {player.id: player for player in project.players}
    all_takes = [take for recorded in project.takes.values() for take in recorded.takes]
    if len(all_takes) > limits.MOST_TAKES:
        yield "takes", f"at most {limits.MOST_TAKES}"
    yield from _unique("takes", (take.id for take in all_takes))
    for player, recorded in project.takes.items():
        place = f"takes[{player!r}]"
        if player not in known:
            yield place, "there is no player of this id"
        yield from _of(known.get(player), _recorded_faults(recorded, place))


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
    yield from _text(f"{place}.name", take.name)
    yield from _text(f"{place}.device", take.device)
    yield from _text(f"{place}.recorded", take.recorded)
    if take.colour and not _COLOUR.fullmatch(take.colour):
        yield f"{place}.colour", 'must be empty or like "#3366cc"'
    yield from _between(f"{place}.wiring.channel", take.wiring.channel, (0, 16))
    yield from _plain_faults(f"{place}.cleaning", take.cleaning)
    for field in take.cleaning.__struct_fields__:
        low, high = limits.CLEANING[field]
        yield from _between(f"{place}.cleaning.{field}", getattr(take.cleaning, field), (low, high))
    yield from _within(place, _within("tempo_map", _tempo_faults(take.tempo_map.changes)))
    yield from _between(
        f"{place}.tempo_map.ticks_per_quarter", take.tempo_map.ticks_per_quarter, limits.TICKS_PER_QUARTER
    )
    times = take.times_us
    if len(times) != len(take.messages):
        yield f"{place}.messages", "must be as many as the times"
    if len(times) > limits.MOST_TAKE_EVENTS:
        yield f"{place}.times_us", f"at most {limits.MOST_TAKE_EVENTS}"
    for value in (take.start_us, take.end_us, *times[:1], *times[-1:]):
        yield from _between(f"{place}.times_us", value, limits.TAKE_US)
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
    yield from _between("seed", project.seed, limits.SEED)
    yield from _between("preroll_beats", project.preroll_beats, limits.PREROLL_BEATS)
    if project.felt_beat_quarters is not None:
        yield from _between("felt_beat_quarters", project.felt_beat_quarters, limits.FELT_BEAT_QUARTERS)
    if not limits.FPS[0] <= project.fps <= limits.FPS[1]:
        yield "fps", f"must be from {limits.FPS[0]} to {limits.FPS[1]}"
    yield from _text("source", project.source)
    if "\0" in project.source:
        yield "source", "must be the path of a MIDI file"
    if project.audio is not None:
        yield from _within("audio", _audio_faults(project.audio))
    yield from _unique("expressions", (expression.name for expression in project.expressions), "name")
    for index, expression in enumerate(project.expressions):
        yield from expression_faults(expression, f"expressions[{index}]")


def _audio_faults(audio: AudioTrack) -> Iterator[Fault]:
    yield from _text("path", audio.path)
    if not audio.path or "\0" in audio.path:
        yield "path", "must be the path of a recording"
    yield from _between("offset_s", audio.offset_s, limits.OFFSET_S)
    if audio.confidence is not None:
        yield from _between("confidence", audio.confidence, (0.0, 1.0))


def expression_faults(expression: Expression, place: str) -> Iterator[Fault]:
    """What is wrong with an expression of the animator's own."""
    yield from _id(f"{place}.name", expression.name)
    yield from _text(f"{place}.description", expression.description)
    for morph, weight in expression.weights.items():
        if morph not in _MORPHS:
            yield f"{place}.weights.{morph}", "not one of the 52 ARKit morph targets"
        yield from _between(f"{place}.weights.{morph}", weight, (0.0, 1.0))
    for field in ("fade_in_s", "fade_out_s"):
        value = getattr(expression, field)
        if not 0.0 < value <= 60.0:
            yield f"{place}.{field}", "must be more than 0 and at most 60"


def _of(player: Player | None, found: Iterable[Fault]) -> Iterator[Fault]:
    """Faults that concern one player, who is named: a number in a list says little to a reader."""
    for place, detail in found:
        yield place, detail if player is None else f"{detail} (player {shortened(player.name, MOST_NAME)!r})"


def _within(prefix: str, found: Iterable[Fault]) -> Iterator[Fault]:
    for place, detail in found:
        yield f"{prefix}.{place}", detail


def _between(place: str, value: float, bounds: limits.Bounds) -> Iterator[Fault]:
    # Also not where it is no number at all, or a whole one that no float can hold.
    if not bounds[0] <= value <= bounds[1]:
        yield place, f"must be from {bounds[0]:.15g} to {bounds[1]:.15g}"


def _in_order(place: str, ticks: Sequence[int]) -> Iterator[Fault]:
    if not ticks:
        yield place, "must not be empty"
        return
    if ticks[0] != 0:
        yield f"{place}[0].tick", "must be 0"
    for index, (tick, following) in enumerate(pairwise(ticks), 1):
        if following <= tick:
            yield f"{place}[{index}].tick", "ticks must ascend"
            return
    if ticks[-1] > limits.LAST_TICK:
        yield f"{place}[{len(ticks) - 1}].tick", f"must be at most {limits.LAST_TICK}"


def _unique(place: str, values: Iterable[str], field: str = "id") -> Iterator[Fault]:
    seen: set[str] = set()
    for index, value in enumerate(values):
        if value in seen:
            yield f"{place}[{index}].{field}", f"{value!r} appears twice"
        seen.add(value)


def _text(place: str, value: str) -> Iterator[Fault]:
    if len(value) > limits.MOST_TEXT:
        yield place, f"at most {limits.MOST_TEXT} characters"


def _id(place: str, value: str) -> Iterator[Fault]:
    if not 0 < len(value) <= limits.MOST_ID:
        yield place, f"must have from 1 to {limits.MOST_ID} characters"
