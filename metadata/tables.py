"""Reads and checks the tables in `metadata` of all kinds; messages name the file and the key."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import msgspec

from app.errors import MapError
from app.formats.table_cache import kept
from app.formats.toml import read_toml, shaped

T = TypeVar("T")

ROOT = Path(__file__).parent


class Title(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Title in the editor's languages; English is used if there is no Japanese one."""

    en: str
    ja: str = ""

    def in_language(self, language: str) -> str:
        """The title in ``"en"`` or ``"ja"``; English if there is no Japanese one."""
        return (self.ja or self.en) if language == "ja" else self.en


def bundled(folder: str, read: Callable[[Path], T], kind: type[T]) -> Callable[[], Mapping[str, T]]:
    """Make a function that returns all bundled tables of a folder, by file name; they are read once."""
    # Created while the import lock is held: msgspec crashes if two threads use a type for the first time at once.
    decoder: msgspec.msgpack.Decoder[Any] = msgspec.msgpack.Decoder(dict[str, kind])  # type: ignore[valid-type]

    def made() -> Mapping[str, T]:
        return {path.stem: read(path) for path in sorted((ROOT / folder).glob("*.toml"))}

    @cache
    def found() -> Mapping[str, T]:
        return kept("metadata", folder, ROOT, decoder, made)

    return found


def label(path: Path) -> str:
    """Return a file's name for messages, with its folder, since files in several folders have the same name."""
    return f"{path.parent.name}/{path.name}"


def decoded(path: Path, kind: type[T], file: str | None = None) -> T:
    """Read a table from a file as a typed value. Raises FileError, MapError."""
    file = label(path) if file is None else file
    return shaped(read_toml(path, file), kind, file)


def invalid(path: Path, key: str, detail: str, file: str | None = None) -> MapError:
    """Return the error for an invalid value at ``key`` of a table; ``file`` replaces the label of the path."""
    return MapError("table.invalid", file=label(path) if file is None else file, place=key, detail=detail)


def check_name(path: Path, name: str, file: str | None = None) -> None:
    """Raise MapError unless a table's name equals the name of its file."""
    if name != path.stem:
        raise invalid(path, "name", f"{name!r} is not the file's name {path.stem!r}", file)


def check_title(path: Path, title: Title) -> None:
    """Raise MapError unless a title is a single printable line."""
    for language in ("en", "ja"):
        text = getattr(title, language)
        if not text.isprintable() or (language == "en" and not text.strip()):
            raise invalid(path, f"title.{language}", "must be a name on one line")
