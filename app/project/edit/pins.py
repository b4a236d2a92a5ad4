"""Pins beats to their time in the recording by adapting the tempo. Notes keep their ticks."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from typing import Final

import msgspec
import numpy as np

from app.errors import UsageError
from app.project import limits
from app.project.edit.tempo import replace_tempi
from app.project.model import Project
from app.project.recording import AudioTrack, BeatPin
from app.score.tempo import TempoChange

_REACH_BEATS: Final = 8
"""Distance in beats from a moved beat beyond which beats stay, unless a pin is nearer."""
_STEEPEST: Final = 0.7
"""Greatest change of a beat's duration next to a moved one, as a share of the duration."""
_LEAST_S: Final = 0.02
"""Least distance in seconds of two pins in the recording."""


def recording_second(project: Project, tick: int) -> float:
    """Return the time in the recording at which a tick currently is. Raises UsageError without a recording."""
    return project.score.tempo_map.seconds(float(tick)) - _audio(project).offset_s


def pin_beat(project: Project, tick: int, recording_s: float | None = None) -> Project:
    """Move a beat to its time in the recording and keep it there.

    Neighbouring beats move along, the farther the less, up to the next pin or `_REACH_BEATS` beats away; the start of
    the piece stays unless it is pinned. The move is limited by the time that neighbouring beats need.

    Parameters
    ----------
    recording_s : float, optional
        Time from the recording's first sample; None for the beat's present time.
    """
    audio = _audio(project)
    if not 0 <= tick <= limits.LAST_TICK:
        raise UsageError("pins.before_the_piece")
    others = [pin for pin in audio.pins if pin.tick != tick]
    now_s = recording_second(project, tick)
    room = _room(project, tick, 0.0 if recording_s is None else recording_s - now_s)
    shift_s = 0.0 if recording_s is None else min(max(recording_s - now_s, room.least_s), room.most_s)
    at_s = now_s + shift_s
    before = max((pin.recording_s for pin in others if pin.tick < tick), default=-np.inf)
    after = min((pin.recording_s for pin in others if pin.tick > tick), default=np.inf)
    if not before + _LEAST_S <= at_s <= after - _LEAST_S:
        raise UsageError("pins.no_room")
    pins = tuple(sorted((*others, BeatPin(tick, float(at_s))), key=lambda pin: pin.tick))
    doubts = tuple(doubt for doubt in audio.doubts if not doubt.start_tick <= tick < doubt.end_tick)
    if shift_s:
        project = _moved(project, tick, shift_s, room)
        audio = _audio(project)
    return _with_audio(project, msgspec.structs.replace(audio, pins=pins, doubts=doubts))


def remove_pins(project: Project, ticks: Collection[int] | None = None) -> Project:
    """Unpin the beats at ``ticks`` (None for all), so that following the recording may move them; they do not
    move now.
    """
    audio = _audio(project)
    kept = tuple(pin for pin in audio.pins if ticks is not None and pin.tick not in ticks)
    if len(kept) == len(audio.pins):
        raise UsageError("pins.none_here")
    return _with_audio(project, msgspec.structs.replace(audio, pins=kept))


@dataclass(frozen=True)
class _Room:
    """Span in which beats move with a pinned beat, and the least and greatest time of that beat, in seconds of the
    score.
    """

    start_s: float
    end_s: float
    least_s: float
    most_s: float


def _room(project: Project, tick: int, shift_s: float) -> _Room:
    clock, beat = project.score.tempo_map, project.metre_map.felt_ticks_at(tick)
    at_s = clock.seconds(float(tick))
    pinned = [pin.tick for pin in _audio(project).pins]
    before = max((one for one in (0, *pinned) if one < tick), default=None)
    after = min((one for one in pinned if one > tick), default=None)
    # A cosine is steepest in its middle; without another pin the room keeps it half as steep as allowed.
    steep = 0.5 * np.pi / _STEEPEST
    wide_s = 2.0 * steep * abs(shift_s)
    start_s = min(clock.seconds(float(tick - _REACH_BEATS * beat)), at_s - wide_s)
    end_s = max(clock.seconds(float(tick + _REACH_BEATS * beat)), at_s + wide_s)
    if before is not None:
        start_s = max(start_s, clock.seconds(float(before)))
    if after is not None:
        end_s = min(end_s, clock.seconds(float(after)))
    least_s = -limits.OFFSET_S[1] if before is None else -(at_s - start_s) / steep
    return _Room(start_s, end_s, least_s, (end_s - at_s) / steep)


def _moved(project: Project, tick: int, shift_s: float, room: _Room) -> Project:
    """Shift the beats within ``room`` around a tick, with a weight that falls from 1 at the tick to 0 at both ends as a
    cosine. Tick 0 must stay at second 0, so for it the recording's offset changes instead.
    """
    clock, changes = project.score.tempo_map, project.score.tempo_map.changes
    first = max(round(clock.ticks(room.start_s)), 0)
    last = max(round(clock.ticks(room.end_s)), tick + 1)
    beats = project.metre_map.felt_between(first, last)
    within = [change.tick for change in changes if first < change.tick < last]
    knots = np.unique(np.array([first, tick, last, *within, *beats[(beats > first) & (beats < last)].tolist()]))
    seconds = clock.seconds(knots)
    at_s = clock.seconds(float(tick))
    reach_s = np.where(seconds < at_s, at_s - room.start_s, room.end_s - at_s)
    share = np.clip(np.abs(seconds - at_s) / np.maximum(reach_s, 1e-9), 0.0, 1.0)
    moved_s = seconds + shift_s * 0.5 * (1.0 + np.cos(np.pi * share))
    lengths_us = 1e6 * np.diff(moved_s) / (np.diff(knots) / clock.ticks_per_quarter)
    low, high = limits.MICROSECONDS_PER_QUARTER
    if not np.all((lengths_us >= low) & (lengths_us <= high)):
        raise UsageError("tempo.outside", low=limits.BPM[0], high=limits.BPM[1])
    going_on = next(change for change in reversed(changes) if change.tick <= last)
    tempi = [change for change in changes if not first <= change.tick <= last]
    tempi += [TempoChange(at, us) for at, us in zip(knots[:-1].tolist(), lengths_us.tolist(), strict=True)]
    tempi.append(msgspec.structs.replace(going_on, tick=last))
    audio = _audio(project)
    project = replace_tempi(project, tempi)
    if tick:
        return project
    return _with_audio(project, msgspec.structs.replace(audio, offset_s=audio.offset_s - shift_s, confidence=None))


def _audio(project: Project) -> AudioTrack:
    if project.audio is None:
        raise UsageError("piece.no_recording")
    return project.audio


def _with_audio(project: Project, audio: AudioTrack) -> Project:
    return project if audio == project.audio else replace(project, audio=audio)
