"""The whole of MIDI, message by message: what is read, and as what; all else is named here as left out.

Names and numbers are those of the MIDI 1.0 Detailed Specification 4.2 (tables I to VII), of its recommended practices
and of the Standard MIDI Files 1.0 specification. Whatever is not read changes nothing at all.
"""

from __future__ import annotations

import io
from typing import Final

import mido
import msgspec
import pytest

from app.capture.journal import is_whole
from app.score.sounding import SoundingNotes
from app.score.take import ControllerMapping, curve_values, decoded
from app.score.tracks import TrackEvents, gather
from metadata.model import BiteSource, BreathSource
from tests.unit.score.midi_bytes import END, chunk, header, ids, meta, note, notes_of, score_of

READ_CONTROLLERS: Final = {
    0: "setups",  # bank select: the sound of the program changes that follow
    1: "controls modulation",
    2: "controls breath",
    6: "parameters",  # data entry
    7: "controls volume",
    11: "controls expression",
    16: "controls bite",  # general purpose 1
    38: "parameters",  # data entry, fine
    74: "controls timbre",  # brightness; the third dimension of MPE
    96: "parameters",  # data increment
    97: "parameters",  # data decrement
    98: "parameters",  # number of an unregistered parameter, fine
    99: "parameters",
    100: "parameters",  # number of a registered parameter, fine
    101: "parameters",
    120: "channels",  # all sound off: ends the notes
    121: "parameters",  # reset all controllers
    123: "channels",  # all notes off: ends the notes
}
LEFT_OUT_CONTROLLERS: Final = {
    3: "undefined", 4: "foot controller", 5: "portamento time", 8: "balance", 9: "undefined", 10: "pan",
    12: "effect control 1", 13: "effect control 2", 14: "undefined", 15: "undefined",
    17: "general purpose 2", 18: "general purpose 3", 19: "general purpose 4",
    **dict.fromkeys(range(20, 32), "undefined"),
    **{number + 32: f"fine of controller {number}" for number in range(32) if number != 6},
    64: "sustain pedal", 65: "portamento on or off", 66: "sostenuto pedal", 67: "soft pedal", 68: "legato footswitch",
    69: "hold 2", 70: "sound variation", 71: "timbre intensity", 72: "release time", 73: "attack time",
    75: "decay time", 76: "vibrato rate", 77: "vibrato depth", 78: "vibrato delay", 79: "undefined sound controller",
    80: "general purpose 5", 81: "general purpose 6", 82: "general purpose 7", 83: "general purpose 8",
    84: "portamento control", 85: "undefined", 86: "undefined", 87: "undefined", 88: "high resolution velocity",
    89: "undefined", 90: "undefined", 91: "reverb depth", 92: "tremolo depth", 93: "chorus depth",
    94: "detune depth", 95: "phaser depth", **dict.fromkeys(range(102, 120), "undefined"),
    122: "local control", 124: "omni off", 125: "omni on", 126: "mono", 127: "poly",
}  # fmt: skip

READ_META: Final = {
    0x01: "texts",
    0x03: "name",
    0x04: "instrument_name",
    0x06: "markers",
    0x07: "markers",  # cue point
    0x09: "port",  # device name
    0x21: "port",
    0x51: "tempos",
    0x58: "metres",
}
LEFT_OUT_META: Final = {
    0x00: "sequence number", 0x02: "copyright", 0x05: "lyric", 0x08: "program name", 0x20: "channel prefix",
    0x54: "SMPTE offset", 0x59: "key signature", 0x7F: "of one sequencer",
    **dict.fromkeys({*range(0x0A, 0x80)} - {0x20, 0x21, 0x2F, 0x51, 0x54, 0x58, 0x59, 0x7F}, "undefined"),
}  # fmt: skip
META_DATA: Final = {
    0x00: bytes(2), 0x20: bytes(1), 0x21: bytes([3]), 0x51: bytes([7, 0, 0]), 0x54: bytes([0x41, 0, 0, 0, 0]),
    0x58: bytes([3, 2, 24, 8]), 0x59: bytes(2),
}  # fmt: skip
"""Lengths of events with a fixed length; all others contain a text."""

