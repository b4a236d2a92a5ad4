"""Recognises standard ensembles by their staves, such as a woodwind quintet whose tracks have no instrument names.

Applies to three to eight lines if some have no known instrument. They get the instruments of the best fitting ensemble
of the vocabulary: in the order of its staves, within the instruments' ranges, compared by lowest, middle and highest
notes with the usual ones of each part or with the instrument's compass. The title may name the ensemble. Tracks with a
known instrument must agree. Ensembles with equal ranges (four saxophones; two trumpets, horn and trombone in a chorale)
cannot be told apart by notes: the more common one is chosen.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from statistics import median_low
from typing import Final, NamedTuple

import msgspec

from app.score.track_channel import TrackChannel
from app.score.track_instrument import recognised, says_nothing, use_of
from instrument_maps.instrument_names import vocabulary
from instrument_maps.instruments import Ensemble, Instrument
from instrument_maps.name_words import words_of

_LEAST_SHARE: Final = 0.98
"""Least share of a part's notes within its instrument's range."""
_MOST_AWAY: Final = 8.0
"""Mean distance in semitones of the parts' medians from the usual ones above which it is a different ensemble."""
_MOST_AWAY_NAMED: Final = 14.0
"""Limit that replaces `_MOST_AWAY` if the title names the ensemble."""
_FEW_SHARE: Final = 0.02
"""Share of lowest and highest notes that is ignored in determining a compass."""
_AROUND: Final = 11
"""Usual deviation in semitones of a part's median, within the easy range of the instrument."""
_END: Final = 0.5
"""Weight of a semitone at an end of the compass relative to one of the median; applied again outside the easy range."""
_LEGATO_SHARE: Final = 0.5
"""Share of a note that may overlap the next one in a line."""
_LINE_SHARE: Final = 0.95
"""Least share of a line's notes that end before or shortly after the next one begins."""


def named_by_ensemble(channels: Sequence[TrackChannel], title: str) -> list[TrackChannel]:
    """Assign the instruments of a recognised ensemble to tracks without an instrument; returns the channels unchanged
    if no ensemble is recognised.
    """
    silent = [says_nothing(channel) for channel in channels]
    sizes = {len(ensemble.parts) for ensemble in vocabulary().ensembles}
    if not any(silent) or len(channels) not in sizes:
        return list(channels)
    said = [None if quiet else recognised(channel) for channel, quiet in zip(channels, silent, strict=True)]
    sections = [recognised(channel) if quiet else None for channel, quiet in zip(channels, silent, strict=True)]
    if not all(
        use_of(channel) == "melodic" and (quiet or (found is not None and found.kind == "wind"))
        for channel, quiet, found in zip(channels, silent, said, strict=True)
    ) or not all(_is_line(channel) for channel, quiet in zip(channels, silent, strict=True) if quiet):
        return list(channels)
    words = words_of(title)
    ranked = [
        (not named, away.unlike + ensemble.unusual, place)
        for place, ensemble in enumerate(vocabulary().ensembles)
        if len(ensemble.parts) == len(channels)
        and _agrees(ensemble, said, sections)
        and (away := _away(ensemble, channels, silent)) is not None
        and away.median <= (_MOST_AWAY_NAMED if (named := _is_named(ensemble, words)) else _MOST_AWAY)
    ]
    if not ranked:
        return list(channels)
    parts = vocabulary().ensembles[min(ranked)[-1]].parts
    return [
        msgspec.structs.replace(channel, reported=(part,), reported_by="ensemble") if quiet else channel
        for channel, quiet, part in zip(channels, silent, parts, strict=True)
    ]


def _agrees(ensemble: Ensemble, said: Sequence[Instrument | None], sections: Sequence[Instrument | None]) -> bool:
    """Return whether the staves of an ensemble match the instruments (``said``) and sections that are known for the
    tracks; None stands for an unknown one.
    """
    words = vocabulary()
    parts = [words.instruments[part] for part in ensemble.parts]
    return all(
        found is None or found.id == part.id or words.is_kind(found, part) or words.is_kind(part, found)
        for part, found in zip(parts, said, strict=True)
    ) and all(
        section is None or not section.families or part.family in section.families
        for part, section in zip(parts, sections, strict=True)
    )


class _Away(NamedTuple):
    """Mean distance in semitones between the parts without an instrument and the usual ranges of an ensemble's staves:
    of the middle notes alone, and in total.
    """

    median: float
    unlike: float


def _away(ensemble: Ensemble, channels: Sequence[TrackChannel], silent: Sequence[bool]) -> _Away | None:
    """Distance of the parts without an instrument from an ensemble, in semitones: by the usual range of each staff or
    by the compass of its instrument, whichever is smaller; None if a part is out of range.
    """
    in_place, in_middle, beyond = [], [], []
    for channel, quiet, part, usual in zip(channels, silent, ensemble.parts, ensemble.pitches, strict=True):
        if not quiet:
            continue
        compass = vocabulary().ranges[part]
        pitches = sorted(channel.pitches)
        if sum(compass.low <= pitch <= compass.high for pitch in pitches) < _LEAST_SHARE * len(pitches):
            return None
        few = int(_FEW_SHARE * len(pitches))
        found = pitches[few], median_low(pitches), pitches[-1 - few]
        low, high = compass.easy_low, compass.easy_high
        in_place.append(_apart(found, (max(low, usual - _AROUND), usual, min(high, usual + _AROUND))))
        in_middle.append(_apart(found, (low, (low + high) / 2.0, high)))
        beyond.append(max(low - found[0], 0) + max(found[2] - high, 0))
    unlike, median = min(
        (sum(away.unlike for away in ways), sum(away.median for away in ways)) for ways in (in_place, in_middle)
    )
    return _Away(median / len(beyond), (unlike + _END * sum(beyond)) / len(beyond))


def _apart(found: tuple[float, float, float], usual: tuple[float, float, float]) -> _Away:
    """Distance in semitones between a part's notes and the usual ones, each given as (lowest, middle, highest)."""
    low, middle, high = (abs(one - other) for one, other in zip(found, usual, strict=True))
    return _Away(middle, middle + _END * (low + high))


def _is_named(ensemble: Ensemble, title: tuple[str, ...]) -> bool:
    """Return whether a title names an ensemble."""
    named = map(words_of, ensemble.names)
    return any(
        title[start : start + len(words)] == words for words in named for start in range(len(title) - len(words) + 1)
    )


def _is_line(channel: TrackChannel) -> bool:
    """Return whether the notes can be played by one player: almost none overlap."""
    rows = sorted(zip(channel.onset_ticks, channel.end_ticks, strict=True))
    free = sum(
        end - following <= _LEGATO_SHARE * min(end - onset, after - following)
        for (onset, end), (following, after) in pairwise(rows)
    )
    return free >= _LINE_SHARE * (len(rows) - 1)
