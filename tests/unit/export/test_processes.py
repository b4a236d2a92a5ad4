"""An export shared by several processes writes the same files, even if processes are killed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import msgspec
import pytest

from app import child
from app.errors import Cancelled, FileError
from app.export import processes, worker
from app.export.processes import Waiting, process_count
from app.export.request import ExportRequest, cast_of
from app.export.run import export
from app.messages import text
from app.performance.ensemble import Performance
from app.performance.span import bars_span
from app.project.model import Project, map_choices, project_from_score
from app.score.read import read_midi
from instrument_maps.load import bundled_maps
from tests.support.odd_names import odd, on_bytes

ROOT = Path(__file__).parents[3]
QUARTET = ROOT / "resources" / "examples" / "quartet.mid"


def request(folder: Path, project: Project, processes: int | None) -> ExportRequest:
    performance = Performance(project)
    return ExportRequest(
        performance=performance,
        players=project.players[1:],
        folder=folder,
        formats=frozenset(("fbx",)),
        span=bars_span(performance, Fraction(15), (2, 2), 0.0),
        bars=(2, 2),
        source="quartet.mid",
        creator="Suisou",
        processes=processes,
    )


def quartet() -> Project:
    maps = bundled_maps()
    return project_from_score(read_midi(QUARTET, maps=map_choices(maps.values())), maps)


def files(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """Files written by a single process."""
    folder = tmp_path_factory.mktemp("alone")
    export(request(folder, quartet(), 1), text)
    return files(folder)


def ending(code: str) -> Any:
    """Replace the child process by one that runs other code."""
    return lambda module: {"args": [sys.executable, "-c", code]}


@pytest.fixture
def no_copies(monkeypatch: pytest.MonkeyPatch) -> None:
    """Start processes as new programs instead of copies of this one."""
    monkeypatch.setattr(processes, "can_fork", lambda: False)


def export_by_copies(folder: Path) -> None:
    """Export with copies of this process that work, are killed, fail or report errors."""
    assert child.can_fork()
    open_before = len(list(Path("/proc/self/fd").iterdir()))

    def killed(*_: Any) -> None:
        os.kill(os.getpid(), signal.SIGKILL)

    def failing(*_: Any) -> None:
        raise RuntimeError("what is seen on standard error")

    def refusing(*_: Any) -> None:
        raise FileError("file.cannot_write", file="", reason="")

    export(request(folder / "working", quartet(), 3), text)
    for name, change in {"killed": ("serve", killed), "failing": ("serve", failing)}.items():
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(processes, *change)
            export(request(folder / name, quartet(), 2), text)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(worker, "export_player", refusing)
        export(request(folder / "refusing", quartet(), 2), text)
    assert len(list(Path("/proc/self/fd").iterdir())) == open_before


@pytest.mark.skipif(sys.platform != "linux", reason="processes are copied on Linux only")
def test_copies_write_what_one_writes(tmp_path: Path, alone: dict[str, bytes]) -> None:
    code = f"from {__name__} import *; export_by_copies(Path({str(tmp_path)!r}))"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stderr.count("Traceback") == done.stderr.count("RuntimeError: what is seen") == 1
    for name in ("working", "killed", "failing", "refusing"):
        assert files(tmp_path / name) == alone


@pytest.mark.usefixtures("no_copies")
def test_processes_write_what_one_writes(tmp_path: Path, alone: dict[str, bytes]) -> None:
    shares: list[float] = []
    export(request(tmp_path, quartet(), 3), text, progress=lambda share, label: shares.append(share))
    assert files(tmp_path) == alone
    assert shares == sorted(shares)
    assert shares[-1] == pytest.approx(1.0)


@pytest.mark.usefixtures("no_copies")
@pytest.mark.parametrize(
    "code",
    [
        "",
        "import sys; sys.stdin.buffer.read(100)",
        "import sys; sys.stdin.buffer.read(100); sys.stdout.buffer.write(b'\\x05\\0\\0\\0What?'); sys.stdout.flush()",
        "import os, signal, sys; sys.stdin.buffer.read(100); os.kill(os.getpid(), signal.SIGKILL)",
    ],
    ids=["ends at once", "ends while it works", "answers what it should not", "is killed"],
)
def test_what_a_process_does_not_finish_is_done_here(
    code: str, tmp_path: Path, alone: dict[str, bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(child, "own_process", ending(code))
    export(request(tmp_path, quartet(), 2), text)
    assert files(tmp_path) == alone


@pytest.mark.usefixtures("no_copies")
def test_where_no_process_can_be_started_one_does_all(
    tmp_path: Path, alone: dict[str, bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(child, "own_process", lambda module: {"args": [str(tmp_path / "absent")]})
    export(request(tmp_path, quartet(), 2), text)
    assert files(tmp_path) == alone


@pytest.mark.usefixtures("no_copies")
def test_stopping_ends_the_processes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[Any] = []

    class Watched(subprocess.Popen[bytes]):
        def __init__(self, **options: Any) -> None:
            super().__init__(**options)
            started.append(self)

    monkeypatch.setattr(subprocess, "Popen", Watched)
    progress: list[float] = []
    with pytest.raises(Cancelled):
        export(
            request(tmp_path / "new", quartet(), 3),
            text,
            stop_requested=lambda: len(progress) > 3,
            progress=lambda share, label: progress.append(share),
        )
    assert [process.poll() is not None for process in started] == [True, True]
    assert not (tmp_path / "new").exists()


def test_each_process_goes_on_with_what_it_has_begun(tmp_path: Path) -> None:
    cast = cast_of(replace(request(tmp_path, quartet(), 2), players=quartet().players), text)
    waiting = Waiting(cast.musicians)
    here = waiting.take(None)
    there = waiting.take(None)
    assert here.player.instrument_id != there.player.instrument_id
    waiting.give_back(there)
    again = [waiting.take(here), waiting.take(here), waiting.take(here), waiting.take(here)]
    kinds = [None if one is None else one.player.instrument_id for one in again]
    other = there.player.instrument_id
    assert kinds == [here.player.instrument_id, other, other, None]


def test_more_processes_only_for_long_work(tmp_path: Path) -> None:
    short = request(tmp_path, quartet(), None)
    assert process_count(short, cast_of(short, text)) == 1


@on_bytes
def test_a_job_says_paths_that_are_no_text(tmp_path: Path) -> None:
    folder = odd(tmp_path)
    said = replace(request(folder, quartet(), 2), asset=odd(tmp_path, ".fbx"))
    job = msgspec.msgpack.decode(msgspec.msgpack.encode(worker.job_of(said, folder)), type=worker.ExportJob)
    read = worker._request(job)
    assert (read.folder, read.asset) == (folder, said.asset)
