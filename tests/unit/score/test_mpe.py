"""A melody spread over several channels belongs to one player, with the curves of the sounding notes."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from app.score.model import Part, Score
from tests.unit.score.midi_bytes import END, MAPS, chunk, header, meta, score_of
from tests.unit.score.test_bend_range import SELECT, set_to

ZONE = set_to((101, 0), (100, 6), (6, 5))
SCALE = (60, 62, 64, 65, 67, 69, 71, 72)

Event = tuple[int, bytes]


def track(events: Sequence[Event], before: bytes = b"") -> bytes:
    """Events at ticks below 128 * 128 in order of time."""
    data, at = bytearray(before), 0
    for tick, message in sorted(events, key=lambda event: event[0]):
        delta = tick - at
        data += (bytes([delta >> 7 | 0x80, delta & 127]) if delta > 127 else bytes([delta])) + message
        at = tick
    return bytes(data)


def rotating(overlap: int = 0, channels: Sequence[int] = (1, 2, 3, 4, 5), more: Sequence[Event] = ()) -> list[Event]:
    """A scale in quarters of 96 ticks, each note on the next channel."""
    events = list(more)
    for place, pitch in enumerate(SCALE):
        channel = channels[place % len(channels)]
        events.append((96 * place, bytes([0x90 | channel, pitch, 64])))
        events.append((96 * place + 90 + overlap, bytes([0x80 | channel, pitch, 0])))
    return events


def scored(events: bytes, name: bytes = b"Trumpet") -> Score:
    named = meta(3, name) if name else b""
    conductor = chunk(b"MTrk", END)
    return score_of(header(1, 2) + conductor + chunk(b"MTrk", named + events + END), maps=MAPS)


def only(score: Score) -> Part:
    (part,) = score.parts
    return part


def curve(part: Part, kind: str) -> dict[int, float]:
    found = next(curve for curve in part.curves if curve.kind == kind)
    return dict(zip(found.ticks, found.values, strict=True))


@pytest.mark.parametrize("name", [b"", b"Trumpet", b"Lead 1"])
@pytest.mark.parametrize("overlap", [0, 20])
@pytest.mark.parametrize("announced", [True, False])
@pytest.mark.parametrize("channels", [(1, 2, 3, 4, 5), (1, 2), (14, 13, 12)])
def test_one_melody_over_several_channels_is_one_player(
    name: bytes, overlap: int, announced: bool, channels: Sequence[int]
) -> None:
    zone = set_to((101, 0), (100, 6), (6, 5), channel=15 if 14 in channels else 0) if announced else b""
    score = scored(track(rotating(overlap, channels), zone), name)
    lines = [[note.pitch for note in part.notes] for part in score.parts]
    assert lines == ([list(SCALE)] if name != b"Lead 1" else [])
    assert len(score.unplayed) == (name == b"Lead 1")


def test_two_players_in_dialogue_are_two() -> None:
    phrases = [(384 * place, 384 * place + 380, channel) for place, channel in enumerate((0, 1, 0, 1, 0, 1))]
    events = [
        event
        for start, _, channel in phrases
        for place in range(4)
        for event in (
            (start + 96 * place, bytes([0x90 | channel, 60 + place, 64])),
            (start + 96 * place + 90, bytes([0x80 | channel, 60 + place, 0])),
        )
    ]
    assert len(scored(track(events), b"").parts) == 2


def test_rotating_channels_of_two_sounds_are_two_players() -> None:
    programs = bytes([0, 0xC1, 56, 0, 0xC2, 57])
    assert len(scored(track(rotating(0, (1, 2)), programs), b"").parts) == 2


def test_each_note_has_the_bend_and_the_pressure_of_its_channel() -> None:
    more = [
        (0, bytes([0xD1, 20])),
        (48, bytes([0xD1, 80])),
        (96, bytes([0xD2, 40])),
        # After the next note has begun, the first channel sends nothing relevant.
        (100, bytes([0xD1, 0])),
        (60, bytes([0xE1, 0, 0x41])),
    ]
    part = only(scored(track(rotating(10, more=more), ZONE)))
    pressure = {tick: round(127 * value) for tick, value in curve(part, "aftertouch").items()}
    assert pressure == {0: 20, 48: 80, 96: 40, 480: 0, 576: 40}
    # 128 steps of 8192 on a range of 48 semitones, from where it was bent to where the next note begins.
    bends = {tick: round(2 * value, 4) for tick, value in curve(part, "pitch_bend").items()}
    assert bends == {60: 0.75, 96: 0.0, 480: 0.75, 576: 0.0}


def test_the_managers_bend_is_added_and_its_breath_is_the_players() -> None:
    more = [
        (0, bytes([0xE0, 0, 0x60])),
        (0, bytes([0xB0, 2, 50])),
        (96, bytes([0xB0, 2, 90])),
        (96, bytes([0xE2, 0, 0x60])),
    ]
    part = only(scored(track(rotating(more=more), ZONE + set_to(*SELECT, (6, 12), channel=3))))
    bends = {tick: round(2 * value, 4) for tick, value in curve(part, "pitch_bend").items()}
    # The manager has two semitones; the members share the range that one of them is given.
    assert bends == {0: 1.0, 96: 7.0, 192: 1.0, 576: 7.0, 672: 1.0}
    assert {tick: round(127 * value) for tick, value in curve(part, "breath").items()} == {0: 50, 96: 90}


def test_timbre_that_follows_the_notes_is_the_breath_of_a_zone() -> None:
    more = [(96 * place, bytes([0xB1 + place % 5, 74, 40 + 5 * place])) for place in range(len(SCALE))]
    found = curve(only(scored(track(rotating(more=more), ZONE))), "expression")
    assert [round(127 * value) for value in found.values()] == [40 + 5 * place for place in range(len(SCALE))]


def test_a_keyboards_chords_are_shared_among_players_without_the_curves_of_single_notes() -> None:
    events: list[Event] = [(0, bytes([0xE0, 0, 0x60])), (10, bytes([0xE1, 0, 0x60])), (10, bytes([0xD2, 90]))]
    for place in range(8):
        for voice in range(3):
            channel = 1 + (place + voice) % 5
            events.append((96 * place, bytes([0x90 | channel, 60 + 4 * voice, 64])))
            events.append((96 * place + 90, bytes([0x80 | channel, 60 + 4 * voice, 0])))
    score = scored(track(events, ZONE))
    assert [len(part.notes) for part in score.parts] == [8, 8, 8]
    assert {curve.kind for part in score.parts for curve in part.curves} == {"pitch_bend"}
    assert curve(score.parts[0], "pitch_bend") == {0: 0.5}


def test_a_zone_that_takes_in_the_percussion_channel_is_no_percussion() -> None:
    zone = set_to((101, 0), (100, 6), (6, 15))
    score = scored(track(rotating(channels=(9, 10, 11)), zone), b"")
    assert [note.pitch for note in only(score).notes] == list(SCALE)


def test_fifteen_channels_that_rotate_are_one_player_though_one_of_them_is_the_percussions() -> None:
    events: list[Event] = []
    for place in range(30):
        channel, pitch = 1 + place % 15, 60 + place % 12
        events += [
            (96 * place, bytes([0x90 | channel, pitch, 64])),
            (96 * place + 90, bytes([0x80 | channel, pitch, 0])),
        ]
    assert len(only(scored(track(events), b"")).notes) == 30


def test_both_zones_are_a_player_each() -> None:
    zones = ZONE + set_to((101, 0), (100, 6), (6, 5), channel=15)
    both = rotating(channels=(1, 2, 3)) + rotating(channels=(14, 13, 12))
    assert [len(part.notes) for part in scored(track(both, zones)).parts] == [8, 8]


def test_a_zone_of_several_sounds_is_none() -> None:
    """A whole band in one track, in which a sequencer declared channel 1 as a zone."""
    programs = bytes([0, 0xC1, 56, 0, 0xC2, 57])
    assert len(scored(track(rotating(channels=(1, 2)), ZONE + programs), b"").parts) == 2


def spread(
    channels: Sequence[int], zone: bytes = b"", name: str = "Trumpet", program: bool = True, more: Sequence[Event] = ()
) -> Score:
    """Scale with every channel on its own track, after a track of settings."""
    events = rotating(channels=channels, more=more)
    tracks = [zone + (b"" if program else bytes([0, 0xC0 | (15 if 14 in channels else 0), 56]))]
    for channel in channels:
        said = meta(3, name.format(channel + 1).encode()) + (bytes([0, 0xC0 | channel, 56]) if program else b"")
        tracks.append(track([event for event in events if event[1][0] & 15 == channel], said))
    data = header(1, len(tracks)) + b"".join(chunk(b"MTrk", one + END) for one in tracks)
    return score_of(data, maps=MAPS)


@pytest.mark.parametrize("name", ["", "Trumpet", "Trumpet Ch. {}", "Trumpet - {}", "MIDI {}"])
@pytest.mark.parametrize(
    ("channels", "zone", "program"),
    [
        ((1, 2, 3, 4, 5), ZONE, True),
        ((1, 2, 3, 4, 5), ZONE, False),
        ((1, 2), ZONE, True),
        ((14, 13, 12), set_to((101, 0), (100, 6), (6, 5), channel=15), False),
        ((1, 2, 3), b"", True),
        ((0, 1, 2, 3), b"", True),
        # Channel 10 among them.
        (tuple(range(7, 12)), set_to((101, 0), (100, 6), (6, 15)), False),
    ],
)
def test_one_melody_over_several_tracks_is_one_player(
    channels: Sequence[int], zone: bytes, program: bool, name: str
) -> None:
    score = spread(channels, zone, name, program)
    part = only(score)
    assert [note.pitch for note in part.notes] == list(SCALE)
    assert [note.onset_tick for note in part.notes] == [96 * place for place in range(len(SCALE))]
    assert (part.map_id, score.unplayed, score.percussion) == ("trumpet", (), ())
    assert len({note.id for note in part.notes}) == len(SCALE)
    assert [warning.id for warning in score.warnings if warning.id != "midi.no_notes"] == ["score.spread"]


def test_two_players_in_dialogue_and_players_of_several_names_are_several() -> None:
    assert len(spread((1, 2)).parts) == 2
    assert len(spread((1, 2, 3), name="Trumpet {}").parts) == 1
    assert len(spread((1, 2, 3), ZONE, "Trumpet {}0").parts) == 3
    chorale = [(96 * place, bytes([0x91, 55, 64])) for place in range(8)]
    chorale += [(96 * place + 90, bytes([0x81, 55, 0])) for place in range(8)]
    # Three tracks, and two voices on the first.
    assert len(spread((1, 2, 3), more=chorale).parts) == 4


def test_bends_and_the_managers_breath_come_from_all_tracks() -> None:
    bend = [(96 * 1 + 10, bytes([0xE2, 0, 0x50])), (96 * 2 + 10, bytes([0xE3, 0, 0x60]))]
    settings = ZONE + bytes([0, 0xB0, 2, 40, 96, 0xB0, 2, 80])
    part = only(spread((1, 2, 3), settings, more=bend))
    bends = curve(part, "pitch_bend")
    # A quarter and half of 48 semitones.
    assert (bends[106], bends[202]) == (0.25 * 24, 0.5 * 24)
    assert curve(part, "breath") == {0: 40 / 127, 96: 80 / 127}
    assert only(spread((1, 2, 3), settings, "", more=bend)).curves == part.curves
