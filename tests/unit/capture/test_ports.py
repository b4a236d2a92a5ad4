"""Recording without a MIDI system."""

from __future__ import annotations

import builtins
from typing import Any

import pytest

from app.capture.midi_library import load_library
from app.capture.ports import MidiSystem, PortError


def test_a_library_that_cannot_be_loaded_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    load = builtins.__import__

    def refuse(name: str, *arguments: Any, **keywords: Any) -> Any:
        if name == "rtmidi":
            raise ImportError("libasound.so.2: cannot open shared object file")
        return load(name, *arguments, **keywords)

    monkeypatch.setattr(builtins, "__import__", refuse)
    with pytest.raises(PortError, match=r"capture\.no_library.*libasound"):
        MidiSystem()


def test_a_system_that_is_not_there_is_reported() -> None:
    try:
        load_library()
    except ImportError as error:
        pytest.skip(str(error))
    with pytest.raises(PortError, match=r"capture\.api_unknown") as caught:
        MidiSystem("telepathy")
    assert caught.value.message.arguments["possible"]