READ_STATUS: Final = {
    0x8: "channels", 0x9: "channels", 0xA: "controls aftertouch", 0xC: "programs setups", 0xD: "controls aftertouch",
    0xE: "controls pitch_bend",
}  # fmt: skip
"""Curves and events by the upper half of the status byte; controllers (0xB) have a table of their own."""
SYSTEM: Final = {
    0xF0: "exclusive", 0xF1: "time code", 0xF2: "song position", 0xF3: "song select", 0xF4: "undefined",
    0xF5: "undefined", 0xF6: "tune request", 0xF7: "exclusive, more of it", 0xF8: "clock", 0xF9: "undefined",
    0xFA: "start", 0xFB: "continue", 0xFC: "stop", 0xFD: "undefined", 0xFE: "active sensing", 0xFF: "meta event",
}  # fmt: skip


def events_with(*messages: mido.Message) -> TrackEvents:
    """Track in which a note sounds during the messages, and another one follows."""
    return gather(
        [
            mido.Message("note_on", note=60, velocity=64),
            *(message.copy(time=24) for message in messages),
            mido.Message("note_off", note=60, time=48 - 24 * len(messages)),
            mido.Message("note_on", note=62, velocity=64),
            mido.Message("note_off", note=62, time=48),
        ],
        0,
        1920,
    )


PLAIN: Final = events_with()


def changed(events: TrackEvents, plain: TrackEvents = PLAIN) -> set[str]:
    """Fields in which events differ from those of the plain track; controls by kind."""
    fields = {name for name in TrackEvents.__struct_fields__ if getattr(events, name) != getattr(plain, name)}
    if "controls" in fields:
        fields = fields - {"controls"} | {"controls", *(kind for _, kind in events.controls)}
    return fields


def test_every_controller_is_read_or_left_out_by_name() -> None:
    assert sorted([*READ_CONTROLLERS, *LEFT_OUT_CONTROLLERS]) == list(range(128))


@pytest.mark.parametrize("value", [0, 64, 127])
def test_a_controller_does_what_its_row_says_and_nothing_else(value: int) -> None:
    for number in range(128):
        events = events_with(mido.Message("control_change", control=number, value=value))
        assert changed(events) == set(READ_CONTROLLERS.get(number, "").split()), number


def test_every_meta_event_is_read_or_left_out_by_name() -> None:
    # Above 0x7F there are none; 0x2F ends the track.
    assert sorted([*READ_META, *LEFT_OUT_META, 0x2F]) == list(range(0x80))


def _gathered(data: bytes) -> TrackEvents:
    """Events of a track that begins with some bytes, as read by mido."""
    file = header() + chunk(b"MTrk", data + note(60) + END)
    return gather(mido.MidiFile(file=io.BytesIO(file)).tracks[0], 0, 1920)


def test_a_meta_event_does_what_its_row_says_and_nothing_else() -> None:
    plain = _gathered(b"")
    for kind in {*range(0x80)} - {0x2F}:
        events = _gathered(meta(kind, META_DATA.get(kind, b"Oboe")))
        assert changed(events, plain) == set(READ_META.get(kind, "").split()), hex(kind)


@pytest.mark.parametrize("length", [0, 1, 4])
def test_a_meta_event_of_any_kind_and_length_harms_no_note(length: int) -> None:
    for kind in {*range(0x100)} - {0x2F}:
        score = score_of(header() + chunk(b"MTrk", meta(kind, bytes(length)) + note(60) + note(62) + END))
        assert [pitch for _, _, pitch in notes_of(score)] == [60, 62], (hex(kind), length)
        assert "midi.bytes_not_understood" not in ids(score)


def test_a_status_of_a_channel_does_what_its_row_says_on_every_channel() -> None:
    for status in range(0x80, 0xF0):
        if status >> 4 == 0xB:
            continue
        size = 1 if status >> 4 in (0xC, 0xD) else 2
        # A note-off ends the sounding note on its own channel only.
        message = mido.Message.from_bytes([status, 60, 100][: size + 1])
        expected = set(READ_STATUS[status >> 4].split()) if status >> 4 != 0x8 or status == 0x80 else set()
        assert changed(events_with(message)) - {"hanging"} == expected, hex(status)


