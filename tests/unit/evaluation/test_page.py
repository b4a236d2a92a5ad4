"""The page reveals nothing about the origin of a clip, and interprets no text as markup."""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

from app.evaluation.key import VARIANTS
from app.evaluation.page import PAGE_FILE
from app.messages import WORDINGS
from tests.unit.evaluation.made import TITLE, small_evaluation

ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> str:
    folder = tmp_path_factory.mktemp("evaluation")
    small_evaluation(folder)
    return (folder / PAGE_FILE).read_text(encoding="utf-8")


class Scripts(HTMLParser):
    """Text of every script, and names of all elements."""

    def __init__(self) -> None:
        super().__init__()
        self.scripts, self.tags = list[str](), list[tuple[str, dict[str, str | None]]]()
        self._within = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        self._within = tag == "script"

    def handle_data(self, data: str) -> None:
        if self._within:
            self.scripts.append(data)

    def handle_endtag(self, tag: str) -> None:
        self._within = False


def read(source: str) -> Scripts:
    reader = Scripts()
    reader.feed(source)
    reader.close()
    return reader


def test_no_variant_is_named(source: str) -> None:
    # The title is the user's, and the clips are letters of any kind.
    said = source.replace(json.dumps(TITLE)[1:-1], "")
    data = json.loads(read(source).scripts[0])
    for encoded in data["clips"].values():
        said = said.replace(encoded, "")
    said = said.replace('\\u003cb\\u003e\\"film\\"', "")
    assert [name for name in VARIANTS if re.search(rf"\b{name}\b", said, re.IGNORECASE)] == []


def test_a_title_is_data(source: str) -> None:
    reader = read(source)
    assert len(reader.scripts) == 2
    assert json.loads(reader.scripts[0])["piece"] == TITLE
    assert [tag for tag, _ in reader.tags if tag == "b"] == []


def test_it_needs_nothing_but_itself(source: str) -> None:
    reader = read(source)
    assert not {"link", "img", "iframe", "base"} & {tag for tag, _ in reader.tags}
    assert not any({"src", "href"} & attributes.keys() for _, attributes in reader.tags)
    assert "http:" not in source
    assert "https:" not in source
    policy = next(attributes["content"] for tag, attributes in reader.tags if "content" in attributes)
    assert policy.startswith("default-src 'none'")


def test_every_text_is_used_and_there() -> None:
    script = (ROOT / "resources" / "evaluation" / "page.js").read_text(encoding="utf-8")
    ids = {id.removeprefix("evaluate.page_") for id in WORDINGS if id.startswith("evaluate.page_")}
    asked = set(re.findall(r'\btext\("(\w+)"', script))
    assert asked <= ids
    aspects = ("fingers_arms", "body", "mouth", "ensemble")
    made = {f"{aspect}{rest}" for aspect in aspects for rest in ("", "_naturalness", "_synchrony")}
    made |= {f"{scale}_{end}" for scale in ("naturalness", "synchrony") for end in ("low", "high")}
    assert ids - asked - made - {"no_script"} == set()
    assert made <= ids
