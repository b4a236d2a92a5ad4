"""Why one would take an alternate fingering, in the person's language: maps say it in fixed English words."""

from __future__ import annotations

import re
from collections.abc import Iterable

from PySide6.QtCore import QCoreApplication

_BETWEEN = re.compile("[,、，]")


def tag_words() -> dict[str, str]:
    """The words for what the bundled maps say, by their tag."""
    return {
        "alternate": QCoreApplication.translate("FingeringTag", "alternate"),
        "trill": QCoreApplication.translate("FingeringTag", "trill"),
        "fast": QCoreApplication.translate("FingeringTag", "fast"),
        "chromatic": QCoreApplication.translate("FingeringTag", "chromatic"),
        "attack": QCoreApplication.translate("FingeringTag", "attack"),
        "held": QCoreApplication.translate("FingeringTag", "held"),
        "rare": QCoreApplication.translate("FingeringTag", "rare"),
        "forked": QCoreApplication.translate("FingeringTag", "forked"),
        "raised": QCoreApplication.translate("FingeringTag", "raised"),
        "forte": QCoreApplication.translate("FingeringTag", "forte"),
        "piano": QCoreApplication.translate("FingeringTag", "piano"),
        "obsolete": QCoreApplication.translate("FingeringTag", "obsolete"),
    }


def words_of_tags(tags: Iterable[str]) -> list[str]:
    """Tags in words; one of a person's own is shown as it is."""
    words = tag_words()
    return [words.get(tag, tag) for tag in tags]


def tags_of_text(text: str) -> list[str]:
    """The tags that a person typed with commas between them: in words, as they stand in maps, or of their own."""
    known = {word.casefold(): tag for tag, word in tag_words().items()}
    typed = [word.strip() for word in _BETWEEN.split(text)]
    return [known.get(word.casefold(), word) for word in typed if word]
