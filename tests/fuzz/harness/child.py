"""The process in which readers are attacked: it may crash, hang or run out of memory, and every file is measured.

``python -m tests.fuzz.harness.child``: a line of JSON for each file comes in and one goes out. Beside what the reader
did the answer says what it cost: CPU of this process and of its children, and the most memory it had (Linux).
"""

from __future__ import annotations

import faulthandler
import gc
import json
import os
import resource
import shutil
import signal
import sys
import tempfile
import time
import traceback
from pathlib import Path
from typing import IO, Any

from app.errors import AppError
from app.messages import text
from tests.fuzz.harness.readers import KINDS, Broken, Refused

HANG_CPU_S = 21
"""Processor seconds per file after which the process ends and reports its place; slightly more than
`campaign.MOST_CPU_S`, so that the limit there can be judged.
"""
HANG_S = 240.0
"""Seconds after which the process ends regardless of its processor time; much longer, since machines may be busy."""
MOST_DATA_BYTES = 2 * 2**30
"""Bytes that may be allocated in addition to those at the start; larger requests raise MemoryError."""


def main() -> None:
    answers = os.fdopen(os.dup(1), "w")
    # Output printed by a library is not an answer.
    os.dup2(2, 1)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    faulthandler.enable()
    faulthandler.register(signal.SIGXCPU, all_threads=True, chain=True)
    names: list[str] = json.loads(sys.stdin.readline())
    for name in names:
        # Modules loaded and objects created once are not attributed to any file.
        kind = KINDS[name]
        for data in kind.seeds()[:2]:
            _run(name, data)
    # Existing objects are exempt from garbage collection, which would take longer than the readers.
    gc.collect()
    gc.freeze()
    data_bytes = status_kb("VmData") * 1024
    if data_bytes:
        resource.setrlimit(resource.RLIMIT_DATA, (data_bytes + MOST_DATA_BYTES, resource.RLIM_INFINITY))
    print(json.dumps({"base_mb": status_kb("VmRSS") / 1024}), file=answers, flush=True)
    _serve(sys.stdin, answers)


def _serve(requests: IO[str], answers: IO[str]) -> None:
    for line in requests:
        name, path = json.loads(line)
        used = resource.getrusage(resource.RUSAGE_SELF)
        limit = int(used.ru_utime + used.ru_stime) + HANG_CPU_S + 1
        resource.setrlimit(resource.RLIMIT_CPU, (limit, resource.RLIM_INFINITY))
        faulthandler.dump_traceback_later(HANG_S, exit=True)
        print(json.dumps(_run(name, Path(path).read_bytes())), file=answers, flush=True)
        faulthandler.cancel_dump_traceback_later()


def _run(name: str, data: bytes) -> dict[str, Any]:
    kind = KINDS[name]
    folder = Path(tempfile.mkdtemp(prefix="suisou-fuzz-"))
    try:
        path = folder / f"file{kind.suffix}"
        path.write_bytes(data)
        work = folder / "work"
        work.mkdir()
        gc.collect()
        forget_peak()
        children_kb = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
        begin_s = _cpu_s()
        answer = _outcome(name, path, work)
        answer["cpu_s"] = _cpu_s() - begin_s
        peak_kb = status_kb("VmHWM")
        now_kb = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
        answer["peak_mb"] = max(peak_kb, now_kb if now_kb > children_kb else 0) / 1024
        return answer
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _outcome(name: str, path: Path, work: Path) -> dict[str, Any]:
    try:
        KINDS[name].read(path, work)
    except AppError as error:
        try:
            return {"outcome": "refused", "place": error.message.id, "detail": text(error.message)[:500]}
        except Exception as fault:  # noqa: BLE001 - a refusal that cannot be worded is a fault
            return _escaped("unworded", fault)
    except Refused as error:
        return {"outcome": "refused", "place": "problem", "detail": str(error)[:500]}
    except Broken as error:
        return {"outcome": "broken", "place": str(error).split(" (")[0][:80], "detail": traceback.format_exc()[-6000:]}
    except BaseException as error:  # noqa: BLE001 - whatever escapes is what is looked for
        return _escaped("escaped", error)
    return {"outcome": "accepted", "place": "", "detail": ""}


def _escaped(outcome: str, error: BaseException) -> dict[str, Any]:
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if "/tests/" not in frame.filename]
    where = f"{Path(frames[-1].filename).name}:{frames[-1].name}" if frames else "-"
    detail = "".join(traceback.format_exception(error))
    return {"outcome": outcome, "place": f"{type(error).__name__} in {where}", "detail": detail[:1500] + detail[-4500:]}


def _cpu_s() -> float:
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


def forget_peak() -> None:
    """Reset the measured peak of memory (Linux)."""
    try:
        Path("/proc/self/clear_refs").write_text("5")
    except OSError:
        return


def status_kb(field: str) -> int:
    """Return a field of Linux's report on this process's memory, kB; 0 on other systems."""
    try:
        lines = Path("/proc/self/status").read_text().splitlines()
    except OSError:
        return 0
    return next((int(line.split()[1]) for line in lines if line.startswith(f"{field}:")), 0)


if __name__ == "__main__":
    main()
