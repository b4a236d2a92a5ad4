"""Checks an animator's corrections: size of texts and numbers, and validity of curves."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import partial
from typing import Any, Final

import msgspec

from app.errors import shortened
from app.plan.by_hand.additive_curve import BODY_CHANNELS, CHANNELS, FACE, MOST_KEYS, AdditiveCurve, CurveKey
from app.plan.by_hand.corrections import Correction
from app.plan.by_hand.mark_corrections import OfMark, SetMark
from app.plan.music.written_dynamics import DYNAMIC_TEXTS
from app.project import limits
from app.project.model import Project
from app.project.value_checks import Fault, about, faults_at_key, faults_of_bounds, id_faults, text_faults
from app.score.marks import MARK_KINDS

_POSSIBLE: Final = f"{', '.join(BODY_CHANNELS)}, {FACE}MORPH (an ARKit morph target)"

_KEY: Final = re.compile(r"\.keys\[(\d+)\]")
_TICKS: Final = (-limits.LAST_TICK, limits.LAST_TICK)


def project_correction_faults(project: Project, before: Project | None = None) -> Iterator[Fault]:
    """Yield the faults of all players' corrections, each described with player, bar and correction. Corrections shared
    with ``before``, which is known to be valid, are skipped.
    """
    known = {player.id: player for player in project.players}
    for player_id, corrections in project.corrections.items():
        if player_id not in known:
            yield f"corrections[{player_id!r}]", "there is no player of this id"
        old = () if before is None else before.corrections.get(player_id, ())
        if corrections is old:
            continue
        sound = set(map(id, old))
        for index, correction in enumerate(corrections):
            if id(correction) not in sound:
                found = correction_faults(correction, f"corrections[{player_id!r}][{index}]")
                yield from about(known.get(player_id), found, partial(_place, project, correction))


def correction_faults(correction: Correction, place: str) -> Iterator[Fault]:
    """Yield key path and description of every fault in a correction; ``place`` is the correction's own key path."""
    if isinstance(correction, AdditiveCurve):
        yield from id_faults(f"{place}.name", correction.name, least=0)
        yield from curve_faults(correction, place)
        return
    for field in correction.__struct_fields__:
        yield from _plain_faults(f"{place}.{field}", getattr(correction, field))
    if isinstance(correction, OfMark):
        yield from faults_at_key(place, _mark_faults(correction))


def _mark_faults(correction: OfMark) -> Iterator[Fault]:
    """Yield the faults in anchors and text of a corrected mark, by its kind."""
    anchor = MARK_KINDS[correction.kind].anchor
    at_tick = anchor in ("place", "span")
    needed = {"note_id": not at_tick, "last_note_id": anchor == "notes", "start_tick": at_tick}
    for field, is_needed in needed.items():
        value = getattr(correction, field)
        if is_needed and value in (None, ""):
            yield field, f"is needed by {correction.kind!r}"
        elif value is not None and not is_needed and not (field == "last_note_id" and anchor == "note"):
            yield field, f"is not used by {correction.kind!r}"
    if correction.start_tick is not None:
        yield from faults_of_bounds("start_tick", correction.start_tick, (0, limits.LAST_TICK))
    if not isinstance(correction, SetMark):
        return
    if anchor == "span" and correction.end_tick is None:
        yield "end_tick", f"is needed by {correction.kind!r}"
    elif correction.end_tick is not None and not at_tick:
        yield "end_tick", f"is not used by {correction.kind!r}"
    yield from text_faults("text", correction.text, limits.MOST_NAME)
    if correction.kind == "dynamic" and correction.text not in DYNAMIC_TEXTS:
        yield "text", f"must be one of {', '.join(DYNAMIC_TEXTS)}"


def _place(project: Project, correction: Correction, place: str) -> str:
    """Return the bar of a fault, and kind and name of its correction, as text for a message; ``place`` is the
    key path.
    """
    name, score = _name(correction), project.score
    named = f"{correction.tag} {name!r}" if name else correction.tag
    tick = _tick(project, correction, place)
    if tick is None or not score.metres or score.ticks_per_quarter < 1:
        return named
    return f"bar {score.metre_map.bar_of_tick(tick)}, {named}"


