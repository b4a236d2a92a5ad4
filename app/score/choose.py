"""Chooses the instrument map of a track: by its names, its program or the piece's title, then by its range.

An exact entry of the vocabulary goes before its kind: a part for the clarinet in A goes to the map of the clarinet in
A, else to that of a clarinet; one for a recorder to the size its notes fit.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Sequence
from enum import Enum
from operator import sub
from typing import Final, Literal

import msgspec

from app.errors import Argument, Message, UsageError
from app.score.marks import Mark, Source
from app.score.model import ControllerCurve, Note
from app.score.sound_module import KIT_PROGRAMS, Use
from instrument_maps.instruments import Instrument
from instrument_maps.vocabulary import vocabulary

_KIT, _EFFECT, _VOICE = "drums", "effect", "voice"
"""Ids in the vocabulary."""
_KIT_NOTES = range(35, 60)
_NEEDED_SHARE = 0.5
LEAST_OUTSIDE: Final = 0.1
"""The share of a part's notes beyond its instrument's range from which on its pitches are taken for written ones, or
its program for another instrument's."""
_OWN_SHARE = 0.96
_FEW = 3
_FEW_SHARE = 0.9
"""A part for an instrument is played on just this one where it has nearly all notes, not on another size or key of it
for the sake of a few; three in a short part may be more."""


