"""``suisou ports``: lists the connected MIDI devices."""

from __future__ import annotations

import argparse
import threading
import time
from collections.abc import Iterator
from types import TracebackType
from typing import Final, Self

from app.capture.link import RecorderLink
from app.capture.protocol import News, Ports, RequestRefused
from app.cli.speech import said, spoken
from app.cli.terminal import say, say_json
from app.cli.widths import on_left, width
from app.errors import AppError, Message
from metadata.load import recognised_controller

_ANSWER_WITHIN_S: Final = 15.0


class NoDevice(AppError):
    """The requested device does not exist, or there are no devices."""


class PortMonitor:
    """A connection to the MIDI recorder's process, which passes on what it reports about the devices."""

    def __init__(self) -> None:
        self._news = threading.Event()
        self.link = RecorderLink(self._news.set)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.link.close()

    def until(self, end_s: float) -> Iterator[News]:
        """Yield the recorder's reports as they arrive, until a moment of `time.monotonic`."""
        while True:
            self._news.clear()
            yield from self.link.poll()
            # Waits in short intervals: on Windows Ctrl-C does not interrupt a wait.
            left_s = end_s - time.monotonic()
            if left_s <= 0.0:
                return
            self._news.wait(min(left_s, 0.1))

    def ports(self) -> Ports:
        """Return the connected devices.

        Raises
        ------
        AppError
            No MIDI system responds.
        """
        reason = Message("capture.no_system")
        for reported in self.until(time.monotonic() + _ANSWER_WITHIN_S):
            if isinstance(reported, Ports) and reported.system:
                return reported
            if isinstance(reported, RequestRefused):
                raise NoDevice(reported.reason.id, **reported.reason.arguments)
        raise NoDevice(reason.id)


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``suisou ports``."""
    command.add_argument("--json", action="store_true")
    command.set_defaults(run=list_ports)


def list_ports(arguments: argparse.Namespace) -> None:
    """Print the devices. Raises AppError if no MIDI system responds."""
    with PortMonitor() as listening:
        ports = listening.ports()
    taken_for = {name: recognised_controller(name) for name in ports.inputs}
    if arguments.json:
        inputs = [{"name": name, "controller": controller.name} for name, controller in taken_for.items()]
        say_json({"system": ports.system, "inputs": inputs, "outputs": ports.outputs})
        return
    if not ports.inputs:
        say(said("capture.no_ports"))
    else:
        wide = max(map(width, ports.inputs))
        say(said("ports.inputs"))
        for name, controller in taken_for.items():
            say(f"  {on_left(name, wide)}  {spoken().name(controller.title)}")
    if ports.outputs:
        say(said("ports.outputs"))
        for name in ports.outputs:
            say(f"  {name}")
