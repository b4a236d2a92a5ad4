"""Common interface of two libraries for MIDI devices: python-rtmidi and, on systems without a wheel of it, rtmidi2.

Both wrap RtMidi and hold Python's lock while connecting and closing. If RtMidi refuses to open a port, python-rtmidi
raises, but rtmidi2 ends the process by an uncaught C++ exception. So the recorder announces the opening of a port, and
its parent process can report the refusal.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any, Final, Protocol, TypeAlias

from app.capture.jack import share_library
from app.capture.port_names import CLIENT

MidiCallback: TypeAlias = Callable[[int, bytes], None]
"""Called in the driver's thread with a moment of `time.perf_counter_ns` and the bytes of a message. It must not raise,
since rtmidi2 ignores exceptions.
"""

_RTMIDI2_SYSTEMS: Final = {"linux": ("alsa", "jack"), "darwin": ("core",), "win32": ("winmm",)}
"""MIDI systems in the wheels of rtmidi2 by platform, since the module does not report them."""


class PortLists(Protocol):
    """Lists of the ports of a MIDI system, by the names that the system gives them."""

    def inputs(self) -> list[str]:
        """Return the names of the system's MIDI input ports."""
        ...

    def outputs(self) -> list[str]:
        """Return the names of the system's MIDI output ports."""
        ...

    def close(self) -> None:
        """Disconnect from the system."""
        ...


class OpenInput(Protocol):
    """An open MIDI input port, which calls its callback until it is closed."""

    def close(self) -> None:
        """Close the port. This blocks forever while messages arrive, since the driver's thread waits for Python's
        lock.
        """
        ...


class MidiLibrary(Protocol):
    """A library for MIDI devices.

    Attributes
    ----------
    systems : tuple of str
        MIDI systems that it supports, in order of preference: ``alsa``, ``jack``, ``core``, ``winmm``.
    errors : tuple of exception types
        Exceptions raised if a system or port refuses.
    """

    systems: tuple[str, ...]
    errors: tuple[type[Exception], ...]

    def lists(self, system: str) -> PortLists:
        """Connect to a MIDI system to list its ports. Raises one of `errors`."""
        ...

    def open_input(self, system: str, index: int, callback: MidiCallback) -> OpenInput:
        """Open the port at an index of `PortLists.inputs`, ignoring system exclusive and real-time messages.

        Messages that arrive before the callback is set are dropped. Raises one of `errors`, or ends the process.
        """
        ...


def load_library() -> MidiLibrary:
    """Return the installed library.

    Raises
    ------
    ImportError
        Neither library is installed, or a system library is missing.
    """
    try:
        return PythonRtmidi()
    except ModuleNotFoundError:
        return Rtmidi2()


class PythonRtmidi:
    """MIDI input and output by the package python-rtmidi."""

    def __init__(self) -> None:
        import rtmidi

        self._rtmidi: Any = rtmidi
        self._numbers = {rtmidi.get_api_name(number): number for number in rtmidi.get_compiled_api()}
        self.systems: tuple[str, ...] = tuple(self._numbers)
        self.errors: tuple[type[Exception], ...] = (rtmidi.RtMidiError, OSError, ValueError, TypeError)

    def lists(self, system: str) -> PortLists:
        """Connect to a MIDI system (such as ALSA) to list its inputs and outputs."""
        number = self._numbers[system]
        return _PythonRtmidiLists(self._rtmidi.MidiIn(number, CLIENT), self._rtmidi.MidiOut(number, CLIENT))

    def open_input(self, system: str, index: int, callback: MidiCallback) -> OpenInput:
        """Open the MIDI input ``index`` of a system; ``callback`` receives nanoseconds and the bytes of each message,
        in a thread of the library."""

        def receive(event: tuple[list[int], float], _: object) -> None:
            ns = time.perf_counter_ns()
            callback(ns, bytes(event[0]))

        midi = self._rtmidi.MidiIn(self._numbers[system], CLIENT)
        midi.ignore_types(sysex=True, timing=True, active_sense=True)
        midi.open_port(index, "in")
        # Not before connecting: that call holds Python's lock while JACK waits for its thread, which waits for the lock
        # to deliver the first event.
        midi.set_callback(receive)
        return _PythonRtmidiInput(midi)


class _PythonRtmidiLists:
    def __init__(self, inputs: Any, outputs: Any) -> None:
        self._inputs, self._outputs = inputs, outputs

    def inputs(self) -> list[str]:
        return list(self._inputs.get_ports())

    def outputs(self) -> list[str]:
        return list(self._outputs.get_ports())

    def close(self) -> None:
        self._inputs.delete()
        self._outputs.delete()


class _PythonRtmidiInput:
    def __init__(self, midi: Any) -> None:
        self._midi = midi

    def close(self) -> None:
        self._midi.close_port()
        self._midi.delete()


class Rtmidi2:
    """MIDI input and output by the package rtmidi2."""

    def __init__(self) -> None:
        # The JACK library bundled in the wheel uses an older protocol than current servers.
        share_library()
        import rtmidi2

        self._rtmidi2: Any = rtmidi2
        self._numbers = {
            "alsa": rtmidi2.API_LINUX_ALSA,
            "jack": rtmidi2.API_UNIX_JACK,
            "core": rtmidi2.API_MACOSX_CORE,
            "winmm": rtmidi2.API_WINDOWS_MM,
        }
        self.systems: tuple[str, ...] = _RTMIDI2_SYSTEMS.get(sys.platform, ())
        # Errors of RtMidi are raised as RuntimeError.
        self.errors: tuple[type[Exception], ...] = (RuntimeError, OSError, ValueError, TypeError)

    def lists(self, system: str) -> PortLists:
        """Connect to a MIDI system (such as ALSA) to list its inputs and outputs."""
        number = self._numbers[system]
        return _Rtmidi2Lists(
            self._rtmidi2.MidiIn(CLIENT, api=number),
            self._rtmidi2.MidiOut(CLIENT, api=number),
        )

    def open_input(self, system: str, index: int, callback: MidiCallback) -> OpenInput:
        """Open the MIDI input ``index`` of a system; ``callback`` receives nanoseconds and the bytes of each message,
        in a thread of the library."""

        def receive(message: list[int], _: float) -> None:
            ns = time.perf_counter_ns()
            callback(ns, bytes(message))

        midi = self._rtmidi2.MidiIn(CLIENT, api=self._numbers[system])
        midi.ignore_types(midi_sysex=True, midi_time=True, midi_sense=True)
        midi.open_port(index)
        # Not before connecting, as with python-rtmidi.
        midi.callback = receive
        return _Rtmidi2Input(midi)


class _Rtmidi2Lists:
    def __init__(self, inputs: Any, outputs: Any) -> None:
        self._inputs, self._outputs = inputs, outputs

    def inputs(self) -> list[str]:
        # The library returns None for a port without a name.
        return [name or "" for name in self._inputs.ports]

    def outputs(self) -> list[str]:
        return [name or "" for name in self._outputs.ports]

    def close(self) -> None:
        # Deleting the objects closes their connections.
        self._inputs = self._outputs = None


class _Rtmidi2Input:
    def __init__(self, midi: Any) -> None:
        self._midi = midi

    def close(self) -> None:
        self._midi.close_port()
        self._midi = None
