"""File name suffixes of music files; the actual format is recognised by content."""

from __future__ import annotations

from typing import Final

MIDI: Final = (".mid", ".midi", ".smf", ".kar", ".rmi")
NOTATION: Final = (".musicxml", ".mxl", ".xml")
MUSIC: Final = (*MIDI, *NOTATION)
