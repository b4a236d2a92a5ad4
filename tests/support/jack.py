"""JACK's dummy server, which provides MIDI ports without hardware; each test module has its own server."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import cycle
from pathlib import Path
from typing import Final

import pytest

from app.capture.midi_library import load_library

RATE_HZ: Final = 48000
PATIENT_FRAMES: Final = 4096
"""Frames per period, so many that every client is scheduled in time on a busy machine; otherwise messages would be lost
before the program receives them.
"""
QUICK_FRAMES: Final = 64
"""Frames per period for measuring latency, and for messages that must not be lost: the server then waits for its
clients, so that killing one would stop it.
"""
_VARIABLE: Final = "JACK_DEFAULT_SERVER"


def require_jack() -> None:
    """Skip the test if JACK or a MIDI library is not installed; fail instead for JACK if all checks are mandatory
    (CI=true).
    """
    try:
        load_library()
    except ImportError as error:
        pytest.skip(f"no MIDI library: {error}")
    if shutil.which("jackd") is None:
        if os.environ.get("CI", "").lower() == "true":
            pytest.fail("jackd is not installed: MIDI transport cannot be tested (apt-get install jackd2)")
        pytest.skip("jackd is not installed (Debian: apt-get install jackd2)")


@contextmanager
def jack_server(
    name: str, period_frames: int = PATIENT_FRAMES, *, is_in_step: bool = False, is_realtime: bool = False
) -> Iterator[Server]:
    """Run a dummy server for this process and its children within a ``with`` block."""
    require_jack()
    before = os.environ.get(_VARIABLE)
    server = Server(name, period_frames, is_in_step=is_in_step, is_realtime=is_realtime)
    try:
        os.environ[_VARIABLE] = server.start()
        yield server
    finally:
        server.stop()
        if before is None:
            os.environ.pop(_VARIABLE, None)
        else:
            os.environ[_VARIABLE] = before


class Server:
    """A server that can be started and stopped; in real time if the system permits it."""

    def __init__(self, name: str, period_frames: int, *, is_in_step: bool, is_realtime: bool = False) -> None:
        self.name, self.period_frames, self.is_in_step = name, period_frames, is_in_step
        self.is_realtime = is_realtime
        self._names = [f"{name}-{number}" for number in range(3)]
        self._process: subprocess.Popen[bytes] | None = None

    def start(self) -> str:
        """Start the server, wait until it answers, and return its name, if possible the previous one. JACK supports at
        most eight names and keeps a killed server's until the name is used again.

        JACK knows eight names at most, a killed server's until one of the same name comes: few names, taken again.
        """
        end_s = time.monotonic() + 60.0
        for name in cycle(self._names):
            self._process = self._started(name)
            while self._process.poll() is None and time.monotonic() < end_s:
                # Another's may answer by this name, and ours end.
                if _answers(name) and self._process.poll() is None:
                    self._names.sort(key=lambda other: other != name)
                    return name
                time.sleep(0.1)
            if time.monotonic() > end_s:
                break
            time.sleep(0.5)
        pytest.fail(f"JACK's dummy server does not start (status {self._process and self._process.poll()})")

    def _started(self, name: str) -> subprocess.Popen[bytes]:
        how = ["--realtime" if self.is_realtime else "--no-realtime", *(["--sync"] if self.is_in_step else [])]
        return subprocess.Popen(
            ["jackd", "-n", name, *how, "-d", "dummy", "-p", str(self.period_frames), "-r", str(RATE_HZ)],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    def stop(self, by: signal.Signals = signal.SIGTERM) -> None:
        """Stop the server."""
        if self._process is not None:
            self._process.send_signal(by)
            try:
                self._process.wait(1.0)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
            self._process = None


def _answers(name: str) -> bool:
    # jack_lsp is another package; a client in this process would print.
    program = "import sys; from app.capture.jack import ServerWatch; sys.exit(not ServerWatch().is_connected)"
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=Path(__file__).parents[2],
        env={**os.environ, _VARIABLE: name},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        check=False,
    )
    return done.returncode == 0
