"""Memory freed between two remaining allocations is returned to the system."""

from __future__ import annotations

import resource
import subprocess
import sys
from pathlib import Path

import pytest

from app.editor.freed_memory import give_back, share_memory

BLOCK_BYTES, BLOCKS = 60_000, 2000


def resident_bytes() -> int:
    return int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()


@pytest.mark.skipif(sys.platform != "linux", reason="other systems take memory back by themselves")
def test_freed_memory_is_returned() -> None:
    blocks = [b"x" * BLOCK_BYTES for _ in range(BLOCKS)]
    # An allocation at the end keeps the memory below it from being returned.
    last = b"x" * BLOCK_BYTES
    del blocks
    give_back()
    before = [b"x" * BLOCK_BYTES for _ in range(BLOCKS)]
    full_bytes = resident_bytes()
    del before
    give_back()
    assert resident_bytes() < full_bytes - 0.8 * BLOCKS * BLOCK_BYTES
    assert last


THREADS = 8
SHARING = f"""
import resource, threading
from pathlib import Path
from app.editor.freed_memory import share_memory

def pools() -> int:
    \"\"\"Places of a thread's own are 64 MB of addresses each.\"\"\"
    return int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize() // 2**26

share_memory()
before, done = pools(), threading.Barrier({THREADS} + 1)

def work() -> None:
    block = bytearray(100_000)
    done.wait()
    done.wait()

threading.stack_size(2**18)
threads = [threading.Thread(target=work) for _ in range({THREADS})]
for thread in threads:
    thread.start()
done.wait()
print(pools() - before)
done.wait()
"""


@pytest.mark.skipif(sys.platform != "linux", reason="other systems share it by themselves")
def test_threads_share_memory() -> None:
    run = subprocess.run([sys.executable, "-c", SHARING], capture_output=True, text=True, check=True)
    assert int(run.stdout) <= 3


def test_it_may_be_asked_for_anywhere(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "win32")
    give_back()
    share_memory()