class MapChoice(msgspec.Struct, frozen=True):
    """What an instrument map can be chosen for.

    Attributes
    ----------
    plays, substitutes_for : tuple of str
        Ids in the vocabulary of instruments: its own, and those it may stand in for.
    concert_low, concert_high : int
        Its range at concert pitch, both included, MIDI numbers.
    transposition_semitones : int
        How much higher its parts are written than they sound.
    usual : (int, int) or None
        Its range without pedal tones and altissimo, where that is smaller.
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
        """Its range without pedal tones and altissimo."""
        return (self.concert_low, self.concert_high) if self.usual is None else self.usual

    def outside(self, pitches: Sequence[int], written: bool = False, usual: bool = False) -> int:
        """Return how many of these pitches, sounding or written ones, it does not reach (``usual``: without pedal tones
        and altissimo)."""
        shift = self.transposition_semitones if written else 0
        low, high = self.usual_range if usual else (self.concert_low, self.concert_high)
        low, high = low + shift, high + shift
        if low <= min(pitches) and max(pitches) <= high:
            return 0
        # Of thousands of notes few are different.
        return sum(count for pitch, count in Counter(pitches).items() if not low <= pitch <= high)


class TrackChannel(msgspec.Struct, frozen=True):
    """The notes of one track on one channel, as read.

    Attributes
    ----------
    track : int
        Counted from 0.
    name, instrument_name : str
        The track's texts for people, empty if there are none.
    onset_ticks, end_ticks, pitches, velocities, numbers : list of int
        One entry per note, by onset; ``numbers`` is the note's place among the track's note-ons, from 1.
    reported : tuple of str
        Of a track that says nothing itself: ids of the instruments that it may be for.
    reported_by : {"title", "ensemble"}
        What says so: the piece's title, or the staves together (`app.score.ensembles`).
    played_on : str
        Id of the instrument that its player changes to for these notes (`app.score.doublings`); empty: that of the
        track.
    change : int
        Which of its player's instruments that is, from 0.
    muted : tuple of (start, end)
        Spans of ticks in which the track is played with a mute.
    stopped : tuple of (start, end)
        Those of them in which the hand stops the bell.
    recorded : bool
        The file says that it is a take of ``suisou record``.
    solos : tuple of (tick, player)
        Who of several players has the notes alone from there on, from 1; 0: all play (`app.score.solos`).
    use : {"melodic", "rhythm", "effect"}
        What its channel is on a sound module while it plays (`app.score.sound_module`).
    certain : bool
        A message says so that means nothing else.
    struck : list of int
        Of a rhythm part: the sounds of its notes as General MIDI numbers them; empty where they are its pitches.
    line : int
        The first of the tracks over which its line is spread (`app.score.spread`); -1: it has the line to itself.
    marks, source
        As those of a `Part`; marks are of the ids that `notes` gives.
    """

    track: int
    channel: int
    name: str
    instrument_name: str
    program: int | None
    onset_ticks: list[int]
    end_ticks: list[int]
    pitches: list[int]
    velocities: list[int]
    numbers: list[int]
    curves: tuple[ControllerCurve, ...]
    reported: tuple[str, ...] = ()
    reported_by: Literal["title", "ensemble"] = "title"
    played_on: str = ""
    change: int = 0
    muted: tuple[tuple[int, int], ...] = ()
    stopped: tuple[tuple[int, int], ...] = ()
    solos: tuple[tuple[int, int], ...] = ()
    recorded: bool = False
    use: Use = "melodic"
    certain: bool = False
    struck: list[int] = []
    line: int = -1
    marks: tuple[Mark, ...] = ()
    source: Source = "sound"

    @property
    def place(self) -> tuple[int, int, int]:
        """Track, channel and instrument, as of the parts that come of it."""
        return self.track, self.channel, self.change

    def notes(self) -> list[Note]:
        """The notes, in the same order."""
        ids = [f"{self.track + 1}:{number}" for number in self.numbers]
        durations = map(sub, self.end_ticks, self.onset_ticks)
        return list(map(Note, ids, self.onset_ticks, durations, self.pitches, self.velocities))


_ORDINAL = r"(?:1[0-6]|[1-9]|VIII|VII|VI|IV|V|III|II|I)(?:st|nd|rd|th|er|[.aoºª°])?"
_PLAYERS = re.compile(
    rf"(?<![A-Za-z\d♭♯#]){_ORDINAL}(?:\s*(?:[.,/&+・–-]|\b(?:and|und|et|ed?|y)\b)\s*{_ORDINAL})+(?![A-Za-z\d♭♯#])"
)
_NO_PROGRAM = 0
_SAYS_NOTHING = re.compile(
    r"(?:(?:midi|new|part|track|staff|voice|channel|untitled|instrument|spur|stimme|system|piste|pista)[a-h]?|"
    r"(?<![^\W\d_])(?:[a-h]|one|two|three|four|five|six|upper|lower|top|middle|bottom|uno|due|tre)(?![^\W\d_])|"
    r"дорожка|трек|канал|パート|トラック|チャンネル|트랙|채널|音轨|音軌|轨道|軌道|通道|[\W\d_])*",
    re.IGNORECASE,
)
"""What programs call a track that no one has named."""
_UNISON = re.compile(r"(?<!\w)[aà] ?([2-4])(?!\w)")
_NUMERALS = ("I", "II", "III", "IV", "V", "VI", "VII", "VIII")


def players_named(name: str) -> int:
    """Return how many players a track's name says it is for: 2 in "Horn 1.2", "Cl. I/II" and "Trumpet a2", 4 in "Trb.
    1-4"; 1 where it says nothing about it."""
    together = _UNISON.search(name)
    if together:
        return int(together[1])
    found = _PLAYERS.search(name)
    if not found:
        return 1
    said = [_NUMERALS.index(one) + 1 if one in _NUMERALS else int(one) for one in re.findall(r"\d+|[IV]+", found[0])]
    through = len(said) == 2 and re.search(r"[–-]", found[0]) and said[0] < said[1]
    return min(said[1] - said[0] + 1 if through else len(set(said)), 16)


class How(Enum):
    """What chose the maps a track may go to."""

    SAID = "said"
    """Its names or its program."""
    ENSEMBLE = "ensemble"
    """The staves together, which are those of a known ensemble."""
    TITLE = "title"
    """The title of the piece, as the file holds it; what the file is called says nothing."""
    RANGE = "range"
    """Nothing but its notes."""


