"""Phrases rendered by a process of their own: the synthesiser lets no other Python run, and would stop the window.

The child is this module, run as a program: it reads MIDI files from its input, writes their sound to its output, both
with their lengths before them, and ends when its input does, so that it never outlives the editor.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
import weakref
from threading import Lock
from typing import Final

import numpy as np

from app.audio.rendering import rendered
from app.audio.track import Samples
from app.child_limits import confine_this_process
from app.own_process import own_process, receive, send

_NICENESS: Final = 5
"""The window has priority where the processor is busy."""


class RenderProcess:
    """Renders in a child that is started with the first phrase.

    Where no process can be started, or it was killed, phrases are rendered here: they sound the same, and the window
    is less smooth.
    """

    def __init__(self) -> None:
        self._lock = Lock()
        self._child: subprocess.Popen[bytes] | None = None
        self._has_child = True

    def __call__(self, midi: bytes) -> Samples:
        """A MIDI file as sound: int16, mono. One at a time; may be called from any thread."""
        with self._lock:
            if self._has_child:
                try:
                    return self._asked(midi)
                except OSError:
                    self._has_child = False
        return rendered(midi)

    def _asked(self, midi: bytes) -> Samples:
        if self._child is None:
            self._child = _started()
            weakref.finalize(self, _end, self._child)
        to, back = self._child.stdin, self._child.stdout
        assert to is not None
        assert back is not None
        send(to, midi)
        return np.frombuffer(receive(back), np.int16)


def _started() -> subprocess.Popen[bytes]:
    return subprocess.Popen(stdin=subprocess.PIPE, stdout=subprocess.PIPE, **own_process(__name__))


def _end(child: subprocess.Popen[bytes]) -> None:
    assert child.stdin is not None
    assert child.stdout is not None
    # It may have been killed with something unsaid; the stream is closed all the same.
    with contextlib.suppress(OSError):
        child.stdin.close()
    # Who still reads from it, in a thread, is reported first that nothing comes.
    child.wait()
    child.stdout.close()


def main() -> None:
    """Render whatever is asked for."""
    confine_this_process("render")
    if hasattr(os, "nice"):
        os.nice(_NICENESS)
    while True:
        try:
            midi = receive(sys.stdin.buffer)
            send(sys.stdout.buffer, rendered(midi).tobytes())
        except BrokenPipeError:
            return


if __name__ == "__main__":
    main()
