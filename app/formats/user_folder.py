"""Libraries of items that are bundled or in a user folder, which is read again when its files change.

An item is a ``.toml`` file with accompanying files. A user's item overrides a bundled one of the same id; errors are
reported by file, and the last valid version stays in use. All callers get the same values; only `UserFolder.reload`
replaces them.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from threading import RLock
from typing import Any, Generic, TypeAlias, TypeVar

import platformdirs

from app.errors import AppError, Message
from app.formats.files import files_in

V = TypeVar("V")
S = TypeVar("S", bound="Shelf[Any]")
Stamp: TypeAlias = frozenset[tuple[str, int, int]]
"""Names, times and sizes of the files in a folder, and the error if it could not be listed."""
TABLE = ".toml"


@dataclass(frozen=True)
class Shelf(Generic[V]):
    """All items of one kind at the time the folder was read.

    Attributes
    ----------
    folder : Path
        The user's folder.
    items : mapping of str to V
        Items by id: bundled ones first, then the user's. Unchanged items stay the same objects.
    files : mapping of str to Path
        Files of the user's items, by id.
    problems : mapping of Path to tuple of Message
        Errors in the user's files. If an earlier version of a file was valid, ``items`` has that version.
    revisions : mapping of str to int
        Number of changes of each id; unchanged ones are missing.
    stamp : frozenset
        Names, times and sizes of the files that were read.
    made_of : mapping of str to Stamp
        Further files that each user's item depends on.
    """

    folder: Path
    items: Mapping[str, V]
    files: Mapping[str, Path] = field(default_factory=dict)
    problems: Mapping[Path, tuple[Message, ...]] = field(default_factory=dict)
    revisions: Mapping[str, int] = field(default_factory=dict)
    stamp: Stamp = frozenset()
    made_of: Mapping[str, Stamp] = field(default_factory=dict)


@dataclass(frozen=True)
class Read(Generic[V]):
    """Result of reading one of the user's files: the value and the files it depends on, or the errors."""

    value: V | None
    files: tuple[Path, ...] = ()
    problems: tuple[Message, ...] = ()


