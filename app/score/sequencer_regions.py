"""Joins tracks that one player plays: consecutive regions written by a sequencer, and lines spread over tracks.

Regions have the same name, channel and program, and each begins after the previous one has ended. Tracks of one name
that overlap or alternate belong to several players.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Sequence
from itertools import pairwise
from typing import Final

import msgspec

from app.score.limits import LAST_TICK
from app.score.model import ControllerCurve, CurveKind
from app.score.track_channel import TrackChannel
from app.score.track_instrument import is_named, use_of

_COPY: Final = re.compile(r"(?:[ _-]*(?:copy|kopie|copie|copia|コピー)(?:[ _]*\d+)?|[ _]*#\d+|\.\d+)+$", re.IGNORECASE)
"""Suffixes that sequencers add to the name of another region."""
_LEGATO_SHARE: Final = 0.5
"""Share of a region's last note that may overlap the next region."""


def groups(channels: Sequence[TrackChannel]) -> list[tuple[int, ...]]:
    """Group the channels that one player plays, as channel indices ordered by the first; most groups have
    one channel.
    """
    alone = _alone(channels)
    same: dict[tuple[object, ...], list[int]] = {}
    for place, channel in enumerate(channels):
        key = ("line", channel.line) if channel.line >= 0 else _key(channel) if place in alone else (place,)
        same.setdefault(key, []).append(place)
    found: list[tuple[int, ...]] = []
    for places in same.values():
        in_time = sorted(places, key=lambda place: channels[place].onset_ticks[0])
        one = len(places) == 1 or are_one_line([channels[place] for place in in_time])
        found += [tuple(in_time)] if one else [(place,) for place in places]
    return sorted(found, key=min)


def _alone(channels: Sequence[TrackChannel]) -> frozenset[int]:
    """Indices of those named melodic channels that are the only part in their track and MIDI channel."""
    owners: dict[tuple[int, int], list[int]] = {}
    for place, channel in enumerate(channels):
        owners.setdefault((channel.track, channel.channel), []).append(place)
    single = [places[0] for places in owners.values() if len(places) == 1]
    return frozenset(place for place in single if is_named(channels[place]) and use_of(channels[place]) == "melodic")


def _key(channel: TrackChannel) -> tuple[object, ...]:
    return _COPY.sub("", channel.name).casefold(), channel.instrument_name, channel.channel, channel.program


def are_one_line(channels: Sequence[TrackChannel]) -> bool:
    """Return whether the channels belong to one player: consecutive regions of a track, or a line spread over
    tracks.
    """
    return is_spread(channels) or follow_one_another(channels)


def is_spread(channels: Sequence[TrackChannel]) -> bool:
    """Return whether the channels are those of one line spread over tracks (`app.score.lines_spread_over_tracks`)."""
    return len(channels) > 1 and len({channel.line for channel in channels}) == 1 and channels[0].line >= 0


def follow_one_another(channels: Sequence[TrackChannel]) -> bool:
    """Return whether the channels are consecutive regions of one track, in order."""
    if len(channels) < 2 or len(set(map(_key, channels))) > 1:
        return False
    return all(
        end - after.onset_ticks[0] <= _LEGATO_SHARE * (end - onset)
        for before, after in pairwise(channels)
        for onset, end in zip(before.onset_ticks, before.end_ticks, strict=True)
        if end > after.onset_ticks[0]
    )


def joined(channels: Sequence[TrackChannel]) -> TrackChannel:
    """Join the channels of one player: the first channel, with the curves, muted spans and marks of all of them.

    If the channels do not follow one another, the curves are those of the first channel that has any.
    """
    curves = next((channel.curves for channel in channels if channel.curves), ())
    if not is_spread(channels) and follow_one_another(channels):
        curves = _curves(channels)
    muted = tuple(sorted({span for channel in channels for span in channel.muted}))
    stopped = tuple(sorted({span for channel in channels for span in channel.stopped}))
    marks = tuple(dict.fromkeys(mark for channel in channels for mark in channel.marks))
    mute_kinds = tuple(sorted({change for channel in channels for change in channel.mute_kinds}))
    return msgspec.structs.replace(
        channels[0], curves=curves, muted=muted, stopped=stopped, mute_kinds=mute_kinds, marks=marks
    )


def _curves(channels: Sequence[TrackChannel]) -> tuple[ControllerCurve, ...]:
    """Join the controller curves of consecutive regions; the curve of each region applies from the end of the previous
    one.
    """
    starts = [0, *(max(before.end_ticks) for before in channels[:-1]), LAST_TICK + 1]
    kinds = sorted({curve.kind for channel in channels for curve in channel.curves})
    return tuple(_curve(kind, channels, starts) for kind in kinds)


def _curve(kind: CurveKind, channels: Sequence[TrackChannel], starts: Sequence[int]) -> ControllerCurve:
    points: dict[int, float] = {}
    for channel, (start, stop) in zip(channels, pairwise(starts), strict=True):
        curve = next((curve for curve in channel.curves if curve.kind == kind), None)
        if curve is None:
            if kind == "pitch_bend" and points:
                points[start] = 0.0
            continue
        first, last = bisect_left(curve.ticks, start), bisect_left(curve.ticks, stop)
        if first and start:
            points[start] = curve.values[first - 1]
        points.update(zip(curve.ticks[first:last], curve.values[first:last], strict=True))
    ticks = sorted(points)
    return ControllerCurve(kind, tuple(ticks), tuple(points[tick] for tick in ticks))
