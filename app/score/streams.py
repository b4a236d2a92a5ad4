"""Groups the notes of a MIDI file's tracks for assignment: by channel, or by channels that belong together."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence, Set
from functools import partial
from typing import TypeAlias

import msgspec

from app.score.channel_notes import ChannelNotes
from app.score.channel_sound import ChannelSound, Use
from app.score.channels import curves_of, leading_channel, players_channels, sounding_channels
from app.score.doublings import doubled_instruments
from app.score.limits import MOST_NAME
from app.score.lines_spread_over_tracks import spread_lines
from app.score.mutes import mutes_of
from app.score.solos import words_of_players
from app.score.sound_module import FIRST_PORT, Port
from app.score.take_tracks import RECORDED
from app.score.texts import TextDecoder
from app.score.track_channel import TrackChannel
from app.score.track_instrument import is_no_name
from app.score.tracks import TrackEvents
from instrument_maps.instrument_names import vocabulary

# LilyPond names tracks "staff:voice"; "\\new" is a staff without a name.
_LILYPOND_NAME = re.compile(r"^([^:]*):([^:]*)$")
_Programs: TypeAlias = Mapping[tuple[Port, int], Set[int]]


def streams_of(
    tracks: Sequence[TrackEvents],
    zones: Sequence[Mapping[int, frozenset[int]]],
    texts: TextDecoder,
    alone: bool,
    apart: Set[tuple[int, int]],
) -> list[TrackChannel]:
    """Group the notes of every track by channel, or by channels that belong together; ``alone`` is True if the file has
    a single track.
    """
    lilypond = any(b"LilyPond" in text for _, text in tracks[0].texts)
    given = _given_programs(tracks)
    streams = []
    lines = spread_lines(tracks, zones, [texts.read(events.name) for events in tracks])
    for index, events in enumerate(tracks):
        name = texts.read(events.name)[:MOST_NAME]
        if lilypond and (match := _LILYPOND_NAME.match(name)):
            name = _lilypond_name(match[1].strip(), match[2].strip())
        spread = lines.get(index)
        groups = players_channels(events, "" if alone else name, zones[index], staff=not alone)
        if any(sum((index, channel) in apart for channel in own) > 1 for own in groups):
            groups = [(channel,) for own in groups for channel in own]
        if alone:
            name = name if len(groups) == 1 and len(tracks) == 1 else ""
        words = (*events.texts, *events.markers) if len(groups) == 1 else ()
        said = [(tick, texts.read(text)) for tick, text in words]
        for channels in groups:
            notes = events.notes(channels)
            first = leading_channel(events, channels)
            heard, among = (events, channels) if spread is None else (spread.events, spread.channels)
            muted, stopped, mute_kinds = mutes_of(events, channels, name, said)
            whole = TrackChannel(
                track=index,
                channel=first,
                name=name,
                instrument_name=texts.read(events.instrument_name)[:MOST_NAME],
                program=None,
                curves=curves_of(heard, among, zones[index]),
                solos=words_of_players(said),
                recorded=any(text == RECORDED.encode() for _, text in events.texts),
                muted=muted,
                stopped=stopped,
                mute_kinds=mute_kinds,
                line=-1 if spread is None else spread.first,
                **msgspec.structs.asdict(notes),
            )
            lead = leading_channel(heard, among)
            sounds = [heard.sound_at(lead, tick) for tick in notes.onset_ticks]
            played_on = doubled_instruments(events, channels, name, said, notes.onset_ticks)
            sounding = sounding_channels(first, among, zones[index])
            streams += _by_kind(whole, notes, sounds, played_on, partial(_program, heard, sounding, given))
    return streams


def _by_kind(
    whole: TrackChannel,
    notes: ChannelNotes,
    sounds: Sequence[ChannelSound],
    played_on: Sequence[str],
    program_at: Callable[[int], int | None],
) -> list[TrackChannel]:
    """Split the notes of a player's channels by kind of sound (melody, rhythm, effect) and by the instrument that the
    player uses.
    """
    kinds = [(sound.use, instrument) for sound, instrument in zip(sounds, played_on, strict=True)]
    streams = []
    for change, kind in enumerate(sorted(dict.fromkeys(kinds), key=_kind_order)):
        use, instrument = kind
        own = notes.where([one == kind for one in kinds])
        mine = [sound for sound, one in zip(sounds, kinds, strict=True) if one == kind]
        struck = [sound.struck(pitch) for sound, pitch in zip(mine, own.pitches, strict=True)]
        streams.append(
            msgspec.structs.replace(
                whole,
                name=_doubled_name(whole.name, instrument)[:MOST_NAME] if change and instrument else whole.name,
                program=program_at(own.onset_ticks[0]),
                use=use,
                certain=mine[0].certain,
                struck=struck if use == "rhythm" and struck != own.pitches else [],
                played_on=instrument,
                change=change,
                **msgspec.structs.asdict(own),
            )
        )
    return streams


def _given_programs(tracks: Sequence[TrackEvents]) -> _Programs:
    """Programs set in tracks with notes, by port and channel."""
    given: dict[tuple[Port, int], set[int]] = {}
    for events in tracks:
        for channel in events.channels.keys() & events.programs.keys():
            key = (events.port or FIRST_PORT, channel)
            given.setdefault(key, set()).update(program for _, program in events.programs[channel])
    return given


def _lilypond_name(staff: str, voice: str) -> str:
    """Name of a track that LilyPond named after staff and voice: the staff's, or the voice's if only that names an
    instrument or the staff has no name.
    """
    staff, voice = ("" if name.startswith("\\") else name for name in (staff, voice))
    found = map(vocabulary().by_name, (staff, voice))
    tells = [one is not None and not (one.vague or one.any_pitch) for one in found]
    return voice if tells == [False, True] or (not staff and not is_no_name(voice)) else staff


def _kind_order(kind: tuple[Use, str]) -> tuple[int, bool]:
    """Sort key for the groups of notes of a track: melodies first and among them the track's main instrument, so that
    the player's main part keeps its index.
    """
    use, instrument = kind
    return ("melodic", "rhythm", "effect").index(use), bool(instrument)


def _doubled_name(name: str, instrument: str) -> str:
    """Name for the notes of a track that the player plays on a second instrument: the instrument comes first, so that
    it is recognised when the file is read again.
    """
    spoken = vocabulary().instruments[instrument].names[0]
    return f"{spoken} ({name})" if name else spoken


def _program(events: TrackEvents, channels: Sequence[int], given: _Programs, first_onset: int) -> int | None:
    """Program of the first note on some channels, likeliest channel first.

    The track's own program has priority, since tracks of large scores share channels; else the program that other
    tracks of the port set in ``given``, if those with notes agree.
    """
    for channel in channels:
        own = events.programs.get(channel)
        if own:
            before = [program for tick, program in own if tick <= first_onset]
            return before[-1] if before else own[0][1]
    others = given.get((events.port or FIRST_PORT, channels[0]), frozenset[int]())
    if len(others) > 1:
        return None
    heard = events.sound_at(channels[0], first_onset).program
    return next(iter(others), None) if heard is None else heard
