r"""A record of the files that the program asks the system about. On Linux ``\\host\share`` is an ordinary file name and
no other computer is contacted; the record shows the accesses that would contact one on Windows.

On Linux ``\\host\share`` is an odd file name and nothing leaves the machine: the record shows what Windows would do.
"""

from __future__ import annotations

import io
import os
import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from unittest.mock import patch

from app.formats.other_computers import host_of

_OS = ("stat", "lstat", "open", "access", "listdir", "scandir", "readlink", "mkdir", "rename", "replace", "remove")
_PATH = ("isfile", "isdir", "exists", "lexists", "getsize", "getmtime", "realpath", "samefile", "islink")


class Touched:
    """Paths that were accessed, in order.

    Attributes
    ----------
    elsewhere : list of str
        Those that name another computer.
    """

    def __init__(self) -> None:
        self.elsewhere: list[str] = []

    def note(self, *values: object) -> None:
        """Record those of the values that are paths on another computer."""
        for value in values:
            if isinstance(value, list | tuple):
                self.note(*value)
            elif isinstance(value, str | os.PathLike | bytes):
                text = os.fsdecode(value)
                # Joined to a folder it is the same place for Windows.
                rooted = text[text.find("\\\\") :] if "\\\\" in text else text
                if (host_of(text) or host_of(rooted)) and self.elsewhere[-1:] != [text]:
                    self.elsewhere.append(text)


@contextmanager
def touching() -> Iterator[Touched]:
    """Record accesses by Python and by started processes within a ``with`` block."""
    touched = Touched()

    def spy(original: Callable[..., Any]) -> Callable[..., Any]:
        def called(*args: Any, **options: Any) -> Any:
            touched.note(*args)
            return original(*args, **options)

        return called

    patches = [patch.object(os, name, spy(getattr(os, name))) for name in _OS]
    patches += [patch.object(os.path, name, spy(getattr(os.path, name))) for name in _PATH]
    patches += [patch.object(io, "open", spy(io.open)), patch("builtins.open", spy(open))]
    patches += [patch.object(Path, name, spy(getattr(Path, name))) for name in ("stat", "open", "resolve", "exists")]
    start = subprocess.Popen.__init__
    patches.append(
        patch.object(
            subprocess.Popen,
            "__init__",
            lambda self, command, *args, **options: (touched.note(command), start(self, command, *args, **options))[1],
        )
    )
    for each in patches:
        each.start()
    try:
        yield touched
    finally:
        for each in reversed(patches):
            each.stop()
