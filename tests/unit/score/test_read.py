"""Meaning of MIDI bytes, and treatment of meaningless ones."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.errors import FileError, Message
from app.messages import text
from app.score.contents import uncast_score
from app.score.limits import LAST_TICK, MOST_NAME, MOST_PARTS, MOST_PLAYER_HOURS, MOST_STREAMS
from app.score.metre_map import Metre
from app.score.model import MOST_VOICES, Marker, PercussionHit
from app.score.read import read_contents, read_midi
from tests.unit.score.midi_bytes import END, MAPS, chunk, header, ids, meta, note, notes_of, one_track, score_of

SCALE = [60, 62, 64, 65]
SCALE_NOTES = [(48 * index, 48, pitch) for index, pitch in enumerate(SCALE)]
SCALE_BYTES = b"".join(note(pitch) for pitch in SCALE)


def error_of(data: bytes) -> FileError:
    with pytest.raises(FileError) as caught:
        score_of(data)
    assert str(caught.value.message.arguments["file"]).endswith("piece.mid")
    return caught.value


# --- notes ------------------------------------------------------------------------------------------------------------


def test_a_scale() -> None:
    score = one_track(SCALE_BYTES)
    assert notes_of(score) == SCALE_NOTES
    assert [n.id for n in score.parts[0].notes] == ["1:1", "1:2", "1:3", "1:4"]
    assert [n.velocity for n in score.parts[0].notes] == [64] * 4


def test_note_on_without_velocity_is_a_note_off_and_running_status_holds() -> None:
    assert notes_of(one_track(bytes([0, 0x90, 60, 64, 48, 60, 0, 0, 62, 64, 48, 62, 0]))) == SCALE_NOTES[:2]


def test_off_and_on_at_one_tick_are_two_notes_in_either_order() -> None:
    off_first = bytes([0, 0x90, 60, 64, 48, 60, 0, 0, 60, 64, 48, 60, 0])
    on_first = bytes([0, 0x90, 60, 64, 48, 60, 64, 0, 60, 0, 48, 60, 0])
    assert notes_of(one_track(off_first)) == notes_of(one_track(on_first)) == [(0, 48, 60), (48, 48, 60)]


def test_a_pitch_that_is_struck_again_ends_there_and_the_second_has_the_last_end() -> None:
    score = one_track(bytes([0, 0x90, 60, 64, 24, 60, 64, 24, 60, 0, 24, 60, 0]))
    assert notes_of(score) == [(0, 24, 60), (24, 48, 60)]


def test_notes_without_end_end_with_the_track_and_notes_without_length_last_a_tick() -> None:
    score = one_track(bytes([0, 0x90, 60, 64, 0, 62, 64, 0, 62, 0]) + meta(1, b"", 96))
    assert notes_of(score) == [(0, 1, 62), (0, 96, 60)]
    assert {"midi.hanging_notes", "midi.zero_length_notes"} <= set(ids(score))


def test_all_notes_off_ends_what_sounds_on_its_channel_only() -> None:
    score = one_track(bytes([0, 0x90, 60, 64, 0, 0x91, 64, 64, 48, 0xB0, 123, 0, 48, 0x81, 64, 0]))
    assert notes_of(score) == [(0, 48, 60), (0, 96, 64)]


# --- controllers ------------------------------------------------------------------------------------------------------


def test_controllers_are_curves_with_the_last_value_of_each_tick() -> None:
    events = bytes([0, 0xB0, 2, 0, 0, 2, 127, 24, 2, 64, 0, 7, 100, 0, 11, 127, 0, 64, 127])
    events += bytes([0, 0xD0, 127, 0, 0xA0, 60, 0, 0, 0xE0, 0, 0, 24, 0xE0, 0, 0x40])
    (part,) = one_track(events + note(60)).parts
    curves = {curve.kind: (curve.ticks, curve.values) for curve in part.curves}
    assert curves == {
        "breath": ((0, 24), (1.0, 64 / 127)),
        "volume": ((24,), (100 / 127,)),
        "expression": ((24,), (1.0,)),
        "aftertouch": ((24,), (0.0,)),
        "pitch_bend": ((24, 48), (-1.0, 0.0)),
    }


# --- tempo, metre, pickup ---------------------------------------------------------------------------------------------


def test_tempo_and_metre_are_taken_from_any_track() -> None:
    conductor = meta(0x58, bytes([3, 2, 24, 8])) + END
    player = meta(0x51, (400_000).to_bytes(3, "big"), 96) + SCALE_BYTES + END
    score = score_of(header(1, 2) + chunk(b"MTrk", conductor) + chunk(b"MTrk", player))
    assert score.metres == (Metre(0, 3, 4),)
    assert [(tick, round(bpm)) for tick, bpm in score.tempo_map.bpm] == [(0, 120), (96, 150)]


@pytest.mark.parametrize("second", [bytes([4, 2, 24, 8]), bytes([3, 2, 24, 8])])
def test_a_first_bar_with_a_metre_of_its_own_is_a_pickup(second: bytes) -> None:
    score = one_track(meta(0x58, bytes([1, 2, 24, 8])) + meta(0x58, second, 96) + SCALE_BYTES)
    assert score.pickup_ticks == 96
    assert score.metre_map.tick_of_bar(1) == 96


def test_a_metre_restated_within_the_first_bar_marks_a_pickup_and_on_a_bar_line_says_nothing() -> None:
    restated = meta(0x58, bytes([3, 2, 24, 8]))
    assert one_track(restated + meta(0x58, bytes([3, 2, 24, 8]), 96) + SCALE_BYTES).pickup_ticks == 96
    on_line = one_track(
        restated + meta(1, b"", 96) + meta(1, b"", 96) + meta(0x58, bytes([3, 2, 24, 8]), 96) + SCALE_BYTES
    )
    assert on_line.pickup_ticks == 0
    assert on_line.metres == (Metre(0, 3, 4),)


def test_impossible_tempi_and_metres_are_left_out_with_a_warning() -> None:
    score = one_track(
        meta(0x51, bytes(3)) + meta(0x58, bytes([0, 2, 24, 8])) + meta(0x58, bytes([4, 200, 24, 8])) + SCALE_BYTES
    )
    assert [(warning.id, warning.arguments["count"]) for warning in score.warnings[:2]] == [
        ("midi.impossible_tempo", 1),
        ("midi.impossible_metre", 2),
    ]
    assert score.metres == (Metre(0, 4, 4),)
    assert score.tempo_map.bpm == ((0, 120.0),)


@pytest.mark.parametrize(
    ("rate", "ticks", "seconds"), [(25, 40, 1000), (24, 4, 96), (30, 80, 2400), (29, 80, 2400 * 1000 / 1001)]
)
def test_smpte_division_is_ticks_per_second(rate: int, ticks: int, seconds: float) -> None:
    score = one_track(SCALE_BYTES, division=(256 - rate) << 8 | ticks)
    assert score.tempo_map.seconds(seconds * 10) == pytest.approx(10)
    assert notes_of(score) == SCALE_NOTES


# --- formats ----------------------------------------------------------------------------------------------------------


def test_the_patterns_of_format_2_follow_one_another() -> None:
    score = score_of(header(2, 2) + 2 * chunk(b"MTrk", SCALE_BYTES + END))
    assert notes_of(score) == SCALE_NOTES + [(onset + 192, length, pitch) for onset, length, pitch in SCALE_NOTES]
    assert "midi.patterns" in ids(score)


def test_format_0_is_split_by_channel() -> None:
    score = one_track(note(60, channel=0) + note(64, channel=1) + note(67, channel=5), format_=0)
    assert [(part.id, part.channel) for part in score.parts] == [("1.1.1", 0), ("1.2.1", 1), ("1.6.1", 5)]


@pytest.mark.parametrize(
    ("events", "players"),
    [
        (note(60) + note(62, channel=1) + note(64), 1),
        # Both notes sound together for one tick.
        (note(60) + bytes([0, 0x91, 62, 64, 47, 0x90, 64, 64, 1, 0x81, 62, 0, 47, 0x80, 64, 0]), 1),
        # The first note of two that overlap lasts longer than the second.
        (bytes([0, 0x90, 60, 64, 6, 64, 64, 18, 64, 0, 0, 0x91, 67, 64, 12, 0x81, 67, 0, 12, 0x80, 60, 0]), 3),
    ],
    ids=["in turns", "a tick together", "under a long note"],
)
def test_channels_of_an_instruments_track_are_one_player_where_they_take_turns(events: bytes, players: int) -> None:
    """Notation programs use a separate channel for a player's muted notes."""
    track = chunk(b"MTrk", meta(3, b"Trumpet") + events + END)
    assert len(score_of(header(1, 2) + chunk(b"MTrk", END) + track).parts) == players


