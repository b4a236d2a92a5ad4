r"""Paths on other computers, which are not touched before the user agrees.

Where a path names another computer (``\\host\share\take.wav``), asking whether the file is there already makes Windows
sign in to that computer with the user's account. A path that a file brings along is therefore refused until its host
was agreed to: in the window, by choosing or dropping a file there, or by naming a path there on the command line.
"""

from __future__ import annotations

import os
import re
from typing import Final

from app.errors import FileError

AGREED: Final = "SUISOU_AGREED_HOSTS"
"""Environment variable with the hosts that were agreed to, one a line: processes that this one begins know them too."""

_URL: Final = re.compile(r"([a-z][a-z0-9+.-]+)://(.*)", re.IGNORECASE | re.DOTALL)
_LOCAL_DEVICE: Final = re.compile(r"(?:[a-z]:|volume\{[^/]*)(?:/|$)", re.IGNORECASE)


def host_of(path: str | os.PathLike[str]) -> str:
    r"""Return the computer that a path names, in lower case; empty for a path on this one.

    The text alone decides, on every system alike: ``\\host\share``, ``//host/share``, ``\\?\UNC\host\share``, other
    paths of the Windows device namespace (``\\?\GLOBALROOT\...``), and URLs such as ``file://host/share``.
    """
    text = os.fspath(path).replace("\\", "/")
    if url := _URL.match(text):
        scheme, rest = url[1].lower(), url[2]
        # file:///C:/take.wav is a file of this computer; file:////host/... is not.
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
    # A port or SSL of WebDAV follows the name: \\host@SSL@8443\share.
    return parts[0].split("@")[0].casefold() if parts else ""


def agree(path: str | os.PathLike[str]) -> None:
    """Allow files on the computer of a path until the program ends; a path on this computer changes nothing."""
    host = host_of(path)
    if host and host not in _agreed():
        os.environ[AGREED] = "\n".join((*_agreed(), host))


def _agreed() -> tuple[str, ...]:
    return tuple(host for host in os.environ.get(AGREED, "").split("\n") if host)


def may_touch(path: str | os.PathLike[str]) -> bool:
    """Return whether a path may be looked at: it is on this computer, or its host was agreed to."""
    host = host_of(path)
    return not host or host in _agreed()


def is_file(path: str | os.PathLike[str]) -> bool:
    """Return whether a file is there; False without a look on a computer that was not agreed to."""
    return may_touch(path) and os.path.isfile(path)


def refuse_others(path: str | os.PathLike[str]) -> None:
    """Raise FileError (``file.other_computer``) for a path that may not be touched."""
    if not may_touch(path):
        raise FileError("file.other_computer", file=os.fspath(path), host=host_of(path))
