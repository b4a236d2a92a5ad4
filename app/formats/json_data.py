"""Decoding of untrusted JSON to typed values, which raises only FileError."""

from __future__ import annotations

import re
from typing import Final, TypeVar

import msgspec

from app.errors import FileError, shortened

T = TypeVar("T")
_MALFORMED: Final = re.compile(r"JSON is malformed: .* \(byte (\d+)\)")

UNREADABLE: Final = (msgspec.MsgspecError, ValueError, RecursionError)
"""Everything that msgspec raises for bytes of any origin: not JSON or MessagePack, not of the type, texts that are not
UTF-8, nested too deep."""


def decode_json(content: bytes, kind: type[T] | msgspec.json.Decoder[T], file: str, refused: str = "json.invalid") -> T:
    """Decode a JSON text.

    Parameters
    ----------
    kind : type or decoder of that type
        Type of the value.
    file : str
        File name for messages.
    refused : str
        Message id, with arguments file and detail, for invalid text.

    Raises
    ------
    FileError
        The text is no JSON or not of the type.
    """
    decoder = kind if isinstance(kind, msgspec.json.Decoder) else msgspec.json.Decoder(kind)
    try:
        return decoder.decode(content)
    except UNREADABLE as error:
        raise FileError(refused, file=file, detail=_plain(error)) from error


def _plain(error: Exception) -> str:
    """Return an error of the decoder in words for users, with its position."""
    malformed = _MALFORMED.match(str(error))
    if malformed is not None:
        return f"its text cannot be understood from byte {malformed[1]} on"
    if str(error) == "Input data was truncated":
        return "it ends too early"
    return shortened(error)