@pytest.mark.parametrize("running", [False, True])
def test_a_system_message_of_any_status_harms_no_note(running: bool) -> None:
    # 0xF0, 0xF7 and 0xFF have lengths; the others have no place in a file: they are counted and passed over.
    second = bytes([0, 62, 64, 48, 62, 0]) if running else note(62)
    data = {0xF0: b"\3\x41\x10\xf7", 0xF1: b"\1", 0xF2: b"\1\2", 0xF3: b"\1", 0xF7: b"\2\xf3\1", 0xFF: b"\x7f\1\0"}
    assert sorted(SYSTEM) == list(range(0xF0, 0x100))
    for status in SYSTEM:
        inserted = bytes([0, status]) + data.get(status, b"")
        score = score_of(header() + chunk(b"MTrk", bytes([0, 0x90, 60, 64, 48, 60, 0]) + inserted + second + END))
        assert notes_of(score) == [(0, 48, 60), (48, 48, 62)], hex(status)
        assert ("midi.bytes_not_understood" in ids(score)) == (status not in (0xF0, 0xF7, 0xFF)), hex(status)


# --- a take ---------------------------------------------------------------------------------------------------------


def _kinds(raw: bytes, mapping: ControllerMapping) -> set[str]:
    """Kinds of a take's message: its curves, and "end" if it ends a sounding note on its channel."""
    message = decoded(raw.hex())
    if message is None:
        return set()
    sounding: SoundingNotes[None] = SoundingNotes()
    sounding.receive(bytes([0x90 | raw[0] & 0xF, 60, 64]), None)
    ended = bool(sounding.receive(raw, None)) and raw[0] >> 4 != 0x9
    return {kind for kind, _ in curve_values(message, mapping)} | ({"end"} if ended else set())


def test_of_a_take_every_status_is_recorded_or_passed_over() -> None:
    for status in range(0x100):
        for size in range(4):
            whole = 0x80 <= status < 0xF0 and size == (1 if status >> 4 in (0xC, 0xD) else 2)
            raw = bytes([status, *[60] * size])
            assert is_whole(raw) == whole, raw.hex()
            if whole:
                assert decoded(raw.hex()) is not None
            elif status >= 0xF0:
                assert decoded(raw.hex()) is None


def test_of_a_take_every_controller_says_what_its_device_sends_with_it() -> None:
    usual = {7: "volume", 11: "expression"}
    for breath in msgspec.json.schema(BreathSource)["enum"]:
        for bite in ("none", "pitch_bend", "channel_pressure", "cc1", "cc2", "cc16", "cc119"):
            mapping = ControllerMapping(breath=breath, bite=bite)
            for number in range(128):
                source = f"cc{number}"
                expected = {"end"} if number in (120, 123) else set()
                if source == bite:
                    expected.add("bite")
                if source == breath:
                    expected.add("breath")
                elif number in usual and source != bite:
                    expected.add(usual[number])
                assert _kinds(bytes([0xB3, number, 99]), mapping) == expected, (breath, bite, number)


def test_of_a_take_every_status_says_what_its_row_says() -> None:
    rows = {0x8: {"end"}, 0x9: set(), 0xA: set(), 0xC: set(), 0xD: {"aftertouch"}, 0xE: {"pitch_bend"}}
    for status in range(0x80, 0xF0):
        if status >> 4 != 0xB:
            raw = bytes([status, 60, 99][: 2 if status >> 4 in (0xC, 0xD) else 3])
            assert _kinds(raw, ControllerMapping()) == rows[status >> 4], hex(status)


def test_every_controller_may_carry_the_bite_that_a_channel_has_no_other_use_for() -> None:
    def is_source(text: str) -> bool:
        try:
            return msgspec.convert(text, BiteSource) == text
        except msgspec.ValidationError:
            return False

    # From 120 on they are messages to the channel.
    assert [number for number in range(200) if is_source(f"cc{number}")] == list(range(120))
