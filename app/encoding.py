"""Text from bytes of unknown encoding: texts of MIDI files, and names of files.

On Linux file names are bytes. In Python's paths, bytes that are not UTF-8 (as from Japanese zip archives) are lone
surrogates (PEP 383), which open the file but cannot be written by JSON, TOML, Qt or terminals. Valid names may contain
line ends and escape sequences. So files contain paths in the form of `stored`, read with `restored`; texts for users
use `shown`.
"""

from __future__ import annotations

import os
import re
import unicodedata
from typing import Final
from urllib.parse import quote_from_bytes, unquote_to_bytes

PREFIX: Final = "bytes://"
"""Prefix of a stored path that is not UTF-8; no real path begins with it, since paths contain no double slashes."""

HIDDEN: Final = re.compile("[\x00-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069\ud800-\udfff]")
"""Characters that are removed from texts for users: line ends, terminal commands, changes of direction, lone
surrogates.
"""

ENCODINGS: Final = (
    *("utf-8", "cp932", "euc_jp", "gb18030", "big5hkscs", "cp949", "cp1251", "koi8_r", "cp866", "cp1252", "mac_roman"),
    *("cp1250", "cp1253", "iso8859_7"),
)
"""Encodings that can be chosen for texts in files."""

_ESCAPED = re.compile("[%\ud800-\udfff]")
# A single non-ASCII character next to a small Latin letter: "Flöte" in Latin-1 decodes as such in CP932.
_LONE_IN_WORD = re.compile(r"(?<=[a-z])[^\x00-\x7f](?![^\x00-\x7f])|(?<![^\x00-\x7f])[^\x00-\x7f](?=[a-z])")


def guessed(data: bytes) -> str:
    """Decode bytes as UTF-8 if valid, else as CP932 (Japanese systems), else as Latin-1.

    Nearly every pair of bytes is valid CP932, so the result is rejected if it contains private characters, or single
    Japanese characters within Latin words.
    """
    for encoding in ("utf-8", "cp932"):
        try:
            text = data.decode(encoding)
        except UnicodeDecodeError:
            continue
        private = any(unicodedata.category(character) == "Co" for character in text)
        if encoding == "utf-8" or not (private or _LONE_IN_WORD.search(text)):
            return text
    return data.decode("latin-1")


def is_encoding(name: str) -> bool:
    """Return whether a name is that of an encoding that can decode any bytes."""
    try:
        # An empty text would not look the encoding up; an ASCII-only encoding fails on this one.
        b"ab\xff".decode(name, errors="replace")
    except (LookupError, ValueError):
        return False
    return True


def stored(path: str | os.PathLike[str]) -> str:
    """Return a path in the form for files: unchanged if it is UTF-8, else ``bytes://`` and percent-encoded bytes.
    `restored` is the inverse.
    """
    text = os.fspath(path)
    if text.startswith(PREFIX):
        if restored(text) == text:
            return text  # a path of another system, with other rules for names
    elif is_text(text):
        return text
    return PREFIX + _ESCAPED.sub(lambda found: quote_from_bytes(_bytes(found[0])), text)


def restored(text: str) -> str:
    """Return the path of a text made by `stored`; unchanged if this system cannot represent it."""
    if not text.startswith(PREFIX):
        return text
    try:
        path = os.fsdecode(unquote_to_bytes(text.removeprefix(PREFIX)))
    except UnicodeDecodeError:
        return text
    return text if "\0" in path else path


def shown(path: str | os.PathLike[str]) -> str:
    """Format a path, or a text containing one, as a single line for users: names that are not UTF-8 are guessed, and
    `HIDDEN` characters are escaped as in Python.
    """
    text = os.fspath(path)
    if not is_text(text):
        text = "/".join(name if is_text(name) else guessed(_bytes(name)) for name in text.split("/"))
    return HIDDEN.sub(lambda found: found[0].encode("unicode_escape").decode(), text)


def is_text(path: str | os.PathLike[str]) -> bool:
    """Return whether a path can be stored as UTF-8 text."""
    try:
        os.fspath(path).encode()
    except UnicodeEncodeError:
        return False
    return True


def _bytes(text: str) -> bytes:
    """Return the bytes of a name, even if this system cannot represent it."""
    try:
        return os.fsencode(text)
    except UnicodeEncodeError:
        return text.encode("utf-8", "surrogatepass")
