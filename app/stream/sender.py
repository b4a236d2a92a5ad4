"""Sending of datagrams to a program on this or another computer, without waiting for it."""

from __future__ import annotations

import ipaddress
import os
import socket
from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum
from typing import Final, TypeAlias

from app.errors import AppError

LOOPBACK: Final = "127.0.0.1"
"""Address of this computer."""
LEAST_PORT, MOST_PORT = 1024, 65535
TO_MANY: Final = "stream.to_many"

SocketAddress: TypeAlias = tuple[str, int] | tuple[str, int, int, int]


class StreamError(AppError):
    """Error: data cannot be sent to the address."""


@dataclass(frozen=True)
class Address:
    """IP address and port of a computer whose name was resolved.

    Attributes
    ----------
    host : str
        Name or address as given by the user.
    family : int
        Address family, IPv4 or IPv6.
    """

    host: str
    family: int
    at: SocketAddress

    def port(self, port: int) -> Address:
        """Return the same host address with another port."""
        return Address(self.host, self.family, (self.at[0], port, *self.at[2:]))


class SendOutcome(Enum):
    """Result of sending a frame."""

    SENT = "sent"
    DROPPED = "dropped"
    """The system's buffer was full, and the frame was discarded."""
    NO_RECEIVER = "no_receiver"
    """The frame was sent, but no program listens at the port."""


def is_loopback(host: str) -> bool:
    """Return whether data sent to this host name or address stays on this computer."""
    if host.strip().casefold() == "localhost":
        return True
    try:
        return ipaddress.ip_address(host.strip()).is_loopback
    except ValueError:
        return False


def checked_port(port: int) -> int:
    """Return ``port`` if it is a valid port number. Raises StreamError otherwise."""
    if not LEAST_PORT <= port <= MOST_PORT:
        raise StreamError("stream.port", port=port, least=LEAST_PORT, most=MOST_PORT)
    return port


def find_address(host: str, port: int) -> Address:
    """Return the address of a computer. Resolving its name may take seconds.

    Raises
    ------
    StreamError
        The name is unknown, or the port is invalid.
    """
    requested = host.strip()
    if not requested:
        # The system would interpret an empty name as any computer.
        raise StreamError("stream.host_unknown", host=requested)
    try:
        found = socket.getaddrinfo(requested, checked_port(port), type=socket.SOCK_DGRAM)
    except (socket.gaierror, UnicodeError) as error:
        raise StreamError("stream.host_unknown", host=requested) from error
    # A host with both kinds of address is reached by IPv4, on which receivers listen.
    family, _, _, _, at = sorted(found, key=lambda row: row[0] != socket.AF_INET)[0]
    return Address(requested, family, at)  # type: ignore[arg-type]


def reaches_many(address: Address) -> bool:
    """Return whether an address reaches many computers: multicast, or the broadcast address of a network."""
    found = ipaddress.ip_address(address.at[0])
    if (getattr(found, "ipv4_mapped", None) or found).is_multicast:
        return True
    with socket.socket(address.family, socket.SOCK_DGRAM) as probe:
        try:
            # Only the system can recognise a network's broadcast address: it refuses to connect unless SO_BROADCAST is
            # set. This sends no data.
            probe.connect(address.at)
        except PermissionError:
            return True
        except OSError:
            return False  # there is no route, which the sender reports
    return False


class Sender:
    """Sends datagrams to one port.

    Parameters
    ----------
    broadcast : bool
        Whether addresses of many computers are allowed.

    Raises
    ------
    StreamError
        There is no route to the address, or it reaches many computers although this is not allowed.
    """

    def __init__(self, address: Address, broadcast: bool = False) -> None:
        if not broadcast and reaches_many(address):
            raise StreamError(TO_MANY, host=address.host)
        self.address = address
        self._socket = socket.socket(address.family, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        try:
            self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, int(broadcast))
            # On a connected socket the system reports that no program listens.
            self._socket.connect(address.at)
        except OSError as error:
            self._socket.close()
            raise self._not_sent(error) from error

    def send(self, datagrams: Iterable[bytes]) -> SendOutcome:
        """Send a frame, as far as the system's buffer allows. Raises StreamError if that fails."""
        outcome = SendOutcome.SENT
        for datagram in datagrams:
            try:
                self._socket.send(datagram)
            except BlockingIOError:
                return SendOutcome.DROPPED
            except (ConnectionRefusedError, ConnectionResetError):
                # The error is about an earlier packet; a receiver that starts later gets the next one.
                outcome = SendOutcome.NO_RECEIVER
            except OSError as error:
                raise self._not_sent(error) from error
        return outcome

    def close(self) -> None:
        """Close the socket to the receiving program."""
        self._socket.close()

    def _not_sent(self, error: OSError) -> StreamError:
        reason = os.strerror(error.errno) if error.errno else str(error)
        return StreamError("stream.not_sent", host=self.address.host, port=self.address.at[1], reason=reason)
