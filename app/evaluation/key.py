"""Key of an evaluation with the variant of each clip, for the evaluator and not for viewers."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Final, Literal, TypeAlias

import msgspec

from app.errors import FileError
from app.formats.atomic import atomic_write
from app.formats.files import read_file
from app.formats.json_data import decode_json

KEY_FILE: Final = "key.json"
VERSION: Final = 1
_MOST_BYTES: Final = 4_000_000

Variant: TypeAlias = Literal["film", "generated", "still", "shifted", "keyframes"]
Aspect: TypeAlias = Literal["fingers_arms", "body", "mouth", "ensemble"]
Scale: TypeAlias = Literal["naturalness", "synchrony"]
Presentation: TypeAlias = Literal["single", "pair"]

VARIANTS: Final[tuple[Variant, ...]] = ("film", "generated", "still", "shifted", "keyframes")
"""Variants: real players; generated; generated with amplitude 0; generated with late fingers, as a control; other
animation.
"""
ASPECTS: Final[tuple[Aspect, ...]] = ("fingers_arms", "body", "mouth", "ensemble")
SCALES: Final[tuple[Scale, ...]] = ("naturalness", "synchrony")
STEPS: Final = 5

Code = Annotated[str, msgspec.Meta(pattern=r"^c[0-9]{2,4}$")]


class EvaluationClip(msgspec.Struct, frozen=True):
    """A clip of an evaluation: the variant, excerpt and view behind its code.

    Attributes
    ----------
    code : str
        ``c01`` and on; the only information for viewers.
    excerpt : int
        Number of the excerpt in the piece, from 1.
    from_s, until_s : float
        Start and end of the excerpt in seconds of the performance.
    view : str
        View of the players as in ``suisou film --view``.
    player : str
        Player in a close-up; empty for all players.
    """

    code: Code
    variant: Variant
    excerpt: Annotated[int, msgspec.Meta(ge=1)]
    from_s: float
    until_s: float
    view: str
    player: str = ""


class EvaluationKey(msgspec.Struct, frozen=True):
    """Key of an evaluation: its clips by code, with the aspects that are judged.

    Attributes
    ----------
    evaluation : str
        Id of 8 hexadecimal digits, as in the answers.
    piece : str
        Title of the piece.
    seed : int
        Seed of codes and orders.
    """

    format: Literal["suisou-evaluation"]
    version: int
    evaluation: Annotated[str, msgspec.Meta(pattern=r"^[0-9a-f]{8}$")]
    piece: str
    seed: int
    clips: tuple[EvaluationClip, ...]
    aspects: tuple[Aspect, ...] = ASPECTS


class _Head(msgspec.Struct):
    format: Literal["suisou-evaluation"]
    version: int


def encoded_key(key: EvaluationKey) -> bytes:
    """Return the key of an evaluation as indented JSON."""
    return msgspec.json.format(msgspec.json.encode(key), indent=1) + b"\n"


def write_key(key: EvaluationKey, path: Path) -> None:
    """Write the key that assigns codes to variants of an evaluation, atomically. Raises FileError."""
    with atomic_write(path) as stream:
        stream.write(encoded_key(key))


def read_key(path: Path) -> EvaluationKey:
    """Read a key.

    Raises
    ------
    FileError
        The file cannot be read, is not a key, or is from a newer version.
    """
    content = read_file(path, _MOST_BYTES)
    if decode_json(content, _Head, str(path), "evaluate.not_a_key").version > VERSION:
        raise FileError("evaluate.newer_key", file=str(path))
    key = decode_json(content, EvaluationKey, str(path), "evaluate.not_a_key")
    codes = [clip.code for clip in key.clips]
    if len(set(codes)) != len(codes):
        raise FileError("evaluate.not_a_key", file=str(path), detail="two clips have the same code")
    return key
