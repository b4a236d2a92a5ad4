"""What was freed between two things that stay is returned to the system."""

from __future__ import annotations

import resource
import sys
from pathlib import Path

import pytest

from app.editor.memory import give_back

BLOCK_BYTES, BLOCKS = 60_000, 2000


def resident_bytes() -> int:
    return int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()


@pytest.mark.skipif(sys.platform != "linux", reason="other systems take memory back by themselves")
def test_freed_memory_is_returned() -> None:
    blocks = [b"x" * BLOCK_BYTES for _ in range(BLOCKS)]
    # What stays at the end keeps all below it from being returned.
    last = b"x" * BLOCK_BYTES
    del blocks
    give_back()
    before = [b"x" * BLOCK_BYTES for _ in range(BLOCKS)]
    full_bytes = resident_bytes()
    del before
    give_back()
    assert resident_bytes() < full_bytes - 0.8 * BLOCKS * BLOCK_BYTES
    assert last


def test_it_may_be_asked_for_anywhere(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "win32")
    give_back()
