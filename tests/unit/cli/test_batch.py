"""`suisou export FOLDER`: every piece is exported regardless of errors in others, and a stopped run is resumed."""

from __future__ import annotations

import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterable
from concurrent.futures import Future, wait
from dataclasses import replace
from pathlib import Path
from typing import Any

import cloudpickle
import pytest
from distributed import LocalCluster

from app.cli import batch, main
from app.cli.batch import BatchOutcome, export_piece, folders_of
from app.cli.batch_inputs import OWN_FOLDERS, own_digests, piece_digest
from app.cli.cluster import check_worker, machine_facts, probe
from app.cli.status import BAD_INPUT, BAD_USE, DONE, PARTIAL, STOPPED
from app.errors import UsageError
from app.export.file_names import REPORT
from app.project.model import map_choices, project_from_score
from app.project.recording import AudioTrack
from app.project.storage import save
from app.score.chunks import INCOMPLETE
from app.score.read import read_midi
from instrument_maps.load import bundled_maps

ROOT = Path(__file__).parents[3]
QUARTET = ROOT / "resources" / "examples" / "quartet.mid"
SHORT = ("--from-bar", "1", "--to-bar", "1", "--fps", "12", "--format", "bvh", "--player", "Trumpet 1")


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
    """Last cell of every piece's line in the table."""
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
    assert (out / "one" / "Trumpet 1.bvh").exists()
    assert (out / "more" / "TWO" / "report.json").exists()
    assert not (out / "bad").exists()

    written = (out / "one" / "Trumpet 1.bvh").stat().st_mtime_ns
    shutil.copy(QUARTET, pieces / "bad.mid")
    assert main(command) == DONE
    second = results(capsys.readouterr().out)
    assert second == {"bad.mid": "exported", "one.mid": "up to date", "more/TWO.MIDI": "up to date"}
    assert (out / "one" / "Trumpet 1.bvh").stat().st_mtime_ns == written


@pytest.fixture(autouse=True)
def _own_folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Set folders of the user's own files, for the pieces' processes too."""
    for kind in OWN_FOLDERS:
        monkeypatch.setenv(kind.variable, str(tmp_path / "own" / kind.name))


@pytest.mark.parametrize("kind", [kind.name for kind in OWN_FOLDERS])
def test_own_files_that_changed_change_the_digest(kind: str, pieces: Path, tmp_path: Path) -> None:
    file = tmp_path / "own" / kind / "mine.toml"
    file.parent.mkdir(parents=True)
    digests = [digest(pieces / "one.mid")]
    for content in ("a = 1", "a = 2"):
        file.write_text(content)
        os.utime(file, ns=(0, 0))  # The content decides, not the time.
        digests.append(digest(pieces / "one.mid"))
    assert len(set(digests)) == 3
    file.unlink()
    assert digest(pieces / "one.mid") == digests[0]


def digest(piece: Path, **options: object) -> str:
    return piece_digest(piece, argparse.Namespace(**options), own_digests())


def test_what_a_project_names_changes_its_digest(tmp_path: Path) -> None:
    recording, asset = tmp_path / "take.wav", tmp_path / "asset.fbx"
    maps = bundled_maps()
    quartet = project_from_score(read_midi(QUARTET, maps=map_choices(maps.values())), maps)
    project = replace(quartet, audio=AudioTrack(str(recording)))
    piece = tmp_path / "piece.suisou"
    save(project, piece)
    digests = [digest(piece)]
    recording.write_bytes(b"sound")
    digests.append(digest(piece))
    recording.write_bytes(b"other")
    digests.append(digest(piece))
    digests.append(digest(piece, check_skeleton=asset))
    asset.write_bytes(b"bones")
    digests.append(digest(piece, check_skeleton=asset))
    digests.append(digest(piece, check_skeleton=asset, fps="24"))
    assert len(set(digests)) == len(digests)
    # Destination and number of processes do not affect the digest.
    assert digest(piece, to=tmp_path, jobs=7, scheduler="tcp://x:1") == digests[2]


@pytest.fixture
def writes_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Export pieces immediately in this process."""

    def write(given: list[str], piece: str, folder: str) -> BatchOutcome:
        Path(folder).mkdir(parents=True, exist_ok=True)
        (Path(folder) / REPORT).touch()
        return BatchOutcome(DONE)

    monkeypatch.setattr(batch, "export_piece", write)


