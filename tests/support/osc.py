"""OSC 1.0 reader according to its specification, independent of the library that the program uses for writing, and a
UDP receiver.
"""

from __future__ import annotations

import socket
import struct
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from types import TracebackType
from typing import Self


@dataclass(frozen=True)
class Reported:
    """A message: its address and arguments."""

    address: str
    arguments: tuple[object, ...]


def read_packet(data: bytes) -> list[Reported]:
    """Return all messages of a packet, including those in bundles, in order. Raises ValueError for other data."""
    if len(data) % 4:
        raise ValueError(f"a packet's size is a multiple of 4, not {len(data)}")
    if not data.startswith(b"#bundle\0"):
        return [_message(data)]
    at, found = 16, list[Reported]()
    while at < len(data):
        (size,) = struct.unpack_from(">i", data, at)
        at += 4
        if size <= 0 or size % 4 or at + size > len(data):
            raise ValueError(f"an element of {size} bytes at {at} of {len(data)}")
        found.extend(read_packet(data[at : at + size]))
        at += size
    return found


def _message(data: bytes) -> Reported:
    address, at = _string(data, 0)
    if not address.startswith("/"):
        raise ValueError(f"{address!r} is no address")
    tags, at = _string(data, at)
    if not tags.startswith(","):
        raise ValueError(f"{tags!r} are no type tags")
    arguments = list[object]()
    for tag in tags[1:]:
        if tag == "s":
            text, at = _string(data, at)
            arguments.append(text)
        elif tag in "if":
            arguments.append(struct.unpack_from(">" + tag, data, at)[0])
            at += 4
        else:
            raise ValueError(f"type {tag!r} is not used by VMC")
    if at != len(data):
        raise ValueError(f"{len(data) - at} bytes too many in {address}")
    return Reported(address, tuple(arguments))


def _string(data: bytes, at: int) -> tuple[str, int]:
    end = data.index(b"\0", at)
    after = (end // 4 + 1) * 4
    if data[end:after].strip(b"\0"):
        raise ValueError("a string is filled up with zeros")
    return data[at:end].decode("ascii"), after


@dataclass
class Frame:
    """Content of one frame of a stream."""

    at_s: float
    time_s: float = -1.0
    root: tuple[float, ...] = ()
    bones: dict[str, tuple[float, ...]] = field(default_factory=dict)
    trackers: dict[str, tuple[float, ...]] = field(default_factory=dict)
    face: dict[str, float] = field(default_factory=dict)
    applied: bool = False


def frames(packets: list[tuple[float, bytes]]) -> list[Frame]:
    """Group packets and their arrival times into frames, each of which begins with ``/VMC/Ext/OK``."""
    found = list[Frame]()
    for at_s, packet in packets:
        for message in read_packet(packet):
            if message.address == "/VMC/Ext/OK":
                assert message.arguments == (1,)
                found.append(Frame(at_s))
                continue
            if not found:
                # The remainder of a frame whose beginning was sent before listening began.
                continue
            if message.address == "/VMC/Ext/Blend/Apply":
                assert message.arguments == ()
                found[-1].applied = True
                continue
            name, *rest = message.arguments
            values = tuple(float(value) for value in rest)
            if message.address == "/VMC/Ext/T":
                found[-1].time_s = float(name)
            elif message.address == "/VMC/Ext/Root/Pos":
                assert name == "root"
                found[-1].root = values
            elif message.address == "/VMC/Ext/Bone/Pos":
                found[-1].bones[str(name)] = values
            elif message.address == "/VMC/Ext/Tra/Pos":
                found[-1].trackers[str(name)] = values
            elif message.address == "/VMC/Ext/Blend/Val":
                assert not found[-1].applied
                found[-1].face[str(name)] = values[0]
            else:
                raise ValueError(f"unknown address {message.address}")
    return found


class Receiver:
    """A program that listens on a port of this computer and keeps every packet."""

    def __init__(self, port: int = 0, host: str = "127.0.0.1") -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
        self._socket.bind((host, port))
        self._socket.settimeout(0.05)
        self.port: int = self._socket.getsockname()[1]
        self.packets: list[tuple[float, bytes]] = []
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._listen, daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stop.set()
        self._thread.join()
        self._socket.close()

    def _listen(self) -> None:
        while not self._stop.is_set():
            try:
                data = self._socket.recv(65536)
            except TimeoutError:
                continue
            self.packets.append((time.perf_counter(), data))

    @property
    def frames(self) -> list[Frame]:
        """Return the frames that have arrived completely so far."""
        found = frames(list(self.packets))
        return found if not found or found[-1].applied else found[:-1]

    def wait(self, ready: Callable[[], bool], most_s: float = 5.0) -> bool:
        """Wait until a condition holds or the time is over; return whether it holds."""
        end_s = time.monotonic() + most_s
        while not ready() and time.monotonic() < end_s:
            time.sleep(0.005)
        return ready()