def test_format_0_with_two_tracks_sounds_together_with_a_warning() -> None:
    score = score_of(header(0, 2) + 2 * chunk(b"MTrk", SCALE_BYTES + END))
    assert notes_of(score) == sorted(2 * SCALE_NOTES)
    assert ids(score)[0] == "midi.format_0_tracks"


# --- what mido refuses ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("inserted", "warns"),
    [
        (meta(0x59, bytes([9, 0])), False),  # nine sharps
        (meta(0x59, bytes([1])), False),  # half a key signature
        (meta(0x54, bytes([1])), False),  # half an SMPTE offset
        (meta(0x51, bytes([1, 2])), False),  # half a tempo
        (bytes([0, 0xF0, 3, 0x41, 0x10, 0xF7]), False),
        (bytes([0, 0xF7, 2, 0xF3, 0x01]), False),
        (bytes([0, 0xF4]), True),
        (bytes([0, 0xF5]), True),
        (bytes([0, 0xFE]), True),
        (bytes([0, 0xF2, 1, 2]), True),
    ],
)
@pytest.mark.parametrize("running", [False, True])
def test_events_between_notes_do_not_disturb_them(inserted: bytes, warns: bool, running: bool) -> None:
    second = bytes([0, 62, 64, 48, 62, 0]) if running else note(62)
    score = one_track(bytes([0, 0x90, 60, 64, 48, 60, 0]) + inserted + second)
    assert notes_of(score) == SCALE_NOTES[:2]
    assert ("midi.bytes_not_understood" in ids(score)) == warns


