"""Attacks by seeded mutants, run in `child` processes and judged; failures are minimised and kept."""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from tests.fuzz.harness.mutators import mutated
from tests.fuzz.harness.readers import KINDS, digest
from tests.fuzz.harness.seeds import HOSTILE, ROOT, hostile

MOST_CPU_S: Final = 20.0
"""Limit of processor seconds per file: four times the goal, since processor time is longer if other processes share the
caches.
"""
MOST_MB: Final = 1024.0
"""Limit in megabytes of the whole process for a file of at most 100 KB."""
SIZES: Final = (1_000, 10_000, 100_000)
_POOL: Final = 200
_MINIMISE_S: Final = 20.0


@dataclass(frozen=True)
class Result:
    """Result of reading one file.

    Attributes
    ----------
    outcome : str
        ``accepted``, ``refused``; else a failure: ``escaped``, ``broken``, ``unworded``, ``killed``.
    place : str
        Which refusal, or where it failed.
    detail : str
    cpu_s, peak_mb : float
    """

    outcome: str
    place: str
    detail: str
    cpu_s: float
    peak_mb: float

    @property
    def failure(self) -> str:
        """Return a short text about the failure; empty if there is none."""
        if self.outcome not in ("accepted", "refused"):
            return f"{self.outcome}: {self.place}"
        if self.cpu_s > MOST_CPU_S:
            return f"costs more than {MOST_CPU_S:.0f} s"
        if self.peak_mb > MOST_MB:
            return "costs more than 1 GB"
        return ""


class Child:
    """A process that reads files and is replaced when it dies.

    Parameters
    ----------
    kinds : sequence of str
        That it will be asked for.
    module : str
        What it runs.
    """

    def __init__(self, kinds: Sequence[str], module: str = "tests.fuzz.harness.child") -> None:
        self._kinds = list(kinds)
        self._module = module
        self._folder = tempfile.TemporaryDirectory(prefix="suisou-fuzz-")
        self._path = Path(self._folder.name) / "mutant"
        self._log = Path(self._folder.name) / "log"
        self._process: subprocess.Popen[str] | None = None

    def run(self, kind: str, data: bytes) -> Result:
        """Read a file."""
        process = self._process or self._start()
        assert process.stdin is not None
        assert process.stdout is not None
        self._path.write_bytes(data)
        process.stdin.write(json.dumps([kind, str(self._path)]) + "\n")
        process.stdin.flush()
        line = process.stdout.readline()
        if line:
            return Result(**json.loads(line))
        process.wait()
        said = self._log.read_text(errors="replace")[-6000:]
        status = process.returncode
        self._process = None
        process.stdin.close()
        process.stdout.close()
        return Result("killed", f"status {status}{_place(said)}", said, float("inf"), float("nan"))

    def _start(self) -> subprocess.Popen[str]:
        home = Path(self._folder.name) / "home"
        environment = {
            **os.environ,
            **{name: str(home / name) for name in ("XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_STATE_HOME")},
            # Threads of a library would reserve memory of their own.
            "OPENBLAS_NUM_THREADS": "1",
            "QT_QPA_PLATFORM": "offscreen",
            "TMPDIR": self._folder.name,
        }
        with self._log.open("w") as log:
            process = subprocess.Popen(
                [sys.executable, "-m", self._module],
                cwd=ROOT,
                env=environment,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=log,
                text=True,
            )
        assert process.stdout is not None
        process.stdin.write(json.dumps(self._kinds) + "\n")
        process.stdin.flush()
        ready = process.stdout.readline()
        if not ready:
            raise RuntimeError(f"good files end the reader: {self._log.read_text(errors='replace')[-6000:]}")
        self.base_mb = float(json.loads(ready)["base_mb"])
        self._process = process
        return process

    def close(self) -> None:
        """End the process."""
        if self._process is not None:
            assert self._process.stdout is not None
            self._process.stdin.close()
            self._process.wait(30)
            self._process.stdout.close()
            self._process = None
        self._folder.cleanup()

    def start(self) -> Child:
        """Start the process in advance, so that the first file need not wait."""
        if self._process is None:
            self._start()
        return self

    def __enter__(self) -> Child:
        return self.start()

    def __exit__(self, *_: object) -> None:
        self.close()


def _place(said: str) -> str:
    """Innermost place in the program's code in the output of `faulthandler`."""
    ours = [line for line in said.splitlines() if line.startswith('  File "') and "/tests/" not in line]
    for line in ours:
        if str(ROOT) in line and "/.venv" not in line:
            file, _, function = line.strip().removeprefix('File "').partition('", line ')
            return f" in {Path(file).name}:{function.partition(' in ')[2]}"
    return ""