class UserFolder(Generic[V, S]):
    """Items of one kind: bundled with the program, and in a user folder.

    Parameters
    ----------
    name : str
        Folder name in the program's data folder. The environment variable ``SUISOU_`` plus this name can give another
        folder.
    suffixes : collection of str
        Suffixes of relevant files other than tables.
    shelf : type of Shelf
        Class of the result.
    bundled : callable
        Returns the bundled items by id, always the same objects.
    read : callable
        Reads a user's table by path; may raise AppError.
    skipped : collection of str
        Names of tables in the folder that hold something else.
    """

    def __init__(
        self,
        name: str,
        suffixes: Collection[str],
        shelf: type[S],
        bundled: Callable[[], Mapping[str, V]],
        read: Callable[[Path], Read[V]],
        skipped: Collection[str] = (),
    ) -> None:
        self.name, self.variable = name, f"SUISOU_{name.upper()}"
        self.suffixes = (TABLE, *suffixes)
        self.lock = RLock()
        self.last: S | None = None
        self._shelf, self._bundled, self._read, self._skipped = shelf, bundled, read, frozenset(skipped)

    def folder(self) -> Path:
        """Return the path of the user's folder, which need not exist."""
        named = os.environ.get(self.variable)
        return Path(named) if named else platformdirs.user_data_path("suisou", appauthor=False) / self.name

    def begin(self) -> S:
        """Return the bundled items only, unless the folder was read already; the folder is then read in the
        background.
        """
        with self.lock:
            self.last = self.last or self._shelf(self.folder(), self._bundled())
            return self.last

    def now(self) -> S:
        """Return all items as last read; the first call reads them."""
        return self.last if self.last is not None else self.reload()

    def reload(self) -> S:
        """Reload the folder if something in it changed, and return the current values."""
        with self.lock:
            self.last = self.read(self.folder(), self.last)
            return self.last

    def preview(self, items: Mapping[str, V], own: Collection[str]) -> None:
        """Use other values until `put_back`, or until the folder changes; ``own`` are the ids of items that count as
        the user's.
        """
        with self.lock:
            shelf = self.now()
            files = {id: shelf.files.get(id, self.folder() / f"{id}{TABLE}") for id in own}
            self.last = replace(shelf, items=items, files=files)

    def put_back(self, shelf: S) -> None:
        """Restore the values from before `preview`, unless the folder was reloaded since."""
        with self.lock:
            if self.last is not None and self.last.stamp == shelf.stamp:
                self.last = shelf

    def read(self, folder: Path, before: S | None = None) -> S:
        """Read the user's folder; a missing folder is empty.

        Parameters
        ----------
        before : Shelf, optional
            Previous result: unchanged items stay the same objects, and last valid versions of invalid files are kept.
        """
        problems: dict[Path, tuple[Message, ...]] = {}
        try:
            listed = files_in(folder, *self.suffixes)
        except AppError as error:
            problems[folder], listed = (error.message,), []
        stamp = stamp_of(listed) | {(problem.id, 0, 0) for reported in problems.values() for problem in reported}
        if before is not None and before.folder == folder and before.stamp == stamp:
            return before
        own: dict[str, V] = {}
        files: dict[str, Path] = {}
        made_of: dict[str, Stamp] = {}
        for path in listed:
            if path.suffix.lower() != TABLE or path.name in self._skipped:
                continue
            id, found = path.stem, self._checked(path)
            earlier: V | None = None if before is None or id not in before.files else before.items[id]
            if found.problems:
                problems[path] = found.problems
            parts = stamp_of(found.files)
            same = earlier is not None and found.value == earlier and before is not None and before.made_of[id] == parts
            if (found.value is None or same) and earlier is not None and before is not None:
                own[id], files[id], made_of[id] = earlier, path, before.made_of[id]
            elif found.value is not None:
                own[id], files[id], made_of[id] = found.value, path, parts
        items = {**self._bundled(), **own}
        known = items if before is None else before.items
        revisions = {} if before is None else dict(before.revisions)
        for id in {**items, **known}:
            if items.get(id) is not known.get(id):
                revisions[id] = revisions.get(id, 0) + 1
        return self._shelf(folder, items, files, problems, revisions, stamp, made_of)

    def _checked(self, path: Path) -> Read[V]:
        try:
            return self._read(path)
        except AppError as error:
            return Read(None, problems=(error.message,))


class Named(Generic[V]):
    """Tables in a folder that contain their own names, independent of file names.

    Parameters
    ----------
    read : callable
        Reads a table by path. Raises AppError.
    name_of : callable
        Returns the name that a table contains.
    """

    def __init__(self, read: Callable[[Path], V], name_of: Callable[[V], str]) -> None:
        self._read, self._name_of = read, name_of

    def found(self, folder: Path) -> tuple[dict[str, V], tuple[Message, ...]]:
        """Return the valid items sorted by name, and the errors of the others. A missing folder is empty."""
        items: dict[str, V] = {}
        problems = []
        try:
            listed = files_in(folder, TABLE)
        except AppError as error:
            return {}, (error.message,)
        for path in listed:
            try:
                item = self._read(path)
            except AppError as error:
                problems.append(error.message)
            else:
                items[self._name_of(item)] = item
        return dict(sorted(items.items())), tuple(problems)

    def path_of(self, folder: Path, name: str) -> Path | None:
        """Return the file of the item with a name; None if there is none. Raises FileError if the folder cannot be
        listed.
        """
        for path in files_in(folder, TABLE):
            with contextlib.suppress(AppError):  # `found` reports errors in other files.
                if self._name_of(self._read(path)) == name:
                    return path
        return None


def stamp_of(paths: Iterable[Path]) -> Stamp:
    """Return names, times and sizes of files, to detect changes."""
    stamps = []
    for path in paths:
        try:
            status = path.stat()
        except (OSError, ValueError):
            # Removed since it was listed, or a name that no file can have: treated as not listed.
            continue
        stamps.append((path.name, status.st_mtime_ns, status.st_size))
    return frozenset(stamps)
