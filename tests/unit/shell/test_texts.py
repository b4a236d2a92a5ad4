"""Every text exists in both languages, is valid and is used; every used text exists."""

from __future__ import annotations

import ast
import re
import string
import tomllib
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import get_args

from app.cli.commands import help_texts
from app.messages import LANGUAGES, WORDINGS
from app.plan.by_hand.corrections import REMOVABLE
from app.plan.events_by_hand import PoseTarget
from app.plan.kinds import COMMAND_TEXTS, EVENT_TEXTS
from app.shell.action_rows import rows
from app.shell.language import TEXTS
from metadata.load import load_expressions

ROOT = Path(__file__).parents[3]
FILES = [path for room in ("app", "widgets") for path in sorted((ROOT / room).rglob("*.toml"))]
"""Tables of texts; Japanese details and the command line's help have other formats, and the guides' places and
the names of bands in titles are no texts.
"""
OTHERS = ("japanese.toml", "places.toml", "help.toml", "argparse.toml", "band_in_title.toml")
TABLES = {path: tomllib.loads(path.read_text("utf-8")) for path in FILES if path.name not in OTHERS}
FUNCTIONS = frozenset(
    {"tr", "Caption", "Button", "Check", "ColumnList", "IconButton", "OkCancel", "PictureButton", "in_form"}
)
"""Functions with text ids as positional arguments; `texted` has them by keyword."""
KINDS = {*REMOVABLE, "embouchure", "pose", "additive", "vary", "style"}
"""First parts of the ids of selectable events."""
NAMES = {f"expression_name.{name}" for name in load_expressions()} | {
    f"pose_name.{target}" for target in get_args(PoseTarget)
}
AVOIDED = {
    **dict.fromkeys(("インストゥルメントマップ", "楽器定義"), "楽器マップ"),
    "ビデオ": "動画",
    "ピストン": "バルブ",
    "音源": "オーディオ",
    "ライブ配信": "モーション送信",
    "ウインドコントローラー": "ウインドシンセサイザー",
    "骨格": "スケルトン",
    "負担": "力の入り具合",
    **dict.fromkeys(("足拍子", "つま先タップ", "足でリズム"), "つま先で拍を取る"),
    "ほお": "頬",
    "あご": "顎",
    "肘": "ひじ",
    "膝": "ひざ",
    "視聴者": "参加者",
    "：": ": ",
    "か?": "か？",
    "ウィンド": "ウインド",
    "エンコーディング": "文字コード",
    "確信度": "信頼度",
    "ティッシモ": "ティシモ",
    **dict.fromkeys(("ノン・", "スライド・"), "no dot within a name"),
    "一人": "1 人",
    "再生ヘッド": "再生位置",
    **dict.fromkeys(("基本姿勢", "レスト姿勢"), "レストポーズ"),
    "捻りの骨": "ツイストボーン",
    "パソコン": "コンピューター",
    "すでに": "既に",
    "既に存在しません": "もう存在しません",
    "標準に戻": "既定に戻",
    "判断不能": "判断できない",
    "全奏者": "全員",
    "〜": "～",
    **{f"付点{number}分": f"付点{kanji}分" for number, kanji in ((2, "二"), (4, "四"), (8, "八"))},
}
"""Japanese words to avoid, with the word that the program uses instead."""
ID = re.compile(r"[a-z_]+\.\w+")
"""Ids of texts; names of objects contain no dot."""


def fields(text: str) -> set[tuple[str, str]]:
    """Return the fields of a template: their names and formats. Plurals, which only English has, are left out."""
    parsed = string.Formatter().parse(text)
    return {(name, spec or "") for _, name, spec, _ in parsed if name is not None and "|" not in (spec or "")}


def sources() -> Iterator[ast.AST]:
    """Every syntax node of the program."""
    for folder in ("app", "widgets"):
        for path in sorted((ROOT / folder).rglob("*.py")):
            yield from ast.walk(ast.parse(path.read_text(encoding="utf-8")))


