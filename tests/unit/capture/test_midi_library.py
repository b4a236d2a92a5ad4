"""The two MIDI libraries behind one interface, and a library that ends its process."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

from app.capture.link import RecorderLink
from app.capture.midi_library import PythonRtmidi, Rtmidi2, load_library
from app.capture.ports import MidiSystem, PortError
from app.capture.protocol import NotStarted, Opened, Ports, RequestRefused, Restarted
from tests.support.listening import Ear

ABORTING = '''
"""python-rtmidi as far as the program needs it; opening a port ends the process while a file is there."""
import os, time
class RtMidiError(Exception):
    pass
def get_compiled_api():
    return [1]
def get_api_name(api):
    return "alsa"
class MidiIn:
    def __init__(self, api, client):
        pass
    def get_ports(self):
        return ["EWI-USB:EWI-USB MIDI 1 20:0"]
    def ignore_types(self, **types):
        pass
    def open_port(self, index, name):
        if os.path.exists({marker!r}):
            os.abort()
    def set_callback(self, callback):
        pass
    def delete(self):
        pass
class MidiOut(MidiIn):
    def get_ports(self):
        return []
'''


def without(monkeypatch: pytest.MonkeyPatch, *names: str) -> None:
    for name in names:
        monkeypatch.setitem(sys.modules, name, None)


def fake_rtmidi2() -> Any:
    """Fake module rtmidi2 with two ports, one without a name; the test calls the driver's callback."""
    module: Any = ModuleType("rtmidi2")
    module.API_LINUX_ALSA, module.API_UNIX_JACK, module.API_MACOSX_CORE, module.API_WINDOWS_MM = 2, 3, 1, 4
    module.made = []

    def made(client: str, api: int) -> SimpleNamespace:
        midi = SimpleNamespace(client=client, api=api, ports=["EWI-USB:EWI-USB MIDI 1 20:0", None], done=[])
        midi.ignore_types = lambda **types: midi.done.append(("ignore_types", types))
        midi.open_port = lambda index: midi.done.append(("open_port", index))
        midi.close_port = lambda: midi.done.append(("close_port",))
        module.made.append(midi)
        return midi

    module.MidiIn = module.MidiOut = made
    return module


def test_the_first_library_that_is_installed_is_used(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "win32")
    monkeypatch.setitem(sys.modules, "rtmidi2", fake_rtmidi2())
    rtmidi: Any = ModuleType("rtmidi")
    rtmidi.get_compiled_api, rtmidi.get_api_name, rtmidi.RtMidiError = lambda: [2], lambda api: "alsa", OSError
    monkeypatch.setitem(sys.modules, "rtmidi", rtmidi)
    assert isinstance(load_library(), PythonRtmidi)
    without(monkeypatch, "rtmidi")
    library = load_library()
    assert isinstance(library, Rtmidi2)
    assert library.systems == ("winmm",)


def test_none_that_is_installed_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    without(monkeypatch, "rtmidi", "rtmidi2")
    with pytest.raises(PortError, match=r"capture\.no_library.*rtmidi2"):
        MidiSystem()


def test_what_rtmidi2_is_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    module = fake_rtmidi2()
    monkeypatch.setitem(sys.modules, "rtmidi2", module)
    library = Rtmidi2()
    lists = library.lists("alsa")
    assert lists.inputs() == ["EWI-USB:EWI-USB MIDI 1 20:0", ""]
    lists.close()
    heard: list[tuple[int, bytes]] = []
    before_ns = time.perf_counter_ns()
    opened = library.open_input("alsa", 1, lambda ns, message: heard.append((ns, message)))
    midi = module.made[-1]
    assert (midi.client, midi.api) == ("Suisou", 2)
    ignored = {"midi_sysex": True, "midi_time": True, "midi_sense": True}
    assert midi.done == [("ignore_types", ignored), ("open_port", 1)]
    midi.callback([0x90, 60, 80], 0.0)
    ((ns, message),) = heard
    assert before_ns < ns < time.perf_counter_ns()
    assert message == bytes([0x90, 60, 80])
    opened.close()
    assert midi.done[-1] == ("close_port",)


def test_a_port_whose_opening_ends_the_process_is_refused_and_opened_later(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The library rtmidi2 ends the process if the driver refuses a port, for instance because another
    program uses it.
    """
    in_use = tmp_path / "in use"
    in_use.touch()
    (tmp_path / "rtmidi.py").write_text(ABORTING.format(marker=str(in_use)))
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr("app.capture.link._OPEN_AGAIN_S", 0.3)
    with RecorderLink(system="alsa") as link:
        ear = Ear(link)
        ear.wait(Ports)
        link.open("EWI-USB MIDI 1")
        refused = ear.wait(RequestRefused)
        assert refused.reason.id == "capture.port_taken"
        assert refused.reason.arguments["port"] == "EWI-USB MIDI 1"
        # More often than a recorder may die by itself.
        for _ in range(5):
            place = len(ear.reported)
            ear.wait(Ports, after=place)
        in_use.unlink()
        assert ear.wait(Opened).port == "EWI-USB MIDI 1"
    assert len(ear.of(RequestRefused)) == 1
    assert not ear.of(Restarted, NotStarted)
