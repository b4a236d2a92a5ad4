"""Detects MIDI tracks that were played on a wind controller, and removes their unintended notes.

Files written by ``suisou record`` are marked. Any other track must be a single line with breath data sent while it was
played, and either have the name of a wind controller, or have notes off the beat and a breath that drops in the rests,
unlike hand-drawn curves.
"""

from __future__ import annotations

from typing import Final, Literal, TypeAlias

import msgspec
import numpy as np

from app.arrays import FloatArray, IntArray
from app.score.clean import Fault, clean_notes
from app.score.model import ControllerCurve, CurveKind, Note
from app.score.take import Cleaning, Controlled, Played
from app.score.tempo import TempoMap
from app.score.track_channel import TrackChannel
from instrument_maps.instrument_names import vocabulary

RECORDED: Final = "Suisou: recorded take"
"""Text of a track written by ``suisou record``."""

TakeReason: TypeAlias = Literal["", "recorded", "name", "breath"]
"""Reason for considering a track a take: a text in the file, its name, or breath and timing; empty if it is none."""

_FAMILY: Final = "wind_controllers"
_BREATHS: Final[tuple[CurveKind, ...]] = ("breath", "expression", "aftertouch", "volume")
"""Kinds of curves that may represent the breath, the most likely first."""
_SENT_PER_S: Final = 5.0
"""Least number of changes per second of a blown breath controller during notes."""
_AUDIBLE, _SILENT = 0.15, 0.06
_TOGETHER_S, _TOGETHER_SHARE = 0.15, 0.03
"""Greatest overlap in seconds, and share of notes that exceed it, in a single line."""
_GRID: Final = 12
"""Number of steps in a quarter on which notes are written: sixteenths and triplets."""
_ON_GRID: Final = 0.5
"""Share of notes on these steps below which the notes were played live."""
_REST_S, _FALLS = 0.15, 0.8
"""Length of a rest in seconds, and share of such rests in which a blown controller falls below the audible level."""
_LEAST_NOTES: Final = 4


def take_reason(channel: TrackChannel, tempo_map: TempoMap) -> TakeReason:
    """Return the evidence that a track is a take recorded from a wind controller; empty if it is not."""
    if channel.recorded:
        return "recorded"
    if channel.use != "melodic" or len(channel.pitches) < _LEAST_NOTES:
        return ""
    notes = notes_as_played(channel, tempo_map)
    breath = notes.curves.get("breath")
    if breath is None or not _is_one_line(notes) or not _is_blown(notes, breath):
        return ""
    if _is_named(" ".join((channel.name, channel.instrument_name))):
        return "name"
    return "breath" if _falls_in_rests(notes, breath) and not _is_on_grid(channel, tempo_map) else ""


def _is_named(name: str) -> bool:
    """Return whether the name contains the name of a wind controller, possibly next to an instrument's name."""
    known = vocabulary()
    found = [*known.all_by_name(name), *map(known.by_name, name.split())]
    return any(instrument is not None and instrument.family == _FAMILY for instrument in found)


def without_faults(channel: TrackChannel, tempo_map: TempoMap) -> tuple[TrackChannel, dict[Fault, list[Note]]]:
    """Clean the notes of a channel like those of a take; also return the removed notes, as played, by reason."""
    clean = clean_notes(notes_as_played(channel, tempo_map), Cleaning())
    before = channel.notes()
    found: dict[Fault, list[Note]] = {}
    for fault, note in zip(clean.faults, before, strict=True):
        if fault:
            found.setdefault(fault, []).append(note)
    kept = clean.kept
    if not found or not kept:
        return channel, {}
    onsets = np.round(tempo_map.ticks(clean.onsets_s[kept])).astype(np.int64)
    ends = np.maximum(np.round(tempo_map.ticks(clean.ends_s[kept])).astype(np.int64), onsets + 1)
    columns = {name: [getattr(channel, name)[index] for index in kept] for name in ("pitches", "velocities", "numbers")}
    return msgspec.structs.replace(channel, onset_ticks=onsets.tolist(), end_ticks=ends.tolist(), **columns), found


def notes_as_played(channel: TrackChannel, tempo_map: TempoMap) -> Played:
    """Convert the notes of a channel and its breath curve to the form of a take."""

    def seconds(ticks: list[int]) -> FloatArray:
        return tempo_map.seconds(np.array(ticks, np.float64))

    onsets_s, ends_s = seconds(channel.onset_ticks), seconds(channel.end_ticks)
    sounding_s = float(np.sum(ends_s - onsets_s))
    curves = {curve.kind: curve for curve in channel.curves}
    breaths = [curves[kind] for kind in _BREATHS if kind in curves and _carries_breath(curves[kind], sounding_s)]
    breath: dict[CurveKind, Controlled] = {}
    if breaths:
        breath["breath"] = Controlled(seconds(list(breaths[0].ticks)), np.array(breaths[0].values))
    pitches, velocities = (np.array(column, np.int64) for column in (channel.pitches, channel.velocities))
    return Played(onsets_s, ends_s, pitches, velocities, breath)


def _carries_breath(curve: ControllerCurve, sounding_s: float) -> bool:
    return max(curve.values, default=0.0) >= _AUDIBLE and len(curve.ticks) >= _SENT_PER_S * sounding_s


def _is_one_line(notes: Played) -> bool:
    over_s = notes.ends_s[:-1] - notes.onsets_s[1:]
    return bool(np.count_nonzero(over_s > _TOGETHER_S) <= _TOGETHER_SHARE * len(notes))


def _is_blown(notes: Played, breath: Controlled) -> bool:
    """Return whether the breath keeps changing while notes sound and stops at least once. A curve that never stops, as
    drawn for dynamics, does not show tonguing.
    """
    if breath.values.min() > _SILENT:
        return False
    inside = _among(notes, breath.times_s)
    lasts_s = float(np.sum(notes.ends_s - notes.onsets_s))
    return bool(np.count_nonzero(inside) >= _SENT_PER_S * lasts_s)


def _among(notes: Played, times_s: FloatArray) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Return a mask (N,) of the times at which a note sounds."""
    ends_s = np.maximum.accumulate(notes.ends_s)
    index: IntArray = np.searchsorted(notes.onsets_s, times_s, side="right") - 1
    return np.asarray((index >= 0) & (times_s < ends_s[np.maximum(index, 0)]))


def _falls_in_rests(notes: Played, breath: Controlled) -> bool:
    """Return whether the breath curve drops to silence in the rests or, if there are no rests, before the
    first note.
    """
    starts_s = np.concatenate(([-1.0 + notes.onsets_s[0]], np.maximum.accumulate(notes.ends_s)[:-1]))
    rests = notes.onsets_s - starts_s >= _REST_S
    middles_s = (0.5 * (starts_s + notes.onsets_s))[rests]
    return bool(np.count_nonzero(breath.at(middles_s) < _AUDIBLE) >= _FALLS * len(middles_s))


def _is_on_grid(channel: TrackChannel, tempo_map: TempoMap) -> bool:
    step = tempo_map.ticks_per_quarter / _GRID
    onsets = np.array(channel.onset_ticks, np.float64)
    off = np.abs(onsets - step * np.round(onsets / step))
    return bool(np.count_nonzero(off <= max(0.05 * step, 1.0)) > _ON_GRID * len(onsets))
