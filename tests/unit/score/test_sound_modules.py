"""Rhythm parts, melodies on channel 10 and sound effects of GS, XG and GM2, and ports, with the parts made
from them.
"""

from __future__ import annotations

from pathlib import Path
from time import process_time

import pytest

from app.project.model import map_choices
from app.score.assignments import PartAssignment
from app.score.contents import assigned_score
from app.score.model import Score
from app.score.read import read_contents, read_midi
from instrument_maps.library import all_maps
from tests.unit.score.midi_bytes import END, chunk, header, meta, note, score_of
from tests.unit.score.sound_module_files import module_file

MAPS = map_choices(all_maps().values())
DRUMS = Path(__file__).parents[4] / "shared" / "data" / "midi" / "drums"
FILES = 200


def read(path: Path, data: bytes) -> Score:
    path.write_bytes(data)
    return read_midi(path, maps=MAPS)


def lines_of(score: Score) -> list[tuple[str, list[tuple[int, int]]]]:
    """Instrument and notes (tick, pitch) of every part."""
    return [(part.instrument or "", [(note.onset_tick, note.pitch) for note in part.notes]) for part in score.parts]


@pytest.mark.parametrize("first", range(0, FILES, 50))
def test_melodies_have_players_and_drums_have_none(first: int, tmp_path: Path) -> None:
    wrong = {}
    for seed in range(first, first + 50):
        made = module_file(seed)
        score = read(tmp_path / "piece.mid", made.data)
        effects = sum(part.reason.id == "score.sound_effect" for part in score.unplayed)
        found = sorted(lines_of(score)), [(hit.tick, hit.pitch) for hit in score.percussion], effects
        if found != (sorted(made.melodies), made.hits, made.effects):
            wrong[seed] = found
    assert not wrong


@pytest.mark.skipif(not DRUMS.is_dir(), reason="no drum recordings here")
def test_drums_of_general_midi_stay_percussion() -> None:
    for path in sorted(DRUMS.glob("*.mid")):
        score = read_midi(path, maps=MAPS)
        assert not score.parts
        assert score.percussion
        assert {part.reason.id for part in score.unplayed} == {"score.percussion"}


# --- single rules -----------------------------------------------------------------------------------------------------

TUNE = b"".join(note(pitch, 24, 10) for pitch in (60, 62, 64, 65))
"""A melody on channel 11."""
BEAT = b"".join(note(pitch, 24, 10) for pitch in (36, 42, 38, 42))
TRUMPET_11 = bytes([0, 0xCA, 56])
XG_ON = bytes([0, 0xF0, 8, 0x43, 0x10, 0x4C, 0, 0, 0x7E, 0, 0xF7])
GS_RESET = bytes([0, 0xF0, 10, 0x41, 0x10, 0x42, 0x12, 0x40, 0, 0x7F, 0, 0x41, 0xF7])
RHYTHM_11 = bytes([0xF0, 10, 0x41, 0x10, 0x42, 0x12, 0x40, 0x1A, 0x15, 1, 0x10, 0xF7])


def bank(msb: int, channel: int = 10) -> bytes:
    return bytes([0, 0xB0 | channel, 0, msb])


def found(*tracks: bytes) -> tuple[int, int, list[str]]:
    """Number of all players' notes, number of percussion hits, and ids of the reasons for parts without a player."""
    score = score_of(header(1, len(tracks)) + b"".join(chunk(b"MTrk", events + END) for events in tracks))
    played = sum(len(part.notes) for part in score.parts)
    return played, len(score.percussion), [part.reason.id for part in score.unplayed]


