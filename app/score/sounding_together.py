"""Counts the notes of a track that sound together beyond legato, and the players that they need."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from app.arrays import BoolArray, FloatArray, IndexArray, IntArray
from app.score.model import MOST_VOICES, Note
from app.score.tempo import TempoMap

# How long two notes of one player may sound together as they are played. Pianists overlap legato notes the longer, the
# longer the notes are (Repp 1995, J. Acoust. Soc. Am. 97, 3862; Bresin and Battel 2000, J. New Music Res. 29, 211-224).
# The figures are our own: 80 ms where notes are short, a quarter of a longer note, never over half of one: that is a
# chord.
LEGATO_LEAST_S: Final = 0.080
_LEGATO_SHARE: Final = 0.25
_LEGATO_MOST_S: Final = 0.200
_LEGATO_MOST_SHARE: Final = 0.5
CHORD_S: Final = 0.045
"""Largest difference between the onsets of notes struck together by two players or two fingers: in trios these
differences have standard deviations of 30 to 50 ms (Rasch 1979, Acustica 43, 121-131)."""
SEVERAL: Final = 4
"""Number of consecutive notes that must sound together with others before another player is assumed; see
`SUSTAINED_S`.
"""
SUSTAINED_S: Final = 0.4
"""Seconds for which such notes must sound together in all: two quarters of a fast march; an accident of the fingers
lasts a tenth."""
_SEVERAL_DOUBLED: Final = 8
"""Same number for octaves and unisons, since editions offer a bass an alternative octave in cadences."""
_MUCH: Final = 0.25
"""Share of a track's simultaneous notes from which a second player is assumed, however short the track."""

_ROUNDING_S: Final = 1e-9
"""Tolerance in seconds: below the shortest note, above rounding errors, so that a note starting at the end of another
one does not overlap it.
"""


class VoiceSpans(NamedTuple):
    """Times of notes in seconds, ordered by onset: onset, end and release; the release is the earliest time at which
    the same voice may begin another note.
    """

    onsets: FloatArray
    ends: FloatArray
    releases: FloatArray

    def depths(self) -> IndexArray:
        """Return the number (N,) of notes that sound at each note's onset, including the note itself."""
        started = np.searchsorted(self.onsets, self.onsets, side="right")
        return started - np.searchsorted(np.sort(self.releases), self.onsets, side="right")

    def of(self, kept: BoolArray | IndexArray) -> VoiceSpans:
        """The spans of the notes selected by a mask or by indices."""
        return VoiceSpans(self.onsets[kept], self.ends[kept], self.releases[kept])


def spans_of(notes: Sequence[Note], tempo_map: TempoMap) -> VoiceSpans:
    """Return onsets, ends and releases of notes in seconds, as arrays."""
    onset_ticks = np.array([note.onset_tick for note in notes], np.float64)
    end_ticks = onset_ticks + np.array([note.duration_tick for note in notes], np.float64)
    onsets, ends = tempo_map.seconds(onset_ticks), tempo_map.seconds(end_ticks)
    return VoiceSpans(onsets, ends, ends - legato_s(ends - onsets) - _ROUNDING_S)


def legato_s(lengths_s: FloatArray) -> FloatArray:
    """Return the longest allowed legato overlap (N,) in seconds for notes of the given lengths in seconds."""
    legato = np.clip(_LEGATO_SHARE * lengths_s, LEGATO_LEAST_S, _LEGATO_MOST_S)
    return np.minimum(legato, _LEGATO_MOST_SHARE * lengths_s)


def players_needed(spans: VoiceSpans, depths: IndexArray, pitches: IntArray) -> int:
    """Return the number of players that the overlapping notes require."""
    doubled = _doubled(spans, pitches)
    plain = spans.of(~doubled)
    plain_depths = plain.depths() if doubled.any() else depths
    deepest = min(int(depths.max()), MOST_VOICES)
    for more in range(2, deepest + 1):
        much = np.count_nonzero(_within(spans, depths, more)) >= _MUCH * len(depths)
        if not (
            much or _sustained(plain, plain_depths, more, SEVERAL) or _sustained(spans, depths, more, _SEVERAL_DOUBLED)
        ):
            return more - 1
    return deepest


def _within(spans: VoiceSpans, depths: IndexArray, more: int) -> BoolArray:
    """Return a mask (N,) of the notes during which at least ``more`` notes sound together; ``depths`` counts them after
    each onset."""
    counts = np.concatenate(([0], np.cumsum(depths >= more)))
    first = np.searchsorted(spans.onsets, spans.onsets, side="left")
    last = np.searchsorted(spans.onsets, spans.releases, side="left")
    return np.asarray(counts[np.maximum(last, first + 1)] > counts[first])


def _sustained(spans: VoiceSpans, depths: IndexArray, more: int, several: int) -> bool:
    """Return whether ``more`` notes sound together for long enough, and over several consecutive notes, that this many
    players are needed.
    """
    struck = depths >= more
    if np.count_nonzero(struck) < several:
        return False
    within = _within(spans, depths, more)
    runs = np.cumsum(~within)
    first = np.flatnonzero(struck & np.append(True, spans.onsets[1:] > spans.onsets[:-1]))
    # In a chord each note lasts until the first of them is released or the next one is struck.
    following = np.append(spans.onsets[first[1:]], np.inf)
    lengths_s = np.minimum(spans.releases[first], following) - spans.onsets[first]
    notes = np.bincount(runs[first])
    seconds = np.bincount(runs[first], weights=lengths_s)
    return bool(np.any((notes >= several) & (seconds >= SUSTAINED_S)))


def _doubled(spans: VoiceSpans, pitches: IntArray) -> BoolArray:
    """Mask (N,) of the notes that only double another note in unison or octaves, struck and released at the
    same time.
    """
    doubled = np.zeros(len(pitches), bool)
    order = np.lexsort((pitches, spans.onsets))
    for step in range(1, 3):
        one, other = order[:-step], order[step:]
        pairs = (
            (np.abs(spans.onsets[other] - spans.onsets[one]) <= CHORD_S)
            & (np.abs(spans.ends[other] - spans.ends[one]) <= LEGATO_LEAST_S)
            & ((pitches[other] - pitches[one]) % 12 == 0)
        )
        doubled[one[pairs]] = True
    return doubled
