"""Limits of child processes; every process that the program starts has a row."""

from __future__ import annotations

import ast
import ctypes
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest

from app.child_limits import LIMITS, ChildLimits, JobLimits, WindowsJob, job_limits, limited_command

ROOT = Path(__file__).parents[2]
MB = 2**20
posix = pytest.mark.skipif(os.name != "posix", reason="Windows has jobs")


@pytest.fixture
def tight(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("app.child_limits.LIMITS", {"tight": ChildLimits(400 * MB, 1, cpu_s=1.0, written_bytes=4096)})


def run(code: str, size: int = 0) -> subprocess.CompletedProcess[bytes]:
    command = limited_command("tight", [sys.executable, "-I", "-c", code], size)
    return subprocess.run(command, capture_output=True, check=False, timeout=60)


@posix
@pytest.mark.usefixtures("tight")
def test_memory_ends_at_its_limit_and_grows_with_the_input() -> None:
    code = f"print(len(bytes({500 * MB})))"
    assert b"MemoryError" in run(code).stderr
    assert run(code, 600 * MB).stdout.strip() == b"%d" % (500 * MB)


@posix
@pytest.mark.usefixtures("tight")
def test_processor_time_ends_at_its_limit() -> None:
    assert run("while True: pass").returncode in (-signal.SIGXCPU, -signal.SIGKILL)


@posix
@pytest.mark.usefixtures("tight")
def test_no_large_file_is_written(tmp_path: Path) -> None:
    path = tmp_path / "large"
    assert run(f"open({os.fspath(path)!r}, 'wb').write(bytes(100_000))").returncode != 0
    assert path.stat().st_size <= 4096
    assert len(run("import sys; sys.stdout.write('a' * 100_000)").stdout) == 100_000


@posix
def test_arguments_reach_the_program_unchanged() -> None:
    told = ["a b", "$(id)", "'", '"', ";", "演奏", "-n", "\\"]
    code = "import sys; print(ascii(sys.argv[1:]))"
    ended = subprocess.run(
        limited_command("render", [sys.executable, "-I", "-c", code, *told]), capture_output=True, check=True
    )
    assert ended.stdout.decode().strip() == ascii(told)


def test_one_kilobyte_may_cost_a_gigabyte_and_five_seconds() -> None:
    for name in ("ffmpeg.facts", "ffmpeg.pictures", "ffmpeg.sound", "ufbx.figure", "unpacker"):
        memory, cpu_s = LIMITS[name].memory_of(1024), LIMITS[name].cpu_of(1024)
        assert memory is not None
        assert memory <= 2**30 + MB
        assert cpu_s is not None
        assert cpu_s <= 5


def test_a_hundred_kilobytes_of_fbx_motion_cost_less_than_five_seconds() -> None:
    assert LIMITS["ufbx.motion"].cpu_of(100_000) == 4


def test_the_structures_of_windows_have_their_sizes() -> None:
    if ctypes.sizeof(ctypes.c_void_p) == 8:
        assert ctypes.sizeof(JobLimits) == 144
    limits = job_limits(123 * MB, 7)
    assert limits.ProcessMemoryLimit == 123 * MB
    assert limits.BasicLimitInformation.PerProcessUserTimeLimit == 70_000_000
    assert limits.BasicLimitInformation.LimitFlags == 0x2102
    assert job_limits(None, None).BasicLimitInformation.LimitFlags == 0x2000


def windows(refuses: bool = False) -> tuple[SimpleNamespace, list[str]]:
    """Fake of the part of Windows that a job needs, which records its calls."""
    calls: list[str] = []

    def create(security: None, name: None) -> int:
        return 77

    def called(name: str, result: int) -> Callable[..., int]:
        def call(job: ctypes.c_void_p, *others: object) -> int:
            values = [other.value if isinstance(other, ctypes.c_void_p) else other for other in others]
            calls.append(" ".join(map(str, [name, job.value, *(one for one in values if isinstance(one, int))])))
            return result

        return call

    kernel32 = SimpleNamespace(
        CreateJobObjectW=create,
        SetInformationJobObject=called("limits", int(not refuses)),
        AssignProcessToJobObject=called("process", 1),
        CloseHandle=called("closed", 1),
    )
    return kernel32, calls


def test_a_job_is_closed_when_its_process_is_done_with() -> None:
    kernel32, calls = windows()
    job = WindowsJob(kernel32, MB, 1)
    assert job.take(5)
    del job
    assert calls == [f"limits 77 9 {ctypes.sizeof(JobLimits)}", "process 77 5", "closed 77"]
    with pytest.raises(OSError, match="no job"):
        WindowsJob(windows(refuses=True)[0], MB, 1)


STARTED = {
    "app/audio/render_process.py": "render",
    "app/cli/batch.py": "batch",
    "app/evaluation/process.py": "evaluation",
    "app/export/processes.py": "export",
    "app/capture/link.py": "recorder",
    "app/child.py": "export",
    "app/export/video.py": "ffmpeg.",
    "app/formats/ffmpeg.py": "ffmpeg.",
    "app/formats/reading_child.py": "ufbx.",
    "app/performance/motion_copies.py": "export",
}
"""Modules that start processes, with the rows of their limits."""

STARTING = {"subprocess.Popen", "subprocess.run", "os.fork", "QProcess", "StartedChild", "ForkedChild"}


def test_every_process_that_is_started_has_a_row() -> None:
    starting = set()
    for folder in ("app", "widgets"):
        for path in (ROOT / folder).rglob("*.py"):
            tree = ast.parse(path.read_text(encoding="utf-8"))
            calls = [ast.unparse(node.func).partition("[")[0] for node in ast.walk(tree) if isinstance(node, ast.Call)]
            if STARTING & set(calls):
                starting.add(path.relative_to(ROOT).as_posix())
    assert starting == set(STARTED)
    for row in STARTED.values():
        assert any(name.startswith(row) for name in LIMITS)
