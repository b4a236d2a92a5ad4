"""OSC messages in bundles that fit into network packets; only their numbers are replaced for each frame.

The bytes are built once by python-osc. Only floats change from frame to frame, and these are at the end of each
message; building messages anew for each frame would take forty times as long.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from pythonosc.osc_bundle_builder import IMMEDIATELY, OscBundleBuilder
from pythonosc.osc_message import OscMessage
from pythonosc.osc_message_builder import OscMessageBuilder

from app.arrays import AnyFloatArray, IndexArray

MOST_BYTES: Final = 1400
"""Largest size of a bundle in bytes: an Ethernet packet with space for tunnels."""
_BUNDLE_HEAD: Final = 16
"""Bytes of the head of an OSC bundle: its mark and its time."""
_LENGTH: Final = 4
"""Bytes of the length before each message."""
_WORD: Final = 4


@dataclass(frozen=True)
class Head:
    """An OSC message without its floats: the address and the arguments that are equal in every frame.

    Attributes
    ----------
    fixed : tuple of str or int
        First arguments, equal in every frame.
    floats : int
        Number of floats after them.
    """

    address: str
    fixed: tuple[str | int, ...] = ()
    floats: int = 0


class Packets:
    """Prebuilt OSC bundles with all messages of a frame."""

    def __init__(self, heads: Sequence[Head]) -> None:
        self.floats = sum(head.floats for head in heads)
        self._bundles: list[tuple[bytes, IndexArray, slice]] = []
        first, taken, size = 0, list[OscMessage](), _BUNDLE_HEAD
        floats = list[int]()
        for head in heads:
            message = _message(head)
            if taken and size + _LENGTH + message.size > MOST_BYTES:
                self._close(taken, floats, first)
                first, taken, size, floats = first + sum(floats), [], _BUNDLE_HEAD, []
            taken.append(message)
            floats.append(head.floats)
            size += _LENGTH + message.size
        if taken:
            self._close(taken, floats, first)

    def _close(self, messages: Sequence[OscMessage], floats: Sequence[int], first: int) -> None:
        bundle = OscBundleBuilder(IMMEDIATELY)
        words, end = list[int](), _BUNDLE_HEAD
        for message, count in zip(messages, floats, strict=True):
            bundle.add_content(message)
            end += _LENGTH + message.size
            words.extend(range(end // _WORD - count, end // _WORD))
        self._bundles.append((bundle.build().dgram, np.array(words, np.intp), slice(first, first + sum(floats))))

    def filled(self, values: AnyFloatArray) -> list[bytes]:
        """Fill the prebuilt messages with the values of a frame, and return its datagrams.

        Parameters
        ----------
        values : (floats,)
            Floats of all messages in their order.
        """
        result = []
        for datagram, words, span in self._bundles:
            frame = np.frombuffer(datagram, ">f4").copy()
            frame[words] = values[span]
            result.append(frame.tobytes())
        return result


def _message(head: Head) -> OscMessage:
    builder = OscMessageBuilder(head.address)
    for argument in head.fixed:
        builder.add_arg(argument)
    for _ in range(head.floats):
        builder.add_arg(0.0, OscMessageBuilder.ARG_TYPE_FLOAT)
    return builder.build()