def test_the_time_before_a_dropped_event_is_kept() -> None:
    score = one_track(note(60) + bytes([48, 0xF0, 1, 0xF7, 48, 0x90, 62, 64, 48, 62, 0]))
    assert notes_of(score) == [(0, 48, 60), (144, 48, 62)]


def test_bytes_of_system_messages_in_texts_and_deltas_are_nothing_special() -> None:
    long_delta = bytes([0xF0, 0x00, 0x90, 62, 64, 48, 62, 0])
    score = one_track(meta(1, bytes(range(0xF0, 0x100))) + note(60) + long_delta)
    assert notes_of(score) == [(0, 48, 60), (48 + (0x70 << 7), 48, 62)]
    assert "midi.bytes_not_understood" not in ids(score)


def test_alien_chunks_are_passed_over() -> None:
    score = score_of(header() + chunk(b"XFIH", b"abc") + chunk(b"MTrk", SCALE_BYTES + END) + chunk(b"XFKM", b""))
    assert notes_of(score) == SCALE_NOTES
    assert all(warning.id.startswith("score.") for warning in score.warnings)


def test_a_riff_wrapper_is_passed_over() -> None:
    inner = header() + chunk(b"MTrk", SCALE_BYTES + END)
    riff = b"RIFF" + (len(inner) + 12).to_bytes(4, "little") + b"RMIDdata" + len(inner).to_bytes(4, "little")
    assert notes_of(score_of(riff + inner)) == SCALE_NOTES


def test_a_longer_header_is_read_by_its_length() -> None:
    long_header = chunk(b"MThd", bytes([0, 1, 0, 1, 0, 96, 1, 2, 3, 4]))
    score = score_of(long_header + chunk(b"MTrk", SCALE_BYTES + END))
    assert notes_of(score) == SCALE_NOTES
    assert "midi.header_length" not in ids(score)