class MapCandidates(msgspec.Struct, frozen=True):
    """Instrument maps that a track can be given, and how they were found.

    Attributes
    ----------
    instrument : Instrument or None
        What the track is for, where that is said.
    exact : frozenset of str
        Ids of the maps that play just this instrument, not a kind of it.
    refused : Instrument or None
        What the track's program names, which cannot play it.
    unknown : bool
        The track has a name, and nothing says what it means: any of the maps might play it, so the user must say.
    """

    how: How
    instrument: Instrument | None
    maps: tuple[MapChoice, ...]
    exact: frozenset[str] = frozenset()
    unknown: bool = False
    refused: Instrument | None = None

    def best(self, pitches: Sequence[int], written: bool = False) -> MapChoice:
        """The map that plays just this instrument where it has the notes; else the one that reaches most of them, among
        equals (a few notes aside) the one in the middle of whose range they lie. Where players choose the key by the
        part, no note is set aside for which another key has a fingering.

        Parameters
        ----------
        written : bool
            They are written ones, not those that sound.
        """

        lowest, highest = min(pitches), max(pitches)
        by_part = self.instrument is not None and self.instrument.key_by_part
        reached = by_part and any(not choice.outside(pitches, written, usual=True) for choice in self.maps)

        def rank(choice: MapChoice) -> tuple[bool, float, int, int]:
            # Who is asked for by name plays pedal tones too; nobody is chosen for them.
            share = _share(pitches, choice, written, usual=choice.map_id not in self.exact)
            shift = choice.transposition_semitones if written else 0
            low, high = choice.usual_range
            below, above = lowest - shift - low, high - highest + shift
            few = (1.0 - share) * len(pitches) < _FEW + 0.5 and share >= _FEW_SHARE and not reached
            return (
                choice.map_id in self.exact and (few or share >= (1.0 if reached else _OWN_SHARE)),
                1.0 if few else share,
                -abs(below - above),
                min(below, above),
            )

        return max(self.maps, key=rank)


def require_map(map_id: str, known: Collection[str]) -> str:
    """The id of an instrument map that the user assigns to a part or a player.

    Raises
    ------
    UsageError
        ``assign.instrument_unknown`` (instrument, possible): there is none of this id.
    """
    if map_id not in known:
        raise UsageError("assign.instrument_unknown", instrument=map_id, possible=", ".join(known))
    return map_id


def recognised(stream: TrackChannel) -> Instrument | None:
    """The instrument that a track's names or numbers, or else the title, give to it; None if they give none."""
    said = _said(stream)
    return vocabulary().instruments[stream.reported[0]] if said is None and len(stream.reported) == 1 else said


def use_of(stream: TrackChannel) -> Use:
    """Return what a track is: a melody, a rhythm part, whose notes name the sounds of a drum kit, or sound effects.

    What the sound module was set to decides, but where that is only what channel 10 or a bank usually is, a name of
    anything but percussion makes it a melody. The name of a drum kit makes a rhythm part of any channel, if its
    program may be a kit's and most notes are those of a kit.
    """
    telling, vague = _named(stream)
    if stream.use == "melodic":
        kit = telling is not None and telling.id == _KIT and (stream.program is None or stream.program in KIT_PROGRAMS)
        return "rhythm" if kit and _names_kit(stream.pitches) else "melodic"
    named = telling or vague
    return stream.use if stream.certain or named is None or named.kind == "percussion" else "melodic"


def _named(stream: TrackChannel) -> tuple[Instrument | None, Instrument | None]:
    """Return what the names of a track mean: the first that tells, and the first that may mean a part of any
    instrument."""
    words = vocabulary()
    named = [found for text in (stream.name, stream.instrument_name) if text and (found := words.by_name(text))]
    telling = next((found for found in named if not found.vague), None)
    return telling, next(iter(named), None) if telling is None else None


def is_named(stream: TrackChannel) -> bool:
    """Return whether someone named a track, not the program that wrote it."""
    return not all(map(is_no_name, (stream.name, stream.instrument_name)))


