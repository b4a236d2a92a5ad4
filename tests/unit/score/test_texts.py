"""Texts of unknown encoding."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.score.texts import TextDecoder


def decoded(data: bytes, encoding: str | None = None) -> str:
    """Decoded form of a single text."""
    return TextDecoder([data], encoding=encoding).read(data)


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


@pytest.mark.parametrize(
    ("encoding", "names"),
    [
        ("gbk", "茉莉花 主旋律 伴奏"),
        ("gbk", "天空之城 左手 右手"),
        ("gbk", "长号"),
        ("cp950", "月亮代表我的心 法國號"),
        ("cp950", "聲部一 聲部二"),
        ("cp950", "小號"),
        ("cp949", "아리랑 왼손 오른손"),
        ("cp949", "주선율"),
        ("cp949", "호른"),
        ("euc_jp", "荒城の月 主旋律 尺八"),
        ("euc_jp", "メロディ"),
        ("cp932", "荒城の月 主旋律 尺八"),
        ("cp932", "ﾄﾗﾝﾍﾟｯﾄ ﾎﾙﾝ"),
        ("cp1251", "Калинка Мелодия Баян"),
        ("cp1251", "ВАЛЬС"),
        ("koi8_r", "Калинка Мелодия Баян"),
        ("koi8_r", "соло"),
        ("mac_roman", "Flöte Überstimme Mélodie"),
        ("mac_roman", "Canción"),
        ("cp1252", "Flöte Überstimme L’été 2ª"),
        ("cp1252", "Gänsemarsch"),
        ("cp1252", "Pièce en ré"),
        ("cp1250", "Trąbka Róg Puzon"),
        ("cp1250", "Křídlovka"),
        ("cp866", "Калинка Мелодия Баян"),
        ("cp866", "Труба Валторна Ударные"),
        ("cp866", "ВАЛЬС"),
        ("cp1253", "Τρομπέτα Μελωδία"),
        ("cp1253", "Σόλο"),
        ("cp1253", "ΤΡΟΜΠΕΤΑ"),
        ("iso8859_7", "Άλτο σαξόφωνο"),
    ],
)
def test_the_texts_of_a_file_say_together_how_they_are_encoded(encoding: str, names: str) -> None:
    data = [name.encode(encoding) for name in names.split()]
    texts = TextDecoder(data[:1], data[1:])
    assert texts.encoding == encoding
    assert [texts.read(name) for name in data] == names.split()


def test_a_text_that_would_be_odd_in_the_encoding_of_the_others_has_its_own() -> None:
    data = [name.encode("cp932") for name in ("トランペット", "吹奏楽")] + [
        "Flöte".encode("cp1252"),
        b"Horn",
        "소리".encode(),
    ]
    assert [TextDecoder(data).read(name) for name in data] == ["トランペット", "吹奏楽", "Flöte", "Horn", "소리"]


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-be", "utf-16-le"])
def test_unicode_needs_no_guess(encoding: str) -> None:
    data = "Trompete in B".encode(encoding)
    assert decoded(data) == "Trompete in B"
    assert TextDecoder([data]).encoding == ""
    marked = b"\xfe\xff" + "Flöte ♭".encode("utf-16-be")
    assert decoded(marked) == "Flöte ♭"


def test_chinese_that_happens_to_be_utf_8_is_chinese_beside_chinese() -> None:
    data = [name.encode("gbk") for name in ("单簧管", "陶笛", "鼓")]
    assert [TextDecoder(data).read(name) for name in data] == ["单簧管", "陶笛", "鼓"]


@given(st.lists(st.binary(max_size=40), max_size=5))
def test_any_bytes_are_read(given_texts: list[bytes]) -> None:
    texts = TextDecoder(given_texts, given_texts)
    assert all(isinstance(texts.read(data), str) for data in given_texts)
