"""JSON of any origin -> typed values; nothing but our own error escapes.

Messages: ``json.invalid``.
"""

from __future__ import annotations

from typing import TypeVar

import msgspec

from app.errors import FileError, shortened

T = TypeVar("T")


def decode_json(content: bytes, kind: type[T] | msgspec.json.Decoder[T], file: str) -> T:
    """The value of a JSON text.

    Parameters
    ----------
    kind : type or decoder of that type
    file : str
        Where it is from, for messages.

    Raises
    ------
    FileError
        ``json.invalid``: it is no JSON, or not of the kind.
    """
    decoder = kind if isinstance(kind, msgspec.json.Decoder) else msgspec.json.Decoder(kind)
    try:
        return decoder.decode(content)
    except (msgspec.MsgspecError, ValueError, RecursionError) as error:
        raise FileError("json.invalid", file=file, detail=shortened(error)) from error
