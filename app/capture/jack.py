"""The JACK library used by RtMidi: which copy is loaded, and whether its server still runs.

RtMidi does not report a dead server; it keeps listing its ports.
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
    """Make MIDI libraries that are loaded later use the system's JACK library instead of their own copy, which works
    only with servers of its own version. Does nothing if the system has no JACK library.
    """
    if sys.platform == "linux":
        with contextlib.suppress(OSError):
            ctypes.CDLL(_LIBRARY, mode=ctypes.RTLD_GLOBAL)


class ServerWatch:
    """A JACK client without ports that is notified when the server ends.

    Inactive if JACK's library is missing, since then there is no server.

    Attributes
    ----------
    has_library : bool
        Whether JACK's library is installed.
    has_ended : bool
        Whether the server that ran at creation has ended; remains true if another one starts.
    """

    def __init__(self) -> None:
        self.has_ended = False
        self.has_library = True
        self._client: int | None = None
        # Keep a reference: the library calls it while the client is open.
        self._reported = _SHUTDOWN(self._report)
        try:
            # CDLL releases Python's lock during calls of this library, unlike rtmidi.
            self._library: Any = ctypes.CDLL(_LIBRARY)
        except OSError:
            self.has_library = False
            return
        self._library.jack_client_open.restype = ctypes.c_void_p
        self._library.jack_on_shutdown.argtypes = [ctypes.c_void_p, _SHUTDOWN, ctypes.c_void_p]
        self._library.jack_client_close.argtypes = [ctypes.c_void_p]
        status = ctypes.c_int()
        # None if no server runs.
        self._client = self._library.jack_client_open(_CLIENT, _NO_START_SERVER, ctypes.byref(status))
        if self._client:
            self._library.jack_on_shutdown(self._client, self._reported, None)

    @property
    def is_connected(self) -> bool:
        """True if a server was running when the watch was created."""
        return self._client is not None

    def _report(self, _: int | None) -> None:
        self.has_ended = True

    def close(self) -> None:
        """Disconnect from the server."""
        if self._client:
            self._library.jack_client_close(self._client)
            self._client = None
