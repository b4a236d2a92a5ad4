"""Ensembles that are known by their staves: a woodwind quintet whose tracks say nothing of themselves.

Three to eight lines of which some are silent about their instrument get those of the ensemble of the vocabulary that
they fit best: in the order of its staves, within the ranges of its instruments, each near the pitch its part usually
has. The title may name the ensemble. A track that says what it is must be what the ensemble has there.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from statistics import median_low
from typing import Final

import msgspec

from app.score.choose import TrackChannel, recognised, says_nothing, use_of
from instrument_maps.name_words import words_of
from instrument_maps.vocabulary import Ensemble, Instrument, vocabulary

_LEAST_SHARE: Final = 0.98
"""Of a part's notes that its instrument's range holds."""
_MOST_AWAY: Final = 8.0
"""Semitones between a part's median and the usual one, on average, beyond which the lines are something else..."""
_MOST_AWAY_NAMED: Final = 14.0
"""... and where the title names the ensemble."""
_LEGATO_SHARE: Final = 0.5
"""Share of a note that may sound into the next one of a line."""
_LINE_SHARE: Final = 0.95
"""Notes of a line that end when the next one begins."""


def named_by_ensemble(streams: Sequence[TrackChannel], title: str) -> list[TrackChannel]:
    """Give the instruments of a known ensemble to the tracks that say nothing themselves; the streams as they are where
    they are none."""
    silent = [says_nothing(stream) for stream in streams]
    sizes = {len(ensemble.parts) for ensemble in vocabulary().ensembles}
    if not any(silent) or len(streams) not in sizes:
        return list(streams)
    said = [None if quiet else recognised(stream) for stream, quiet in zip(streams, silent, strict=True)]
    sections = [recognised(stream) if quiet else None for stream, quiet in zip(streams, silent, strict=True)]
    if not all(
        use_of(stream) == "melodic" and (quiet or (found is not None and found.kind == "wind"))
        for stream, quiet, found in zip(streams, silent, said, strict=True)
    ) or not all(_is_line(stream) for stream, quiet in zip(streams, silent, strict=True) if quiet):
        return list(streams)
    words = words_of(title)
    ranked = [
        (not named, away + ensemble.unusual, place)
        for place, ensemble in enumerate(vocabulary().ensembles)
        if len(ensemble.parts) == len(streams)
        and _agrees(ensemble, said, sections)
        and (away := _away(ensemble, streams, silent)) is not None
        and away <= (_MOST_AWAY_NAMED if (named := _is_named(ensemble, words)) else _MOST_AWAY)
    ]
    if not ranked:
        return list(streams)
    parts = vocabulary().ensembles[min(ranked)[-1]].parts
    return [
        msgspec.structs.replace(stream, reported=(part,), reported_by="ensemble") if quiet else stream
        for stream, quiet, part in zip(streams, silent, parts, strict=True)
    ]


def _agrees(ensemble: Ensemble, said: Sequence[Instrument | None], sections: Sequence[Instrument | None]) -> bool:
    """Return whether what tracks say, of themselves or of their section, is what an ensemble has in their places."""
    words = vocabulary()
    parts = [words.instruments[part] for part in ensemble.parts]
    return all(
        found is None or found.id == part.id or words.is_kind(found, part) or words.is_kind(part, found)
        for part, found in zip(parts, said, strict=True)
    ) and all(
        section is None or not section.families or part.family in section.families
        for part, section in zip(parts, sections, strict=True)
    )


def _away(ensemble: Ensemble, streams: Sequence[TrackChannel], silent: Sequence[bool]) -> float | None:
    """The average distance of the silent parts from where an ensemble has them; None where one does not fit."""
    away = []
    for stream, quiet, part, usual in zip(streams, silent, ensemble.parts, ensemble.pitches, strict=True):
        low, high = vocabulary().ranges[part]
        inside = sum(low <= pitch <= high for pitch in stream.pitches)
        if quiet and inside < _LEAST_SHARE * len(stream.pitches):
            return None
        if quiet:
            away.append(abs(median_low(stream.pitches) - usual))
    return sum(away) / len(away)


def _is_named(ensemble: Ensemble, title: tuple[str, ...]) -> bool:
    """Return whether a title names an ensemble."""
    named = map(words_of, ensemble.names)
    return any(
        title[start : start + len(words)] == words for words in named for start in range(len(title) - len(words) + 1)
    )


def _is_line(stream: TrackChannel) -> bool:
    """Return whether one player can have the notes."""
    rows = sorted(zip(stream.onset_ticks, stream.end_ticks, strict=True))
    free = sum(
        end - following <= _LEGATO_SHARE * min(end - onset, after - following)
        for (onset, end), (following, after) in pairwise(rows)
    )
    return free >= _LINE_SHARE * (len(rows) - 1)
