"""Keeping of chosen parts unchanged while a re-read file replaces the others."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import replace
from fractions import Fraction

import msgspec

from app.project.file_curves import moved_curve
from app.project.found_parts import FoundParts, PartMatch
from app.project.model import Project
from app.project.moved_ticks import place_map
from app.score.marks import moved_marks
from app.score.model import ControllerCurve, Note, Part


def keeping(found: FoundParts, project: Project, ids: Collection[str], scale: Fraction) -> FoundParts:
    """Return the matched parts with some of them kept as they are in the project; new parts of the file among them are
    left out.

    For these parts the stored version of the file stays as well, so that the next reading offers the same changes
    again.

    Parameters
    ----------
    ids : collection of str
        Ids of the parts to keep.
    scale : Fraction
        Ticks of the file per tick of the project.
    """
    place = place_map((), scale)
    pairs = [
        (_as_here(former, part, place, scale), None) if former is not None and part.id in ids else (part, former)
        for part, former in zip(found.parts, found.former, strict=True)
        if former is not None or part.id not in ids
    ]
    kept = frozenset(part.id for part, _ in pairs) & frozenset(ids)
    read = {part.id: found.read_notes[part.id] for part, _ in pairs if part.id not in kept}
    for id in kept & project.read_notes.keys():
        read[id] = {name: _scaled(note, place, scale) for name, note in project.read_notes[id].items()}
    places = {id: own for id, own in found.places.items() if id not in kept}
    ours = {note.id for part, _ in pairs if part.id not in kept for note in part.notes}
    return replace(
        found,
        parts=tuple(part for part, _ in pairs),
        former=tuple(former for _, former in pairs),
        matches=tuple(
            PartMatch(one.part_id, one.former_name, one.former_name, one.kept + one.removed, 0, 0, 0)
            if one.part_id in kept
            else one
            for one in found.matches
        ),
        conflicts=tuple(one for one in found.conflicts if one.part_id not in kept),
        read_notes=read,
        places=places | {id: [(0, 0)] for id in kept},
        added=tuple(id for id in found.added if id in ours),
        still=scale == 1 and all(tick == now for own in places.values() for tick, now in own),
        kept=kept,
    )


def read_curves_of(project: Project, found: FoundParts, scale: Fraction) -> dict[str, tuple[ControllerCurve, ...]]:
    """Return the controllers in the file by part id; for kept parts, those of the previous reading, whose ticks are
    multiplied by ``scale``.
    """
    place = place_map((), scale)
    result = {part.id: part.curves for part in found.parts if part.id not in found.kept}
    for id in found.kept & project.read_curves.keys():
        result[id] = tuple(moved_curve(curve, place) for curve in project.read_curves[id])
    return result


def moved_part(part: Part, id: str, place: Callable[[int], int], scale: Fraction) -> Part:
    """Return a part with a new id and all ticks converted by ``place``; lengths are multiplied by ``scale``."""
    notes = [_scaled(note, place, scale) for note in part.notes]
    ordered = tuple(sorted(notes, key=lambda note: (note.onset_tick, note.pitch)))
    curves = tuple(moved_curve(curve, place) for curve in part.curves)
    muted, stopped = (
        tuple(sorted((max(place(start), 0), max(place(end), 0)) for start, end in spans))
        for spans in (part.muted, part.stopped)
    )
    marks = moved_marks(part.marks, place)
    kinds = tuple(sorted((max(place(tick), 0), kind) for tick, kind in part.mute_kinds))
    return msgspec.structs.replace(
        part, id=id, notes=ordered, curves=curves, muted=muted, stopped=stopped, mute_kinds=kinds, marks=marks
    )


def _as_here(former: Part, part: Part, place: Callable[[int], int], scale: Fraction) -> Part:
    """Return a part of the project with its ticks converted to those of the file, at the file's track and channel.

    ``former`` is the part in the project, ``part`` that in the file; ``place`` and ``scale`` as in `moved_part`.
    """
    here = moved_part(former, former.id, place, scale)
    return msgspec.structs.replace(here, track=part.track, channel=part.channel, voice=part.voice)


def _scaled(note: Note, place: Callable[[int], int], scale: Fraction) -> Note:
    return msgspec.structs.replace(
        note, onset_tick=max(place(note.onset_tick), 0), duration_tick=max(round(note.duration_tick * scale), 1)
    )
