"""Synthesiser in a process of its own, since it blocks Python and would freeze the window.

The child process runs this module: it receives MIDI files and sends their sound.
"""

from __future__ import annotations

import contextlib
import os
import weakref
from threading import Lock
from typing import Final

import numpy as np

from app.audio.rendering import rendered
from app.audio.track import Samples
from app.child import MessageChannel, StartedChild, channel_to_parent

_NICENESS: Final = 5
"""Unix niceness of the process, so that the window has priority."""


class RenderProcess:
    """Renders in a child process that is started with the first phrase.

    If no process can be started or it was killed, phrases are rendered in this process, with equal sound.
    """

    def __init__(self) -> None:
        self._lock = Lock()
        self._child: StartedChild[bytes] | None = None
        self._has_child = True

    def __call__(self, midi: bytes) -> Samples:
        """Render a MIDI file to sound: int16, mono. Phrases are rendered one at a time; any thread may call this."""
        with self._lock:
            if self._has_child:
                try:
                    return self._asked(midi)
                except OSError:
                    self._has_child = False
        return rendered(midi)

    def _asked(self, midi: bytes) -> Samples:
        if self._child is None:
            self._child = StartedChild[bytes](bytes, __name__)
            weakref.finalize(self, self._child.ended)
        self._child.send(midi)
        return np.frombuffer(self._child.receive(), np.int16)


def main() -> None:
    """Render all requested MIDI files."""
    channel: MessageChannel[bytes] = channel_to_parent(bytes, "render")
    if hasattr(os, "nice"):
        os.nice(_NICENESS)
    with contextlib.suppress(BrokenPipeError):
        while True:
            channel.send(rendered(channel.receive()).tobytes())


if __name__ == "__main__":
    main()
