"""Finds the instrument of a track from its names, its program or the title of the piece."""

from __future__ import annotations

import re
from collections.abc import Sequence

import msgspec

from app.score.channel_sound import Use
from app.score.track_channel import TrackChannel
from instrument_maps.instrument_names import vocabulary
from instrument_maps.instruments import Instrument

_KIT, _EFFECT, _VOICE = "drums", "effect", "voice"
"""Ids of drums, effects and voices in the vocabulary."""
_KIT_NOTES = range(35, 60)
_MOST_DRUMS = 6
"""Greatest number of sounds in a part of small percussion; more indicate a melody, as of steel drums."""
_NO_PROGRAM = 0
_SAYS_NOTHING = re.compile(
    r"(?:(?:midi|new|part|track|staff|voice|channel|untitled|instrument|spur|stimme|system|piste|pista)[a-h]?|"
    r"(?<![^\W\d_])(?:[a-h]|one|two|three|four|five|six|upper|lower|top|middle|bottom|uno|due|tre)(?![^\W\d_])|"
    r"дорожка|трек|канал|パート|トラック|チャンネル|트랙|채널|音轨|音軌|轨道|軌道|通道|[\W\d_])*",
    re.IGNORECASE,
)
"""Names that programs give to tracks without a name."""
_ORDINAL = r"(?:1[0-6]|[1-9]|VIII|VII|VI|IV|V|III|II|I)(?:st|nd|rd|th|er|[.aoºª°])?"
_NUMERALS = ("I", "II", "III", "IV", "V", "VI", "VII", "VIII")
_PLAYERS = re.compile(
    rf"(?<![A-Za-z\d♭♯#]){_ORDINAL}(?:\s*(?:[.,/&+・–-]|\b(?:and|und|et|ed?|y)\b)\s*{_ORDINAL})+(?![A-Za-z\d♭♯#])"
)
_UNISON = re.compile(r"(?<!\w)[aà] ?([2-4])(?!\w)")


def players_named(name: str) -> int:
    """Return the number of players in a track's name: 2 in "Horn 1.2", "Cl. I/II" and "Trumpet a2", 4 in "Trb. 1-4"; 1
    if it names none.
    """
    together = _UNISON.search(name)
    if together:
        return int(together[1])
    found = _PLAYERS.search(name)
    if not found:
        return 1
    said = [_NUMERALS.index(one) + 1 if one in _NUMERALS else int(one) for one in re.findall(r"\d+|[IV]+", found[0])]
    through = len(said) == 2 and re.search(r"[–-]", found[0]) and said[0] < said[1]
    return min(said[1] - said[0] + 1 if through else len(set(said)), 16)


def recognised(channel: TrackChannel) -> Instrument | None:
    """Return the instrument of a track by its names or its program, else by the title of the piece; None if none of
    them gives one.
    """
    said = said_of(channel)
    return vocabulary().instruments[channel.reported[0]] if said is None and len(channel.reported) == 1 else said


def use_of(channel: TrackChannel) -> Use:
    """Classify a track as melody, rhythm part (its notes are drum kit sounds) or sound effects.

    The settings of the sound module decide. If they are only defaults (channel 10, a bank), a name other than
    percussion makes the track a melody. The name of drums or other untuned percussion makes any channel a rhythm part;
    so does its program, if no name is more specific. Tuned percussion stays a melody, and so does a wind instrument's
    tune named after a drum.
    """
    telling, vague = _named(channel)
    if channel.use == "melodic":
        return "rhythm" if _untuned(channel, telling, vague) is not None else "melodic"
    named = telling or vague
    return channel.use if channel.certain or named is None or named.kind == "percussion" else "melodic"


def sounds_of(channel: TrackChannel) -> list[int]:
    """General MIDI numbers of the sounds in a rhythm part. Notation often gives a single drum an arbitrary pitch, which
    is replaced by the drum's number.
    """
    if channel.struck or channel.use != "melodic":
        return channel.struck or channel.pitches
    found = _untuned(channel, *_named(channel))
    stroke = None if found is None or found.id == _KIT else vocabulary().stroke(found.names[0])
    pitches = set(channel.pitches)
    return (
        channel.pitches
        if stroke is None or len(pitches) > 1 or pitches <= {*_KIT_NOTES}
        else [stroke] * len(channel.pitches)
    )


def _untuned(channel: TrackChannel, telling: Instrument | None, vague: Instrument | None) -> Instrument | None:
    """Untuned percussion instrument that a track's names or, without a name, its program give; None if it is something
    else.
    """
    words = vocabulary()
    numbered = None if channel.program is None else words.by_program(channel.program)
    found = numbered if telling is None and vague is None else telling
    if channel.played_on or found is None or found.kind != "percussion":
        return None
    if found.various:
        return found if len(set(channel.pitches)) <= _MOST_DRUMS else None
    if words.stroke(found.names[0]) is None or (numbered is not None and _is_after_a_drum(channel, found, numbered)):
        return None
    return found


def _is_after_a_drum(channel: TrackChannel, named: Instrument, numbered: Instrument) -> bool:
    """Return whether a wind instrument's tune is merely titled after a drum, such as "The Little Drummer Boy"."""
    drum = numbered.kind == "wind" and vocabulary().stroke(named.names[0]) is not None
    return drum and not _names_kit(channel.pitches)


