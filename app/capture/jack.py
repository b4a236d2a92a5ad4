"""Whether the JACK server still runs, which rtmidi does not tell: it goes on listing a dead one's ports."""

from __future__ import annotations

import ctypes
from typing import Any, Final

_CLIENT: Final = b"Suisou watch"
_NO_START_SERVER: Final = 1
_SHUTDOWN: Final = ctypes.CFUNCTYPE(None, ctypes.c_void_p)


class ServerWatch:
    """A client without ports, that is notified when the server ends.

    Without JACK's library nothing is watched: then no server runs either.

    Attributes
    ----------
    has_ended : bool
        Whether the server that ran at the beginning has gone; stays so when another runs.
    """

    def __init__(self) -> None:
        self.has_ended = False
        self._client: int | None = None
        # Kept: the library calls it as long as the client is open.
        self._reported = _SHUTDOWN(self._report)
        try:
            # Python's lock is free while this library works, unlike within rtmidi.
            self._library: Any = ctypes.CDLL("libjack.so.0")
        except OSError:
            return
        self._library.jack_client_open.restype = ctypes.c_void_p
        self._library.jack_on_shutdown.argtypes = [ctypes.c_void_p, _SHUTDOWN, ctypes.c_void_p]
        self._library.jack_client_close.argtypes = [ctypes.c_void_p]
        status = ctypes.c_int()
        self._client = self._library.jack_client_open(_CLIENT, _NO_START_SERVER, ctypes.byref(status))
        if self._client:
            self._library.jack_on_shutdown(self._client, self._reported, None)

    def _report(self, _: int | None) -> None:
        self.has_ended = True

    def close(self) -> None:
        """Watch no more."""
        if self._client:
            self._library.jack_client_close(self._client)
            self._client = None
