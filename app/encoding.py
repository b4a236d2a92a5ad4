"""Text in bytes whose encoding no one states: texts of MIDI files, and names of files.

On Linux the name of a file is bytes. Those that are not UTF-8, as of files out of a Japanese zip archive, are lone
surrogates in Python's paths (PEP 383): they open the file, and neither JSON, nor TOML, nor Qt, nor a terminal takes
them. Those that are UTF-8 may hold line ends and escape sequences all the same. So paths are kept in files as `stored`
writes them, and read back with `restored`; what a user reads, and what is named after a file, is `shown`.
"""

from __future__ import annotations

import os
import re
import unicodedata
from typing import Final
from urllib.parse import quote_from_bytes, unquote_to_bytes

PREFIX: Final = "bytes://"
"""Begins a stored path that is not UTF-8; no other path begins so, because two slashes are one in a path."""

HIDDEN: Final = re.compile("[\x00-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069\ud800-\udfff]")
"""Characters that texts for users never hold: line ends, terminal commands, changes of direction, lone surrogates."""

ENCODINGS: Final = (
    *("utf-8", "cp932", "euc_jp", "gb18030", "big5hkscs", "cp949", "cp1251", "koi8_r", "cp866", "cp1252", "mac_roman"),
    *("cp1250", "cp1253", "iso8859_7"),
)
"""Encodings of texts in files, to choose from."""

_ESCAPED = re.compile("[%\ud800-\udfff]")
# One character from beyond ASCII, alone, touching a small Latin letter: what "Flöte" in Latin-1 looks like in CP932.
_LONE_IN_WORD = re.compile(r"(?<=[a-z])[^\x00-\x7f](?![^\x00-\x7f])|(?<![^\x00-\x7f])[^\x00-\x7f](?=[a-z])")


def guessed(data: bytes) -> str:
    """Text in UTF-8 if the bytes are valid UTF-8, else in CP932 (Japanese systems), else in Latin-1.

    Nearly every pair of bytes is valid CP932, so its reading is refused if it holds private characters or single ones
    within Latin words.
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
    """Return whether it is the name of an encoding that turns any bytes into text."""
    try:
        # Looks it up, which an empty text does not; one that is for ASCII alone fails.
        b"ab\xff".decode(name, errors="replace")
    except (LookupError, ValueError):
        return False
    return True


def stored(path: str | os.PathLike[str]) -> str:
    """A path as a file keeps it: itself where it is UTF-8, else ``bytes://`` and its bytes, percent-encoded where they
    are not UTF-8. `restored` gives the path back."""
    text = os.fspath(path)
    if text.startswith(PREFIX):
        if restored(text) == text:
            return text  # of another system, which has other names
    elif is_text(text):
        return text
    return PREFIX + _ESCAPED.sub(lambda found: quote_from_bytes(_bytes(found[0])), text)


def restored(text: str) -> str:
    """The path that was `stored`; as it stands where this system cannot have it."""
    if not text.startswith(PREFIX):
        return text
    try:
        path = os.fsdecode(unquote_to_bytes(text.removeprefix(PREFIX)))
    except UnicodeDecodeError:
        return text
    return text if "\0" in path else path


def shown(path: str | os.PathLike[str]) -> str:
    """A path, or any text with a path in it, for users to read and to name something by, on one line: names that are
    not UTF-8 are guessed, and what is `HIDDEN` is escaped as in Python."""
    text = os.fspath(path)
    if not is_text(text):
        text = "/".join(name if is_text(name) else guessed(_bytes(name)) for name in text.split("/"))
    return HIDDEN.sub(lambda found: found[0].encode("unicode_escape").decode(), text)


def is_text(path: str | os.PathLike[str]) -> bool:
    """Return whether a path is UTF-8."""
    try:
        os.fspath(path).encode()
    except UnicodeEncodeError:
        return False
    return True


def _bytes(text: str) -> bytes:
    """The bytes of a name, also of one that this system cannot have."""
    try:
        return os.fsencode(text)
    except UnicodeEncodeError:
        return text.encode("utf-8", "surrogatepass")