@pytest.mark.parametrize("length", [5, 12, 10_000])
def test_a_track_whose_length_is_wrong_is_read_to_its_real_end(length: int) -> None:
    data = header(1, 2) + chunk(b"MTrk", SCALE_BYTES + END, length) + chunk(b"MTrk", SCALE_BYTES + END)
    score = score_of(data)
    assert notes_of(score) == sorted(2 * SCALE_NOTES)
    assert "midi.track_length" in ids(score)


@pytest.mark.parametrize("cut", range(1, 16))
def test_a_track_that_breaks_off_keeps_what_came_before(cut: int) -> None:
    data = header() + chunk(b"MTrk", SCALE_BYTES + END)
    score = score_of(data[:-cut])
    whole = (len(SCALE_BYTES + END) - cut) // 8
    assert notes_of(score)[:whole] == SCALE_NOTES[:whole]
    assert "midi.track_cut_off" in ids(score)
    if cut not in (4, 8, 12):
        truncated = next(warning for warning in score.warnings if warning.id == "midi.track_truncated")
        assert truncated.arguments["track"] == 1


@pytest.mark.parametrize("repaired", [b"", bytes([0, 0xF4])])
def test_a_value_above_127_is_127_whether_or_not_the_track_needs_repair(repaired: bytes) -> None:
    score = one_track(repaired + bytes([0, 0x90, 60, 200, 48, 60, 0]))
    assert [n.velocity for n in score.parts[0].notes] == [127]


def test_bytes_that_are_no_events_are_counted_and_placed() -> None:
    score = one_track(bytes([0, 0xF4, 0, 60]) + note(60) + bytes([0, 0xF2, 1, 2]))
    assert notes_of(score) == SCALE_NOTES[:1]
    warning = next(warning for warning in score.warnings if warning.id == "midi.bytes_not_understood")
    assert warning.arguments == {"track": 1, "byte": 22, "count": 7}


# --- errors -----------------------------------------------------------------------------------------------------------


def test_errors_say_the_file_and_the_byte() -> None:
    assert error_of(b"").message.id == "midi.empty"
    not_midi = error_of(b"\x89PNG\r\n")
    assert (not_midi.message.id, not_midi.message.arguments["byte"]) == ("midi.not_midi", 0)
    cut = error_of(header()[:9])
    assert (cut.message.id, cut.message.arguments["byte"]) == ("midi.header_truncated", 9)
    timeless = error_of(header(division=0) + chunk(b"MTrk", END))
    assert (timeless.message.id, timeless.message.arguments["byte"]) == ("midi.bad_division", 12)
    trackless = error_of(header() + chunk(b"mTrk", SCALE_BYTES + END))
    assert trackless.message.arguments == {**trackless.message.arguments, "byte": 14}


def test_a_file_that_is_not_there_and_an_unknown_encoding(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"file\.(cannot_read|not_regular)"):
        read_midi(tmp_path / "nothing.mid", maps=MAPS)
    with pytest.raises(FileError, match=r"file\.(cannot_read|not_regular)"):
        read_midi(tmp_path, maps=MAPS)
    with pytest.raises(FileError, match=r"midi\.unknown_encoding"):
        read_midi(tmp_path / "nothing.mid", encoding="klingon", maps=MAPS)


# --- names and programs -----------------------------------------------------------------------------------------------


def test_names_programs_and_titles() -> None:
    conductor = meta(3, "行進曲".encode("cp932")) + END
    player = meta(3, "トランペット".encode("cp932")) + bytes([0, 0xC0, 73]) + SCALE_BYTES + END
    score = score_of(header(1, 2) + chunk(b"MTrk", conductor) + chunk(b"MTrk", player))
    (part,) = score.parts
    assert (score.title, part.name, part.instrument, part.map_id) == ("行進曲", "トランペット", "trumpet", "trumpet")
    assert part.program == 73  # the name beats it


def test_the_encoding_can_be_given() -> None:
    data = header() + chunk(b"MTrk", meta(3, "Труба".encode("cp1251")) + SCALE_BYTES + END)
    assert score_of(data, encoding="koi8_r").unplayed[0].name == "рПСАЮ"
    assert score_of(data, encoding="cp1251").parts[0].name == score_of(data).parts[0].name == "Труба"


