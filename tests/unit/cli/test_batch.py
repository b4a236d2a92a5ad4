"""`suisou export FOLDER`: every piece, whatever is wrong with another; a run that was stopped goes on."""

from __future__ import annotations

import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from distributed import LocalCluster

from app.cli import main
from app.cli.batch import folders_of
from app.cli.status import BAD_INPUT, BAD_USE, DONE, PARTIAL, STOPPED

ROOT = Path(__file__).parents[3]
QUARTET = ROOT / "resources" / "examples" / "quartet.mid"
SHORT = ("--from-bar", "1", "--to-bar", "1", "--fps", "12", "--format", "fbx", "--player", "Trumpet 1")


@pytest.fixture
def pieces(tmp_path: Path) -> Path:
    folder = tmp_path / "pieces"
    (folder / "more").mkdir(parents=True)
    shutil.copy(QUARTET, folder / "one.mid")
    shutil.copy(QUARTET, folder / "more" / "TWO.MIDI")
    (folder / "bad.mid").write_bytes(b"no MIDI")
    (folder / "notes.txt").write_text("not a piece")
    return folder


def results(printed: str) -> dict[str, str]:
    """The last cell of every piece's line."""
    lines = [line.split("  ") for line in printed.splitlines() if line.strip()]
    return {line[0].strip(): line[-1].strip() for line in lines[1:-1]}


def test_one_bad_file_stops_nothing_and_is_tried_again(
    pieces: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    command = ["export", str(pieces), "--to", str(out), *SHORT]
    assert main(command) == PARTIAL
    first = results(capsys.readouterr().out)
    assert (first["one.mid"], first["more/TWO.MIDI"]) == ("exported", "exported")
    assert "is not a MIDI file" in first["bad.mid"]
    assert (out / "one" / "Trumpet 1.fbx").exists()
    assert (out / "more" / "TWO" / "report.json").exists()
    assert not (out / "bad").exists()

    written = (out / "one" / "Trumpet 1.fbx").stat().st_mtime_ns
    shutil.copy(QUARTET, pieces / "bad.mid")
    assert main(command) == DONE
    second = results(capsys.readouterr().out)
    assert second == {"bad.mid": "exported", "one.mid": "up to date", "more/TWO.MIDI": "up to date"}
    assert (out / "one" / "Trumpet 1.fbx").stat().st_mtime_ns == written

    # Other options, other files.
    assert main([*command, "--seed", "5"]) == DONE
    assert set(results(capsys.readouterr().out).values()) == {"exported"}


def test_what_stopped_in_the_middle_goes_on(pieces: Path, tmp_path: Path) -> None:
    (pieces / "bad.mid").unlink()
    for index in range(2):
        shutil.copy(QUARTET, pieces / f"piece {index}.mid")
    out = tmp_path / "out"
    command = [sys.executable, "-m", "app", "export", str(pieces), "--to", str(out), "--jobs", "1", *SHORT]
    running = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True)
    while not (out / "exported.json").exists():
        assert running.poll() is None
        time.sleep(0.02)
    running.send_signal(signal.SIGINT)
    printed, _ = running.communicate(timeout=60)
    assert running.returncode == STOPPED
    assert "the same command goes on" in printed
    done = {piece for piece, result in results(printed).items() if result == "exported"}
    assert 1 <= len(done) < 4
    # Nothing half-written stays.
    assert len([path for path in out.rglob("*") if path.is_file()]) == 1 + 3 * len(done)

    finished = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    again = results(finished.stdout)
    assert {piece for piece, result in again.items() if result == "up to date"} == done
    assert len(again) == 4


def test_where_all_pieces_are_bad(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "bad.mid").write_bytes(b"")
    assert main(["export", str(tmp_path), "--to", str(tmp_path / "out")]) == BAD_INPUT
    assert "0 of 1 piece exported" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "status", "said"),
    [
        (("--to", "{out}"), BAD_INPUT, "there is no piece"),
        (("--unreal", "{out}"), BAD_USE, "use --to"),
    ],
)
def test_what_is_wrong_with_the_request(
    options: tuple[str, str], status: int, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "empty").mkdir()
    filled = [option.format(out=tmp_path / "out") for option in options]
    assert main(["export", str(tmp_path / "empty"), *filled]) == status
    assert said in capsys.readouterr().err


def test_damaged_notes_are_named(pieces: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    out.mkdir()
    (out / "exported.json").write_text("{")
    assert main(["export", str(pieces), "--to", str(out)]) == BAD_INPUT
    assert "exported.json is damaged" in capsys.readouterr().err


def test_pieces_of_one_name_and_hidden_files(tmp_path: Path) -> None:
    for name in ("song.mid", "song.suisou", "x/song.mid", ".trash/old.mid", "other.mid.bak"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(b"")
    assert folders_of(tmp_path) == {"song.mid": "song.mid", "song.suisou": "song.suisou", "x/song.mid": "x/song"}


def test_one_piece_needs_no_scheduler(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    command = ["export", str(QUARTET), "--to", str(tmp_path), "--scheduler", "tcp://127.0.0.1:1"]
    assert main(command) == BAD_USE
    assert "folder of pieces" in capsys.readouterr().err


def test_a_scheduler_that_does_not_answer(
    pieces: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.cli.batch.CONNECT_S", 0.5)
    command = ["export", str(pieces), "--to", str(tmp_path / "out"), "--scheduler", "tcp://127.0.0.1:1"]
    assert main(command) == BAD_USE
    assert "no Dask scheduler answers at tcp://127.0.0.1:1" in capsys.readouterr().err


def test_a_cluster_exports_the_pieces(pieces: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with LocalCluster(
        n_workers=1, threads_per_worker=2, processes=False, protocol="tcp", host="127.0.0.1", dashboard_address=None
    ) as cluster:
        command = ["export", str(pieces), "--to", str(tmp_path / "out"), *SHORT]
        assert main([*command, "--scheduler", cluster.scheduler_address]) == PARTIAL
    found = results(capsys.readouterr().out)
    assert (found["one.mid"], found["more/TWO.MIDI"]) == ("exported", "exported")
    assert "is not a MIDI file" in found["bad.mid"]
    # Where the pieces were exported makes no difference.
    assert main(command) == PARTIAL
    assert results(capsys.readouterr().out)["one.mid"] == "up to date"
