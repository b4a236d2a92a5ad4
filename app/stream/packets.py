"""Messages of OSC in bundles that fit a network's packets, their numbers filled in again for every frame.

The bytes are built by python-osc, once; what changes from frame to frame are floats, whose places are known since a
message ends with them. Building them again for each frame would take forty times as long.
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
"""Largest bundle: an Ethernet packet, with room for tunnels."""
_BUNDLE_HEAD: Final = 16
"""Bytes of an OSC bundle's head: its mark and its time."""
_LENGTH: Final = 4
"""Before each message."""
_WORD: Final = 4


@dataclass(frozen=True)
class Head:
    """A message without its floats.

    Attributes
    ----------
    fixed : tuple of str or int
        Its first arguments, the same in every frame.
    floats : int
        How many follow.
    """

    address: str
    fixed: tuple[str | int, ...] = ()
    floats: int = 0


class Packets:
    """A frame's messages as bundles, in their order."""

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
        """The datagrams of a frame.

        Parameters
        ----------
        values : (floats,)
            Of all messages, in their order.
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
