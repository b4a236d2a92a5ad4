"""Words for details of messages: faults of files, tables and projects, and errors of the operating system
(`japanese.toml`).

Words of a library that are missing in the table remain unchanged.
"""

from __future__ import annotations

import errno
import os
import re
import tomllib
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path
from typing import Final, TypeAlias

from app.messages.wordings import CORRECTION, CORRECTIONS, wording

_NAME: Final = r"""('.*?'|".*?")"""
_KIND: Final = "|".join(CORRECTIONS)
_WHERE: Final = re.compile(
    rf"(.*) \((?:(player|dancer) {_NAME})?(?:, )?(?:bar (-?\d+))?(?:, )?(?:\b({_KIND})(?: {_NAME})?)?\)"
)
Label: TypeAlias = Callable[[str, str], str]


@cache
def _japanese() -> tuple[dict[str, str], tuple[tuple[re.Pattern[str], str], ...]]:
    """Read the table of Japanese words: for errors of the operating system by English text, and for details
    by pattern.
    """
    table = tomllib.loads(Path(__file__).with_name("japanese.toml").read_text(encoding="utf-8"))
    reasons = {os.strerror(getattr(errno, name, -1)): words for name, words in table["system"].items()}
    return reasons, tuple((re.compile(pattern), words) for pattern, words in table["patterns"].items())


def detail_text(detail: str, language: str, label: Label = lambda kind, name: name) -> str:
    """Translate the detail of a message (the words of a library or of the operating system) to a language.

    Parameters
    ----------
    label : callable
        Returns a correction's name for the user from its kind and its name in the file.
    """
    place = _WHERE.fullmatch(detail)
    if place is not None and any(place.groups()[1:]):
        what, who, name, bar, kind, correction = place.groups()
        said = [wording(f"detail.{who}", language).format(value=name)] if who else []
        said += [wording("detail.bar", language).format(value=bar)] if bar else []
        if kind:
            word = wording(f"{CORRECTION}{kind}", language)
            said.append(f"{word} {_labelled(correction, partial(label, kind))}" if correction else word)
        where = wording("detail.comma", language).join(said)
        return wording("detail.at", language).format(what=detail_text(what, language), where=where)
    if language != "ja":
        return detail
    reasons, patterns = _japanese()
    found = ((pattern.fullmatch(detail), words) for pattern, words in patterns)
    return reasons.get(detail) or next((match.expand(words) for match, words in found if match), detail)


def _labelled(quoted: str, label: Callable[[str], str]) -> str:
    """Replace a quoted internal name by its name for users, in the same quotes."""
    return f"{quoted[0]}{label(quoted[1:-1])}{quoted[-1]}"
