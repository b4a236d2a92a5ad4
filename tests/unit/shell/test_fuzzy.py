"""Matching of typed letters and names."""

from __future__ import annotations

import pytest

from app.shell.fuzzy import fitness


def best(query: str, *texts: str) -> str:
    fitting = [(value, text) for text in texts if (value := fitness(query, text)) is not None]
    return max(fitting)[1]


@pytest.mark.parametrize(
    ("query", "requested", "others"),
    [
        ("save", "Save", ("Save As", "Unsaved work")),
        ("sa", "Save As", ("Close Project", "Undo")),
        ("light", "Light Theme", ("Slight Delay", "Highlight")),
        ("lt", "Light Theme", ("Split at Playhead", "Reset to Default")),
        ("theme dark", "Dark Theme", ("Light Theme",)),
        ("zoom in", "Zoom In Timeline", ("Zoom Out Timeline",)),
        ("ライト", "ライトテーマ", ("ダークテーマ",)),
    ],
)
def test_the_best_fit(query: str, requested: str, others: tuple[str, ...]) -> None:
    assert best(query, requested, *others) == requested


def test_letters_must_be_there_in_their_order() -> None:
    assert fitness("xyz", "Save") is None
    assert fitness("evas", "Save") is None


def test_letters_strewn_about_do_not_fit() -> None:
    assert fitness("eel", "Reset to Default") is None
    assert fitness("rdf", "Reset to Default") is not None


def test_case_does_not_count() -> None:
    assert fitness("SAVE", "save") == fitness("save", "SAVE")
