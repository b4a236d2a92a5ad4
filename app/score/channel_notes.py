"""Notes of one channel while they are collected, and repair of missing or ambiguous note-offs."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from itertools import compress, pairwise
from typing import Final

import msgspec

_MOST_TOGETHER: Final = 0.05
"""Greatest share of a melody's notes that overlap others, by legato or by short wrong notes of a wind controller."""


class ChannelNotes(msgspec.Struct):
    """Notes of one channel while they are collected, as parallel lists by onset.

    ``numbers`` is the index of each note among the note-ons of the track, from 1.
    """

    onset_ticks: list[int] = []
    end_ticks: list[int] = []
    pitches: list[int] = []
    velocities: list[int] = []
    numbers: list[int] = []

    def where(self, kept: list[bool]) -> ChannelNotes:
        """Select the notes that a mask marks; returns the object itself if it marks all."""
        if all(kept):
            return self
        return ChannelNotes(*(list(compress(column, kept)) for column in msgspec.structs.astuple(self)))


def end_unended(notes: ChannelNotes, silenced: Mapping[int, int], most_ticks: int, track_end: int) -> int:
    """Set ends for notes without a note-off, change the ends of the other notes of the same pitches to match, drop a
    second note of one pitch and tick, and return the number of notes that had no end.

    So far note-offs were matched first in, first out; here the first note-off after a note ends it, unless the pitch is
    struck again before.

    Parameters
    ----------
    notes : ChannelNotes
        The notes; a negative end marks one without a note-off.
    silenced : mapping of int to int
        Tick of an all-notes-off, by the number of the note it ended.
    """
    onsets, ends = notes.onset_ticks, notes.end_ticks
    count = 0
    doubled: set[int] = set()
    of_pitch: dict[int, list[int]] = {pitch: [] for pitch, end in zip(notes.pitches, ends, strict=True) if end < 0}
    for index, pitch in enumerate(notes.pitches):
        if pitch in of_pitch:
            of_pitch[pitch].append(index)
    for places in of_pitch.values():
        offs = sorted(ends[index] for index in places if ends[index] >= 0)
        struck: dict[int, int] = {}
        for index in places:
            if struck.setdefault(onsets[index], index) != index:
                doubled.add(index)
        count += len(places) - len(struck)
        again = [*list(struck)[1:], track_end + 1]
        for (onset, index), following in zip(struck.items(), again, strict=True):
            at = bisect_right(offs, onset)
            if at < len(offs) and offs[at] <= following:
                ends[index] = offs[at]
                continue
            later = bisect_right(onsets, onset)
            next_onset = onsets[later] if later < len(onsets) else track_end
            silence = silenced.get(index, track_end)
            ends[index] = min(next_onset, onset + most_ticks, silence)
            count += index not in silenced or ends[index] < silence
    if doubled:
        for name in notes.__struct_fields__:
            values = getattr(notes, name)
            values[:] = [value for index, value in enumerate(values) if index not in doubled]
    return count


def end_where_struck_again(notes: ChannelNotes) -> None:
    """End overlapping notes of one pitch where the next one begins, if the channel becomes monophonic by this.

    A wind controller may strike a note again without ending it, and send two note-offs later. Matched first in, first
    out, the second note would sound on below other notes.
    """
    onsets, ends = notes.onset_ticks, notes.end_ticks
    of_pitch: dict[int, list[int]] = {}
    for index, pitch in enumerate(notes.pitches):
        of_pitch.setdefault(pitch, []).append(index)
    followed = list(ends)
    for places in of_pitch.values():
        offs = sorted(ends[index] for index in places)
        for index, again in pairwise(places):
            if onsets[index] == onsets[again]:
                # Two players in unison.
                return
        for index, again in pairwise([*places, -1]):
            if ends[index] > onsets[index]:
                first_off = offs[bisect_right(offs, onsets[index])]
                followed[index] = first_off if again < 0 else min(first_off, onsets[again])
    swallowed, together = covered(notes, ends)
    if not swallowed or not together:
        return
    swallowed_then, together_then = covered(notes, followed)
    sounding = sum(followed) - sum(onsets)
    if swallowed_then < swallowed and together_then < together and together_then <= _MOST_TOGETHER * sounding:
        ends[:] = followed


def end_late(notes: ChannelNotes) -> None:
    """End notes at the tick where their pitch is struck again, if their note-off comes later.

    A key must be released before it is struck again, so one instrument never sounds a pitch twice. Two players on one
    channel may: assumed where other notes overlap too and at most two notes of the pitch do. An overlap of less than a
    quarter of the note is legato and stays.
    """
    onsets, ends = notes.onset_ticks, notes.end_ticks
    of_pitch: dict[int, list[int]] = {}
    for index, pitch in enumerate(notes.pitches):
        of_pitch.setdefault(pitch, []).append(index)
    cut = list(ends)
    deep: set[int] = set()
    for pitch, places in of_pitch.items():
        at = list(dict.fromkeys(onsets[index] for index in places))
        for index in places:
            later = bisect_right(at, onsets[index])
            again = at[later] if later < len(at) else ends[index]
            if ends[index] > again and 4 * (ends[index] - again) >= ends[index] - onsets[index]:
                cut[index] = again
            if later + 1 < len(at) and ends[index] > at[later + 1]:
                deep.add(pitch)
    melody = covered(notes, cut)[1] <= _MOST_TOGETHER * (sum(cut) - sum(onsets))
    ends[:] = [
        new if melody or pitch in deep else old for new, old, pitch in zip(cut, ends, notes.pitches, strict=True)
    ]


def covered(notes: ChannelNotes, ends: Sequence[int]) -> tuple[int, int]:
    """Return the number of notes that lie completely within a note of another pitch, and the total ticks in which a
    note overlaps an earlier note of another pitch.
    """
    swallowed = together = 0
    # Latest end of the pitch that ends last, and of any other pitch.
    last, last_end, other_end = -1, -1, -1
    for onset, end, pitch in zip(notes.onset_ticks, ends, notes.pitches, strict=True):
        until = other_end if pitch == last else last_end
        if until < 0:
            until = onset
        if until >= end:
            swallowed += 1
            together += end - onset if end > onset else 0
        elif until > onset:
            together += until - onset
        if pitch == last:
            if end > last_end:
                last_end = end
        elif end > last_end:
            last, last_end, other_end = pitch, end, last_end
        elif end > other_end:
            other_end = end
    return swallowed, together
