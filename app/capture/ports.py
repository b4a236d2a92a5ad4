"""MIDI ports by name, over whichever of the compiled-in systems answers (ALSA or JACK, CoreMIDI, Windows).

Names stay the same when a device goes and comes back: the numbers that a system puts behind them are taken off, and of
two devices of one kind the second gets a number of ours.

Everything here is called from one thread: macOS reports new devices only in it.
"""

from __future__ import annotations

import contextlib
import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Final, TypeAlias

import msgspec

from app.capture.jack import ServerWatch
from app.errors import AppError

MidiCallback: TypeAlias = Callable[[tuple[list[int], float], object], None]
"""Called in the driver's thread with (bytes, delta) and nothing of use."""

CLIENT: Final = "Suisou"
_OWN: Final = re.compile(rf"{CLIENT}(-\d+)?:")
_ALSA_NUMBERS: Final = re.compile(r" \d+:\d+$")


class PortError(AppError):
    """MIDI devices, or one of them, cannot be used."""


class Port(msgspec.Struct, frozen=True):
    """A port as it is now.

    Attributes
    ----------
    name : str
        Its own among the ports that are there.
    identity : str
        Differs for a device that went and came back, where the system lets us know.
    index : int
        Its place in the system's list.
    """

    name: str
    identity: str
    index: int


def named(found: Sequence[str], system: str) -> tuple[Port, ...]:
    """The ports of a system's list, without our own.

    Parameters
    ----------
    found : sequence of str
        As the system calls them.
    system : {"alsa", "jack", "core", "winmm"}
    """
    ports = []
    seen: Counter[str] = Counter()
    for index, full in enumerate(found):
        if _OWN.match(full):
            continue
        plain = _plain(full, index, system)
        seen[plain] += 1
        name = plain if seen[plain] == 1 else f"{plain} ({seen[plain]})"
        # Only these two give every port a name of its own that does not depend on the others.
        ports.append(Port(name, full if system in ("alsa", "jack") else name, index))
    return tuple(ports)


def _plain(full: str, index: int, system: str) -> str:
    if system == "alsa":
        client, _, port = _ALSA_NUMBERS.sub("", full).partition(":")
        return (port if port.startswith(client) else f"{client}:{port}").strip() or full
    if system == "winmm":
        return full.removesuffix(f" {index}").strip() or full
    return full.strip() or "MIDI"


class MidiSystem:
    """The first system that answers.

    Parameters
    ----------
    requested : str
        Name of the only system to try; empty for all that are compiled in.

    Raises
    ------
    PortError
        ``capture.no_library`` (detail), ``capture.api_unknown`` (name, possible), ``capture.no_system``.
    """

    def __init__(self, requested: str = "") -> None:
        try:
            import rtmidi
        except ImportError as error:
            raise PortError("capture.no_library", detail=str(error)) from error
        self._rtmidi: Any = rtmidi
        compiled = {rtmidi.get_api_name(api): api for api in rtmidi.get_compiled_api()}
        if requested and requested not in compiled:
            raise PortError("capture.api_unknown", name=requested, possible=", ".join(sorted(compiled)))
        for name, api in compiled.items():
            if requested in ("", name):
                with contextlib.suppress(rtmidi.RtMidiError):
                    self.name, self._api = name, api
                    self._inputs, self._outputs = rtmidi.MidiIn(api, CLIENT), rtmidi.MidiOut(api, CLIENT)
                    self._watch = ServerWatch() if name == "jack" else None
                    return
        raise PortError("capture.no_system")

    @property
    def has_ended(self) -> bool:
        """Whether it has gone since, with all of its ports: what it lists is of the past."""
        return self._watch is not None and self._watch.has_ended

    def inputs(self) -> tuple[Port, ...]:
        """What can be listened to now."""
        return named(self._inputs.get_ports(), self.name)

    def outputs(self) -> tuple[Port, ...]:
        """What could be sent to now."""
        return named(self._outputs.get_ports(), self.name)

    def open_input(self, port: Port, callback: MidiCallback) -> Any:
        """Listen to a port, to messages of channels only.

        Raises
        ------
        PortError
            ``capture.port_refused`` (port, detail).
        """
        with self._refusal(port):
            midi = self._rtmidi.MidiIn(self._api, CLIENT)
            midi.ignore_types(sysex=True, timing=True, active_sense=True)
            midi.open_port(port.index, "in")
            # Not before: rtmidi keeps Python's lock while it connects, and JACK waits meanwhile for its thread, which
            # waits for that lock with the first event.
            midi.set_callback(callback)
        return midi

    @contextlib.contextmanager
    def _refusal(self, port: Port) -> Iterator[None]:
        try:
            yield
        except (self._rtmidi.RtMidiError, OSError, ValueError, TypeError) as error:
            raise PortError("capture.port_refused", port=port.name, detail=str(error)) from error

    def close(self) -> None:
        """Let go of the system."""
        if self._watch is not None:
            self._watch.close()
        self._inputs.delete()
        self._outputs.delete()


def close_lost(midi: Any) -> None:
    """Let go of an opened port whose device has gone.

    One from which events come cannot be closed: rtmidi keeps Python's lock while it waits for the driver's thread,
    which waits for that lock. Only the end of the process closes it.
    """
    midi.close_port()
    midi.delete()