def test_programs_belong_to_tracks_not_to_channels() -> None:
    trumpet = bytes([0, 0xC0, 56]) + SCALE_BYTES + END
    trombone = bytes([0, 0xC0, 57]) + SCALE_BYTES + END
    score = score_of(header(1, 2) + chunk(b"MTrk", trumpet) + chunk(b"MTrk", trombone))
    assert [part.instrument for part in score.parts] == ["trumpet", "trombone"]


def test_a_program_given_by_a_set_up_track_counts_for_the_channel() -> None:
    set_up = bytes([0, 0xC3, 57]) + END
    player = note(60, channel=3) + END
    score = score_of(header(1, 2) + chunk(b"MTrk", set_up) + chunk(b"MTrk", player))
    assert [part.instrument for part in score.parts] == ["trombone"]


def test_lilypond_contexts_are_cut_from_names_in_lilypond_files_only() -> None:
    def names(creator: bytes) -> list[str]:
        conductor = meta(1, creator) + END
        tracks = [meta(3, name) + meta(4, b"trumpet") + SCALE_BYTES + END for name in (b"Sopran:1", b":one", b"\\new:")]
        chunks = b"".join(chunk(b"MTrk", track) for track in (conductor, *tracks))
        return [part.name for part in score_of(header(1, 4) + chunks).parts]

    assert names(b"LilyPond 2.24.1") == ["Sopran", "trumpet", "trumpet"]
    # A voice determines the instrument if its staff does not.
    tracks = [meta(3, name) + SCALE_BYTES + END for name in (b"winds:trumpetMusic", b"upper:trumpetI", b"trumpet:one")]
    chunks = b"".join(chunk(b"MTrk", track) for track in (meta(1, b"LilyPond 2.24.1") + END, *tracks))
    parts = score_of(header(1, 4) + chunks).parts
    assert [part.name for part in parts] == ["trumpetMusic", "trumpetI", "trumpet"]
    assert names(b"") == ["Sopran:1", ":one", "\\new:"]


def test_markers_and_cue_points_are_markers_of_the_piece() -> None:
    conductor = (
        meta(0x06, b"Intro")
        + meta(0x06, "練習番号Ａ".encode("cp932"), delta=96)
        + meta(0x07, b"lights\r\nup ")
        + meta(0x06, b" ", delta=1)
        + meta(0x06, b"after the end", delta=120)
        + END
    )
    # Some programs repeat the markers in every track.
    player = meta(0x03, b"Trumpet") + meta(0x06, b"Intro") + meta(0x07, b"mute", delta=48) + note(60) + END
    score = score_of(header(1, 2) + chunk(b"MTrk", conductor) + chunk(b"MTrk", player))
    assert score.markers == (
        Marker(0, "Intro"),
        Marker(48, "mute"),
        Marker(96, "練習番号Ａ"),
        Marker(96, "lights up"),
        Marker(217, "after the end"),
    )
    assert score.end_tick == 96
    assert (score.warnings, score.unplayed) == ((), ())


def test_the_encoding_that_is_given_holds_for_markers_and_a_text_without_end_is_cut() -> None:
    data = header() + chunk(b"MTrk", meta(0x06, "Б".encode("koi8-r")) + SCALE_BYTES + END)
    assert score_of(data, encoding="koi8-r").markers == (Marker(0, "Б"),)
    long = bytes([0, 0xFF, 0x06, 0x81, 0xDD, 0x00]) + b"x" * 28288
    assert score_of(header() + chunk(b"MTrk", long + SCALE_BYTES + END)).markers == (Marker(0, 1000 * "x"),)


# --- lost note-offs ---------------------------------------------------------------------------------------------------


def test_a_lost_note_off_makes_neither_a_second_player_nor_a_drone() -> None:
    # 62 is never ended; the end of the track is hours away.
    events = note(60) + bytes([0, 0x90, 62, 64]) + note(64, delta=48) + meta(1, b"", 48) + b"\xbf\xff\xff\x7f"
    score = score_of(header() + chunk(b"MTrk", events + b"\xff\x2f\x00"))
    assert notes_of(score) == [(0, 48, 60), (48, 48, 62), (96, 48, 64)]
    assert len(score.parts) == 1
    assert [warning.arguments["count"] for warning in score.warnings if warning.id == "midi.hanging_notes"] == [1]


