"""Texts whose encoding no one wrote down."""

import pytest

from app.score.texts import decoded


@pytest.mark.parametrize(
    ("text", "encoding"),
    [
        ("Trumpet 1", "ascii"),
        ("Flöte", "utf-8"),
        ("トランペット", "utf-8"),
        ("トランペット", "cp932"),
        ("1stトランペット", "cp932"),
        ("ﾄﾗﾝﾍﾟｯﾄ 2", "cp932"),
        ("吹奏楽のための行進曲", "cp932"),
        ("Tp.1番", "cp932"),
        ("Flöte", "latin-1"),
        ("Flûte à bec", "latin-1"),
        ("Hörner in Es", "latin-1"),
        ("Pièce en ré", "latin-1"),
        ("Große Trommel", "latin-1"),
        ("Ténor", "latin-1"),
        ("Célesta", "latin-1"),
    ],
)
def test_what_was_written_comes_back(text: str, encoding: str) -> None:
    assert decoded(text.encode(encoding)) == text


def test_the_guess_can_be_overridden() -> None:
    data = "Флейта".encode("cp1251")
    assert decoded(data, "cp1251") == "Флейта"
    assert decoded(b"a\xff", "utf-8") == "a\ufffd"


def test_control_characters_and_outer_space_fall_away() -> None:
    assert decoded(b" Horn\x00 1 \r\n") == "Horn 1"
