"""Names of performers, and file names made from them.

A name from a MIDI file is only displayed; file names use a cleaned form, so that a name can never become a path, a
device or a hidden file on any system.
"""

from __future__ import annotations

import re
import unicodedata
from collections import Counter
from collections.abc import Iterable, Sequence

# Device names of Windows, reserved with any extension ("Naming Files, Paths, and Namespaces", Microsoft Learn).
_DEVICES = frozenset(
    ["con", "prn", "aux", "nul", "conin$", "conout$"]
    + [f"{device}{digit}" for device in ("com", "lpt") for digit in "0123456789¹²³"]
)
_FORBIDDEN = re.compile(r'[<>:"/\\|?*]')
_LONGEST_NAME_BYTES = 80
"""Greatest number of bytes in a name, which leaves room for an instrument and a suffix within the 255 bytes of common
file systems and Windows' short paths.
"""


def clean_name(text: str) -> str:
    """Return a text on one line, in composed form (NFC), without control characters; may be empty."""
    kept = (" " if character.isspace() else character for character in unicodedata.normalize("NFC", text))
    visible = "".join(
        character for character in kept if unicodedata.category(character) not in ("Cc", "Cs", "Cn", "Co")
    )
    return " ".join(visible.split())


def unique_names(names: Iterable[str]) -> tuple[str, ...]:
    """Make names unique, ignoring case.

    Names that occur once stay; equal ones are numbered in order ("trumpet 1", "trumpet 2"), skipping numbers in use.
    """
    requested = [clean_name(name) for name in names]
    counts = Counter(name.casefold() for name in requested)
    taken = {name.casefold() for name in requested if counts[name.casefold()] == 1}
    next_number = dict.fromkeys(counts, 1)
    unique = []
    for name in requested:
        key = name.casefold()
        if counts[key] == 1:
            unique.append(name)
            continue
        while f"{key} {next_number[key]}" in taken:
            next_number[key] += 1
        taken.add(f"{key} {next_number[key]}")
        unique.append(f"{name} {next_number[key]}")
    return tuple(unique)


def file_stem(name: str) -> str:
    """Return a file name without extension, made from a name, that every common system accepts; it is never empty, a
    path, a device or hidden.
    """
    text = "".join(
        character
        for character in clean_name(name)
        # Format characters (zero width, direction marks) may hide an extension; a family emoji loses only its joiners.
        if unicodedata.category(character) != "Cf"
    )
    text = _FORBIDDEN.sub("_", text).strip(" .")
    while len(text.encode("utf-8")) > _LONGEST_NAME_BYTES:
        text = text[:-1]
    text = text.rstrip(" .")
    if not text.strip("_ ."):
        text = "player"
    if text.split(".")[0].rstrip().casefold() in _DEVICES:
        text = f"_{text}"
    return text


def file_stems(names: Sequence[str]) -> tuple[str, ...]:
    """Return file names without suffix for names, made unique regardless of case by numbers."""
    taken: set[str] = set()
    stems = []
    for name in names:
        stem = base = file_stem(name)
        number = 2
        while _key(stem) in taken:
            stem = f"{base} ({number})"
            number += 1
        taken.add(_key(stem))
        stems.append(stem)
    return tuple(stems)


def _key(text: str) -> str:
    """Return a key for comparing names; names with equal keys may be the same file on some system."""
    return unicodedata.normalize("NFKD", text.casefold())
