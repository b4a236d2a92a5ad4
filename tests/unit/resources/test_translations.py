"""The Japanese of the editor is whole, fits its English, and is what the editor reads."""

from __future__ import annotations

import string
from pathlib import Path

import pytest
from PySide6.QtCore import QTranslator

from resources.build import build_translations as build

ROOMS = sorted(build.rooms())
FILES = sorted(build.TARGET.glob("*_ja.ts"))


def fields(text: str) -> set[tuple[str, str]]:
    """What a template is filled with: names, and how they are formatted; plurals are English."""
    parsed = string.Formatter().parse(text)
    return {(name, spec or "") for _, name, spec, _ in parsed if name is not None and "|" not in (spec or "")}


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_text_is_translated_with_its_arguments(path: Path) -> None:
    for (context, source), text in build.translations(path).items():
        assert text.strip(), f"{context}: {source!r} is not translated"
        assert fields(text) == fields(source), f"{context}: {source!r} -> {text!r}"
        assert ("&" in text) == ("&" in source), f"{context}: the mark of a key: {source!r} -> {text!r}"


def test_nothing_is_missing_and_nothing_is_left_over(tmp_path: Path) -> None:
    for room, sources in build.rooms().items():
        fresh = tmp_path / f"{room}_ja.ts"
        build.collect(sources, fresh)
        committed = build.TARGET / fresh.name
        assert committed.exists(), f"run resources/build/build_translations.py: {committed.name} is missing"
        now, before = set(build.translations(fresh)), set(build.translations(committed))
        assert now == before, f"{room}: run resources/build/build_translations.py: {sorted(now ^ before)}"
    for name, (context, texts) in build.declared().items():
        committed = build.TARGET / f"{name}_ja.ts"
        assert list(build.translations(committed)) == [(context, text) for text in texts], f"{name}: run it"


def test_the_editor_reads_what_the_translators_wrote() -> None:
    translator = QTranslator()
    assert translator.load(str(build.TARGET / "suisou_ja.qm"))
    for path in FILES:
        for (context, source), text in build.translations(path).items():
            assert translator.translate(context, source) == text, f"suisou_ja.qm is stale: {context}: {source!r}"


def test_every_room_has_its_file() -> None:
    assert {path.stem.removesuffix("_ja") for path in FILES} == {*ROOMS, *build.declared()}
