"""Doublings: the player of one track changes to another instrument and back, as from flute to piccolo.

A change is found by a change of program, or by a text in the track: "to Picc.", "muta in Ob.", ピッコロに持ち替え. A
change to another sound of the same instrument (muted trumpet), to a section ("brass") or to something other
than a wind instrument does not count.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from app.score.limits import MOST_NAME
from app.score.mutes import sounds_of
from app.score.tracks import TrackEvents
from instrument_maps.instrument_names import vocabulary
from instrument_maps.instruments import Instrument

_CHANGE = re.compile(
    r"(?:change to|changes to|switch to|to|muta(?:no)? in|muta|nimmt|wechselt zu|wechsel zu|prend|prenez|changez en|"
    r"passe à|toma|cambia a|cambia in|muda para|passa a) (?P<after>.+)|"
    r"(?P<before>.+?)(?:に|へ)?(?:持ち?替え?|もちかえ)",
    re.IGNORECASE,
)


def doubled_instruments(
    events: TrackEvents, channels: Sequence[int], name: str, texts: Sequence[tuple[int, str]], onset_ticks: list[int]
) -> list[str]:
    """The instrument of each note, as an id in the vocabulary; empty for the track's main instrument.

    Parameters
    ----------
    channels : sequence of int
        Channels of the track that have the notes.
    name : str
        Name of the track.
    texts : sequence of (tick, text)
        Texts of the track with their ticks.
    onset_ticks : list of int
        Onset of each note in ticks, ascending.
    """
    if not all(map(events.is_melodic, channels)):
        return [""] * len(onset_ticks)
    named = vocabulary().by_name(name)
    programs = sorted({row for channel in channels for row in events.programs.get(channel, [])})
    # A program number contains no key and hardly any size: that of a clarinet also fits a clarinet in A.
    changes = [
        (tick, 0, named if named is not None and vocabulary().is_kind(named, found) else found)
        for tick, program in sounds_of(programs, named)
        if (found := _doubling(vocabulary().by_program(program)))
    ]
    changes += [(tick, 1, found) for tick, text in texts if (found := requested_instrument(text))]
    changes.sort(key=lambda row: row[:2])
    if not changes:
        return [""] * len(onset_ticks)
    # The first program determines the instrument, whatever the track's name is ("Cornet" with a trumpet's program),
    # unless the name gives that instrument second ("Flute / Piccolo") or the track changes later to the named one.
    begun = [found for tick, _, found in changes if tick <= onset_ticks[0]]
    first = begun[-1] if begun else named
    mine = {found.id for found in (first, named) if found is not None}
    if first is not None and named is not None and first.id != named.id:
        own = {one.id for one in vocabulary().all_by_name(name)}
        if first.id in own or any(found.id == named.id for _, _, found in changes):
            mine = {named.id}
    played, place, current = [], 0, "" if first is None or first.id in mine else first.id
    for tick in onset_ticks:
        while place < len(changes) and changes[place][0] <= tick:
            found = changes[place][2]
            current = "" if found.id in mine else found.id
            place += 1
        played.append(current)
    return played


def requested_instrument(text: str) -> Instrument | None:
    """Return the instrument to which a text tells the player to change; None if it is another text."""
    match = _CHANGE.fullmatch(" ".join(text[:MOST_NAME].split()).strip("()[]"))
    return _doubling(vocabulary().by_name(match["after"] or match["before"])) if match else None


def _doubling(found: Instrument | None) -> Instrument | None:
    return found if found is not None and found.kind == "wind" and not (found.vague or found.any_pitch) else None