def is_no_name(text: str) -> bool:
    """Return whether a track's name is what a program calls a track that no one has named, or none."""
    return _SAYS_NOTHING.fullmatch(text) is not None


def _names_kit(pitches: Sequence[int]) -> bool:
    """Return whether most notes are bass drums, snare drums, toms, hi-hats and cymbals in General MIDI."""
    return 2 * sum(map(_KIT_NOTES.__contains__, pitches)) > len(pitches)


def says_nothing(stream: TrackChannel) -> bool:
    """Return whether a melody has neither a name nor a program that tells more than a section; the piano's program is
    what many programs write for none."""
    if stream.played_on or is_named(stream) or any(_named(stream)):
        return False
    numbered = None if stream.program is None else vocabulary().by_program(stream.program)
    return numbered is None or stream.program == _NO_PROGRAM or numbered.any_pitch


def _by_program(stream: TrackChannel) -> Instrument | None:
    """The wind that nothing but a track's program names; None where a name does, or the program names none."""
    telling, _ = _named(stream)
    if stream.played_on or stream.program is None or telling is not None or use_of(stream) != "melodic":
        return None
    numbered = vocabulary().by_program(stream.program)
    return numbered if numbered is not None and numbered.kind == "wind" and not numbered.any_pitch else None


def _member(stream: TrackChannel) -> Instrument | None:
    """The instrument of its program's family that a track's name says by a size or key alone: "Alto" among saxophones;
    of a name that is an instrument's too, as "Baritone", only where voices are called so."""
    words = vocabulary()
    numbered = None if stream.program in (None, _NO_PROGRAM) else words.by_program(stream.program or _NO_PROGRAM)
    if numbered is None or numbered.kind != "wind" or use_of(stream) != "melodic":
        return None
    text = next(filter(None, (stream.name, stream.instrument_name)), "")
    member = words.within(text, numbered)
    if member is None or (_named(stream)[0] is not None and words.within(text, words.instruments[_VOICE]) is None):
        return None
    return member


def _said(stream: TrackChannel) -> Instrument | None:
    """What a track says of itself, in the ensemble that it is in."""
    if stream.reported and stream.reported_by == "ensemble":
        return None
    return (None if stream.played_on else _member(stream)) or _said_plainly(stream)


def _said_plainly(stream: TrackChannel) -> Instrument | None:
    """What the names or the program of a track are called."""
    words = vocabulary()
    if stream.played_on:
        return words.instruments[stream.played_on]
    telling, vague = _named(stream)
    use = use_of(stream)
    if use == "rhythm":
        return telling if telling is not None and telling.kind == "percussion" else words.instruments[_KIT]
    if use == "effect":
        return words.instruments[_EFFECT]
    if telling is not None:
        return telling
    numbered = None if stream.program is None else words.by_program(stream.program)
    # Many programs write 0, the piano, for no program at all: a name that is not understood is not a piano's for that.
    if stream.program == _NO_PROGRAM and vague is None and is_named(stream):
        return None
    if vague is None or numbered is None:
        return numbered or vague
    says_more = numbered.kind == "wind" or (vague.kind == "wind" and stream.program != _NO_PROGRAM)
    return numbered if says_more else vague


def named_by_title(streams: Sequence[TrackChannel], title: str) -> list[TrackChannel]:
    """Give the winds that a piece's title names to the tracks that say nothing themselves.

    As many as there are such tracks go to them in their order ("oboe and bassoon"); else each of them may be any of
    those named, as its notes fit. A section alone ("brass quintet") leaves it to them who of the section plays.
    """
    silent = [index for index, stream in enumerate(streams) if _said(stream) is None]
    winds = [found for found in vocabulary().all_by_name(title) if found.kind == "wind"]
    sections = [found.id for found in winds if found.any_pitch]
    named = [found.id for found in winds if not found.any_pitch] or sections[:1]
    reported = list(streams)
    for place, index in enumerate(silent):
        own = (named[place],) if len(named) == len(silent) else tuple(dict.fromkeys(named))
        reported[index] = msgspec.structs.replace(streams[index], reported=own)
    return reported


