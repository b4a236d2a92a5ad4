"""Atomic changes of a tree of files.

New files are written next to their place, on the same disk, and renamed at the end; replaced files are kept until
everything is renamed. On an error everything is restored. A killed process leaves its folder, from which the next
process restores the previous state.

Trees are untrusted and may contain links: nothing is written, moved or removed through a link that leads outside. The
tree itself may be reached through links, and links within it are followed.
"""

from __future__ import annotations

import contextlib
import os
import re
import secrets
import shutil
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path, PurePath, PureWindowsPath
from typing import Final

from app.encoding import shown
from app.errors import FileError
from app.formats.files import cannot_write, read_file
from app.formats.locks import is_locked, lock
from app.formats.temporary_folders import abandoned_folders, scratch_folder

_SCRATCH: Final = re.compile(r"\.[0-9a-f]{16}\.partial")
MOST_BYTES = 2**24
_NEW, _OLD, _LOCK, _LIST = "new", "old", "lock", "coming.txt"
_NOTE: Final = "tree"
"""Name of the file in a process's temporary folder that records the changed folder and the folder being written."""
_MOST_NOTE: Final = 2**20


@dataclass
class TreeChange:
    """Pending changes to a tree of files.

    Attributes
    ----------
    new : path
        Folder to write into, with the layout of the tree.
    removed : list of path
        Files to delete, relative to the tree.
    last : list of path
        New files to be renamed last, relative to the tree, such as manifests that list the others.
    """

    new: Path
    removed: list[Path] = field(default_factory=list)
    last: list[Path] = field(default_factory=list)


@contextlib.contextmanager
def tree_into(root: Path, scratch: Path) -> Iterator[TreeChange]:
    """Change a tree of files at the end of the block; if the block raises, nothing is changed.

    Parameters
    ----------
    root : path
        An existing folder.
    scratch : path
        Folder for temporary files in ``root``, or ``root`` itself; created if needed, and removed if it stays empty.

    Yields
    ------
    TreeChange
        The pending changes, to be filled in the block.

    Raises
    ------
    FileError
        The tree cannot be written, is in use by another process, has a link leading outside, or cannot be restored.
    """
    refuse_links_out(root, [scratch.relative_to(root) / _NEW])
    had_scratch = os.path.isdir(scratch)
    try:
        scratch.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_write(scratch, error) from error
    partial = scratch / f".{secrets.token_hex(8)}.partial"
    noted = contextlib.ExitStack()
    try:
        recover(root, scratch)
        with contextlib.suppress(OSError, FileError):  # otherwise the next export into this folder cleans up
            note = noted.enter_context(scratch_folder()) / _NOTE
            note.write_bytes(b"\0".join(os.fsencode(path.absolute()) for path in (root, scratch)))
        try:
            (partial / _NEW).mkdir(parents=True)
            stream = (partial / _LOCK).open("xb")
        except OSError as error:
            raise cannot_write(scratch, error) from error
        with stream:
            with contextlib.suppress(OSError):  # the file system has no locks
                lock(stream)
            change = TreeChange(partial / _NEW)
            try:
                yield change
            except FileError as error:
                raise _named_in_tree(error, change.new, root) from error
            _commit(root, partial, change)
    finally:
        # Files that could not be restored are kept, for the next export to try.
        if not os.path.exists(partial / _LIST):
            shutil.rmtree(partial, ignore_errors=True)
        if not had_scratch:
            with contextlib.suppress(OSError):  # it is in use again
                scratch.rmdir()
        noted.close()


def _named_in_tree(error: FileError, new: Path, root: Path) -> FileError:
    """Return an error that names a file by its place in the tree instead of by the temporary folder ``new``, which the
    user has not chosen and which is deleted.
    """
    file = Path(str(error.message.arguments["file"]))
    temporary = Path(shown(os.fspath(new)))
    if not file.is_relative_to(temporary):
        return error
    named = {**error.message.arguments, "file": os.fspath(root / file.relative_to(temporary))}
    return FileError(error.message.id, **named)


def clean_up() -> None:
    """Delete temporary files of killed processes everywhere, and restore the files they had removed from trees."""
    for folder in abandoned_folders():
        # Left to the next export into this folder if it fails.
        with contextlib.suppress(OSError, ValueError, FileError):
            root, scratch = (Path(os.fsdecode(path)) for path in read_file(folder / _NOTE, _MOST_NOTE).split(b"\0"))
            recover(root, scratch)
            if scratch != root:
                scratch.rmdir()


