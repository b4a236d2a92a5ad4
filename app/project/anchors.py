"""Anchors of corrections (notes, events, ticks), and moving corrections to other anchors.

Field names determine the kind: ``note_id``, ``last_note_id`` and ``moved_from`` are notes (or ``"@tick"``, a place);
``event_id`` ends with the note or place of its event; ``..._offset_tick`` and ``..._ticks`` are lengths; ``tick`` and
other ``..._tick`` are places.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any, TypeVar

import msgspec

from app.plan.by_hand.additive_curve import CurveKey, Tangent
from app.plan.by_hand.corrections import Correction
from app.project.dance_corrections import DanceCorrection

C = TypeVar("C", bound=Correction | DanceCorrection)

NOTE_FIELDS = ("note_id", "last_note_id", "moved_from")
_NOTE = re.compile(r"(?:^|(?<=:))(?:\d+|[nft]):\d+$", re.ASCII)
_PLACE = re.compile(r"(?:^|(?<=:))@(-?\d+)$", re.ASCII)


def note_of(correction: Correction) -> str | None:
    """Return the id of the note that a correction belongs to; None if it belongs to a tick or to an event without a
    note.
    """
    note_id: str | None = getattr(correction, "note_id", None)
    if note_id is not None:
        return None if _PLACE.search(note_id) else note_id
    found = _NOTE.search(getattr(correction, "event_id", ""))
    return found.group() if found else None


def notes_of(correction: Correction) -> tuple[str, ...]:
    """Return the ids of all notes that a correction belongs to: for a slur those at both ends."""
    last: str | None = getattr(correction, "last_note_id", None)
    return tuple(note for note in (note_of(correction), last) if note is not None)


def moved_correction(
    correction: C, note_ids: Mapping[str, str], place: Callable[[int], int] | None = None, scale: Fraction = Fraction(1)
) -> C:
    """Return the correction with other notes and places; the same value if nothing changes.

    Parameters
    ----------
    note_ids : mapping of str to str
        New id of each old one; ids that are missing stay.
    place : callable, optional
        Function from old to new ticks.
    scale : Fraction
        Factor for lengths in ticks.
    """
    changes: dict[str, Any] = {}
    for field in correction.__struct_fields__:
        value = getattr(correction, field)
        if field in NOTE_FIELDS or field == "event_id":
            if value is not None:
                changes[field] = _renamed(value, note_ids, place)
        elif field == "keys":
            changes[field] = _moved_keys(value, place, scale)
        elif not isinstance(value, int) or isinstance(value, bool):
            continue
        elif field.endswith(("_offset_tick", "_ticks")):
            changes[field] = round(value * scale)
        elif (field == "tick" or field.endswith("_tick")) and place is not None:
            changes[field] = place(value)
    start, end = changes.get("start_tick"), changes.get("end_tick")
    if start is not None and end is not None and end <= start and correction_span(correction) > 0:
        changes["end_tick"] = start + 1
    if all(getattr(correction, field) == value for field, value in changes.items()):
        return correction
    result: C = msgspec.structs.replace(correction, **changes)
    return result


def _moved_keys(
    keys: tuple[CurveKey, ...], place: Callable[[int], int] | None, scale: Fraction
) -> tuple[CurveKey, ...]:
    """Return the keys of a curve moved to the ticks given by ``place``, in ascending order; keys that would coincide
    move apart by one tick. Lengths of handles are multiplied by ``scale``.
    """
    result: list[CurveKey] = []
    for key in keys:
        tick = key.tick if place is None else place(key.tick)
        if result and tick <= result[-1].tick:
            tick = result[-1].tick + 1
        handles = {side: _scaled(getattr(key, side), scale) for side in ("arrive", "leave")}
        result.append(msgspec.structs.replace(key, tick=tick, **handles))
    return tuple(result)


def _scaled(handle: Tangent | None, scale: Fraction) -> Tangent | None:
    return None if handle is None else Tangent(round(handle.ticks * scale), handle.value)


def correction_span(correction: Correction | DanceCorrection) -> int:
    """Return the length in ticks of a correction's span; 0 if it has none."""
    start, end = getattr(correction, "start_tick", None), getattr(correction, "end_tick", None)
    return 0 if start is None or end is None else int(end - start)


def _renamed(text: str, note_ids: Mapping[str, str], place: Callable[[int], int] | None) -> str:
    """Return a note id, or an event id that ends with a note or tick, after notes were renamed (``note_ids``) and ticks
    moved (``place``).
    """
    note = _NOTE.search(text)
    if note is not None:
        return text[: note.start()] + note_ids.get(note.group(), note.group())
    found = _PLACE.search(text)
    if found is not None and place is not None:
        return f"{text[: found.start()]}@{place(int(found.group(1)))}"
    return note_ids.get(text, text)
