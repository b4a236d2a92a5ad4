"""Output of the command line in one place; only `app.cli.progress` prints otherwise.

Names of files and their texts are untrusted: a terminal would execute an escape sequence in them, and a line feed would
begin a line that looks like the program's own. So everything printed consists of lines, and invisible characters are
escaped (`app.encoding.shown`).
"""

from __future__ import annotations

import json
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TextIO

import msgspec

from app.encoding import HIDDEN, shown


def say(*lines: str, stream: TextIO | None = None) -> None:
    """Print lines on standard output or another stream."""
    for line in lines:
        print(shown(line), file=stream, flush=stream is not None)


def warn(sentence: str) -> None:
    """Print an error or a warning on standard error."""
    say(f"suisou: {sentence}", stream=sys.stderr)


def say_json(value: Any) -> None:
    """Print a value as JSON with terminal control characters escaped."""
    text = json.dumps(value, ensure_ascii=False)
    # JSON in ASCII escapes every control character but DEL, so megabytes need not be searched.
    if not text.isascii() or "\x7f" in text:
        text = HIDDEN.sub(lambda found: f"\\u{ord(found[0]):04x}", text)
    print(msgspec.json.format(text, indent=2))


def count(number: int, *, is_last: bool) -> None:
    """Print a number of a count-in after the previous ones, with the terminal's bell."""
    bell = "\a" if sys.stdout.isatty() else ""
    print(f"{bell}{number}", end="\n" if is_last else " ", flush=True)


@contextmanager
def interrupted_by(number: signal.Signals) -> Iterator[None]:
    """Turn a signal, such as a request to end, into KeyboardInterrupt within a block, so that no half-written file
    remains.
    """
    before = signal.signal(number, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(number, before)
