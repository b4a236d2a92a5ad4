"""Checks a score: sizes and order of notes, curves, tempi, metres and markers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from app.project import limits
from app.project.value_checks import (
    Fault,
    faults_at_key,
    faults_of_bounds,
    id_faults,
    in_order,
    text_faults,
    unique,
)
from app.score.limits import too_long
from app.score.marks import Mark
from app.score.metre_map import Metre
from app.score.model import ControllerCurve, Marker, Note, Part, PercussionHit, Score, value_range
from app.score.mutes import NAMED
from app.score.tempo import TempoChange


def score_faults(score: Score, before: Score | None) -> Iterator[Fault]:
    yield from text_faults("title", score.title)
    yield from faults_of_bounds("ticks_per_quarter", score.ticks_per_quarter, limits.TICKS_PER_QUARTER)
    if score.tempo_map.ticks_per_quarter != score.ticks_per_quarter:
        yield "tempo_map.ticks_per_quarter", "differs from the score's"
    yield from tempo_faults(score.tempo_map.changes)
    yield from metre_faults(score.metres)
    yield from _marker_faults(score.markers)
    if before is None or score.percussion is not before.percussion:
        yield from _percussion_faults(score.percussion)
    if not score.metres or score.metres[0].tick != 0 or not score.tempo_map.changes or score.ticks_per_quarter < 1:
        # Without a valid resolution no duration can be computed.
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
    """Yield a fault for every note id that occurs twice in the piece; parts found in ``before`` were checked
    already.
    """
    old = {part.id: part for part in before}
    if all(
        part.id in old and len(part.note_ids) == len(part.notes) and part.note_ids <= old[part.id].note_ids
        for part in parts
        if part is not old.get(part.id)
    ):
        # No part has a note id that it did not have before.
        return
    seen: set[str] = set()
    for index, part in enumerate(parts):
        for number, note in enumerate(part.notes):
            if note.id in seen:
                yield f"parts[{index}].notes[{number}].id", f"{note.id!r} appears twice"
            seen.add(note.id)


def tempo_faults(changes: Sequence[TempoChange]) -> Iterator[Fault]:
    place = "tempo_map.changes"
    yield from in_order(place, [change.tick for change in changes])
    for index, change in enumerate(changes):
        yield from faults_of_bounds(
            f"{place}[{index}].microseconds_per_quarter",
            change.microseconds_per_quarter,
            limits.MICROSECONDS_PER_QUARTER,
        )


def metre_faults(metres: Sequence[Metre]) -> Iterator[Fault]:
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
        # One comparison for the many valid hits.
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
    for index, (tick, kind) in enumerate(part.mute_kinds):
        yield from faults_of_bounds(f"{place}.mute_kinds[{index}][0]", tick, (0, limits.LAST_TICK))
        if kind not in ("mute", *NAMED):
            yield f"{place}.mute_kinds[{index}][1]", "must be a kind of mute"
    if [tick for tick, _ in part.mute_kinds] != sorted(tick for tick, _ in part.mute_kinds):
        yield f"{place}.mute_kinds", "changes must be ordered by tick"
    yield from note_faults(part.notes, f"{place}.notes")
    for index, mark in enumerate(part.marks):
        yield from faults_at_key(f"{place}.marks[{index}]", _mark_faults(mark))
    for index, curve in enumerate(part.curves):
        yield from controller_faults(curve, f"{place}.curves[{index}]")


def _mark_faults(mark: Mark) -> Iterator[Fault]:
    yield from id_faults("note_id", mark.note_id, least=0)
    yield from id_faults("last_note_id", mark.last_note_id, least=0)
    yield from faults_of_bounds("tick", mark.tick, (0, limits.LAST_TICK))
    if mark.end_tick:
        yield from faults_of_bounds("end_tick", mark.end_tick, (mark.tick, limits.LAST_TICK))
    yield from text_faults("text", mark.text, limits.MOST_NAME)


def note_faults(notes: Sequence[Note], place: str) -> Iterator[Fault]:
    for index, note in enumerate(notes):
        # One comparison for the many valid notes.
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


def controller_faults(curve: ControllerCurve, place: str) -> Iterator[Fault]:
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
