"""Cache of rendered sound in temporary files instead of in memory."""

from __future__ import annotations

import mmap
import tempfile
import weakref
from collections.abc import Callable
from dataclasses import dataclass
from threading import Lock
from typing import IO, Final

import numpy as np

from app.audio.track import Samples

_FILE_BYTES: Final = 16 * 1024 * 1024
"""Size of a cache file in bytes. A file is deleted when nothing in it is needed, so small files take less disk
space.
"""


@dataclass(eq=False)
class _File:
    """A memory-mapped temporary file without a name, which exists as long as any sound in it is used."""

    file: IO[bytes]
    memory: mmap.mmap
    used: int = 0

    @classmethod
    def of(cls, size: int) -> _File:
        file = tempfile.TemporaryFile()  # noqa: SIM115 - it stays open while there is room in it
        file.truncate(size)
        made = cls(file, mmap.mmap(file.fileno(), size, access=mmap.ACCESS_READ))
        weakref.finalize(made, file.close)
        return made

    def added(self, samples: Samples) -> Samples:
        # Writing through a memory map would end the program when the disk is full; writing to the file raises an error.
        self.file.seek(self.used)
        self.file.write(samples.tobytes())
        self.file.flush()
        found = np.frombuffer(self.memory, samples.dtype, samples.size, self.used).reshape(samples.shape)
        self.used += samples.nbytes
        return found


class Shelved:
    """Renderer that caches its results in files, or in memory if the disk is full.

    Parameters
    ----------
    render : callable
        Renderer; it and this object may be called from any thread.
    """

    def __init__(self, render: Callable[[bytes], Samples]) -> None:
        self._render = render
        self._lock = Lock()
        self._file: _File | None = None

    def __call__(self, midi: bytes) -> Samples:
        """Return the sound of a MIDI file as samples, rendered only the first time."""
        samples = self._render(midi)
        with self._lock:
            try:
                if self._file is None or self._file.used + samples.nbytes > len(self._file.memory):
                    self._file = _File.of(max(_FILE_BYTES, samples.nbytes))
                return self._file.added(samples)
            except OSError:
                self._file = None
                return samples
