r"""Protection against paths on other computers, which are not accessed before the user agrees.

On Windows even checking for a file on another computer (``\\host\share\take.wav``) signs in there with the user's
account. Such paths from files are therefore refused until the user agrees to their host: in the window, by choosing or
dropping a file there, or by giving a path there on the command line.
"""

from __future__ import annotations

import os
import re
from typing import Final

from app.errors import FileError

AGREED: Final = "SUISOU_AGREED_HOSTS"
"""Environment variable with the hosts that the user has allowed, one per line, for child processes."""

_URL: Final = re.compile(r"([a-z][a-z0-9+.-]+)://(.*)", re.IGNORECASE | re.DOTALL)
_LOCAL_DEVICE: Final = re.compile(r"(?:[a-z]:|volume\{[^/]*)(?:/|$)", re.IGNORECASE)


def host_of(path: str | os.PathLike[str]) -> str:
    r"""Return the host of a path, in lower case; empty for a path on this computer.

    Only the text is examined, identically on every system: ``\\host\share``, ``//host/share``, ``\\?\UNC\host\share``,
    other paths of the Windows device namespace (``\\?\GLOBALROOT\...``), and URLs such as ``file://host/share``.
    """
    text = os.fspath(path).replace("\\", "/")
    if url := _URL.match(text):
        scheme, rest = url[1].lower(), url[2]
        # file:///C:/take.wav is a file on this computer, file:////host/... is not.
        if scheme == "file" and rest.startswith("/") and not rest.startswith("//"):
            return ""
        authority = rest.lstrip("/").split("/")[0].rpartition("@")[2]
        return re.sub(r"(?<!:):\d*$", "", authority).casefold()
    if text.startswith("/??/"):
        text = f"//?/{text[4:]}"
    if not text.startswith("//"):
        return ""
    parts = [part for part in text.split("/") if part]
    if parts and parts[0] in ("?", "."):
        inner = "/".join(parts[1:])
        if _LOCAL_DEVICE.match(inner):
            return ""
        parts = parts[2:] if inner.lower().startswith("unc/") else parts[1:]
    # WebDAV appends port and SSL to the host name: \\host@SSL@8443\share.
    return parts[0].split("@")[0].casefold() if parts else ""


def agree(path: str | os.PathLike[str]) -> None:
    """Allow access to the host of a path until the program ends; paths on this computer change nothing."""
    host = host_of(path)
    if host and host not in _agreed():
        os.environ[AGREED] = "\n".join((*_agreed(), host))


def _agreed() -> tuple[str, ...]:
    return tuple(host for host in os.environ.get(AGREED, "").split("\n") if host)


def may_touch(path: str | os.PathLike[str]) -> bool:
    """Return whether a path may be accessed: it is on this computer, or the user agreed to its host."""
    host = host_of(path)
    return not host or host in _agreed()


def is_file(path: str | os.PathLike[str]) -> bool:
    """Return whether a file exists; False without access for hosts the user has not agreed to."""
    return may_touch(path) and os.path.isfile(path)


def refuse_others(path: str | os.PathLike[str]) -> None:
    """Raise FileError for a path that may not be accessed."""
    if not may_touch(path):
        raise FileError("file.other_computer", file=os.fspath(path), host=host_of(path))
