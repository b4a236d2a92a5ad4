"""Cuts stuck notes, whose note-off comes long after all other music because a key or cable stuck while recording.

A note is cut at the end of the other notes if it lasts so much longer that the rest of the piece is short in
comparison.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from app.errors import Message
from app.score.limits import LAST_TICK
from app.score.metre_map import MetreMap
from app.score.tempo import TempoMap
from app.score.tracks import TrackEvents

ALONE_S: Final = 3600.0
"""Seconds for which a note sounds after all others have ended from which it is stuck."""
BESIDE_S, TIMES = 600.0, 2.0
"""Seconds of a note, and multiple of the remaining piece's duration, above which it is stuck too."""


class _Long(NamedTuple):
    """A note so long that its end may be missing: track, channel and index, onset, end and pitch."""

    track: int
    channel: int
    number: int
    onset_tick: int
    end_tick: int
    pitch: int


def cut_stuck_notes(
    tracks: Sequence[TrackEvents], tempo_map: TempoMap, metre_map: MetreMap, least_ticks: int
) -> list[Message]:
    """Cut the stuck notes of a file in place, and return a message for each track that had some.

    Parameters
    ----------
    least_ticks : int
        Length that a note keeps at least.
    """
    long, rest_tick, others = _candidates(tracks, tempo_map)
    if not long:
        return []
    rest_tick = max(rest_tick, *(note.onset_tick for note in long))
    rest_s = tempo_map.seconds(float(rest_tick))
    stuck = []
    for note in long:
        over_s = tempo_map.seconds(float(min(note.end_tick, LAST_TICK))) - rest_s
        if over_s > ALONE_S or (others and over_s > max(BESIDE_S, TIMES * rest_s)):
            stuck.append(note)
            tracks[note.track].channels[note.channel].end_ticks[note.number] = max(
                rest_tick, note.onset_tick + least_ticks
            )
    return _messages(stuck, tempo_map, metre_map)


def _candidates(tracks: Sequence[TrackEvents], tempo_map: TempoMap) -> tuple[list[_Long], int, bool]:
    """Find the notes that may be stuck because they sound alone for longer than `BESIDE_S`; also return the tick at
    which all other notes have ended, and whether there are other notes.
    """
    long: list[_Long] = []
    rest_tick, others = 0, False
    for track, events in enumerate(tracks):
        for channel, notes in events.channels.items():
            onsets = np.minimum(np.array(notes.onset_ticks, np.float64), LAST_TICK)
            ends = np.minimum(np.array(notes.end_ticks, np.float64), LAST_TICK)
            lasts = tempo_map.seconds(ends) - tempo_map.seconds(onsets) > BESIDE_S
            for index in np.flatnonzero(lasts).tolist():
                row = notes.onset_ticks[index], notes.end_ticks[index], notes.pitches[index]
                long.append(_Long(track, channel, index, *row))
            if not lasts.all():
                others = True
                rest_tick = max(rest_tick, int(ends[~lasts].max()))
    return long, rest_tick, others


def _messages(stuck: Sequence[_Long], tempo_map: TempoMap, metre_map: MetreMap) -> list[Message]:
    found = []
    for track in sorted({note.track for note in stuck}):
        own = [note for note in stuck if note.track == track]
        first = min(own, key=lambda note: (note.onset_tick, note.pitch))
        hours = tempo_map.seconds(float(min(first.end_tick, LAST_TICK))) - tempo_map.seconds(float(first.onset_tick))
        found.append(
            Message(
                "midi.stuck_notes",
                {
                    "track": track + 1,
                    "count": len(own),
                    "place": metre_map.label(first.onset_tick),
                    "pitch": first.pitch,
                    "hours": float(f"{hours / 3600.0:.2g}"),
                },
            )
        )
    return found
