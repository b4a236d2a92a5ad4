"""``suisou ports`` and ``suisou record`` with real MIDI transport (JACK's dummy server)."""

from __future__ import annotations

import errno
import json
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import BinaryIO

import mido
import pytest

from app.capture.journal import JournalHeader, JournalWriter
from app.cli import main
from app.formats import atomic
from tests.support.jack import jack_server
from tests.support.wind_player import WindPlayer, phrase

ROOT = Path(__file__).parents[3]
PHRASE = phrase([60, 62, 64], beat_s=0.2)

Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    def call(*arguments: str | Path) -> tuple[int, str, str]:
        capsys.readouterr()
        status = main([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        assert "Traceback" not in captured.err
        return status, captured.out, captured.err

    return call


@pytest.fixture(autouse=True)
def _state(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    """Use a temporary folder instead of the user's second folder for recordings."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path_factory.mktemp("state")))


@pytest.fixture(scope="module")
def jack() -> Iterator[None]:
    with jack_server("suisou-cli"):
        yield


@pytest.fixture
def player(jack: None) -> Iterator[WindPlayer]:
    with WindPlayer() as found:
        yield found


@pytest.fixture
def playing(player: WindPlayer) -> Iterator[WindPlayer]:
    """A synthetic player who plays continuously."""
    done = threading.Event()

    def play() -> None:
        while not done.is_set():
            player.play(PHRASE)

    thread = threading.Thread(target=play)
    thread.start()
    yield player
    done.set()
    thread.join()


def pitches(path: Path) -> list[int]:
    return [m.note for track in mido.MidiFile(path).tracks for m in track if m.type == "note_on" and m.velocity]


def test_the_devices_are_listed(player: WindPlayer, run: Run) -> None:
    status, reported, _ = run("ports")
    assert status == 0
    assert f"  {player.name}  Akai EWI USB\n" in reported
    status, reported, _ = run("ports", "--json")
    assert status == 0
    assert json.loads(reported) == {
        "system": "jack",
        "inputs": [{"name": player.name, "controller": "ewi_usb"}],
        "outputs": [],
    }


def test_no_device_is_said(jack: None, run: Run, tmp_path: Path) -> None:
    assert run("ports") == (0, "no MIDI device is connected; connect one and switch it on\n", "")
    status, _, reported = run("record", "--port", "EWI", "--to", tmp_path / "take.mid")
    assert (status, reported) == (1, "suisou: no MIDI device is connected; connect one and switch it on\n")
    assert not list(tmp_path.iterdir())


def test_no_midi_system_is_said(monkeypatch: pytest.MonkeyPatch, run: Run) -> None:
    monkeypatch.setenv("JACK_DEFAULT_SERVER", "suisou-none")
    monkeypatch.setenv("SUISOU_MIDI_API", "jack")
    status, _, reported = run("ports")
    assert status == 1
    assert "the MIDI system does not respond" in reported


def test_a_take_is_recorded(playing: WindPlayer, run: Run, tmp_path: Path) -> None:
    path = tmp_path / "take.mid"
    arguments = ("--seconds", "2", "--count-in", "1", "--tempo", "240")
    status, reported, errors = run("record", "--port", "ewi", "--to", path, *arguments)
    assert status == 0
    assert errors == "suisou: recording\n"
    assert reported.startswith("1 2 3 4\n")
    assert reported.endswith(" notes in 2.0 s\n")
    assert list(tmp_path.iterdir()) == [path], "the journal went"
    file = mido.MidiFile(path)
    assert file.type == 1
    assert file.length == pytest.approx(2.0, abs=0.3)
    assert set(pitches(path)) == {60, 62, 64}
    assert any(m.is_cc(2) for m in file.tracks[1])
    assert mido.tempo2bpm(file.tracks[0][0].tempo) == pytest.approx(240.0)


def test_ctrl_c_ends_the_take(playing: WindPlayer, tmp_path: Path) -> None:
    path = tmp_path / "take.mid"
    recording = subprocess.Popen(
        [sys.executable, "-m", "app", "record", "--port", playing.name, "--to", str(path)],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert recording.stderr.readline() == "suisou: recording; Ctrl+C ends it\n"
    time.sleep(1.5)
    recording.send_signal(signal.SIGINT)
    reported, errors = recording.communicate(timeout=900)
    assert (recording.returncode, errors) == (0, "")
    assert reported.startswith(f"{path}: ")
    assert pitches(path)


def test_a_device_that_is_not_there_is_said_with_those_that_are(player: WindPlayer, run: Run, tmp_path: Path) -> None:
    status, _, reported = run("record", "--port", "flute", "--to", tmp_path / "take.mid")
    assert (status, reported) == (1, f"suisou: MIDI device 'flute' was not found; connected devices: {player.name}\n")


def test_silence_is_no_take(player: WindPlayer, run: Run, tmp_path: Path) -> None:
    status, _, reported = run("record", "--port", player.name, "--to", tmp_path / "take.mid", "--seconds", "0.2")
    assert status == 1
    assert f"nothing was received from {player.name}" in reported
    assert not list(tmp_path.iterdir())


def test_nothing_is_written_over(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "take.mid"
    path.write_text("precious")
    status, _, reported = run("record", "--port", "EWI", "--to", path)
    assert status == 1
    assert "already exists" in reported
    assert path.read_text() == "precious"


def left(tmp_path: Path) -> Path:
    """Journal of a recording that was killed."""
    journal = tmp_path / "take.mid.take-journal"
    writer = JournalWriter(str(journal), JournalHeader("", "", "EWI USB", "ewi_usb", 0.0, ""))
    writer.sync(10**9, 0.0, 0)
    writer.event(10**9, b"\x90\x3c\x50")
    writer.event(2 * 10**9, b"\x80\x3c\x50")
    writer.close()
    with journal.open("ab") as stream:
        stream.write(b"e 30000")
    return journal


def test_what_a_crash_left_is_written(run: Run, tmp_path: Path) -> None:
    left(tmp_path)
    path = tmp_path / "take.mid"
    status, _, reported = run("record", "--port", "EWI", "--to", path)
    assert status == 1
    assert f"'suisou record --rescue --to {path}'" in reported
    assert run("record", "--rescue", "--to", path) == (0, f"{path}: 1 note in 1.0 s\n", "")
    assert pitches(path) == [60]
    assert list(tmp_path.iterdir()) == [path]


def test_a_take_lasts_until_the_recording_was_stopped_and_not_until_its_last_note(run: Run, tmp_path: Path) -> None:
    writer = JournalWriter(
        str(tmp_path / "take.mid.take-journal"), JournalHeader("", "", "EWI USB", "ewi_usb", 0.0, "")
    )
    writer.sync(10**9, 0.0, 0)
    writer.event(10**9, b"\x90\x3c\x50")
    writer.event(2 * 10**9, b"\x80\x3c\x50")
    writer.sync(5 * 10**9, 4.0, 0)
    writer.close()
    path = tmp_path / "take.mid"
    assert run("record", "--rescue", "--to", path) == (0, f"{path}: 1 note in 4.0 s\n", "")
    assert mido.MidiFile(path).length == pytest.approx(4.0, abs=0.01)


def test_a_take_that_its_folder_refuses_is_written_in_a_second_place(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "full").mkdir()
    journal = left(tmp_path / "full")
    path = tmp_path / "full" / "take.mid"
    monkeypatch.setattr("app.cli.record.platformdirs.user_state_path", lambda *names, **more: tmp_path / "state")
    second = tmp_path / "state" / "recordings" / "take.mid"
    new_partial = atomic._new_partial

    def full(folder: Path) -> tuple[Path, BinaryIO]:
        if folder == path.parent:
            raise OSError(errno.ENOSPC, "No space left on device")
        return new_partial(folder)

    monkeypatch.setattr("app.formats.atomic._new_partial", full)
    status, reported, errors = run("record", "--rescue", "--to", path)
    assert (status, reported) == (4, f"{second}: 1 note in 1.0 s\n")
    assert "No space left on device" in errors
    assert str(second) in errors
    assert pitches(second) == [60]
    assert not journal.exists()
    # Another take of the same name replaces nothing.
    left(tmp_path / "full")
    assert run("record", "--rescue", "--to", path)[1].startswith(f"{second.with_name('take (2).mid')}: ")


def test_a_full_disk_keeps_the_journal_and_names_the_remedy(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    journal = left(tmp_path)
    path = tmp_path / "take.mid"

    def full(file: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr("app.formats.atomic.os.fsync", full)
        status, _, errors = run("record", "--rescue", "--to", path)
    assert status == 1
    assert "No space left on device; the recording is kept in take.mid.take-journal" in errors
    assert f"'suisou record --rescue --to {path}'" in errors
    assert list(tmp_path.iterdir()) == [journal]
    assert run("record", "--rescue", "--to", path)[0] == 0


def test_a_running_recording_is_left_alone(run: Run, tmp_path: Path) -> None:
    journal = tmp_path / "take.mid.take-journal"
    writer = JournalWriter(str(journal), JournalHeader("", "", "EWI USB", "ewi_usb", 0.0, ""))
    for arguments in (("--rescue",), ("--port", "EWI")):
        status, _, reported = run("record", *arguments, "--to", tmp_path / "take.mid")
        assert status == 1
        assert "is in progress" in reported
    writer.close()


@pytest.mark.parametrize(
    ("arguments", "status"),
    [
        (("--port", "EWI"), 2),
        (("--to", "x.mid"), 2),
        (("--to", "x.mid", "--port", "EWI", "--tempo", "nan"), 2),
        (("--to", "x.mid", "--port", "EWI", "--tempo", "5"), 2),
        (("--to", "x.mid", "--port", "EWI", "--seconds", "0"), 2),
        (("--to", "x.mid", "--port", "EWI", "--count-in", "1.5"), 2),
        (("--to", "x.mid", "--port", "EWI", "--count-in", "-1"), 2),
        (("--to", "x.mid", "--rescue"), 1),
    ],
)
def test_what_makes_no_sense_is_refused(run: Run, arguments: tuple[str, ...], status: int, tmp_path: Path) -> None:
    assert run("record", *(str(tmp_path / a) if a == "x.mid" else a for a in arguments))[0] == status
