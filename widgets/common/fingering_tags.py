"""Tags of alternate fingerings (reasons to use them) in the user's language; maps contain fixed English words."""

from __future__ import annotations

import re
from collections.abc import Iterable

from app.editor.translated import tr

_BETWEEN = re.compile("[,、，]")


def tag_words() -> dict[str, str]:
    """Return the translated words for the tags of fingerings that bundled maps use, by tag."""
    return {
        "alternate": tr("fingering_tag.alternate"),
        "trill": tr("fingering_tag.trill"),
        "fast": tr("fingering_tag.fast"),
        "chromatic": tr("fingering_tag.chromatic"),
        "attack": tr("fingering_tag.attack"),
        "held": tr("fingering_tag.held"),
        "beside": tr("fingering_tag.beside"),
        "rare": tr("fingering_tag.rare"),
        "forked": tr("fingering_tag.forked"),
        "raised": tr("fingering_tag.raised"),
        "lipped": tr("fingering_tag.lipped"),
        "forte": tr("fingering_tag.forte"),
        "piano": tr("fingering_tag.piano"),
        "obsolete": tr("fingering_tag.obsolete"),
    }


def words_of_tags(tags: Iterable[str]) -> list[str]:
    """Return fingering tags as translated words; tags made by the user are unchanged."""
    words = tag_words()
    return [words.get(tag, tag) for tag in tags]


def tags_of_text(text: str) -> list[str]:
    """Return the tags in a text separated by commas; translated words are converted to the tags in maps, others are
    unchanged.
    """
    known = {word.casefold(): tag for tag, word in tag_words().items()}
    typed = [word.strip() for word in _BETWEEN.split(text)]
    return [known.get(word.casefold(), word) for word in typed if word]
