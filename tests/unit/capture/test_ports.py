"""Names of ports: the same whatever numbers the system puts behind them, and no two alike."""

from __future__ import annotations

import builtins
from typing import Any

import pytest

from app.capture.ports import MidiSystem, PortError, named


def names(found: list[str], system: str) -> list[str]:
    return [port.name for port in named(found, system)]


def test_alsa_numbers_change_and_names_do_not() -> None:
    before = named(["Midi Through:Midi Through Port-0 14:0", "EWI-USB:EWI-USB MIDI 1 20:0"], "alsa")
    after = named(["Midi Through:Midi Through Port-0 14:0", "EWI-USB:EWI-USB MIDI 1 24:0"], "alsa")
    assert [port.name for port in before] == [port.name for port in after] == ["Midi Through Port-0", "EWI-USB MIDI 1"]
    assert before[0].identity == after[0].identity
    assert before[1].identity != after[1].identity, "it went and came back"
    assert names(["Synth:out 130:1"], "alsa") == ["Synth:out"]


def test_windows_numbers_change_and_names_do_not() -> None:
    assert names(["EWI5000 0", "Digital Piano 1"], "winmm") == ["EWI5000", "Digital Piano"]
    before, after = named(["Piano 0", "EWI5000 1"], "winmm")[1], named(["EWI5000 0"], "winmm")[0]
    assert (before.name, before.identity) == (after.name, after.identity), "the piano was unplugged, not the EWI"


@pytest.mark.parametrize(
    ("system", "found"),
    [
        ("alsa", ["EWI-USB:EWI-USB MIDI 1 20:0", "EWI-USB:EWI-USB MIDI 1 24:0"]),
        ("winmm", ["EWI-USB MIDI 1 0", "EWI-USB MIDI 1 1"]),
        ("core", ["EWI-USB MIDI 1", "EWI-USB MIDI 1"]),
    ],
)
def test_two_of_a_kind_are_distinguished(system: str, found: list[str]) -> None:
    ports = named(found, system)
    assert [port.name for port in ports] == ["EWI-USB MIDI 1", "EWI-USB MIDI 1 (2)"]
    assert [port.index for port in ports] == [0, 1]


def test_our_own_ports_are_no_devices() -> None:
    ports = named(["Suisou:in", "Suisou-01:out", "EWI:EWI USB", "Suisou Ensemble:x"], "jack")
    assert [(port.name, port.index) for port in ports] == [("EWI:EWI USB", 2), ("Suisou Ensemble:x", 3)]


def test_a_nameless_port_has_a_name() -> None:
    assert names(["", ""], "core") == ["MIDI", "MIDI (2)"]


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
    pytest.importorskip("rtmidi")
    with pytest.raises(PortError, match=r"capture\.api_unknown") as caught:
        MidiSystem("telepathy")
    assert caught.value.message.arguments["possible"]
