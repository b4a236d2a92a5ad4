"""A take as a MIDI file contains everything played at its time, without hanging notes."""

from __future__ import annotations

from pathlib import Path

import mido
import pytest

from app.errors import FileError
from app.score.read import read_midi
from app.score.write_take import TICKS_PER_QUARTER, write_take
from tests.support.wind_player import phrase
from tests.unit.score.midi_bytes import MAPS

Event = tuple[float, bytes]


def on(pitch: int, velocity: int = 80) -> bytes:
    return bytes([0x90, pitch, velocity])


def off(pitch: int) -> bytes:
    return bytes([0x80, pitch, 64])


def file_of(
    tmp_path: Path,
    events: list[Event],
    *,
    tempo: float = 120.0,
    end_s: float | None = None,
    name: str = "EWI ウインド",
) -> tuple[int, mido.MidiFile]:
    path = tmp_path / "take.mid"
    count = write_take(
        path,
        [round(at_s * 1e6) for at_s, _ in events],
        [message for _, message in events],
        name=name,
        beats_per_minute=tempo,
        end_us=None if end_s is None else round(end_s * 1e6),
    )
    return count, mido.MidiFile(path, charset="utf-8")


def played(file: mido.MidiFile) -> list[tuple[float, str]]:
    """Times in seconds and texts of everything on the second track."""
    tick, found = 0, []
    tempo = file.tracks[0][0].tempo
    for message in file.tracks[1]:
        tick += message.time
        if not message.is_meta:
            found.append((round(mido.tick2second(tick, file.ticks_per_beat, tempo), 3), message.hex().replace(" ", "")))
    return found


@pytest.mark.parametrize("tempo", [20.0, 96.0, 120.0, 400.0])
def test_everything_is_there_within_a_millisecond(tmp_path: Path, tempo: float) -> None:
    events = phrase([60, 62, 64, 65, 67], ghosts=3)
    count, file = file_of(tmp_path, events, tempo=tempo, end_s=4.0)
    assert file.type == 1
    assert len(file.tracks) == 2
    assert file.ticks_per_beat == TICKS_PER_QUARTER
    assert mido.tempo2bpm(file.tracks[0][0].tempo) == pytest.approx(tempo, rel=1e-5)
    assert file.tracks[1].name == "EWI ウインド"
    found = played(file)
    assert [text for _, text in found] == [message.hex().upper() for _, message in events]
    least_s = 0.5 * 60.0 / tempo / TICKS_PER_QUARTER + 0.001
    assert all(abs(at_s - due_s) < least_s for (at_s, _), (due_s, _) in zip(found, events, strict=True))
    assert count == 8
    assert file.length == pytest.approx(4.0, abs=0.01)


def test_our_own_reader_reads_it(tmp_path: Path) -> None:
    file_of(tmp_path, phrase([60, 62, 64, 65, 67]), name="Trumpet")
    (part,) = read_midi(tmp_path / "take.mid", maps=MAPS).parts
    assert [note.pitch for note in part.notes] == [60, 62, 64, 65, 67]
    assert {"breath", "aftertouch", "pitch_bend"} <= {curve.kind for curve in part.curves}


def test_held_notes_end_with_the_take(tmp_path: Path) -> None:
    _, file = file_of(tmp_path, [(0.0, on(60)), (0.5, on(62)), (1.0, off(62))], end_s=2.0)
    assert played(file)[-1] == (2.0, "803C00")


AGAIN = [(0.0, on(60)), (0.5, off(60)), (1.0, on(62)), (1.5, on(62)), (2.0, off(62)), (2.5, on(64)), (3.0, off(64))]
"""Messages in which a note is struck again before its end, and ended once more than it sounds: four notes of half a
second.
"""


def test_a_note_that_is_struck_again_ends_there(tmp_path: Path) -> None:
    count, file = file_of(tmp_path, [*AGAIN, (4.0, off(62))], end_s=5.0, name="Trumpet")
    assert count == 4
    assert played(file)[3:5] == [(1.5, "803E00"), (1.5, "903E50")]
    (part,) = read_midi(tmp_path / "take.mid", maps=MAPS).parts
    assert [(note.pitch, note.duration_tick) for note in part.notes] == [(pitch, 960) for pitch in (60, 62, 62, 64)]


def test_all_notes_off_ends_the_notes_of_its_channel(tmp_path: Path) -> None:
    other = bytes([0x91, 60, 80])
    _, file = file_of(tmp_path, [(0.0, on(60)), (0.1, other), (1.0, bytes([0xB0, 123, 0]))], end_s=2.0)
    assert played(file)[2:] == [(1.0, "803C00"), (1.0, "B07B00"), (2.0, "813C00")]


def test_an_end_without_a_begin_is_left_out(tmp_path: Path) -> None:
    _, file = file_of(tmp_path, [(0.5, off(60)), (1.0, on(60, 0)), (1.5, on(61)), (2.0, on(61, 0))])
    assert [text for _, text in played(file)] == ["903D50", "903D00"]


def test_what_was_before_the_first_beat(tmp_path: Path) -> None:
    breath = [(-1.0, b"\xb0\x02\x10"), (-0.5, b"\xb0\x02\x20"), (-0.4, b"\xe0\x00\x41"), (-0.3, b"\xb0\x07\x64")]
    notes = [(-2.0, on(50)), (-1.5, off(50)), (-0.1, on(60)), (-0.08, on(61)), (-0.01, off(61)), (0.5, off(60))]
    held = [(-3.0, on(40)), (0.25, off(40))]
    events = sorted([*breath, *notes, *held], key=lambda event: event[0])
    count, file = file_of(tmp_path, events)
    found = played(file)
    assert {at_s for at_s, _ in found[:7]} == {0.0}
    assert {text for _, text in found[:3]} == {"B00220", "E00041", "B00764"}, "how the controllers stood"
    assert [text for _, text in found[3:5]] == ["903D50", "803D40"]
    assert {text for _, text in found[5:7]} == {"902850", "903C50"}
    assert found[7:] == [(0.25, "802840"), (0.5, "803C40")]
    assert count == 3


def test_nothing_is_a_file_too(tmp_path: Path) -> None:
    count, file = file_of(tmp_path, [], end_s=1.0)
    assert count == 0
    assert file.length == pytest.approx(1.0)


def test_a_folder_that_is_not_there_is_reported(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"file\.cannot_write"):
        write_take(tmp_path / "nowhere" / "take.mid", [], [], name="")
