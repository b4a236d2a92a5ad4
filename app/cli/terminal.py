"""Output of the command line, in one place; only `app.cli.progress` has a line of its own.

Names of files and texts in them come from anywhere. An escape sequence in one would be obeyed by the terminal, and a
newline would begin what looks like a line of the program's own; so whatever is printed is lines, and what is not
visible in one is escaped (`app.encoding.shown`).
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
    """Print lines, on standard output unless another stream is named."""
    for line in lines:
        print(shown(line), file=stream, flush=stream is not None)


def warn(sentence: str) -> None:
    """Print what went wrong or deserves attention, on standard error."""
    say(f"suisou: {sentence}", stream=sys.stderr)


def say_json(value: Any) -> None:
    """Print a value as JSON, which every reader takes back exactly; what a terminal would obey is escaped in it."""
    text = json.dumps(value, ensure_ascii=False)
    # Of ASCII JSON escapes all but one itself: megabytes need not be searched.
    if not text.isascii() or "\x7f" in text:
        text = HIDDEN.sub(lambda found: f"\\u{ord(found[0]):04x}", text)
    print(msgspec.json.format(text, indent=2))


def count(number: int, *, is_last: bool) -> None:
    """Print a number of a count-in behind the ones before, with the terminal's bell."""
    bell = "\a" if sys.stdout.isatty() else ""
    print(f"{bell}{number}", end="\n" if is_last else " ", flush=True)


@contextmanager
def interrupted_by(number: signal.Signals) -> Iterator[None]:
    """Let a signal (Ctrl-C, or a request to end) end what is done here by KeyboardInterrupt, so that nothing
    half-written stays."""
    before = signal.signal(number, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(number, before)
