"""Muted passages: with a mute in the bell, or hand-stopped where the instrument's map allows that."""

from __future__ import annotations

import numpy as np

from app.arrays import BoolArray
from app.errors import Message
from app.plan.model import MuteEvent, MuteKind
from app.score.model import Note
from app.score.mutes import NAMED, is_muted, mute_at
from app.score.tempo import TempoMap
from instrument_maps.model import InstrumentMap

Spans = tuple[tuple[int, int], ...]


def stopped_notes(notes: tuple[Note, ...], stopped: Spans, instrument: InstrumentMap) -> BoolArray:
    """Return a mask (N,) of the notes for which the hand stops the bell; ``stopped`` are spans of ticks."""
    if instrument.stopped is None or not stopped:
        return np.zeros(len(notes), dtype=bool)
    return np.array([is_muted(stopped, note.onset_tick) for note in notes], dtype=bool)


def plan_mutes(
    notes: tuple[Note, ...],
    muted: Spans,
    stopped: Spans,
    mute_kinds: tuple[tuple[int, str], ...],
    instrument: InstrumentMap,
    clock: TempoMap,
) -> tuple[MuteEvent, ...]:
    """Return the muted passages that contain notes, in order; a passage ends where the kind of mute changes."""
    if not muted:
        return ()
    rows: list[tuple[MuteKind, int, int, Message]] = []
    last = -1
    for place, note in enumerate(notes):
        if not is_muted(muted, note.onset_tick):
            continue
        end = note.onset_tick + note.duration_tick
        by_hand = is_muted(stopped, note.onset_tick)
        said = "mute" if by_hand else mute_at(mute_kinds, note.onset_tick)
        named: MuteKind = next((one for one in NAMED if one == said), "mute")
        kind: MuteKind = "stopped" if by_hand and instrument.stopped is not None else named
        if rows and last == place - 1 and rows[-1][0] == kind:
            rows[-1] = (kind, rows[-1][1], max(rows[-1][2], end), rows[-1][3])
        else:
            rows.append((kind, note.onset_tick, end, _reason(kind, by_hand, instrument)))
        last = place
    return tuple(
        MuteEvent(f"mute:{start}", kind, start, end, clock.seconds(float(start)), clock.seconds(float(end)), reason)
        for kind, start, end, reason in rows
    )


def _reason(kind: MuteKind, by_hand: bool, instrument: InstrumentMap) -> Message:
    if kind == "stopped" and instrument.stopped is not None:
        return Message(f"mute.stopped_{instrument.stopped.hand}")
    return Message("mute.no_hand" if by_hand else f"mute.{kind}")