def test_every_text_is_there_in_both_languages_with_its_arguments() -> None:
    for id, wording in TEXTS.items():
        english, japanese = wording
        assert english.strip(), id
        assert japanese.strip(), id
        assert fields(japanese) == fields(english), f"{id}: {english!r} -> {japanese!r}"
        assert ("&" in japanese) == ("&" in english), f"{id}: the mark of a key: {english!r} -> {japanese!r}"


def test_one_japanese_word_for_one_thing() -> None:
    tables = {path.name: path.read_text("utf-8") for path in (ROOT / "metadata").glob("[!b]*/*.toml")}
    texts = {id: japanese for id, (_, japanese) in TEXTS.items()} | tables
    # In running text a full-width colon is usual.
    guides = (*(ROOT / "docs").glob("*_ja.md"), ROOT / "README_ja.md")
    texts |= {path.name: path.read_text("utf-8").replace("：", "") for path in guides}
    texts |= {f"{name} {key}": text["ja"] for name, options in help_texts().items() for key, text in options.items()}
    assert {id: AVOIDED[word] for id, text in texts.items() for word in AVOIDED if word in text} == {}


def test_every_id_stands_in_one_table() -> None:
    """An id occurs in one table, each table is where it is read, and contains a text in each language and
    nothing else.
    """
    counted = Counter(id for table in TABLES.values() for id in table)
    assert [id for id, count in counted.items() if count > 1] == []
    of_kinds = EVENT_TEXTS.keys() | COMMAND_TEXTS.keys()
    assert counted.keys() == TEXTS.keys() - of_kinds
    wordings = {id: wording for table in TABLES.values() for id, wording in table.items()}
    assert [id for id, wording in wordings.items() if list(wording) != list(LANGUAGES)] == []


def test_what_is_used_is_there_and_what_is_there_is_used() -> None:
    used, named, around = set[str](), set[str](), set[tuple[str, str]]()
    for node in sources():
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            named.add(node.value)
        if isinstance(node, ast.JoinedStr) and node.values and isinstance(node.values[0], ast.Constant):
            last = node.values[-1]
            around.add((str(node.values[0].value), str(last.value) if isinstance(last, ast.Constant) else ""))
        if not isinstance(node, ast.Call) or not node.args:
            continue
        name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        if name in FUNCTIONS or name == "texted":
            given = [keyword.value for keyword in node.keywords] if name == "texted" else node.args
            strings = (
                part.value for argument in given for part in ast.walk(argument) if isinstance(part, ast.Constant)
            )
            used.update(text for text in strings if isinstance(text, str) and ID.fullmatch(text))
    # Tool tips refer to the actions whose keys they contain.
    used = {text for text in used if not any(row.id.startswith(text) for row in rows())}
    actions = {f"action.{row.id}" for row in rows()}
    actions |= {f"menu.{part}" for row in rows() for part in row.menu.split("/") if part}
    actions.add("menu.open_recent")  # the window fills it
    assert used | actions <= TEXTS.keys()
    composed = {
        id
        for id in TEXTS
        for start, end in around
        if id.startswith(start) and id.endswith(end) and id[len(start) :].removesuffix(end) in named
    }
    assert TEXTS.keys() - WORDINGS.keys() <= named | composed | actions | {f"event.{kind}" for kind in KINDS} | NAMES


def test_every_table_is_packed() -> None:
    patterns = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["setuptools"]["package-data"]
    packed = {path for room in ("app", "widgets") for pattern in patterns[room] for path in (ROOT / room).glob(pattern)}
    assert packed >= {*FILES, *(ROOT / "widgets/viewport/shaders").iterdir()}


def test_every_kind_and_bundled_name_is_called_something() -> None:
    assert {f"event.{kind}" for kind in KINDS} | NAMES <= TEXTS.keys()