@pytest.mark.usefixtures("writes_at_once")
def test_own_rules_and_other_options_export_every_piece_again(
    pieces: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (pieces / "bad.mid").unlink()
    (pieces / "more" / "TWO.MIDI").unlink()
    command = ["export", str(pieces), "--to", str(tmp_path / "out"), *SHORT]
    assert main(command) == DONE
    capsys.readouterr()
    assert main([*command, "--seed", "5"]) == DONE
    assert results(capsys.readouterr().out) == {"one.mid": "exported"}
    assert main(command) == DONE
    own = tmp_path / "own" / "expressions" / "calm.toml"
    own.parent.mkdir(parents=True)
    own.write_bytes((ROOT / "metadata" / "expressions" / "bright.toml").read_bytes())
    capsys.readouterr()
    assert main(command) == DONE
    assert results(capsys.readouterr().out) == {"one.mid": "exported"}
    assert main(command) == DONE
    assert results(capsys.readouterr().out) == {"one.mid": "up to date"}


def cut_off(where: str) -> bytes:
    """The quartet's file, cut within its last track."""
    whole = QUARTET.read_bytes()
    last = whole.rindex(b"MTrk")
    event = whole.index(b"\x93", last + 100)
    return whole[: {"within an event": event + 2, "between events": event + 3, "before a track": last}[where]]


@pytest.mark.parametrize("where", ["within an event", "between events", "before a track"])
def test_a_file_that_breaks_off_is_incomplete(where: str, tmp_path: Path) -> None:
    piece = tmp_path / "cut.mid"
    piece.write_bytes(cut_off(where))
    assert {warning.id for warning in read_midi(piece, maps=map_choices(bundled_maps().values())).warnings} & INCOMPLETE


def test_a_truncated_piece_is_marked(pieces: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("one.mid", "more/TWO.MIDI"):
        (pieces / name).unlink()
    (pieces / "bad.mid").write_bytes(cut_off("between events"))
    command = ["export", str(pieces), "--to", str(tmp_path / "out"), *SHORT]
    for first in ("exported, incomplete: ", "up to date, incomplete: "):
        assert main(command) == PARTIAL
        printed = capsys.readouterr().out
        assert results(printed)["bad.mid"].startswith(first)
        assert "1 of 1 piece exported; 1 of them is incomplete" in printed


def test_what_stopped_in_the_middle_goes_on(pieces: Path, tmp_path: Path) -> None:
    (pieces / "bad.mid").unlink()
    shutil.copy(QUARTET, pieces / "piece.mid")
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
    # On a busy computer the signal may come when the other pieces are finished too.
    assert done
    # No partial file remains.
    assert len([path for path in out.rglob("*") if path.is_file()]) == 1 + 2 * len(done)

    finished = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    again = results(finished.stdout)
    assert {piece for piece, result in again.items() if result == "up to date"} == done
    assert len(again) == 3


def test_what_was_done_when_a_run_was_stopped_is_noted(
    pieces: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(futures: Iterable[Future[BatchOutcome]]) -> None:
        wait(futures)
        raise KeyboardInterrupt

    monkeypatch.setattr(batch, "as_completed", interrupt)
    monkeypatch.setattr(batch, "export_piece", lambda given, piece, folder: BatchOutcome(DONE))
    out = tmp_path / "out"
    out.mkdir()
    assert main(["export", str(pieces), "--to", str(out), *SHORT]) == STOPPED
    assert json.loads((out / "exported.json").read_text(encoding="utf-8")).keys() == {
        "bad.mid", "more/TWO.MIDI", "one.mid"
    }  # fmt: skip


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
    monkeypatch.setattr("app.cli.cluster.CONNECT_S", 0.5)
    command = ["export", str(pieces), "--to", str(tmp_path / "out"), "--scheduler", "tcp://127.0.0.1:1"]
    assert main(command) == BAD_USE
    assert "no Dask scheduler answers at tcp://127.0.0.1:1" in capsys.readouterr().err


def test_a_scheduler_without_workers(
    pieces: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.cli.cluster.CONNECT_S", 1.0)
    with LocalCluster(
        n_workers=0, processes=False, protocol="tcp", host="127.0.0.1", dashboard_address=None
    ) as cluster:
        command = ["export", str(pieces), "--to", str(tmp_path / "out"), *SHORT]
        assert main([*command, "--scheduler", cluster.scheduler_address]) == BAD_USE
    assert "has no workers; start some with: dask worker tcp://" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("changed", "id"),
    [
        ({}, None),
        ({"program": "0"}, "dask.other_program"),
        ({"own": {**own_digests(), "styles": "0"}}, "dask.other_files"),
        (None, "dask.no_program"),
    ],
)
def test_workers_are_checked(changed: dict[str, object] | None, id: str | None) -> None:
    answer = {} if changed is None else {**machine_facts(), **changed}
    if id is None:
        check_worker("tcp://a:1", answer)
        return
    with pytest.raises(UsageError) as raised:
        check_worker("tcp://a:1", answer)
    assert raised.value.message.id == id
    assert raised.value.message.arguments["worker"] == "tcp://a:1"
    if id == "dask.other_files":
        assert raised.value.message.arguments["kinds"] == "styles"


def test_a_worker_without_the_program_answers(tmp_path: Path) -> None:
    sent = tmp_path / "sent"
    sent.write_bytes(cloudpickle.dumps(probe()))
    code = f"import sys; sys.path.append({str(Path(cloudpickle.__file__).parents[1])!r}); import pickle; " + (
        f"print(pickle.load(open({str(sent)!r}, 'rb'))())"
    )
    # Without site, an editable installation of the program is not found.
    answered = subprocess.run([sys.executable, "-I", "-S", "-c", code], capture_output=True, text=True, check=True)
    assert answered.stdout == "{}\n"


def test_processes_of_pieces_use_memory_as_ours_do(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[dict[str, Any]] = []

    def start(**command: Any) -> Any:
        started.append(command)
        raise ProcessLookupError

    monkeypatch.setattr(subprocess, "Popen", start)
    monkeypatch.setenv("MALLOC_TRIM_THRESHOLD_", "65536")
    with pytest.raises(ProcessLookupError):
        export_piece(["export", "pieces"], "one.mid", str(tmp_path))
    assert "MALLOC_TRIM_THRESHOLD_" not in started[0]["env"]


def test_a_cluster_exports_the_pieces(pieces: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with LocalCluster(
        n_workers=1, threads_per_worker=2, processes=False, protocol="tcp", host="127.0.0.1", dashboard_address=None
    ) as cluster:
        (pieces / "more" / "TWO.MIDI").unlink()
        command = ["export", str(pieces), "--to", str(tmp_path / "out"), *SHORT]
        assert main([*command, "--scheduler", cluster.scheduler_address]) == PARTIAL
    found = results(capsys.readouterr().out)
    assert found["one.mid"] == "exported"
    assert "is not a MIDI file" in found["bad.mid"]
    # The computer on which pieces were exported makes no difference.
    assert main(command) == PARTIAL
    assert results(capsys.readouterr().out)["one.mid"] == "up to date"
