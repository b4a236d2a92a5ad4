"""Chooses the instrument map of a track: by its names, its program or the title of the piece, then by its range.

An exact match precedes a related instrument: a part for clarinet in A goes to the map of the clarinet in A if there is
one, else to any clarinet; a part for recorder goes to the size that fits the notes.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Sequence
from enum import Enum
from typing import Final

import msgspec

from app.errors import Argument, Message, UsageError
from app.score.track_channel import TrackChannel
from app.score.track_instrument import (
    by_program_alone,
    called,
    is_named,
    said_of,
    said_plainly,
    use_of,
)
from instrument_maps.instrument_names import vocabulary
from instrument_maps.instruments import Instrument

_NEEDED_SHARE = 0.5
LEAST_OUTSIDE: Final = 0.1
"""Share of a part's notes outside its instrument's range from which its pitches are considered to be written ones, or
its program that of another instrument.
"""
_OWN_SHARE = 0.96
_FEW = 3
_FEW_SHARE = 0.9
"""Share of notes, relative to the best instrument of a family, from which the named size or key is kept although others
fit more notes; a short part may have three misfits more.
"""


class MapChoice(msgspec.Struct, frozen=True):
    """Facts about an instrument map that decide whether it is chosen.

    Attributes
    ----------
    plays, substitutes_for : tuple of str
        Ids in the vocabulary of instruments: those it plays, and those for which it may be substituted.
    concert_low, concert_high : int
        Range at concert pitch, inclusive, MIDI numbers.
    transposition_semitones : int
        Semitones by which its parts are written above the sounding pitch.
    usual : (int, int) or None
        Range without pedal tones and altissimo, where this is smaller.
    """

    map_id: str
    plays: tuple[str, ...]
    substitutes_for: tuple[str, ...]
    concert_low: int
    concert_high: int
    transposition_semitones: int = 0
    usual: tuple[int, int] | None = None

    @property
    def usual_range(self) -> tuple[int, int]:
        """Range of the map's instrument without pedal tones and altissimo."""
        return (self.concert_low, self.concert_high) if self.usual is None else self.usual

    def outside(self, pitches: Sequence[int], written: bool = False, usual: bool = False) -> int:
        """Count the pitches outside the instrument's range; ``written`` if they are written pitches, ``usual`` to
        compare with the narrower usual range.
        """
        shift = self.transposition_semitones if written else 0
        low, high = self.usual_range if usual else (self.concert_low, self.concert_high)
        low, high = low + shift, high + shift
        if low <= min(pitches) and max(pitches) <= high:
            return 0
        # Thousands of notes have few different pitches.
        return sum(count for pitch, count in Counter(pitches).items() if not low <= pitch <= high)


class How(Enum):
    """Evidence by which the instrument maps of a track were found."""

    SAID = "said"
    """Decided by the names or the program of the part."""
    ENSEMBLE = "ensemble"
    """Decided by all staves together, which match a known ensemble."""
    TITLE = "title"
    """Decided by the title in the file; the file's name does not count."""
    RANGE = "range"
    """Decided by the range of the notes alone."""


class MapCandidates(msgspec.Struct, frozen=True):
    """Instrument maps that a track can be assigned to, and the evidence for them.

    Attributes
    ----------
    instrument : Instrument or None
        Instrument of the track, if its names or program give one.
    exact : frozenset of str
        Ids of the maps for exactly this instrument, not a related one.
    refused : Instrument or None
        Instrument of the track's program, rejected since it cannot play the notes.
    unknown : bool
        Whether the track has a name that is not understood: any map might fit, so the user must choose.
    """

    how: How
    instrument: Instrument | None
    maps: tuple[MapChoice, ...]
    exact: frozenset[str] = frozenset()
    unknown: bool = False
    refused: Instrument | None = None

    def best(self, pitches: Sequence[int], written: bool = False) -> MapChoice:
        """Choose a map for the pitches of a part: the one for exactly this instrument if all notes are in its range;
        else the map that reaches most notes, and among nearly equal ones the map whose range is centred on them. Where
        players choose an instrument's key by the part, a map that can play all notes is preferred over one that misses
        a few.

        Parameters
        ----------
        written : bool
            Whether the pitches are written ones instead of sounding ones.
        """

        lowest, highest = min(pitches), max(pitches)
        by_part = self.instrument is not None and self.instrument.key_by_part
        reached = by_part and any(not choice.outside(pitches, written, usual=True) for choice in self.maps)
        shares = {one.map_id: _share(pitches, one, written, usual=one.map_id not in self.exact) for one in self.maps}
        most = max(shares.values())

        def rank(choice: MapChoice) -> tuple[bool, float, int, int]:
            # An instrument that is named plays pedal tones too; they are no reason to choose an instrument.
            share = shares[choice.map_id]
            shift = choice.transposition_semitones if written else 0
            low, high = choice.usual_range
            below, above = lowest - shift - low, high - highest + shift

            def nearly(whole: float) -> bool:
                return (whole - share) * len(pitches) < _FEW + 0.5 and share >= _FEW_SHARE * whole and not reached

            few = nearly(1.0)
            # Notes that no map reaches are no argument for another map.
            return (
                choice.map_id in self.exact and (nearly(most) or share >= most * (1.0 if reached else _OWN_SHARE)),
                1.0 if few else share,
                -abs(below - above),
                min(below, above),
            )

        return max(self.maps, key=rank)


def require_map(map_id: str, known: Collection[str]) -> str:
    """Return ``map_id``, chosen by the user for a part or player, if a map with this id exists.

    Raises
    ------
    UsageError
        There is no map of this id.
    """
    if map_id not in known:
        raise UsageError("assign.instrument_unknown", instrument=map_id, possible=", ".join(known))
    return map_id


