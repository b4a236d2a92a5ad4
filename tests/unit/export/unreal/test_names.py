"""Names of assets are valid, unique and reproducible."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.export.unreal.names import LONGEST, asset_name
from app.formats.unique_names import numbered

# Invalid in asset names (send2ue's validations, Unreal's own list), or in Windows' file names.
FORBIDDEN = set("'\".,/:|&!~@#(){}[]=;^%$`*? <>\\\t\n")
DEVICES = {"con", "prn", "aux", "nul", *(f"{port}{digit}" for port in ("com", "lpt") for digit in range(10)), "none"}


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("quartet", "quartet"),
        ("Trumpet 1", "Trumpet_1"),
        ("../../etc/passwd", "etc_passwd"),
        ("a\"b'c", "a_b_c"),
        ("Café – Señor", "Cafe_Senor"),
        ("トランペット1", "toranpetto1"),
        ("ﾌﾙｰﾄ", "huruto"),
        ("きゃっと", "kyatto"),
        ("Ｆｌｕｔｅ　２", "Flute_2"),
        ("CON", "Piece_CON"),
        ("None", "Piece_None"),
    ],
)
def test_names_that_people_read(text: str, name: str) -> None:
    assert asset_name(text, "Piece") == name


@pytest.mark.parametrize(
    "pair", [("第一楽章", "第二楽章"), ("🎺", "🎷"), ("x" * 300, "x" * 301), ("", "🎺"), ("愛 1", "恋 1")]
)
def test_names_that_lose_something_stay_two(pair: tuple[str, str]) -> None:
    one, other = (asset_name(text, "Piece") for text in pair)
    assert one.casefold() != other.casefold()
    assert re.search(r"_[0-9a-f]{8}$", one)


@given(st.text(st.characters()), st.sampled_from(["Piece", "Player"]))
def test_any_name_is_harmless(text: str, otherwise: str) -> None:
    name = asset_name(text, otherwise)
    assert name == asset_name(text, otherwise)
    assert re.fullmatch(r"[A-Za-z0-9_]+", name)
    assert len(name) <= LONGEST
    assert not set(name) & FORBIDDEN
    assert name.casefold() not in DEVICES


@given(st.lists(st.sampled_from(["a", "A", "a_2", "b", "a_3"]), max_size=8))
def test_unique_where_case_does_not_count(names: list[str]) -> None:
    made = numbered(names)
    assert len({name.casefold() for name in made}) == len(names)
    assert all(name.casefold().startswith(requested.casefold()) for name, requested in zip(made, names, strict=True))
