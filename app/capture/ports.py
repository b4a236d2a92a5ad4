"""MIDI ports over whichever of the compiled-in systems answers (ALSA or JACK, CoreMIDI, Windows).

Everything here is called from one thread: macOS reports new devices only in it.
"""

from __future__ import annotations

import contextlib

from app.capture.jack import ServerWatch
from app.capture.midi_library import MidiCallback, OpenInput, load_library
from app.capture.port_names import Port, named
from app.errors import AppError


class PortError(AppError):
    """MIDI devices, or one of them, cannot be used."""


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
        """True if it has gone since, with all of its ports: what it lists is of the past."""
        return self._watch is not None and self._watch.has_ended

    def inputs(self) -> tuple[Port, ...]:
        """Present inputs."""
        ports = named(self._lists.inputs(), self.name, self._known)
        self._known |= {port.identity: port.name for port in ports}
        return ports

    def outputs(self) -> tuple[Port, ...]:
        """Present outputs."""
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
