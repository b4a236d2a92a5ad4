"""Cache of rendered phrases for all tests of a process, since the quartet takes seconds of processor time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import pytest

from app.audio.render_process import RenderProcess
from app.audio.rendering import rendered
from app.audio.synth import Synthesiser
from app.audio.track import Samples

_KNOWN: Final = dict[bytes, Samples]()
"""Rendered sound by MIDI content, which determines it in every process (tests/unit/audio/test_render_process)."""


def _known(midi: bytes, render: Callable[[bytes], Samples] = rendered) -> Samples:
    if midi not in _KNOWN:
        _KNOWN[midi] = render(midi)
        _KNOWN[midi].setflags(write=False)
    return _KNOWN[midi]


def know_phrases(monkeypatch: pytest.MonkeyPatch) -> None:
    """Render only phrases that are new, both in mixes and in the editor's rendering process."""
    in_process = RenderProcess.__call__
    monkeypatch.setattr(RenderProcess, "__call__", lambda self, midi: _known(midi, lambda midi: in_process(self, midi)))
    monkeypatch.setattr("app.audio.mix.Synthesiser", lambda: Synthesiser(_known))