def test_the_last_note_of_a_track_that_never_ends_lasts_four_quarters() -> None:
    score = one_track(note(60) + bytes([0, 0x90, 62, 64]) + meta(1, b"", 0) + b"\x90\x00\xff\x01\x00")
    assert notes_of(score) == [(0, 48, 60), (48, 4 * 96, 62)]


def test_a_pitch_that_has_lost_a_note_off_is_struck_again_and_not_held() -> None:
    # First in, first out would give each note the end of the next.
    repeated = b"".join(bytes([0, 0x90, 60, 64, 48, *([60, 0] if number != 1 else [61, 0])]) for number in range(4))
    score = one_track(repeated)
    assert notes_of(score) == [(48 * number, 48, 60) for number in range(4)]
    assert len(score.parts) == 1


def test_a_note_that_is_ended_where_it_is_struck_again_lasts_until_then() -> None:
    # The first 60 has lost its end; another voice is struck during the second, which ends as the third begins.
    struck = bytes([0, 0x90, 60, 64, 48, 60, 64, 12, 48, 64, 12, 48, 0, 24, 60, 0, 0, 60, 64, 48, 60, 0])
    score = one_track(struck)
    assert notes_of(score) == [(0, 48, 60), (48, 48, 60), (60, 12, 48), (96, 48, 60)]
    assert [warning.arguments["count"] for warning in score.warnings if warning.id == "midi.hanging_notes"] == [1]


def test_a_note_struck_again_and_ended_twice_is_no_drone_below_a_melody() -> None:
    # Messages of a wind controller: 62 is struck again without an end, and ended once more after 64.
    melody = bytes([0, 0x90, 62, 64, 48, 62, 64, 48, 62, 0, 48, 64, 64, 48, 64, 0])
    score = one_track(melody + bytes([48, 62, 0]))
    assert notes_of(score) == [(0, 48, 62), (48, 48, 62), (144, 48, 64)]
    assert len(score.parts) == 1
    # Below a second voice it may well be one: first in, first out.
    chord = bytes([0, 67, 64, 0, 69, 64, 48, 67, 0, 0, 69, 0, 48, 62, 0])
    assert (48, 240, 62) in notes_of(one_track(melody + chord))


def test_a_note_struck_twice_at_once_and_ended_once_is_one() -> None:
    score = one_track(bytes([0, 0x90, 60, 64, 0, 60, 64, 48, 60, 0]) + note(62))
    assert notes_of(score) == [(0, 48, 60), (48, 48, 62)]
    # Ended twice, they are two voices in unison, which one player plays.
    score = one_track(bytes([0, 0x90, 60, 64, 0, 60, 64, 48, 60, 0, 0, 60, 0]) + note(62))
    assert notes_of(score) == [(0, 48, 60), (48, 48, 62)]
    assert "score.unisons" in ids(score)


def test_all_notes_off_does_not_hold_notes_until_then() -> None:
    line = b"".join(bytes([48, 0x90, pitch, 64]) for pitch in range(60, 70))
    score = one_track(line + bytes([96, 0xB0, 123, 0]))
    assert notes_of(score) == [(48 * number, 48, 59 + number) for number in range(1, 10)] + [(480, 96, 69)]
    assert len(score.parts) == 1


# --- bounds -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("events", "division", "most"),
    [
        (note(60) + meta(0x51, b"\x00\x27\x10") + b"\x8c\x80\x80\x00" + note(60)[1:], 1, "quarters"),
        (note(60) + meta(0x51, b"\xff\xff\xff") + b"\x81\xff\xff\x7f" + note(60)[1:], 96, "hours"),
        (meta(0x58, bytes([1, 6, 24, 8])) + note(60) + b"\x83\xff\x7f" + note(60)[1:], 4, "bars"),
    ],
)
def test_a_piece_that_is_too_long_is_refused_with_what_it_has_and_may_have(
    events: bytes, division: int, most: str
) -> None:
    other = chunk(b"MTrk", note(60) + END)
    error = error_of(header(1, 2, division) + other + chunk(b"MTrk", events + END))
    arguments = error.message.arguments
    assert error.message.id == "midi.too_long"
    assert arguments["track"] == 2
    long = [kind for kind in ("hours", "quarters", "bars") if arguments[kind] > arguments[f"most_{kind}"]]
    assert most in long