def candidates(streams: Sequence[TrackChannel], maps: Sequence[MapChoice]) -> MapCandidates:
    """The maps that tracks which are played as one may go to; those whose range fits where nothing is said."""
    lead = next((one for one in streams if _said(one) is not None), streams[0])
    said = _said(lead)
    pitches = [pitch for stream in streams for pitch in stream.pitches]
    if said is not None and not said.any_pitch:
        found = _of_instrument(How.SAID, said, maps)
        numbered, general = _by_program(lead), _said_plainly(lead)
        if general is not None and general != said and not any(plays(choice, said) for choice in found.maps):
            # A size of its family that no map plays.
            found = _of_instrument(How.SAID, general, maps)
        return found if numbered is None else _instead(numbered, found, pitches, maps) or found
    reported = dict.fromkeys(id for stream in streams for id in stream.reported) if said is None else {}
    how = How.ENSEMBLE if any(one.reported_by == "ensemble" for one in streams) else How.TITLE
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
    unknown = section is None and any(map(is_named, streams))
    return MapCandidates(How.RANGE, section, tuple(usual or maps), unknown=unknown)


def refusal(stream: TrackChannel, maps: Sequence[MapChoice]) -> Message | None:
    """Why a track has no player; None if it has one."""
    if use_of(stream) == "effect":
        return Message("score.sound_effect")
    instrument = _said(stream)
    found = candidates([stream], maps)
    if instrument is not None and not instrument.any_pitch:
        if instrument.kind != "wind":
            id_ = "score.percussion" if instrument.kind == "percussion" else "score.not_wind"
            return Message(id_, {"instrument": instrument.names[0]})
        return None if found.maps else Message("score.no_map", {"instrument": instrument.names[0]})
    range_: dict[str, Argument] = {"lowest": min(stream.pitches), "highest": max(stream.pitches)}
    if found.unknown:
        return Message("score.unknown_instrument", range_)
    if max((_share(stream.pitches, choice) for choice in found.maps), default=0.0) <= _NEEDED_SHARE:
        return Message("score.outside_ranges", range_)
    return None


def _instead(
    numbered: Instrument, found: MapCandidates, pitches: Sequence[int], maps: Sequence[MapChoice]
) -> MapCandidates | None:
    """The maps of another instrument where a part's program names one that cannot play it, at sounding or written
    pitch: of its family, of its name ("horn" for an English horn), of its section, or any; None where it stays."""
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
    """Return whether a map plays an instrument, or a sort of it."""
    return any(id == instrument.id or vocabulary().is_sort(id, instrument.id) for id in choice.plays)


def _of_instrument(how: How, instrument: Instrument, maps: Sequence[MapChoice]) -> MapCandidates:
    """The maps that play an instrument, those of its sorts among them; else those that stand in for it; else those of
    the kind it is a sort of."""
    exact = frozenset(choice.map_id for choice in maps if instrument.id in choice.plays)
    own = [choice for choice in maps if plays(choice, instrument)]
    own = own or [choice for choice in maps if instrument.id in choice.substitutes_for]
    if not own and instrument.sort_of:
        general = _of_instrument(how, vocabulary().instruments[instrument.sort_of], maps)
        return MapCandidates(how, instrument, general.maps, general.exact)
    return MapCandidates(how, instrument, tuple(own), exact)


def _where(maps: Iterable[MapChoice], requested: Callable[[Instrument], bool]) -> list[MapChoice]:
    """The maps of which something they play is requested; also those that play nothing the vocabulary knows."""
    known = vocabulary().instruments
    return [choice for choice in maps if any(id not in known or requested(known[id]) for id in choice.plays)]


def _share(pitches: Sequence[int], choice: MapChoice, written: bool = False, usual: bool = True) -> float:
    """Return how many of the notes a map reaches, 0..1."""
    return (len(pitches) - choice.outside(pitches, written, usual)) / len(pitches)
