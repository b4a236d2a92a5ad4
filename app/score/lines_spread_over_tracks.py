"""Melodic lines spread over several tracks, one for each channel of a controller that changes the channel note by note.

Programs that divide an MPE recording by channel write such files. The tracks have the same sound and the same name
except for the channel number, and either belong to one MPE zone or are three or more that take turns note by note. Two
tracks without a zone are treated as two players.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Final, NamedTuple

import msgspec

from app.score.channels import is_line, rotate
from app.score.sound_module import FIRST_PORT, Port
from app.score.tracks import TrackEvents

_CHANNEL: Final = re.compile(
    r"[\s_\-–:,/(\[#]*(?:midi[\s_]*)?(?:ch(?:annel|an)?|kanal|canal|canale|mpe|チャンネル|通道|채널|канал)?"
    r"[\s_.\-#]*(\d+)[\s)\]]*$",
    re.IGNORECASE,
)
_LEAST_TRACKS: Final = 3
"""Least number of tracks of a line without an announced zone."""


class SpreadLine(NamedTuple):
    """A melodic line spread over several tracks.

    Attributes
    ----------
    first : int
        Index of its first track.
    events : TrackEvents
        The channels of all its tracks, and the controllers of the zone's manager channel.
    channels : tuple of int
        MIDI channels of its tracks.
    """

    first: int
    events: TrackEvents
    channels: tuple[int, ...]


def spread_lines(
    tracks: Sequence[TrackEvents], zones: Sequence[Mapping[int, frozenset[int]]], names: Sequence[str]
) -> dict[int, SpreadLine]:
    """Find the lines that are spread over several tracks; the result has an entry for each of their tracks, by its
    index.

    Parameters
    ----------
    zones : sequence of mapping of int to frozenset of int
        MPE zones of each track: member channels by manager channel.
    """
    alike: dict[tuple[Port, int | None, str, bytes], list[int]] = {}
    for place, events in enumerate(tracks):
        if len(events.channels) == 1:
            (channel,) = events.channels
            manager = next((one for one, own in zones[place].items() if channel == one or channel in own), None)
            key = events.port or FIRST_PORT, manager, _base(names[place], channel), events.instrument_name
            alike.setdefault(key, []).append(place)
    found: dict[int, SpreadLine] = {}
    for (port, manager, *_), places in alike.items():
        channels = tuple(sorted(next(iter(tracks[place].channels)) for place in places))
        if len({*channels}) != len(places) or len(places) < (_LEAST_TRACKS if manager is None else 2):
            continue
        managing = [one for one in tracks if (one.port or FIRST_PORT) == port and manager not in one.channels]
        events = _together([tracks[place] for place in places], managing, manager)
        if is_line(events, channels) if manager is not None else rotate(events, channels):
            found.update(dict.fromkeys(places, SpreadLine(places[0], events, channels)))
    return found


def _base(name: str, channel: int) -> str:
    """Remove the channel number from the name of a track, for comparison."""
    number = _CHANNEL.search(name)
    return (name[: number.start()] if number and int(number[1]) == channel + 1 else name).casefold().strip()


def _together(own: Sequence[TrackEvents], managing: Sequence[TrackEvents], manager: int | None) -> TrackEvents:
    """Merge the events of the tracks of one line (``own``), with all events that the tracks ``managing`` send on the
    manager channel of their MPE zone.
    """
    events = TrackEvents(port=own[0].port)
    for one in own:
        events.channels.update(one.channels)
        events.controls.update(one.controls)
        events.programs.update(one.programs)
        events.sounds.update(one.sounds)
    for one in managing:
        for key, points in one.controls.items():
            if key[0] == manager:
                events.controls[key] = {**points, **events.controls.get(key, {})}
        if manager is not None and manager in one.programs:
            events.programs.setdefault(manager, one.programs[manager])
    # Note numbers count within a track; within the line they follow the onsets.
    numbers = sorted((onset, channel) for channel, notes in events.channels.items() for onset in notes.onset_ticks)
    events.channels = {
        channel: msgspec.structs.replace(
            notes, numbers=[place for place, (_, other) in enumerate(numbers, 1) if other == channel]
        )
        for channel, notes in events.channels.items()
    }
    return events