def test_silence_behind_the_music_costs_nothing() -> None:
    late = b"\xff\xff\xff\x7f"
    score = one_track(
        note(60) + b"".join(late + b"\xff\x06\x01a" for _ in range(9)) + late + b"\xff\x58\x04\x01\x06\x18\x08"
    )
    assert score.sounding_end_tick == 48
    assert [warning.arguments["count"] for warning in score.warnings if warning.id == "midi.beyond_all_music"] == [3]
    assert all(marker.tick <= LAST_TICK for marker in score.markers)
    assert len(score.markers) == 7
    assert len(score.metres) == 1


def test_a_delta_of_many_bytes_is_no_huge_number() -> None:
    # 2 ** 60 and more: such ticks have no fractions, so two notes at one tick shared no voice (IndexError).
    far = bytes([0x90, *[0x80] * 6, 0])
    events = far + bytes([0x90, 60, 64, 0, 62, 64, 0, 64, 64, 1, 60, 0]) + far + bytes([62, 0])
    assert error_of(header() + chunk(b"MTrk", events + END)).message.id == "midi.too_long"
    # Beyond any float (OverflowError).
    score = one_track(note(60) + b"\xff" * 160 + bytes([0x7F, 0x90, 60, 64, 1, 60, 0]))
    assert "midi.track_truncated" in ids(score)
    assert notes_of(score) == [(0, 48, 60)]


def test_more_parts_than_any_score_has_are_refused() -> None:
    track = chunk(b"MTrk", note(60) + END)
    assert len(score_of(header(1, MOST_PARTS) + track * MOST_PARTS).parts) == MOST_PARTS
    error = error_of(header(1, MOST_STREAMS + 1) + track * (MOST_STREAMS + 1))
    assert error.message.id == "midi.too_many_parts"


def test_more_players_than_any_band_has_are_left_out() -> None:
    track = chunk(b"MTrk", note(60) + END)
    score = score_of(header(1, MOST_PARTS + 2) + track * (MOST_PARTS + 2))
    assert len(score.parts) == MOST_PARTS
    assert [part.reason.id for part in score.unplayed] == ["score.too_many_players"] * 2


def test_in_a_piece_of_hours_fewer_players_play() -> None:
    ticks = 3 * 7200 * 96
    later = bytes([0x80 | ticks >> 14, 0x80 | ticks >> 7 & 0x7F, ticks & 0x7F])
    track = chunk(b"MTrk", note(60) + later + note(60)[1:] + END)
    score = score_of(header(1, 90) + track * 90)
    assert len(score.parts) == MOST_PLAYER_HOURS // 3
    reason = Message("score.too_many_for_hours", {"most": len(score.parts), "hours": 3.0})
    assert [part.reason for part in score.unplayed] == [reason] * (90 - len(score.parts))


def test_more_notes_at_once_than_any_section_plays_are_left_out() -> None:
    cluster = b"".join(bytes([0, 0x90, 50 + number, 64]) for number in range(MOST_VOICES + 4))
    ends = b"".join(bytes([48 if not number else 0, 0x80, 50 + number, 0]) for number in range(MOST_VOICES + 4))
    score = one_track(cluster + ends + note(60))
    assert len(score.parts) == MOST_VOICES
    # The highest stay.
    assert sorted(note.pitch for part in score.parts for note in part.notes) == sorted([*range(54, 70), 60])
    (warning,) = [warning for warning in score.warnings if warning.id == "score.notes_left_out"]
    assert warning.arguments == {
        "part": score.parts[0].name,
        "most": MOST_VOICES,
        "count": 4,
        "place": "1.1.000",
        "pitch": 50,
    }


