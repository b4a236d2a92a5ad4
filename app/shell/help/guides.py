"""The guides: Markdown files in ``docs``, in the editor's language if a translation exists.

A translation lies beside its guide (``acting_ja.md`` beside ``acting.md``) and has the same headings in the same order,
so that section numbers agree. Qt renders the Markdown; HTML in it is ignored.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Final

from PySide6.QtGui import QTextBlock, QTextDocument

FOLDER: Final = Path(str(files("resources"))).parent / "docs"
"""Folder of the guides, beside the packages in a checkout and in an installation."""
FEATURES: Final = (
    QTextDocument.MarkdownFeature.MarkdownDialectGitHub.value | QTextDocument.MarkdownFeature.MarkdownNoHTML.value
)
ORDER: Final = (
    *("editor", "correct-by-hand", "cameras"),
    *("from-your-notation-program", "piece-settings", "marks", "acting", "curves", "choreography"),
    *("record-your-first-take", "follow-a-recording", "reference-video", "bring-your-own-character"),
    *("into-unreal", "unreal-import-options", "files-for-other-programs", "skeletons", "stream-live", "evaluate"),
    *("add-an-instrument", "metadata", "command-line", "inspect", "glossary"),
    *("install", "tested", "licences", "security", "conduct", "architecture"),
)
"""Names of the guides in the order of the contents: window, music, acting, recordings, characters, export, tables."""


@dataclass(frozen=True)
class GuideSection:
    """A heading of a guide and the text below it.

    Attributes
    ----------
    level : int
        Level of the heading, 1 for the title of the guide.
    anchor : str
        Part of a link after ``#``, made from the heading as GitHub does.
    block : int
        Number of the heading's text block in the Qt document.
    text : str
        Plain text up to the next heading.
    """

    heading: str
    level: int
    anchor: str
    block: int
    text: str


@dataclass(frozen=True)
class Guide:
    """A guide in one language.

    Attributes
    ----------
    name : str
        File name of the English guide without its ending.
    markdown : str
        Text of the guide in Markdown.
    is_translated : bool
        False if the text is English because there is no translation.
    sections : tuple of GuideSection
        Sections in their order, that of the title first.
    """

    name: str
    markdown: str
    is_translated: bool
    sections: tuple[GuideSection, ...]

    @property
    def title(self) -> str:
        """Return the title, which is the first heading."""
        return self.sections[0].heading

    def number(self, anchor: str) -> int | None:
        """Return the index of the section with an anchor: 0 for an empty anchor, None if there is no such section."""
        if not anchor:
            return 0
        return next((number for number, section in enumerate(self.sections) if section.anchor == anchor), None)


@dataclass(frozen=True)
class SearchHit:
    """A section found by a search, with an excerpt around the first match."""

    guide: str
    number: int
    heading: str
    excerpt: str


def anchor_of(heading: str) -> str:
    """Return the anchor of a heading, made as GitHub does: lower case, hyphens for spaces, no punctuation."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def names() -> tuple[str, ...]:
    """Return the names of all guides in the order of the table of contents."""
    found = {path.stem for path in FOLDER.glob("*.md")}
    found -= {name for name in found if "_" in name and name.rpartition("_")[0] in found}
    return (*(name for name in ORDER if name in found), *sorted(found - set(ORDER)))


@cache
def guide(name: str, language: str) -> Guide:
    """Return a guide in a language, or in English where it is not translated.

    Raises
    ------
    KeyError
        If there is no guide of this name.
    """
    if name not in names():
        raise KeyError(name)
    translation = FOLDER / f"{name}_{language}.md"
    is_translated = language == "en" or os.path.isfile(translation)
    path = translation if language != "en" and is_translated else FOLDER / f"{name}.md"
    markdown = path.read_text(encoding="utf-8")
    return Guide(name, markdown, is_translated, sections(markdown))


def sections(markdown: str) -> tuple[GuideSection, ...]:
    """Divide a Markdown text into its headings with the text below each."""
    document = QTextDocument()
    document.setMarkdown(markdown, QTextDocument.MarkdownFeature(FEATURES))
    found: list[GuideSection] = []
    seen: dict[str, int] = {}
    heading, below = QTextBlock(), list[str]()

    def close() -> None:
        if heading.isValid():
            anchor = anchor_of(heading.text())
            repeated = seen[anchor] = seen.get(anchor, -1) + 1
            anchor = f"{anchor}-{repeated}" if repeated else anchor
            level = heading.blockFormat().headingLevel()
            found.append(GuideSection(heading.text(), level, anchor, heading.blockNumber(), " ".join(below)))

    for block in _blocks(document):
        if block.blockFormat().headingLevel():
            close()
            heading, below = QTextBlock(block), []
        else:
            below.append(block.text().replace("\N{OBJECT REPLACEMENT CHARACTER}", ""))
    close()
    return tuple(found)


def _blocks(document: QTextDocument) -> Iterator[QTextBlock]:
    block = document.begin()
    while block.isValid():
        yield block
        block = block.next()


EXCERPT: Final = 90
"""Number of characters of an excerpt on each side of the first match."""


def search(words: str, language: str) -> tuple[SearchHit, ...]:
    """Return the sections of all guides that contain every word: those with the words in the heading first, then by
    number of matches.
    """
    searched = words.casefold().split()
    if not searched:
        return ()
    found: list[tuple[tuple[int, int], SearchHit]] = []
    for name in names():
        for number, section in enumerate(guide(name, language).sections):
            heading, text = section.heading.casefold(), section.text.casefold()
            if all(word in heading or word in text for word in searched):
                headed = sum(word in heading for word in searched)
                count = sum(text.count(word) for word in searched)
                hit = SearchHit(name, number, section.heading, _excerpt(section.text, searched))
                found.append(((-headed, -count), hit))
    return tuple(hit for _, hit in sorted(found, key=lambda entry: entry[0]))


def _excerpt(text: str, words: list[str]) -> str:
    folded = text.casefold()
    places = [place for word in words if (place := folded.find(word)) >= 0]
    first = min(places, default=0)
    start = max(first - EXCERPT, 0)
    end = min(first + EXCERPT, len(text))
    return f"{'…' if start else ''}{text[start:end].strip()}{'…' if end < len(text) else ''}"
