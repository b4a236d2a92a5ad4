"""Channels of one track: grouping by player, and merging of their controllers.

Notation programs put one player's muted or plucked notes on a separate channel. A controller with MIDI Polyphonic
Expression (MPE) sends each note on the next channel, so that every note has its own bend and pressure.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Collection, Mapping, Sequence
from itertools import pairwise
from operator import add, itemgetter
from typing import Final

from app.score.bend_range import RangeHistory, bent
from app.score.limits import LAST_TICK
from app.score.model import MOST_BEND, ControllerCurve
from app.score.mutes import sounds_of
from app.score.sound_module import FIRST_PORT, Port, module_ranges
from app.score.tracks import SentKind, TrackEvents
from instrument_maps.instrument_names import vocabulary

_PLAYED_SHARE: Final = 0.8
"""Least share of the notes during which a controller is above its minimum to represent dynamics; vibrato comes and
goes.
"""
_LEAST_ROTATING: Final = 5
"""Number of notes of a track from which rotation of its channels can be recognised."""
_ROTATING_SHARE: Final = 0.75
"""Least share of notes on another channel than the previous note for channels to rotate."""
_UNISON_SHARE: Final = 0.9
"""Least share of notes that two channels play together to be two voices in unison."""
_FEW: Final = 8
"""Number of channels above which channel 10 may take part in a rotation, since drum kits do not rotate."""
_LEGATO_SHARE: Final = 0.5
"""Largest share of the shorter note by which two notes of one line overlap."""
_LEGATO_NOTES: Final = 0.9
"""Least share of the notes of a line that satisfy `_LEGATO_SHARE`."""

_Points = dict[int, float]
_Span = tuple[int, int, int]
"""Onset, end and channel of a note."""


def settle_bends(tracks: Sequence[TrackEvents]) -> list[dict[int, frozenset[int]]]:
    """Convert the pitch bends of all tracks to the usual range, in place.

    A track that sets the bend range of a channel uses its own setting; otherwise the other tracks of the port set it.
    Messages to a port's sound module apply to all of its tracks; a reset ends every bend.

    Returns
    -------
    list of dict of int to frozenset of int
        MPE zones of each track: member channels by manager channel.
    """
    ports = [events.port or FIRST_PORT for events in tracks]
    rows: dict[Port, list[tuple[int, int, int, int]]] = {port: [] for port in ports}
    for port, events in zip(ports, tracks, strict=True):
        # A conductor's track applies to every port.
        for heard in rows if events.port is None and not events.channels else (port,):
            rows[heard] += events.parameters
    modules = module_ranges([events.said_of_sounds for events in tracks], rows)
    said = {port: RangeHistory.of(sorted(own, key=itemgetter(0)), modules[port]) for port, own in rows.items()}
    zones = []
    for port, events in zip(ports, tracks, strict=True):
        own, shared = RangeHistory.of(events.parameters), said[port]
        zones.append(own.zones or shared.zones)
        mixed = RangeHistory.of(events.parameters, modules[port]) if own.ranges and modules[port] else own
        resets = [one.tick for one in modules[port] if one.channel is None]
        for (channel, kind), raw in list(events.controls.items()):
            if kind == "pitch_bend":
                ranges = (mixed if channel in own.ranges else shared).ranges.get(channel, {})
                events.controls[channel, kind] = bent(_ended(raw, resets), ranges)
    return zones


def _ended(raw: Mapping[int, float], resets: Sequence[int]) -> Mapping[int, float]:
    """Insert a bend of 0 at every reset of the sound module that comes while a bend is held."""
    ticks = sorted(raw)
    places = ((tick, bisect_left(ticks, tick)) for tick in resets if tick not in raw)
    return {**raw, **{tick: 0.0 for tick, place in places if place and raw[ticks[place - 1]]}}


def players_channels(
    events: TrackEvents, name: str, zones: Mapping[int, frozenset[int]], *, staff: bool = False
) -> list[tuple[int, ...]]:
    """Group the channels of a track that one player plays; groups and their members are in order of channel.

    The channels of an MPE zone with one sound form a group. All channels form one if they take turns and the track is
    named after an instrument, or one of them is the muted sound of the others, or the track is a staff; or if with one
    sound they take turns note by note or play in unison. Otherwise every channel is a group.

    Parameters
    ----------
    staff : bool
        Whether the track is a staff among several, and not a part of a file divided by channel.
    """
    channels = sorted(events.channels)
    together = [
        own
        for manager, members in zones.items()
        if len(own := tuple(one for one in channels if one == manager or one in members)) > 1
        and _one_sound(events, own)
    ]
    if together:
        rest = set(channels).difference(*together)
        return sorted([*together, *((channel,) for channel in rest)])
    if len(channels) < 2:
        return [(channel,) for channel in channels]
    named = vocabulary().by_name(name)
    melodic = all(map(events.is_melodic, channels))
    sure = named is not None and not named.vague
    one_player = sure or (_one_player(events, channels) and (staff or not _one_sound(events, channels)))
    if melodic and one_player and (events.take_turns(channels) or _is_line(_spans(events, channels))):
        return [tuple(channels)]
    if (melodic or len(channels) > _FEW) and rotate(events, channels):
        return [tuple(channels)]
    if melodic and _in_unison(events, channels, least=staff):
        return [tuple(channels)]
    return [(channel,) for channel in channels]


def leading_channel(events: TrackEvents, channels: Collection[int]) -> int:
    """Return the channel with the earliest note among the given channels; rhythm channels count only if all are rhythm
    channels.
    """
    played = list(filter(events.is_melodic, channels)) or channels
    return min(played, key=lambda channel: events.channels[channel].numbers[0])


def sounding_channels(first: int, channels: Collection[int], zones: Mapping[int, frozenset[int]]) -> tuple[int, ...]:
    """Order the channels whose program may be that of a group, likeliest first: the leading channel ``first``, the
    manager of its MPE zone, the others.
    """
    managers = [one for one, members in zones.items() if len(channels) > 1 and members & {*channels}]
    return tuple(dict.fromkeys((first, *managers, *channels)))


def _one_sound(events: TrackEvents, channels: Collection[int]) -> bool:
    """Return whether all channels that select a program select the same."""
    programs = (frozenset(program for _, program in events.programs.get(one, [])) for one in channels)
    return len(set(filter(None, programs))) <= 1


def _one_player(events: TrackEvents, channels: Collection[int]) -> bool:
    """Return whether all programs of the channels belong to one instrument, muted or open."""
    sounds = [sounds_of(sorted(events.programs.get(one, []))) for one in channels]
    together = sounds_of(sorted(row for rows in sounds for row in rows))
    found = {vocabulary().by_program(program) for _, program in together}
    return len(found) == 1 and None not in found


def is_line(events: TrackEvents, channels: Collection[int]) -> bool:
    """Return whether the notes of the channels form one melodic line with one sound."""
    return _one_sound(events, channels) and _is_line(_spans(events, channels))


def rotate(events: TrackEvents, channels: Collection[int]) -> bool:
    """Return whether the channels take turns note by note in one melodic line with one sound, as with MPE."""
    spans = _spans(events, channels)
    if not _one_sound(events, channels) or len(spans) < _LEAST_ROTATING or not _is_line(spans):
        return False
    changes = sum(before[2] != after[2] for before, after in pairwise(spans))
    return changes >= _ROTATING_SHARE * (len(spans) - 1)


def _in_unison(events: TrackEvents, channels: Collection[int], *, least: bool) -> bool:
    """Return whether channels with one sound strike nearly all notes together, as two voices of a staff in unison.

    Parameters
    ----------
    least : bool
        Compare with the channel of fewest notes instead of most: a voice that doubles another only for a while.
    """
    struck = [{*zip(events.channels[one].onset_ticks, events.channels[one].pitches, strict=True)} for one in channels]
    counted = min(map(len, struck)) if least else max(map(len, struck))
    return len(set.intersection(*struck)) >= _UNISON_SHARE * counted and _one_sound(events, channels)


def _spans(events: TrackEvents, channels: Collection[int]) -> list[_Span]:
    """List the onset, end and channel of all notes of the channels, ordered by onset."""
    return sorted(
        (onset, end, channel)
        for channel in channels
        for onset, end in zip(events.channels[channel].onset_ticks, events.channels[channel].end_ticks, strict=True)
    )


def _is_line(spans: Sequence[_Span]) -> bool:
    """Return whether the notes form a melodic line: each begins after the previous one, except for legato overlaps."""
    near = sum(
        before[1] - after[0] <= _LEGATO_SHARE * min(before[1] - before[0], after[1] - after[0])
        for before, after in pairwise(spans)
    )
    return near >= _LEGATO_NOTES * (len(spans) - 1)


def curves_of(
    events: TrackEvents, channels: Collection[int], zones: Mapping[int, frozenset[int]]
) -> tuple[ControllerCurve, ...]:
    """Merge the controller curves of the channels that one player uses, by kind of controller.

    Where several channels send a kind, the channel of the most recent note counts. The manager channel of an MPE zone
    applies to all members: its bend is added to theirs; its other controllers count where the members send none. If
    notes of the zone overlap, as from a keyboard, only the manager's curves are kept, since the members' are for single
    notes.

    Modulation, and in a zone timbre, is used as expression if it is raised while notes sound and neither breath nor
    expression changes.
    """
    spans = _spans(events, channels)
    manager = next((one for one, members in zones.items() if len(channels) > 1 and members & {*channels}), None)
    players = {*channels} - {manager} if len(channels) == 1 or _is_line(spans) else set[int]()
    kinds = {kind for channel, kind in events.controls if channel in players or channel == manager}
    curves = {kind: _curve(events, kind, players, manager, spans) for kind in kinds}
    modulation, timbre = curves.pop("modulation", {}), curves.pop("timbre", {})
    if not any(_moves(curves.get(kind, {})) for kind in ("breath", "expression")):
        pressed = _moves(curves.get("aftertouch", {}))
        if _is_dynamics(modulation, spans):
            curves["expression"] = modulation
        elif manager is not None and not pressed and _is_dynamics(timbre, spans):
            curves["expression"] = timbre
    return tuple(
        ControllerCurve(kind, tuple(sorted(points)), tuple(points[tick] for tick in sorted(points)))
        for kind, points in sorted(curves.items())
        if kind != "modulation" and kind != "timbre"
    )


def _curve(
    events: TrackEvents, kind: SentKind, players: Collection[int], manager: int | None, spans: Sequence[_Span]
) -> _Points:
    """Merge the steps of one kind of controller from the channels of a player and the manager channel of their MPE
    zone.
    """
    own = {channel: points for channel in players if (points := events.controls.get((channel, kind)))}
    shared = events.controls.get((manager, kind), {}) if manager is not None else {}
    if not own:
        return dict(shared)
    points = next(iter(own.values())) if len(players) == 1 else _by_turns(own, spans, kind)
    if not shared or kind != "pitch_bend":
        return points
    ticks = sorted({*points, *shared})
    sums = map(add, _held(points, ticks), _held(shared, ticks))
    return {tick: max(-MOST_BEND, min(value, MOST_BEND)) for tick, value in zip(ticks, sums, strict=True)}


def _held(points: _Points, ticks: Sequence[int]) -> list[float]:
    """Return the value of a step function, given as points, at each of the ascending ticks; 0 before its
    first point.
    """
    at, now, values = sorted(points), 0.0, []
    place = 0
    for tick in ticks:
        while place < len(at) and at[place] <= tick:
            now = points[at[place]]
            place += 1
        values.append(now)
    return values


def _by_turns(own: Mapping[int, _Points], spans: Sequence[_Span], kind: SentKind) -> _Points:
    """Merge a controller's steps from several channels: each channel is used from the onset of one of its notes to the
    next onset on any channel.
    """
    at = {channel: sorted(points) for channel, points in own.items()}
    merged: _Points = {}
    starts = [-1, *(onset for onset, _, _ in spans[1:])]
    for (onset, _, channel), start, stop in zip(spans, starts, [*starts[1:], LAST_TICK + 1], strict=True):
        ticks = at.get(channel, [])
        first, last = bisect_right(ticks, start), bisect_left(ticks, stop)
        if start >= 0 and first:
            merged[start] = own[channel][ticks[first - 1]]
        elif start >= 0 and kind == "pitch_bend":
            merged[onset] = 0.0
        merged.update((tick, own[channel][tick]) for tick in ticks[first:last])
    return _without_repeats(merged)


def _without_repeats(points: _Points) -> _Points:
    """Remove from a controller's steps those that repeat the previous value."""
    changed: _Points = {}
    before: float | None = None
    for tick in sorted(points):
        if points[tick] != before:
            before = changed[tick] = points[tick]
    return changed


def _moves(points: Mapping[int, float]) -> bool:
    return len(set(points.values())) > 1


def _is_dynamics(points: Mapping[int, float], spans: Sequence[_Span]) -> bool:
    """Return whether a controller is used for dynamics: its value changes, and is above 0 under most notes."""
    if not _moves(points):
        return False
    ticks = sorted(points)
    up = sum(points[ticks[place - 1]] > 0.0 for place in (bisect_right(ticks, onset) for onset, _, _ in spans) if place)
    return up >= _PLAYED_SHARE * len(spans)
