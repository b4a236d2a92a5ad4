"""Menus, buttons and labels named in guides and messages exist, in both languages."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import pytest

from app.messages import LANGUAGES
from app.shell.action import without_dots, without_key
from app.shell.action_rows import rows
from app.shell.language import TEXTS
from app.shell.menus import BAR
from metadata.library import bundled_gestures, metadata_library

ROOT = Path(__file__).parents[3]
SHOWN = 40
"""Number of characters of a wrong path that are displayed."""
GUIDES = (ROOT / "README.md", ROOT / "README_ja.md", *sorted((ROOT / "docs").glob("*.md")))


@cache
def paths(place: int) -> list[re.Pattern[str]]:
    """Every menu within another one and every command, with the menus above, in one of the languages, as patterns.
    Pages of a command's dialog may follow."""
    menus_alone = {(without_key(TEXTS["menu.file"][place]), without_key(TEXTS["menu.open_recent"][place]))}
    commands = set[tuple[str, ...]]()
    for row in rows():
        menus = tuple(without_key(TEXTS[f"menu.{part}"][place]) for part in row.menu.split("/") if part)
        menus_alone.add(menus)
        commands.add((*menus, without_dots(without_key(TEXTS[f"action.{row.id}"][place]))))
    return [
        re.compile(re.escape(" > ".join(names)) + r"(?![A-Za-z])" + ("" if names in commands else "(?! >)"))
        for names in menus_alone | commands
        if len(names) > 1
    ]


def wrong(text: str, place: int) -> list[str]:
    """Return the places of a text that begin with a menu of the bar and ``>`` but name none of its menus and
    commands."""
    known, flowing = paths(place), " ".join(text.split())
    bar = "|".join(re.escape(without_key(TEXTS[f"menu.{name}"][place])) for name in BAR)
    starts = [found.start() for found in re.finditer(rf"(?<!> )(?<![A-Za-z])(?:{bar}) > ", flowing)]
    return [flowing[at : at + SHOWN] for at in starts if not any(one.match(flowing, at) for one in known)]


def test_a_path_that_is_not_there_is_found() -> None:
    assert wrong("Choose File > Save As, or File >\nMelt.", 0) == ["File > Melt."]
    assert wrong("*Record > Devices...*", 0) == ["Record > Devices...*"]
    assert wrong("Record > Recorder", 0) == ["Record > Recorder"]
    assert wrong("「録音 > MIDI デバイス」で選んでください。録音 > 装置", 1) == ["録音 > 装置"]


@pytest.mark.parametrize("guide", GUIDES, ids=lambda path: path.name)
def test_guides_name_menus_as_they_are(guide: Path) -> None:
    assert wrong(guide.read_text(encoding="utf-8"), int(guide.stem.endswith("_ja"))) == []


@cache
def labels(place: int) -> set[str]:
    """All texts of the window as a guide writes them, and the names of styles, habits and gestures."""
    language = tuple(LANGUAGES)[place]
    texts = {
        without_dots(without_key(re.sub(r" ?[(（]?\{\w+\}[)）]?", "", wording[place]))) for wording in TEXTS.values()
    }
    acting = metadata_library()
    titles = [row.title for row in acting.styles.items.values()]
    titles += [row.title for row in acting.habits.items.values()]
    titles += [row.title for row in bundled_gestures().values()]
    named = [title.in_language(language) for title in titles]
    return {text.strip(" :：").lower() for text in [*texts, *named]}


@pytest.mark.parametrize("guide", GUIDES, ids=lambda path: path.name)
def test_guides_name_labels_as_they_are(guide: Path) -> None:
    """Every text in italics, in Japanese in corner brackets, is a label; a bold one may be a heading."""
    text = re.sub(r"^    .*$|`[^`]*`", "", guide.read_text(encoding="utf-8"), flags=re.MULTILINE)
    quoted = r"「([^」]+)」" if guide.stem.endswith("_ja") else r"(?<![\w*])\*(?![ *])([^*]+?)\*(?![\w*])"
    named = re.findall(quoted, " ".join(text.split()))
    known = labels(int(guide.stem.endswith("_ja")))
    missing = [
        name
        for name in named
        if not all(without_dots(part).strip(" :：.").lower() in known for part in name.split(" > "))
    ]
    assert missing == []


@pytest.mark.parametrize("place", [0, 1], ids=list(LANGUAGES))
def test_messages_and_texts_name_menus_as_they_are(place: int) -> None:
    texts = {id: wording[place] for id, wording in TEXTS.items()}
    assert {id: found for id, text in texts.items() if (found := wrong(text, place))} == {}


def test_the_guide_from_notation_names_the_keys_of_marks() -> None:
    guide = (ROOT / "docs/from-your-notation-program.md").read_text(encoding="utf-8")
    table = re.findall(r"^\| ((?:Shift\+|`[<>]`).*?) \| (.*?) \|$", guide, re.MULTILINE)
    named = {
        key.strip("`"): name.removeprefix("a ").split()[0]
        for keys, names in table
        for key, name in zip(keys.split(", "), names.split(", "), strict=False)
    }
    assert len(named) >= 9
    titles = {
        row.shortcut: TEXTS[f"action.{row.id}"][0].lower()
        for row in rows()
        if row.id.startswith("marks.") and row.shortcut
    }
    assert {key: name for key, name in named.items() if name not in titles.get(key, "")} == {}