@pytest.mark.parametrize(
    ("tracks", "expected"),
    [
        # A bank takes effect with the next program change; one without a later change was meant for the first note.
        ((XG_ON + bank(0) + TRUMPET_11 + TUNE + bank(127) + TUNE,), "tune"),
        ((XG_ON + bank(0) + TRUMPET_11 + TUNE + bank(127) + TRUMPET_11 + BEAT,), "both"),
        ((XG_ON + TRUMPET_11 + bank(127) + BEAT,), "beat"),
        ((XG_ON + TRUMPET_11 + bank(64) + BEAT,), "effect"),
        # Settings that come within the first bar are the channel's; later ones change it.
        ((BEAT + XG_ON + bank(127) + TRUMPET_11,), "beat"),
        ((meta(3, b"Trumpet") + TUNE * 6 + XG_ON + bank(127) + TRUMPET_11 + BEAT,), "long tune and beat"),
        # Without a reset, or with another system's.
        ((bank(127) + TRUMPET_11 + BEAT,), "beat"),
        ((bank(126) + TRUMPET_11 + BEAT,), "effect"),
        ((bank(64) + TRUMPET_11 + TUNE,), "tune"),
        ((meta(3, b"Trumpet") + bank(127) + TRUMPET_11 + TUNE,), "tune"),
        ((meta(3, b"Trumpet") + XG_ON + bank(127) + TRUMPET_11 + BEAT,), "beat"),
        ((GS_RESET + bank(127) + TRUMPET_11 + TUNE,), "tune"),
        ((GS_RESET + XG_ON + bank(127) + TRUMPET_11 + BEAT,), "beat"),
        # Settings behind the notes' track in the file, in pieces, without an end, without a checksum's right value.
        ((TRUMPET_11 + BEAT, b"\0" + RHYTHM_11), "beat"),
        ((TRUMPET_11 + BEAT, bytes([0, 0xF0, 4, 0x41, 0x10, 0x42, 0x12, 0, 0xF7, 6]) + RHYTHM_11[6:]), "beat"),
        ((TRUMPET_11 + BEAT, bytes([0, 0xF7, 11]) + RHYTHM_11[:1] + RHYTHM_11[2:]), "beat"),
        ((TRUMPET_11 + BEAT, bytes([0, 0xF0, 9]) + RHYTHM_11[2:-1]), "beat"),
        ((bytes([0, 0xF0, 10, 0x41, 0x10, 0x42, 0x12, 0x40, 0x1A, 0x15, 1, 0, 0xF7]) + TRUMPET_11 + BEAT,), "beat"),
        # A reset restores the default; a mode of another part has no effect.
        ((b"\0" + RHYTHM_11 + b"\1" + GS_RESET[1:] + TRUMPET_11 + TUNE,), "tune"),
        ((bytes([0, 0xF0, 10, 0x41, 0x10, 0x42, 0x12, 0x40, 0x1B, 0x15, 1, 0xF, 0xF7]) + TRUMPET_11 + TUNE,), "tune"),
        # Part 10 receives on channel 11.
        ((bytes([0, 0xF0, 10, 0x41, 0x10, 0x42, 0x12, 0x40, 0x10, 2, 10, 0x24, 0xF7]) + BEAT,), "beat"),
        # Names of kits on any channel, but not where a wind's program has a tune.
        ((END, meta(3, b"Drum Kit") + BEAT), "beat"),
        ((END, meta(3, b"Drum Kit") + TUNE), "beat"),
        ((END, meta(3, b"Drum Kit") + TRUMPET_11 + TUNE), "tune"),
    ],
)
def test_what_a_channel_is(tracks: tuple[bytes, ...], expected: str) -> None:
    results = {
        "beat": (0, 4, ["score.percussion"]),
        "effect": (0, 0, ["score.sound_effect"]),
        "both": (4, 4, ["score.percussion"]),
        "long tune and beat": (24, 4, ["score.percussion"]),
    }
    played, hits, reasons = found(*tracks)
    if expected == "tune":
        assert played in (4, 8)
        assert (hits, reasons) == (0, [])
    else:
        assert (played, hits, reasons) == results[expected]