def _named(channel: TrackChannel) -> tuple[Instrument | None, Instrument | None]:
    """Instruments in a track's names: the first definite one, and the first vague one, which is None if there is a
    definite one.
    """
    words = vocabulary()
    named = [found for text in (channel.name, channel.instrument_name) if text and (found := words.by_name(text))]
    telling = next((found for found in named if not found.vague), None)
    return telling, next(iter(named), None) if telling is None else None


def called(channel: TrackChannel, instrument: Instrument) -> str:
    """Return the name under which a track's instrument is shown; for a collective instrument it is the name in the
    score ("和太鼓").
    """
    own = (
        text for text in (channel.name, channel.instrument_name) if text and vocabulary().by_name(text) == instrument
    )
    return next(own if instrument.various else iter(()), instrument.names[0])


def is_named(channel: TrackChannel) -> bool:
    """Return whether a track has a name given by a person rather than by a program."""
    return not all(map(is_no_name, (channel.name, channel.instrument_name)))


def is_no_name(text: str) -> bool:
    """Return whether a text is empty or a default track name of some program."""
    return _SAYS_NOTHING.fullmatch(text) is not None


def _names_kit(pitches: Sequence[int]) -> bool:
    """Return whether most pitches are those of bass drums, snare drums, toms, hi-hats and cymbals in General MIDI."""
    return 2 * sum(map(_KIT_NOTES.__contains__, pitches)) > len(pitches)


def says_nothing(channel: TrackChannel) -> bool:
    """Return whether neither name nor program of a melody is informative; programs of a whole section do not count, nor
    does the piano's, a common default.
    """
    if channel.played_on or is_named(channel) or any(_named(channel)):
        return False
    numbered = None if channel.program is None else vocabulary().by_program(channel.program)
    return numbered is None or channel.program == _NO_PROGRAM or numbered.any_pitch


def by_program_alone(channel: TrackChannel) -> Instrument | None:
    """Return the wind instrument of a melodic track if only its program gives it; None if a name gives one, or if it is
    no wind instrument.
    """
    telling, _ = _named(channel)
    if channel.played_on or channel.program is None or telling is not None or use_of(channel) != "melodic":
        return None
    numbered = vocabulary().by_program(channel.program)
    return numbered if numbered is not None and numbered.kind == "wind" and not numbered.any_pitch else None


def _member(channel: TrackChannel) -> Instrument | None:
    """Return the member of the program's instrument family that a size or key in the track's name selects: "Alto"
    selects the alto saxophone. A word that is also an instrument ("Baritone") counts only if voices are named so.
    """
    words = vocabulary()
    numbered = None if channel.program in (None, _NO_PROGRAM) else words.by_program(channel.program or _NO_PROGRAM)
    if numbered is None or numbered.kind != "wind" or use_of(channel) != "melodic":
        return None
    text = next(filter(None, (channel.name, channel.instrument_name)), "")
    member = words.within(text, numbered)
    if member is None or (_named(channel)[0] is not None and words.within(text, words.instruments[_VOICE]) is None):
        return None
    return member


def said_of(channel: TrackChannel) -> Instrument | None:
    """Instrument that the names or the program of a track give; None if only the ensemble suggests one."""
    if channel.reported and channel.reported_by == "ensemble":
        return None
    return (None if channel.played_on else _member(channel)) or said_plainly(channel)


def said_plainly(channel: TrackChannel) -> Instrument | None:
    """Instrument given by the names or the program of a track."""
    words = vocabulary()
    if channel.played_on:
        return words.instruments[channel.played_on]
    telling, vague = _named(channel)
    use = use_of(channel)
    if use == "rhythm":
        found = telling or (_untuned(channel, None, vague) if channel.use == "melodic" else None)
        return found if found is not None and found.kind == "percussion" else words.instruments[_KIT]
    if use == "effect":
        return words.instruments[_EFFECT]
    numbered = None if channel.program is None else words.by_program(channel.program)
    if telling is not None:
        return numbered if numbered is not None and _is_after_a_drum(channel, telling, numbered) else telling
    # Many programs write 0, the piano, if no program is chosen: an unknown name is not taken as a piano's.
    if channel.program == _NO_PROGRAM and vague is None and is_named(channel):
        return None
    if vague is None or numbered is None:
        return numbered or vague
    says_more = numbered.kind == "wind" or (vague.kind == "wind" and channel.program != _NO_PROGRAM)
    return numbered if says_more else vague


def named_by_title(channels: Sequence[TrackChannel], title: str) -> list[TrackChannel]:
    """Assign the wind instruments named in the title to the tracks without information about theirs.

    If their numbers are equal, they are assigned in order ("oboe and bassoon"); else each track may be any of them,
    decided by its notes. A section ("brass quintet") leaves the choice within the section open.
    """
    silent = [index for index, channel in enumerate(channels) if said_of(channel) is None]
    winds = [found for found in vocabulary().all_by_name(title) if found.kind == "wind"]
    sections = [found.id for found in winds if found.any_pitch]
    named = [found.id for found in winds if not found.any_pitch] or sections[:1]
    reported = list(channels)
    for place, index in enumerate(silent):
        own = (named[place],) if len(named) == len(silent) else tuple(dict.fromkeys(named))
        reported[index] = msgspec.structs.replace(channels[index], reported=own)
    return reported