def test_names_are_cut_to_what_can_be_shown() -> None:
    long = b"\0\xff\x03" + bytes([0x90, 0x00]) + b"T" * 2048
    score = score_of(header(1, 2) + chunk(b"MTrk", long + END) + chunk(b"MTrk", long + note(60) + END))
    assert len(score.title) == len(score.unplayed[0].name) == MOST_NAME


# --- percussion -------------------------------------------------------------------------------------------------------


def test_every_note_of_the_percussion_is_a_hit_and_no_part(tmp_path: Path) -> None:
    drums = (
        note(42, channel=9) + note(36, channel=9) + bytes([0, 0x99, 22, 1, 0, 0x99, 3, 127, 9, 0x89, 22, 0, 0, 3, 0])
    )
    data = header(1, 2) + chunk(b"MTrk", SCALE_BYTES + END) + chunk(b"MTrk", drums + END)
    score = score_of(data)
    hits = [(0, 42, 64), (48, 36, 64), (96, 3, 127), (96, 22, 1)]
    assert score.percussion == tuple(PercussionHit(*hit) for hit in hits)
    assert len(score.parts) == 1
    assert one_track(SCALE_BYTES).percussion == ()
    (tmp_path / "piece.mid").write_bytes(data)
    uncast = uncast_score(read_contents(tmp_path / "piece.mid"))
    assert notes_of(uncast) == SCALE_NOTES
    assert uncast.percussion == score.percussion


def test_a_file_without_notes_says_so_track_by_track() -> None:
    volume = bytes([0, 0xB0, 7, 100, 0, 0xB0, 7, 90])
    data = header(1, 3) + chunk(b"MTrk", END) + chunk(b"MTrk", meta(3, b"Horn") + volume + END)
    score = score_of(data + chunk(b"MTrk", meta(3, b"Tuba") + END))
    assert (score.parts, score.unplayed) == ((), ())
    assert [(warning.id, warning.arguments) for warning in score.warnings] == [
        ("midi.no_notes", {"tracks": 3}),
        ("midi.unnamed_track_without_notes", {"track": 1, "count": 0}),
        ("midi.track_without_notes", {"track": 2, "name": "Horn", "count": 2}),
        ("midi.track_without_notes", {"track": 3, "name": "Tuba", "count": 0}),
    ]
    assert text(score.warnings[2]) == "track 2 (Horn) has no notes and 2 other events"


def test_a_file_with_notes_in_one_track_is_no_file_without_notes() -> None:
    score = score_of(header(1, 2) + chunk(b"MTrk", END) + chunk(b"MTrk", note(60) + END))
    assert not [warning for warning in score.warnings if "no_notes" in warning.id or "without" in warning.id]


# --- notes after an end of the track ----------------------------------------------------------------------------------


@pytest.mark.parametrize("system", [b"", bytes([0, 0xF2, 1, 2])])
@pytest.mark.parametrize("ends", [1, 3])
def test_notes_after_an_early_end_of_the_track_are_read_with_a_warning(system: bytes, ends: int) -> None:
    """Also if the track needs other repairs before or after it."""
    for events in (system + END * ends + SCALE_BYTES, END * ends + SCALE_BYTES[:8] + system + SCALE_BYTES[8:]):
        score = one_track(events)
        assert notes_of(score) == SCALE_NOTES
        assert [one.arguments["count"] for one in score.warnings if one.id == "midi.early_end"] == [4]


@pytest.mark.parametrize(
    "rest", [bytes(7), b"\x00\x00\x00", b"\xff\xff\xff", meta(6, b"Coda"), b"junk", bytes([0, 0x80, 60, 0])]
)
def test_what_follows_an_end_of_the_track_and_is_no_note_is_nothing(rest: bytes) -> None:
    plain = one_track(SCALE_BYTES + meta(1, b"", 96))
    score = one_track(SCALE_BYTES + meta(1, b"", 96) + END + rest)
    assert (notes_of(score), score.markers) == (notes_of(plain), plain.markers)
    assert "midi.early_end" not in ids(score)