def test_a_port_has_its_own_programs_and_modes() -> None:
    port_0, port_1 = meta(0x21, b"\0"), meta(0x21, b"\1")
    trumpet, tune = bytes([0, 0xC0, 56]), b"".join(note(pitch, 24) for pitch in (36, 38, 42, 60))
    # The program of another port's track is not this one's, nor is that of another device.
    for other in (port_1, meta(9, b"SC-88 B")):
        assert found(END, meta(9, b"SC-88 A") + port_0 + trumpet + tune, other + meta(3, b"Solo II") + tune)[2] == [
            "score.unknown_instrument"
        ]
    # Settings of no port are everyone's; those of a port, and GS's of the other one (50 1x), are one's.
    rhythm_1, rhythm_1_b = (
        bytes([0, 0xF0, 10, 0x41, 0x10, 0x42, 0x12, at, 0x11, 0x15, 1, 0x19, 0xF7]) for at in (64, 80)
    )
    both = port_0 + trumpet + tune, port_1 + trumpet + tune
    assert found(rhythm_1, *both)[:2] == (0, 8)
    assert found(port_1 + rhythm_1, *both)[:2] == (4, 4)
    assert found(port_0 + rhythm_1_b, *both)[:2] == (4, 4)
    # A module with two ports is reset at one of them; settings without a device's name apply to the named device.
    effects = bytes([0, 0xB0, 0, 64]) + trumpet + tune
    assert found(port_0 + XG_ON, port_0 + trumpet + tune, port_1 + effects)[2] == ["score.sound_effect"]
    assert found(port_0 + rhythm_1, port_0 + meta(9, b"SC-88") + trumpet + tune, port_1 + trumpet + tune)[:2] == (4, 4)


def test_sounds_of_kits_have_the_numbers_of_general_midi() -> None:
    beat = b"".join(note(pitch, 24, 10) for pitch in (22, 26, 33, 36))

    def struck(*setup: bytes) -> list[int]:
        score = score_of(header(1, 1) + chunk(b"MTrk", b"".join(setup) + beat + END))
        return [hit.pitch for hit in score.percussion]

    assert struck(XG_ON, bank(127), bytes([0, 0xCA, 0])) == [34, 38, 35, 36]
    assert struck(GS_RESET, b"\0", RHYTHM_11) == [33, 39, 33, 36]
    assert struck(bank(120), bytes([0, 0xCA, 0])) == [22, 26, 33, 36]


def test_a_hundred_kilobytes_of_settings_are_read_at_once() -> None:
    """Many tracks on one channel, and a track of settings for all of them."""
    settings = b"".join(bank(0, 0) + bytes([0, 0xC0, 56]) + b"\0" + RHYTHM_11 for _ in range(4500))
    tracks = [settings, *([note(60)] * 200)]
    begin = process_time()
    score = score_of(header(1, len(tracks)) + b"".join(chunk(b"MTrk", events + END) for events in tracks))
    assert len(score.parts) == 128
    assert process_time() - begin < 5.0


def test_drums_before_a_melody_on_one_channel_can_be_played_too(tmp_path: Path) -> None:
    path = tmp_path / "piece.mid"
    both = XG_ON + bank(127) + TRUMPET_11 + BEAT + bank(0) + TRUMPET_11 + TUNE
    path.write_bytes(header(1, 1) + chunk(b"MTrk", both + END))
    contents = read_contents(path)
    rows = [PartAssignment((place,), "trumpet_Bb") for place in range(2)]
    score = assigned_score(contents, rows, MAPS)
    assert sorted(len(part.notes) for part in score.parts) == [4, 4]
    assert len({part.id for part in score.parts}) == 2
    assert not score.percussion


def test_one_track_may_have_more_than_sixteen_channels() -> None:
    """File of format 0 with port events before the messages; equal channels of two ports are different."""
    events = meta(3, b"Song")
    for port, program in ((0, 56), (1, 57)):
        events += meta(0x21, bytes([port])) + bytes([0, 0xC0, program])
    for high, low in ((60, 50), (62, 48), (64, 47), (65, 45)):
        events += meta(0x21, b"\0") + bytes([0, 0x90, high, 90]) + meta(0x21, b"\1") + bytes([0, 0x90, low, 90])
        events += meta(0x21, b"\0") + bytes([48, 0x80, high, 0]) + meta(0x21, b"\1") + bytes([0, 0x80, low, 0])
    score = score_of(header(0, 1) + chunk(b"MTrk", events + END))
    assert score.title == "Song"
    assert [(part.map_id, [(one.onset_tick, one.pitch) for one in part.notes]) for part in score.parts] == [
        ("trumpet", [(0, 60), (48, 62), (96, 64), (144, 65)]),
        ("trombone", [(0, 50), (48, 48), (96, 47), (144, 45)]),
    ]
    assert len({note.id for part in score.parts for note in part.notes}) == 8