def _name(correction: Correction) -> str:
    """Return the display name of a correction: the user's title, or its subject; empty for corrections of a note."""
    if isinstance(correction, OfMark):
        return correction.kind
    fields = ("title", "channel", "target", "style", "gesture", "expression")
    known = (getattr(correction, field, None) for field in fields)
    return next((name for name in known if isinstance(name, str) and name), "")


def _tick(project: Project, correction: Correction, place: str) -> int | None:
    """Return the tick of the faulty key, or else of the correction's start; None if it has no place in the score."""
    if isinstance(correction, AdditiveCurve):
        found = _KEY.search(place)
        index = 0 if found is None else int(found[1])
        tick = correction.keys[index].tick if correction.keys else None
    else:
        tick = getattr(correction, "start_tick", getattr(correction, "tick", None))
    if tick is None:
        note_id = getattr(correction, "note_id", None)
        notes = (note for part in project.score.parts for note in part.notes)
        tick = next((note.onset_tick for note in notes if note.id == note_id), None)
    return tick if isinstance(tick, int) and _TICKS[0] <= tick <= _TICKS[1] else None


def _plain_faults(place: str, value: Any) -> Iterator[Fault]:
    """Yield the faults of a value of any type within a correction: texts and numbers outside generous limits."""
    if isinstance(value, str):
        yield from text_faults(place, value, limits.MOST_ID)
    elif isinstance(value, int | float):
        if place.endswith(("_tick", "_ticks")):
            yield from faults_of_bounds(place, value, _TICKS)
        elif isinstance(value, float):
            yield from faults_of_bounds(place, value, (-limits.MOST_NUMBER, limits.MOST_NUMBER))
        elif abs(value) > limits.SEED[1]:
            yield place, f"must be from {-limits.SEED[1]} to {limits.SEED[1]}"
    elif isinstance(value, tuple | list):
        for index, item in enumerate(value):
            yield from _plain_faults(f"{place}[{index}]", item)
    elif isinstance(value, msgspec.Struct):
        for field in value.__struct_fields__:
            yield from _plain_faults(f"{place}.{field}", getattr(value, field))


def curve_faults(curve: AdditiveCurve, place: str) -> Iterator[Fault]:
    """Yield the faults of an additive curve."""
    channel = CHANNELS.get(curve.channel)
    if channel is None:
        yield f"{place}.channel", f"there is no channel {shortened(curve.channel, 40)!r}; possible: {_POSSIBLE}"
        return
    if curve.title:
        yield from text_faults(f"{place}.title", curve.title)
    yield from faults_of_bounds(f"{place}.weight", curve.weight, (0.0, 1.0))
    for field in ("blend_in_ticks", "blend_out_ticks"):
        yield from faults_of_bounds(f"{place}.{field}", getattr(curve, field), (0, limits.LAST_TICK))
    if not 1 <= len(curve.keys) <= MOST_KEYS:
        yield f"{place}.keys", f"must be from 1 to {MOST_KEYS}"
    for index, key in enumerate(curve.keys):
        at = f"{place}.keys[{index}]"
        yield from _key_faults(key, at, channel.most)
        if index and key.tick <= curve.keys[index - 1].tick:
            yield f"{at}.tick", "ticks must ascend"


def _key_faults(key: CurveKey, place: str, most: float) -> Iterator[Fault]:
    yield from faults_of_bounds(f"{place}.tick", key.tick, (-limits.LAST_TICK, limits.LAST_TICK))
    yield from faults_of_bounds(f"{place}.value", key.value, (-most, most))
    for side in ("arrive", "leave"):
        handle = getattr(key, side)
        if handle is not None:
            yield from faults_of_bounds(f"{place}.{side}.ticks", handle.ticks, (0, limits.LAST_TICK))
            yield from faults_of_bounds(f"{place}.{side}.value", handle.value, (-10.0 * most, 10.0 * most))
