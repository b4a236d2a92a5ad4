"""JACK beside RtMidi: which copy of its library is used, and whether its server still runs.

RtMidi does not tell the latter: it goes on listing a dead server's ports.
"""

from __future__ import annotations

import contextlib
import ctypes
import sys
from typing import Any, Final

_LIBRARY: Final = "libjack.so.0"
_CLIENT: Final = b"Suisou watch"
_NO_START_SERVER: Final = 1
_SHUTDOWN: Final = ctypes.CFUNCTYPE(None, ctypes.c_void_p)


def share_library() -> None:
    """Have libraries that are loaded from now on use the system's JACK library instead of a copy of their own, which
    only talks to servers of its own version. Without one, nothing changes."""
    if sys.platform == "linux":
        with contextlib.suppress(OSError):
            ctypes.CDLL(_LIBRARY, mode=ctypes.RTLD_GLOBAL)


class ServerWatch:
    """A client without ports, that is notified when the server ends.

    Without JACK's library nothing is watched: then no server runs either.

    Attributes
    ----------
    has_library : bool
        Whether JACK's library is there.
    has_ended : bool
        Whether the server that ran at the beginning has gone; stays so when another runs.
    """

    def __init__(self) -> None:
        self.has_ended = False
        self.has_library = True
        self._client: int | None = None
        # Kept: the library calls it as long as the client is open.
        self._reported = _SHUTDOWN(self._report)
        try:
            # Python's lock is free while this library works, unlike within rtmidi.
            self._library: Any = ctypes.CDLL(_LIBRARY)
        except OSError:
            self.has_library = False
            return
        self._library.jack_client_open.restype = ctypes.c_void_p
        self._library.jack_on_shutdown.argtypes = [ctypes.c_void_p, _SHUTDOWN, ctypes.c_void_p]
        self._library.jack_client_close.argtypes = [ctypes.c_void_p]
        status = ctypes.c_int()
        # None where no server runs.
        self._client = self._library.jack_client_open(_CLIENT, _NO_START_SERVER, ctypes.byref(status))
        if self._client:
            self._library.jack_on_shutdown(self._client, self._reported, None)

    @property
    def is_connected(self) -> bool:
        """Return whether a server ran at the beginning."""
        return self._client is not None

    def _report(self, _: int | None) -> None:
        self.has_ended = True

    def close(self) -> None:
        """Watch no more."""
        if self._client:
            self._library.jack_client_close(self._client)
            self._client = None
