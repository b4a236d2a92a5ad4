"""Reasons for fingerings are shown and typed in the user's language."""

from __future__ import annotations

import pytest

from instrument_maps.load import bundled_maps
from widgets.common.fingering_tags import tag_words, tags_of_text, words_of_tags

USED = {tag for instrument in bundled_maps().values() for one in instrument.fingerings for tag in one.tags}


@pytest.mark.usefixtures("qt_app")
def test_there_is_a_word_for_every_tag_of_the_bundled_maps() -> None:
    assert set(tag_words()) >= USED


@pytest.mark.usefixtures("japanese")
def test_in_japanese_no_tag_is_left_in_english_and_what_is_typed_is_the_tag() -> None:
    assert not [word for word in words_of_tags(sorted(USED)) if word.isascii()]
    assert words_of_tags(["trill", "sotto voce"]) == ["トリル", "sotto voce"]
    assert tags_of_text("トリル、 fast, Sotto voce,, フォーク") == ["trill", "fast", "Sotto voce", "forked"]


@pytest.mark.usefixtures("qt_app")
def test_in_english_they_are_typed_in_any_case() -> None:
    assert tags_of_text("Trill,sotto voce") == ["trill", "sotto voce"]
    assert tags_of_text(" , ") == []