def candidates(channels: Sequence[TrackChannel], maps: Sequence[MapChoice]) -> MapCandidates:
    """Find the instrument maps that can be assigned to tracks played as one part; if names and programs give no
    instrument, by range alone.
    """
    lead = next((one for one in channels if said_of(one) is not None), channels[0])
    said = said_of(lead)
    pitches = [pitch for channel in channels for pitch in channel.pitches]
    if said is not None and not said.any_pitch:
        found = _of_instrument(How.SAID, said, maps)
        numbered, general = by_program_alone(lead), said_plainly(lead)
        if general is not None and general != said and not any(plays(choice, said) for choice in found.maps):
            # A size of the family that no map plays.
            found = _of_instrument(How.SAID, general, maps)
        return found if numbered is None else _instead(numbered, found, pitches, maps) or found
    reported = dict.fromkeys(id for channel in channels for id in channel.reported) if said is None else {}
    how = How.ENSEMBLE if any(one.reported_by == "ensemble" for one in channels) else How.TITLE
    named = [vocabulary().instruments[id] for id in reported]
    possible = [_of_instrument(how, one, maps) for one in named if not one.any_pitch]
    fitting = [one for one in possible if any(_share(pitches, choice) > _NEEDED_SHARE for choice in one.maps)]
    if len(fitting) == 1:
        return fitting[0]
    if fitting:
        together = {choice.map_id: choice for one in fitting for choice in one.maps}
        return MapCandidates(how, None, tuple(together.values()))
    section = said or next((one for one in named if one.any_pitch), None)
    families = () if section is None else section.families
    usual = _where(maps, lambda one: not one.by_name_only and (not families or one.family in families))
    unknown = section is None and any(map(is_named, channels))
    return MapCandidates(How.RANGE, section, tuple(usual or maps), unknown=unknown)


def refusal(channel: TrackChannel, maps: Sequence[MapChoice]) -> Message | None:
    """Return the message that explains why a track has no player; None if it has one."""
    if use_of(channel) == "effect":
        return Message("score.sound_effect")
    instrument = said_of(channel)
    found = candidates([channel], maps)
    if instrument is not None and not instrument.any_pitch:
        if instrument.kind != "wind":
            id_ = "score.percussion" if instrument.kind == "percussion" else "score.not_wind"
            return Message(id_, {"instrument": called(channel, instrument)})
        return None if found.maps else Message("score.no_map", {"instrument": instrument.names[0]})
    range_: dict[str, Argument] = {"lowest": min(channel.pitches), "highest": max(channel.pitches)}
    if found.unknown:
        return Message("score.unknown_instrument", range_)
    if max((_share(channel.pitches, choice) for choice in found.maps), default=0.0) <= _NEEDED_SHARE:
        return Message("score.outside_ranges", range_)
    return None


def _instead(
    numbered: Instrument, found: MapCandidates, pitches: Sequence[int], maps: Sequence[MapChoice]
) -> MapCandidates | None:
    """Candidate maps of another instrument, if the instrument that a part's program names cannot play its notes,
    neither as sounding nor as written pitches: of the same family, of a similar name ("horn" for English horn), of the
    section, or any; None if the program's instrument fits.
    """
    least = LEAST_OUTSIDE * len(pitches)
    if not found.maps or any(
        choice.outside(pitches) < least or not choice.outside(pitches, written=True) for choice in found.maps
    ):
        return None
    words = vocabulary()
    for relatives in words.relatives(numbered):
        fitting = [
            choice
            for choice in maps
            if _share(pitches, choice) >= _OWN_SHARE
            and any(id in words.instruments and words.instruments[id] in relatives for id in choice.plays)
        ]
        if fitting:
            best = MapCandidates(How.SAID, None, tuple(fitting)).best(pitches)
            instrument = next(words.instruments[id] for id in best.plays if id in words.instruments)
            other = _of_instrument(How.SAID, instrument, maps)
            return msgspec.structs.replace(other, refused=numbered)
    return None


def plays(choice: MapChoice, instrument: Instrument) -> bool:
    """Return whether a map plays an instrument or a variety of it."""
    return any(id == instrument.id or vocabulary().is_sort(id, instrument.id) for id in choice.plays)


def _of_instrument(how: How, instrument: Instrument, maps: Sequence[MapChoice]) -> MapCandidates:
    """Candidate maps for an instrument: those that play it or one of its varieties; else those that substitute for it;
    else those of the more general instrument.
    """
    exact = frozenset(choice.map_id for choice in maps if instrument.id in choice.plays)
    own = [choice for choice in maps if plays(choice, instrument)]
    own = own or [choice for choice in maps if instrument.id in choice.substitutes_for]
    if not own and instrument.sort_of:
        general = _of_instrument(how, vocabulary().instruments[instrument.sort_of], maps)
        return MapCandidates(how, instrument, general.maps, general.exact)
    return MapCandidates(how, instrument, tuple(own), exact)


def _where(maps: Iterable[MapChoice], requested: Callable[[Instrument], bool]) -> list[MapChoice]:
    """Select the maps that play at least one instrument for which ``requested`` returns True, and those with an
    instrument missing in the vocabulary.
    """
    known = vocabulary().instruments
    return [choice for choice in maps if any(id not in known or requested(known[id]) for id in choice.plays)]


def _share(pitches: Sequence[int], choice: MapChoice, written: bool = False, usual: bool = True) -> float:
    """Return the share of the pitches within a map's range, 0..1."""
    return (len(pitches) - choice.outside(pitches, written, usual)) / len(pitches)
