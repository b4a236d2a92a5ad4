"""Key switches: notes far outside an instrument's range that select a sampler's articulation in a sequencer.

They make no sound and are removed: short notes before a phrase, or notes held below it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import msgspec
import numpy as np

from app.arrays import BoolArray, IntArray
from app.score.instrument_choice import How, MapCandidates, MapChoice, candidates
from app.score.tempo import TempoMap
from app.score.track_channel import TrackChannel

_AWAY: Final = 5
"""Least distance in semitones from the instrument's range; wrong notes and pedal notes are nearer."""
_APART: Final = 7
"""Least distance in semitones from the music; samplers leave half an octave free."""
_MOST_PITCHES: Final = 24
"""Greatest number of pitches: two octaves of articulations."""
_MOST_SHARE: Final = 0.4
"""Greatest share of the notes; several notes follow each switch."""
_SHORT_S: Final = 0.25
"""Length in seconds up to which a note may be a key switch; a longer one must be held while the music sounds."""
_BEFORE_S: Final = 2.0
"""Greatest seconds before the next note of the music."""
_MOST_ODD: Final = 0.2
"""Greatest share of key switches that are neither short nor held."""


def without_key_switches(
    channel: TrackChannel, found: MapCandidates, maps: Sequence[MapChoice], tempo_map: TempoMap
) -> tuple[TrackChannel, tuple[int, ...]]:
    """Remove the key switches from a channel; returns the channel (unchanged if it has none) and the indices of the
    removed notes.

    Parameters
    ----------
    found : MapCandidates
        Candidate maps of the track.
    maps : sequence of MapChoice
        All available maps.
    """
    pitches = np.array(channel.pitches)
    for away in _far(pitches):
        rest = _kept(channel, ~away)
        # If only the range chose the instrument, the maps found fit the key switches too.
        own = found if found.how is not How.RANGE else candidates([rest], maps)
        choice = own.best(rest.pitches)
        low, high = choice.usual_range
        low, high = low - _AWAY, high + _AWAY
        if ((pitches[away] <= low) | (pitches[away] >= high)).all() and _switch(channel, away, tempo_map):
            return rest, tuple(np.flatnonzero(away).tolist())
    return channel, ()


def _far(pitches: IntArray) -> list[BoolArray]:
    """Return masks (N,) of the few notes below, and of those above, the widest gap in a channel's pitches; empty if no
    gap is wide.
    """
    used = np.unique(pitches)
    gaps = np.diff(used)
    if not len(gaps) or gaps.max() < _APART:
        return []
    at = used[int(gaps.argmax())]
    parts = (pitches <= at, pitches > at)
    few = [part for part in parts if np.count_nonzero(part) <= _MOST_SHARE * len(pitches)]
    return [part for part in few if len(np.unique(pitches[part])) <= _MOST_PITCHES]


def _switch(channel: TrackChannel, away: BoolArray, tempo_map: TempoMap) -> bool:
    """Return whether the notes marked in ``away`` are played like key switches: short and before the music, or held
    while it sounds.
    """
    onsets = tempo_map.seconds(np.array(channel.onset_ticks))
    ends = tempo_map.seconds(np.array(channel.end_ticks))
    music_onsets, music_ends = onsets[~away], np.maximum.accumulate(ends[~away])
    following = np.append(music_onsets, np.inf)[np.searchsorted(music_onsets, onsets[away])]
    sounding_until = np.append(-np.inf, music_ends)[np.searchsorted(music_onsets, onsets[away], side="right")]
    begun = (following - onsets[away] <= _BEFORE_S) | (sounding_until > onsets[away])
    held = (following < ends[away]) | (sounding_until > onsets[away])
    short = ends[away] - onsets[away] <= _SHORT_S
    odd = ~(begun & (short | held))
    return bool(np.count_nonzero(odd) <= _MOST_ODD * len(odd))


def _kept(channel: TrackChannel, kept: BoolArray) -> TrackChannel:
    """Return a channel with only those notes that the mask selects."""
    places = np.flatnonzero(kept).tolist()
    columns = ("onset_ticks", "end_ticks", "pitches", "velocities", "numbers")
    return msgspec.structs.replace(
        channel, **{name: [getattr(channel, name)[place] for place in places] for name in columns}
    )
