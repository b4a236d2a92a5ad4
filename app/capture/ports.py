"""MIDI ports of the first available system (ALSA or JACK, CoreMIDI, Windows).

All calls must be made from one thread, since macOS reports new devices only there.
"""

from __future__ import annotations

import contextlib

from app.capture.jack import ServerWatch
from app.capture.midi_library import MidiCallback, OpenInput, load_library
from app.capture.port_names import Port, named
from app.errors import AppError


class PortError(AppError):
    """A MIDI device, or the MIDI system, cannot be used."""


class MidiSystem:
    """The first MIDI system that responds.

    Parameters
    ----------
    requested : str
        Name of the only system to try; empty for all that the library supports.

    Raises
    ------
    PortError
        No library is installed, the requested system is unknown, or no system responds.
    """

    def __init__(self, requested: str = "") -> None:
        try:
            self._library = load_library()
        except ImportError as error:
            raise PortError("capture.no_library", detail=str(error)) from error
        self._known: dict[str, str] = {}
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
        """True if the system has ended together with its ports, so that its lists are outdated."""
        return self._watch is not None and self._watch.has_ended

    def inputs(self) -> tuple[Port, ...]:
        """Return the MIDI inputs connected at present."""
        ports = named(self._lists.inputs(), self.name, self._known)
        self._known |= {port.identity: port.name for port in ports}
        return ports

    def outputs(self) -> tuple[Port, ...]:
        """Return the MIDI outputs connected at present."""
        return named(self._lists.outputs(), self.name)

    def open_input(self, port: Port, callback: MidiCallback) -> OpenInput:
        """Listen to the channel messages of a port.

        Raises
        ------
        PortError
            The port cannot be opened.
        """
        try:
            return self._library.open_input(self.name, port.index, callback)
        except self._library.errors as error:
            raise PortError("capture.port_refused", port=port.name, detail=str(error)) from error

    def close(self) -> None:
        """Disconnect from the system."""
        if self._watch is not None:
            self._watch.close()
        self._lists.close()
