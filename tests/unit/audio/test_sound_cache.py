"""Rendered sound stored in files."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from app.audio import sound_cache
from app.audio.sound_cache import Shelved


def noise(midi: bytes) -> np.ndarray[Any, np.dtype[np.int16]]:
    return np.random.default_rng(list(midi)).integers(-30000, 30000, 40 + 3 * midi[0]).astype(np.int16)


def test_sound_comes_back_as_it_was_rendered(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sound_cache, "_FILE_BYTES", 1000)
    shelved = Shelved(noise)
    midis = [bytes([number]) for number in range(200)]
    kept = [shelved(midi) for midi in midis]
    assert all(np.array_equal(one, noise(midi)) for one, midi in zip(kept, midis, strict=True))
    assert all(one.dtype == np.int16 for one in kept)


def test_no_memory_of_the_process_holds_it() -> None:
    shelved = Shelved(noise)
    kept = shelved(b"\x05")
    assert not kept.flags.owndata
    assert not kept.flags.writeable


def test_where_no_file_can_be_made_memory_keeps_it(monkeypatch: pytest.MonkeyPatch) -> None:
    def full() -> Any:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("tempfile.TemporaryFile", full)
    assert np.array_equal(Shelved(noise)(b"\x07"), noise(b"\x07"))