def recover(root: Path, scratch: Path) -> None:
    """Restore files that a killed process had removed from a tree, and delete its temporary files.

    Raises
    ------
    FileError
        The process is running, a link leads outside, or the system refuses.
    """
    refuse_links_out(root, [scratch.relative_to(root) / _OLD])
    if not os.path.isdir(scratch):
        return
    for partial in sorted(path for path in scratch.iterdir() if _SCRATCH.fullmatch(path.name)):
        if os.path.islink(partial) or not os.path.isdir(partial):
            continue
        # No file has been replaced yet between creating the folder and locking it.
        if is_locked(partial / _LOCK):
            raise FileError("tree.busy", file=os.fspath(root))
        _give_back(root, partial)
        shutil.rmtree(partial, ignore_errors=True)


def refuse_links_out(root: Path, paths: Iterable[Path | PurePath]) -> None:
    """Raise FileError if a path, relative to a tree, leads outside through a link."""
    top = Path(os.path.realpath(root))
    for folder in sorted({path.parent for path in map(Path, paths)}):
        for step in (*reversed(folder.parents), folder):
            target = Path(os.path.realpath(root / step))
            if not target.is_relative_to(top):
                raise FileError("tree.leads_outside", file=os.fspath(root / step), target=os.fspath(target))


def files_below(folder: Path) -> list[Path]:
    """Return the sorted relative paths of all files below a folder."""
    return sorted(path.relative_to(folder) for path in folder.rglob("*") if os.path.isfile(path))


def stays_inside(name: str) -> bool:
    """Return whether a relative path from an untrusted file stays inside its folder on every system."""
    path = PureWindowsPath(name)
    return bool(path.parts) and not (path.anchor or ".." in path.parts or "\\" in name)


def _commit(root: Path, partial: Path, change: TreeChange) -> None:
    coming = [path for path in files_below(change.new) if path not in change.last] + change.last
    refuse_links_out(root, [*coming, *change.removed])
    at = root
    try:
        for path in [*coming, *change.removed]:
            at = root / path
            if os.path.isdir(at):
                raise IsADirectoryError(f"{path.name} is a folder")
            if os.path.exists(at):
                # A hard link instead of a move: at every moment each file exists, old or new.
                _second_name(at, partial / _OLD / path)
        _write_list(partial, coming)
        for path in coming:
            at = root / path
            at.parent.mkdir(parents=True, exist_ok=True)
            (change.new / path).replace(at)
        for path in change.removed:
            at = root / path
            at.unlink(missing_ok=True)
            _prune(at.parent, root)
    except OSError as error:
        _give_back(root, partial)
        raise FileError("tree.refused", file=os.fspath(at), reason=_reason(error)) from error
    except BaseException:
        _give_back(root, partial)
        raise
    # From here on nothing needs to be restored.
    (partial / _LIST).unlink(missing_ok=True)


def _write_list(partial: Path, coming: list[Path]) -> None:
    """Record the files about to be renamed; while this record exists, some files of the tree may be old and
    some new.
    """
    draft = partial / f"{_LIST}.draft"
    draft.write_text("\n".join(path.as_posix() for path in coming), encoding="utf-8")
    draft.replace(partial / _LIST)


def _give_back(root: Path, partial: Path) -> None:
    """Restore the tree to its state before the change."""
    if not os.path.isfile(partial / _LIST):
        return
    lines = read_file(partial / _LIST, MOST_BYTES).decode("utf-8", "replace").splitlines()
    # The list may come from elsewhere, so its paths are checked.
    coming = [Path(line) for line in lines if stays_inside(line)]
    refuse_links_out(root, [*coming, partial.relative_to(root) / _OLD / _LIST])
    old = files_below(partial / _OLD) if os.path.isdir(partial / _OLD) else []
    refuse_links_out(root, old)
    at = root
    try:
        for path in coming:
            # A file that has not been moved yet is still among the new ones.
            if path not in old and not os.path.exists(partial / _NEW / path):
                at = root / path
                at.unlink(missing_ok=True)
            _prune((root / path).parent, root)
        for path in old:
            at = root / path
            at.parent.mkdir(parents=True, exist_ok=True)
            (partial / _OLD / path).replace(at)
    except OSError as error:
        raise FileError("tree.not_restored", file=os.fspath(at), reason=_reason(error)) from error
    (partial / _LIST).unlink(missing_ok=True)


def _second_name(file: Path, name: Path) -> None:
    name.parent.mkdir(parents=True, exist_ok=True)
    try:
        os.link(file, name)
    except OSError:
        shutil.copy2(file, name)


def _prune(folder: Path, root: Path) -> None:
    """Delete a folder and those above it, below ``root``, if they have become empty."""
    while folder != root:
        try:
            folder.rmdir()
        except FileNotFoundError:
            pass  # the folder was never created, though its parents may have been
        except OSError:
            return
        folder = folder.parent


def _reason(error: OSError) -> str:
    return error.strerror or str(error)
