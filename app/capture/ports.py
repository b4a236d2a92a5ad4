"""MIDI ports by name, over whichever of the compiled-in systems answers (ALSA or JACK, CoreMIDI, Windows).

Names stay the same when a device goes and comes back: the numbers that a system puts behind them are taken off, and of
two devices of one kind the second gets a number of ours.

Everything here is called from one thread: macOS reports new devices only in it.
"""

from __future__ import annotations

import contextlib
import re
from collections import Counter
from collections.abc import Sequence
from typing import Final

import msgspec

from app.capture.jack import ServerWatch
from app.capture.midi_library import CLIENT, MidiCallback, OpenInput, load_library
from app.errors import AppError

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
        Name of the only system to try; empty for all that the library is built for.

    Raises
    ------
    PortError
        ``capture.no_library`` (detail), ``capture.api_unknown`` (name, possible), ``capture.no_system``.
    """

    def __init__(self, requested: str = "") -> None:
        try:
            self._library = load_library()
        except ImportError as error:
            raise PortError("capture.no_library", detail=str(error)) from error
        systems = self._library.systems
        if requested and requested not in systems:
            raise PortError("capture.api_unknown", name=requested, possible=", ".join(sorted(systems)))
        for name in systems:
            if requested in ("", name):
                self._watch = ServerWatch() if name == "jack" else None
                if self._watch is not None and self._watch.has_library and not self._watch.is_connected:
                    continue
                with contextlib.suppress(*self._library.errors):
                    self.name = name
                    self._lists = self._library.lists(name)
                    return
        raise PortError("capture.no_system")

    @property
    def has_ended(self) -> bool:
        """Whether it has gone since, with all of its ports: what it lists is of the past."""
        return self._watch is not None and self._watch.has_ended

    def inputs(self) -> tuple[Port, ...]:
        """What can be listened to now."""
        return named(self._lists.inputs(), self.name)

    def outputs(self) -> tuple[Port, ...]:
        """What could be sent to now."""
        return named(self._lists.outputs(), self.name)

    def open_input(self, port: Port, callback: MidiCallback) -> OpenInput:
        """Listen to a port, to messages of channels only.

        Raises
        ------
        PortError
            ``capture.port_refused`` (port, detail).
        """
        try:
            return self._library.open_input(self.name, port.index, callback)
        except self._library.errors as error:
            raise PortError("capture.port_refused", port=port.name, detail=str(error)) from error

    def close(self) -> None:
        """Let go of the system."""
        if self._watch is not None:
            self._watch.close()
        self._lists.close()