@dataclass
class Tally:
    """Results of the attacks on one kind of file.

    Attributes
    ----------
    tries, accepted, refused : int
    failures : dict of str to (int, bytes, Result)
        By what is wrong: how often, the smallest file, what it did.
    worst : dict of int to dict of str to (float, bytes)
        By the size that files may have and what is measured (``cpu_s``, ``peak_mb``): the most, and the file.
    """

    tries: int = 0
    accepted: int = 0
    refused: int = 0
    failures: dict[str, tuple[int, bytes, Result]] = field(default_factory=dict)
    worst: dict[int, dict[str, tuple[float, bytes]]] = field(default_factory=dict)

    def add(self, data: bytes, result: Result) -> bool:
        """Count a file; return whether it cost more than all previous ones of its size."""
        self.tries += 1
        if failure := result.failure:
            count, smallest, known = self.failures.get(failure, (0, data, result))
            if len(data) < len(smallest):
                smallest, known = data, result
            self.failures[failure] = count + 1, smallest, known
        elif result.outcome == "accepted":
            self.accepted += 1
        else:
            self.refused += 1
        size = next((size for size in SIZES if len(data) <= size), None)
        if size is None:
            return False
        rows = self.worst.setdefault(size, {})
        costly = False
        for name, value in (("cpu_s", result.cpu_s), ("peak_mb", result.peak_mb)):
            known_cost = rows.get(name, (0.0, b""))[0]
            if value > known_cost:
                # A little more may be noise.
                costly |= value > 1.3 * known_cost
                rows[name] = value, data
        return costly


def attack(kinds: Sequence[str], seconds: float, seed: int) -> dict[str, Tally]:
    """Attack kinds for some time, each its share of it; mutants that are read in a new way, or cost more than others,
    have mutants of their own."""
    tallies = {kind: Tally() for kind in kinds}
    with Child(kinds) as child:
        whole = sum(KINDS[kind].share for kind in kinds)
        for kind in kinds:
            _attack(child, kind, seconds * KINDS[kind].share / whole, seed, tallies[kind])
    return tallies


def _attack(child: Child, kind: str, seconds: float, seed: int, tally: Tally) -> None:
    chance = random.Random(f"{kind} {seed}")
    spec = KINDS[kind]
    good = [*spec.seeds(), *(make() for make in hostile(kind).values())]
    pool: list[bytes] = []
    known: set[tuple[str, str]] = set()
    end_s = time.monotonic() + seconds
    ahead = spec.seeds()[::-1]
    while ahead or time.monotonic() < end_s:
        seeds = pool if pool and chance.random() < 0.3 else good
        # Valid inputs come first, unchanged; inputs found earlier, which test_found reads, only as mutants.
        data = ahead.pop() if ahead else mutated(seeds, chance, spec.structured)
        result = child.run(kind, data)
        costly = tally.add(data, result)
        way = result.outcome, result.place
        if (way not in known or costly) and not result.failure:
            known.add(way)
            pool.append(data)
            del pool[:-_POOL]


def minimised(
    kind: str, data: bytes, failure: str, seconds: float = _MINIMISE_S, module: str = "tests.fuzz.harness.child"
) -> bytes:
    """A smaller file that fails in the same way: pieces are left out as long as it does."""
    end_s = time.monotonic() + seconds
    with Child([kind], module) as child:
        piece = max(len(data) // 2, 1)
        while piece >= 1 and time.monotonic() < end_s:
            at, shorter = 0, False
            while at < len(data) and time.monotonic() < end_s:
                tried = data[:at] + data[at + piece :]
                if child.run(kind, tried).failure == failure:
                    data, shorter = tried, True
                else:
                    at += piece
            if not shorter or piece > len(data):
                piece //= 2
    return data


def keep(kind: str, data: bytes, folder: Path = HOSTILE) -> Path:
    """Write a file among those that every test run reads."""
    path = folder / kind / f"{digest(data)}{KINDS[kind].suffix}"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)
    return path


def described(kind: str, tally: Tally) -> dict[str, Any]:
    """A tally as plain values, for a table."""
    return {
        "kind": kind,
        "tries": tally.tries,
        "accepted": tally.accepted,
        "refused": tally.refused,
        "failures": {failure: count for failure, (count, _, _) in tally.failures.items()},
        "worst": {
            str(size): {name: value for name, (value, _) in rows.items()} for size, rows in sorted(tally.worst.items())
        },
    }
